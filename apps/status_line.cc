#include "status_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "gloam/text.h"

namespace gloam::cli {
namespace {

// A terminal that is not the controlling one (-1) has no background.
bool is_foreground() {
  const pid_t group = ::tcgetpgrp(STDERR_FILENO);
  return group == ::getpgrp() || group < 0;
}

size_t terminal_width() {
  winsize size = {};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col : 80;
}

}  // namespace

StatusLine::StatusLine() {
  const char* const term = std::getenv("TERM");
  is_possible_ =
      ::isatty(STDERR_FILENO) == 1 && term != nullptr && std::string_view(term) != "dumb";
}

void StatusLine::show(const std::string& text) {
  if (!is_possible_ || !is_foreground()) return;
  // The last column stays empty: some terminals would begin another line.
  const std::string line = printable(text).substr(0, terminal_width() - 1);
  std::fprintf(stderr, "\r\033[J\n%s\033[A\r", line.c_str());
  std::fflush(stderr);
  is_shown_ = true;
}

void StatusLine::clear() {
  if (!is_shown_ || !is_foreground()) return;
  std::fputs("\r\033[J", stderr);
  std::fflush(stderr);
  is_shown_ = false;
}

}  // namespace gloam::cli

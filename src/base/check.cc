#include "base/check.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "gloam/text.h"

namespace gloam {

void check_failed(const char* file, int line, const char* condition, const char* message) {
  std::fprintf(stderr, "gloam: bug at %s:%d: %s (%s)\n", file, line, printable(message).c_str(),
               condition);
  std::signal(SIGABRT, SIG_DFL);  // a handler would take it for want of memory in MuJoCo
  std::abort();
}

}  // namespace gloam

#include "teleop/terminal.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "gloam/drive/teleop.h"

namespace gloam {
namespace teleop {
namespace {

// For signal handlers.
struct SavedTerminal {
  std::atomic<int> descriptor{-1};       // -1 = none
  std::atomic<bool> is_switched{false};  // it differs from `before`
  std::atomic<bool> is_stopping{false};  // Ctrl-Z has restored it
  termios before = {};
};
SavedTerminal saved;

// A crash leaves no broken terminal behind; SIGQUIT is Ctrl-\.
constexpr std::array kFatalSignals = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGQUIT};
std::array<struct sigaction, kFatalSignals.size()> former_fatal;
struct sigaction former_stop;

// A terminal that is not the controlling one (-1) has no background.
bool is_foreground(int descriptor) {
  const pid_t group = ::tcgetpgrp(descriptor);
  return group == ::getpgrp() || group < 0;
}

void on_fatal(int signal) {
  restore_terminal();
  for (size_t i = 0; i < kFatalSignals.size(); ++i)
    if (kFatalSignals[i] == signal) ::sigaction(signal, &former_fatal[i], nullptr);
  ::raise(signal);  // acts when this handler has returned
}

struct sigaction action_of(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  return action;
}

// Ctrl-Z: the process stops within raise() and goes on there.
void on_stop(int) {
  const int error = errno;
  saved.is_stopping = true;
  restore_terminal();
  const struct sigaction stop = action_of(SIG_DFL), again = action_of(on_stop);
  ::sigaction(SIGTSTP, &stop, nullptr);
  sigset_t this_signal;
  sigemptyset(&this_signal);
  sigaddset(&this_signal, SIGTSTP);
  ::raise(SIGTSTP);
  ::pthread_sigmask(SIG_UNBLOCK, &this_signal, nullptr);
  ::sigaction(SIGTSTP, &again, nullptr);
  saved.is_stopping = false;
  errno = error;
}

// Signals that are ignored stay ignored.
void watch_signal(int signal, void (*handler)(int), struct sigaction* former) {
  const struct sigaction action = action_of(handler);
  ::sigaction(signal, nullptr, former);
  if (former->sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
}

void watch_signals() {
  for (size_t i = 0; i < kFatalSignals.size(); ++i)
    watch_signal(kFatalSignals[i], on_fatal, &former_fatal[i]);
  watch_signal(SIGTSTP, on_stop, &former_stop);
}

void leave_signals() {
  for (size_t i = 0; i < kFatalSignals.size(); ++i)
    ::sigaction(kFatalSignals[i], &former_fatal[i], nullptr);
  ::sigaction(SIGTSTP, &former_stop, nullptr);
}

}  // namespace

Status check_terminal(int descriptor) {
  if (::isatty(descriptor) == 1) return {};
  return Error{ErrorKind::kUsage,
               "teleoperation reads keys from the terminal, but standard input is not a terminal",
               {},
               "start gloam in a terminal without redirecting its input, or name a gamepad"};
}

Result<std::unique_ptr<Terminal>> Terminal::open(int descriptor) {
  GLOAM_TRY_STATUS(check_terminal(descriptor));
  if (saved.descriptor >= 0)
    return Error{ErrorKind::kUsage, "another teleoperation reads keys from the terminal"};
  saved.is_switched = false;
  saved.descriptor = descriptor;
  watch_signals();
  std::unique_ptr<Terminal> terminal(new Terminal(descriptor));
  static_cast<void>(terminal->is_ready());
  return terminal;
}

Terminal::~Terminal() {
  restore_terminal();
  leave_signals();
  saved.descriptor = -1;
}

bool Terminal::is_ready() {
  if (is_lost_ || saved.is_stopping || !is_foreground(descriptor_)) return false;
  termios mode = {};
  if (::tcgetattr(descriptor_, &mode) != 0) {  // it has been closed
    is_lost_ = true;
    return false;
  }
  // Shells restore their own mode, also after a SIGSTOP, of which the process is not notified.
  if (saved.is_switched && (mode.c_lflag & ICANON) == 0) return true;
  saved.before = mode;
  mode.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | IEXTEN);
  mode.c_iflag &= ~static_cast<tcflag_t>(IXON | ICRNL | INLCR);  // Ctrl-S must not stop the output
  mode.c_cc[VMIN] = 0;
  mode.c_cc[VTIME] = 0;
  saved.is_switched = true;  // before the change: a signal may come in between
  return ::tcsetattr(descriptor_, TCSANOW, &mode) == 0;
}

std::vector<unsigned char> Terminal::read() {
  std::vector<unsigned char> bytes(256);
  pollfd input{descriptor_, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) return {};
  const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
  if (count > 0) {
    bytes.resize(static_cast<size_t>(count));
    return bytes;
  }
  const bool is_closed = (input.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  if (is_closed || (count < 0 && errno != EAGAIN && errno != EINTR)) is_lost_ = true;
  return {};
}

}  // namespace teleop

// In the background the terminal belongs to another process.
void restore_terminal() noexcept {
  using teleop::saved;
  const int error = errno;
  const int descriptor = saved.descriptor;
  if (descriptor >= 0 && saved.is_switched.exchange(false) && teleop::is_foreground(descriptor)) {
    ::tcflush(descriptor, TCIFLUSH);  // keys for the robot are not for the shell
    ::tcsetattr(descriptor, TCSANOW, &saved.before);
  }
  errno = error;
}

}  // namespace gloam

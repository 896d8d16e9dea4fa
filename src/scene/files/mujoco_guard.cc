#include "scene/files/mujoco_guard.h"

#include <mujoco/mujoco.h>
#include <setjmp.h>
#include <signal.h>

#include <atomic>
#include <cctype>
#include <cstdio>
#include <exception>
#include <mutex>

#include "base/abort_guard.h"
#include "base/check.h"
#include "base/log.h"
#include "base/memory.h"
#include "scene/files/mujoco_compiles.h"

namespace gloam {
namespace {

constexpr size_t kLongestMessage = 1024;
constexpr size_t kMostWarnings = 256;

thread_local jmp_buf* recovery_point = nullptr;
thread_local char error_message[kLongestMessage] = "";
thread_local MujocoWarningCapture* warning_capture = nullptr;
std::atomic<int64_t> warning_count{0};
std::atomic<int> compiles{0};

void copy_message(const char* text) {
  std::snprintf(error_message, sizeof(error_message), "%s", text);
  for (char* c = error_message; *c != 0; ++c) {
    if (*c == '\n' || *c == '\r') *c = ' ';  // errors are one line
  }
}

// MuJoCo's compiler is C++ with its own runtime library, whose unwinder misreads our frames. Its
// exceptions therefore never reach us: they end in its std::terminate(), in abort(), and with the
// process, because the state of its threads and locks is then unknown.
struct sigaction previous_abort = {};

void on_abort(int signal) {
  if (recovery_point != nullptr || compiles > 0)
    end_out_of_memory(", or MuJoCo failed without a message");
  ::sigaction(signal, &previous_abort, nullptr);  // abort() raises it again
  if (previous_abort.sa_handler != SIG_DFL && previous_abort.sa_handler != SIG_IGN) ::raise(signal);
}

void catch_abort() {
  struct sigaction action = {};
  action.sa_handler = on_abort;
  ::sigaction(SIGABRT, &action, &previous_abort);
}

void take_message(const mjLogMessage* message) {
  if (message->level == mjLOG_ERROR) {
    copy_message(message->subject);
    if (recovery_point == nullptr && is_want_of_memory(error_message))
      end_out_of_memory(", in MuJoCo");
    GLOAM_CHECK(recovery_point != nullptr, error_message);
    _longjmp(*recovery_point, 1);
  }
  if (message->level == mjLOG_WARNING) {
    warning_count.fetch_add(1, std::memory_order_relaxed);
    if (warning_capture != nullptr) {
      warning_capture->add(message->subject);
    } else {
      log_warning("MuJoCo: {}", message->subject);
    }
  } else if (message->topic == mjTOPIC_NONE) {
    log_debug("MuJoCo: {}", message->subject);
  }
}

// A warning for which there is no memory is lost: no exception may cross MuJoCo.
void handle_message(const mjLogMessage* message) {
  try {
    take_message(message);
  } catch (const std::exception&) {  // it has been counted
  }
}

}  // namespace

bool is_want_of_memory(std::string_view message) {
  for (const std::string_view said : {"ould not allocate", "memory allocation failed", "bad_alloc"})
    if (message.find(said) != std::string_view::npos) return true;
  return false;
}

std::string plain_message(std::string_view said) {
  const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!said.empty() && is_blank(said.back())) said.remove_suffix(1);
  std::string text;
  for (const char c : said) {
    if (c == '\n') {
      text += "; ";
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      text += c;
    }
  }
  for (const std::string_view prefix : {"XML Error: ", "Error: ", "XML error: "}) {
    if (text.starts_with(prefix)) text.erase(0, prefix.size());
  }
  return text;
}

void install_mujoco_handler() {
  static std::once_flag once;
  std::call_once(once, [] {
    mjLogConfig config = mju_getLogConfig();
    config.logto_file = 0;
    config.logto_console = 0;
    config.logfile[0] = 0;
    mju_setLogConfig(config);
    mju_setLogHandler(handle_message);
    catch_abort();
    // Made at the first call, which must not be one of the compiler's threads when memory has
    // ended: MuJoCo does not check that it got any.
    mj_getCache();
  });
}

const char* mujoco_error_message() { return error_message; }

int64_t mujoco_warning_count() { return warning_count.load(std::memory_order_relaxed); }

MujocoWarningCapture::MujocoWarningCapture() : outer_(warning_capture) {
  install_mujoco_handler();
  warning_capture = this;
}

MujocoWarningCapture::~MujocoWarningCapture() { warning_capture = outer_; }

void MujocoWarningCapture::add(const char* message) {
  if (messages_.size() < kMostWarnings) messages_.emplace_back(message);
}

MujocoCompiles::MujocoCompiles() { ++compiles; }
MujocoCompiles::~MujocoCompiles() { --compiles; }

namespace detail {

// The only setjmp of the program. Locals that change after it would be indeterminate after a jump:
// there are none.
bool run_guarded(void (*call)(void*), void* context) {
  install_mujoco_handler();
  jmp_buf here;
  jmp_buf* const outer = recovery_point;
  recovery_point = &here;
  if (_setjmp(here) != 0) {
    recovery_point = outer;
    return false;
  }
  call_as_outermost(call, context);
  recovery_point = outer;
  return true;
}

}  // namespace detail
}  // namespace gloam

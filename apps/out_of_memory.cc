#include "out_of_memory.h"

#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "gloam/drive/teleop.h"

namespace gloam::cli {
namespace {

std::terminate_handler previous_handler = std::abort;

void on_terminate() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    end_out_of_memory();
  } catch (const std::system_error& error) {
    if (is_want_of_memory(error)) end_out_of_memory();
  } catch (...) {  // the previous handler reports it
  }
  previous_handler();
  std::abort();
}

}  // namespace

void end_when_out_of_memory() { previous_handler = std::set_terminate(on_terminate); }

void end_out_of_memory() {
  restore_terminal();
  constexpr std::string_view kText =
      "gloam: error: out of memory (lower the resolution or the size of the scene)\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kText.data(), kText.size());
  ::_exit(1);
}

// pthread_create reports EAGAIN.
bool is_want_of_memory(const std::system_error& error) {
  return error.code() == std::errc::resource_unavailable_try_again ||
         error.code() == std::errc::not_enough_memory;
}

}  // namespace gloam::cli

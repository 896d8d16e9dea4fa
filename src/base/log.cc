#include "base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "gloam/text.h"

namespace gloam {
namespace {

spdlog::level::level_enum to_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
    case LogLevel::kOff:
      return spdlog::level::off;
  }
  return spdlog::level::info;
}

spdlog::logger& logger() {
  // Leaked: threads may log while statics are destroyed.
  static spdlog::logger& instance = *[] {
    auto* made =
        new spdlog::logger("gloam", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    made->set_pattern("gloam: %^%l%$: %v");
    return made;
  }();
  return instance;
}

}  // namespace

void set_log_level(LogLevel level) { logger().set_level(to_spdlog(level)); }

void log_message(LogLevel level, std::string_view text) {
  logger().log(to_spdlog(level), "{}", printable(text, "\n"));
}

}  // namespace gloam

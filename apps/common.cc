// Functions that several commands share: errors, progress, option parsing.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "command.h"
#include "gloam/topics.h"
#include "interrupt.h"
#include "print.h"

namespace gloam::cli {
namespace {

std::string as_time(double seconds) {
  const auto whole = static_cast<int64_t>(seconds + 0.5);
  return whole < 60 ? fmt::format("{} s", whole)
                    : fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

std::atomic<bool> progress_line_open{false};  // jobs show progress from their own threads

}  // namespace

int fail(const Error& error) {
  finish_progress();
  tell("gloam: error: {}\n", error.to_string());
  return error.exit_code();
}

std::function<void(const Progress&)> progress_line(const Globals& globals) {
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  return [terminal, quiet = globals.quiet, last_print = -1e9](const Progress& progress) mutable {
    // Nothing for the first moments: most commands end before anybody wonders.
    const double interval = terminal ? 0.2 : 10.0;
    if (!quiet && progress.seconds > 1.0 && progress.seconds - last_print >= interval) {
      last_print = progress.seconds;
      const double fraction = std::min(std::max(progress.done, 0.0), 1.0);
      double left = progress.left;
      if (left == 0 && fraction > 0.01) left = progress.seconds * (1 - fraction) / fraction;
      const std::string eta = left > 0 ? fmt::format(", about {} left", as_time(left)) : "";
      if (terminal) {
        constexpr int kWidth = 30;
        const int filled = static_cast<int>(fraction * kWidth);
        std::fprintf(stderr, "\r\033[K%s [%s%s] %3d %%, %s%s", printable(progress.what).c_str(),
                     std::string(filled, '#').c_str(), std::string(kWidth - filled, '.').c_str(),
                     static_cast<int>(fraction * 100), as_time(progress.seconds).c_str(),
                     eta.c_str());
        progress_line_open = true;
      } else {
        std::fprintf(stderr, "gloam: %s: %d %%, %s%s\n", printable(progress.what).c_str(),
                     static_cast<int>(fraction * 100), as_time(progress.seconds).c_str(),
                     eta.c_str());
      }
      std::fflush(stderr);
    }
  };
}

ProgressCallback progress_display(const Globals& globals) {
  return [show = progress_line(globals)](const Progress& progress) {
    stop_on_interrupt();
    if (progress.what == kFinishingFiles) finish_on_interrupt();
    show(progress);
    return !interrupted();
  };
}

void finish_progress() {
  if (progress_line_open) std::fputs("\r\033[K", stderr);
  progress_line_open = false;
}

namespace {

CLI::Validator number_check(const char* what, bool (*good)(double)) {
  return {[what, good](const std::string& text) {
            double value = 0;
            const char* end = text.data() + text.size();
            const auto [after, error] = std::from_chars(text.data(), end, value);
            const bool ok = error == std::errc() && after == end && std::isfinite(value);
            return ok && good(value) ? std::string() : text + " is not a " + what + " number";
          },
          "NUMBER"};
}

}  // namespace

CLI::Validator positive_number() {
  return number_check("positive", [](double value) { return value > 0; });
}
CLI::Validator non_negative_number() {
  return number_check("non-negative", [](double value) { return value >= 0; });
}

void add_access_options(CLI::App& command, FileAccess& access, std::vector<std::string>& packages) {
  command.add_option("--root", access.root,
                     "Folder that contains all files of the model; files outside it are rejected");
  command.add_flag("--strict", access.strict, "Use the folder of the model file as --root");
  command.add_option("--package", packages,
                     "Folder that package://NAME refers to, as NAME=FOLDER (repeatable)");
}

Status apply_packages(FileAccess& access, const std::vector<std::string>& packages) {
  for (const std::string& text : packages) {
    const size_t split = text.find('=');
    if (split == std::string::npos || split == 0 || split + 1 == text.size()) {
      return Error{ErrorKind::kUsage, fmt::format("--package {}: expected NAME=FOLDER", text)};
    }
    access.packages.emplace_back(text.substr(0, split), text.substr(split + 1));
  }
  return {};
}

namespace {

void tell_all(const char* heading, const std::vector<Error>& errors) {
  constexpr size_t kMaxListed = 20;
  for (size_t i = 0; i < std::min(errors.size(), kMaxListed); ++i)
    tell("gloam: {}: {}\n", heading, errors[i].to_string());
  if (errors.size() > kMaxListed)
    tell("gloam: {}: {} more; run gloam info to list them\n", heading, errors.size() - kMaxListed);
}

}  // namespace

Result<World> compile(const Scene& scene, const Globals& globals, const std::string& keyframe) {
  const EndOnInterrupt watched;
  const ProgressCallback tell_progress = [show = progress_line(globals)](const Progress& progress) {
    show(progress);
    return true;  // an interrupt does not wait for the end of it
  };
  Result<World> world = keyframe.empty() ? World::compile(scene, tell_progress)
                                         : World::compile_at(scene, keyframe, tell_progress);
  finish_progress();
  if (!world.ok()) return world;
  tell_all("note", world->notes());
  tell_all("note", topic_notes(*world));
  tell_all("warning: not supported", world->unsupported());
  return world;
}

Status parse_resolution(const std::string& text, int& width, int& height) {
  const char* end = text.data() + text.size();
  const auto [after_width, error] = std::from_chars(text.data(), end, width);
  if (error == std::errc() && after_width != end && *after_width == 'x') {
    const auto [after_height, error2] = std::from_chars(after_width + 1, end, height);
    constexpr int kLargest = 16384;
    if (error2 == std::errc() && after_height == end && width >= 1 && height >= 1 &&
        width <= kLargest && height <= kLargest) {
      return {};
    }
  }
  return Error{ErrorKind::kUsage,
               fmt::format("--resolution {}: expected WIDTHxHEIGHT, each from 1 to 16384", text),
               {},
               "for example 640x480"};
}

}  // namespace gloam::cli

#include "world/compile/progress/load_progress.h"

#include <fmt/format.h>

#include <algorithm>

namespace gloam {

LoadProgress::LoadProgress(const std::vector<uint64_t>& bytes) {
  for (const uint64_t n : bytes) files_.push_back({static_cast<double>(n), 0});
}

std::string LoadProgress::report(size_t file, double share, double seconds) {
  constexpr double kInterval = 2;  // [s]
  const std::lock_guard lock(mutex_);
  files_[file].share = std::max(files_[file].share, share);
  if (seconds - told_ < kInterval) return {};
  told_ = seconds;
  double all = 0, read = 0;
  for (const File& f : files_) all += f.bytes, read += f.bytes * f.share;
  const auto whole = std::ranges::count_if(files_, [](const File& f) { return f.share >= 1; });
  const double left = read > 0 ? seconds * (all - read) / read : 0;
  return fmt::format("reading model files: {} of {}, {:.0f} of {:.0f} MB{}", whole, files_.size(),
                     read / 1e6, all / 1e6,
                     left > 0 ? fmt::format(", about {:.0f} s left", left) : "");
}

double LoadProgress::share() const {
  const std::lock_guard lock(mutex_);
  double all = 0, read = 0;
  for (const File& f : files_) all += f.bytes, read += f.bytes * f.share;
  return all > 0 ? read / all : 1;
}

}  // namespace gloam

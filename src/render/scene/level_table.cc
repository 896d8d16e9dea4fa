#include "render/scene/level_table.h"

#include <algorithm>

namespace gloam {
namespace {

// 256 spans of the 30 ms that a slow rolling shutter takes are 0.12 ms: 80 in a period of the
// mains' ripple. What is faster is averaged.
constexpr size_t kBins = 256;
constexpr size_t kMostValues = size_t{1} << 22;  // of the table: crowds of lamps get fewer bins
constexpr int kTimes = 4;                        // in each bin

template <class Rows>
size_t scheduled(const Rows& rows) {
  return static_cast<size_t>(
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.schedule >= 0; }));
}

}  // namespace

void LevelTable::update(const RenderDescription& description, double open, double close) {
  bins_.clear();
  lights_.assign(description.lights.size(), {});
  materials_.assign(description.materials.size(), {});
  if (description.schedules.empty()) return;
  const size_t count = scheduled(description.lights) + scheduled(description.materials);
  bin_count_ =
      static_cast<uint32_t>(std::clamp(kMostValues / std::max<size_t>(count, 1), size_t{1}, kBins));
  uint32_t lamp = 0;  // lights, then materials
  for (size_t i = 0; i < lights_.size(); ++i)
    lights_[i] = level(description, description.lights[i].schedule, lamp++, open, close);
  for (size_t i = 0; i < materials_.size(); ++i)
    materials_[i] = level(description, description.materials[i].schedule, lamp++, open, close);
}

LightLevel LevelTable::level(const RenderDescription& description, int schedule, uint32_t lamp,
                             double open, double close) {
  if (schedule < 0) return {};
  const auto at = [&](double time) {
    return light_level(description.schedules[static_cast<size_t>(schedule)], time,
                       description.schedule_seed, lamp);
  };
  if (!(close > open)) return {.mean = static_cast<float>(at(open))};
  const size_t first = bins_.size();
  const int times = kTimes * static_cast<int>(bin_count_);
  double sum = 0, part = 0;
  for (int k = 0; k < times; ++k) {
    part += at(open + (close - open) * (k + 0.5) / times);
    if ((k + 1) % kTimes != 0) continue;
    bins_.push_back(static_cast<float>(part / kTimes));
    sum += part;
    part = 0;
  }
  const auto mean = static_cast<float>(sum / times);
  const auto begin = bins_.begin() + static_cast<std::ptrdiff_t>(first);
  if (std::all_of(begin, bins_.end(), [&](float bin) { return bin == *begin; })) {
    bins_.resize(first);
    return {.mean = mean};
  }
  for (size_t i = first; i < bins_.size(); ++i) bins_[i] /= mean;  // above 0: not all bins are
  return {.mean = mean, .row = static_cast<int>(first / bin_count_)};
}

}  // namespace gloam

#include "sim/effects/soil/soil_tracks.h"

#include <algorithm>

#include "sim/effects/shared_version.h"

namespace gloam {
namespace {
constexpr int kFirstVersions = 4;
}

void SoilTracks::Box::add(const Box& other) {
  low_x = std::min(low_x, other.low_x), low_y = std::min(low_y, other.low_y);
  high_x = std::max(high_x, other.high_x), high_y = std::max(high_y, other.high_y);
}

SoilTracks::SoilTracks(const SoilDescription& soil)
    : soil_(soil), nx_(soil.nx), ny_(soil.ny), height_(soil.cells()), changed_(nothing()) {
  for (int i = 0; i < kFirstVersions; ++i) {
    versions_.push_back({std::make_shared<SurfaceHeights>(), nothing()});
    versions_.back().heights->height.resize(height_.size());
  }
}

void SoilTracks::reset() {
  std::fill(height_.begin(), height_.end(), 0.0f);
  changed_ = nothing();
  for (Version& version : versions_) version.stale = everything();
  shown_.reset();
}

void SoilTracks::take_over(const SoilTracks& before) {
  height_ = before.height_;
  changed_ = before.changed_;
  shown_ = before.shown_;
  for (Version& version : versions_) version.stale = everything();
}

void SoilTracks::set_height(int cell, float height) {
  const int x = cell % nx_, y = cell / nx_;
  const float fallen = fallen_on(cell);
  height_[static_cast<size_t>(cell)] = height < 0   ? height - fallen
                                       : height > 0 ? height + fallen
                                                    : 0;
  changed_.add({x, y, x, y});
}

const std::shared_ptr<const SurfaceHeights>& SoilTracks::field() {
  if (!changed_.empty()) publish();
  return shown_;
}

void SoilTracks::publish() {
  for (Version& version : versions_) version.stale.add(changed_);
  changed_ = nothing();
  shown_.reset();
  auto free = std::find_if(versions_.begin(), versions_.end(),
                           [](const Version& version) { return is_free(version.heights); });
  if (free == versions_.end()) {  // readers hold all
    versions_.push_back({std::make_shared<SurfaceHeights>(), everything()});
    free = versions_.end() - 1;
    free->heights->height.resize(height_.size());
  }
  for (int y = free->stale.low_y; y <= free->stale.high_y; ++y) {
    const auto row = static_cast<std::ptrdiff_t>(y) * nx_;
    std::copy(height_.begin() + row + free->stale.low_x,
              height_.begin() + row + free->stale.high_x + 1,
              free->heights->height.begin() + row + free->stale.low_x);
  }
  free->stale = nothing();
  shown_ = free->heights;
}

}  // namespace gloam

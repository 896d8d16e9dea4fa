#pragma once
// What bodies have left of a bed's surface, for whoever looks: versions of its heights that are
// made when a Snapshot asks and something has changed.

#include <memory>
#include <vector>

#include "sim/effects/height_change.h"
#include "world/soil_description.h"

namespace gloam {

class SoilTracks {
 public:
  explicit SoilTracks(const SoilDescription& soil);

  void reset();
  /// Goes on with what another bed of the same grid shows.
  void take_over(const SoilTracks& before);
  float height(int cell) const { return height_[static_cast<size_t>(cell)]; }
  /// Of a cell against rest [m].
  void set_height(int cell, float height);
  /// Null where nothing has changed since the beginning.
  const std::shared_ptr<const SurfaceHeights>& field();

 private:
  struct Box {
    int low_x, low_y, high_x, high_y;  // cells, inclusive
    void add(const Box& other);
    bool empty() const { return low_x > high_x; }
  };
  struct Version {
    std::shared_ptr<SurfaceHeights> heights;
    Box stale;  // what it does not have yet
  };
  Box nothing() const { return {nx_, ny_, -1, -1}; }
  Box everything() const { return {0, 0, nx_ - 1, ny_ - 1}; }
  void publish();

  const int nx_, ny_;
  std::vector<float> height_;
  Box changed_;  // since shown_ was made
  std::vector<Version> versions_;
  std::shared_ptr<const SurfaceHeights> shown_;
};

}  // namespace gloam

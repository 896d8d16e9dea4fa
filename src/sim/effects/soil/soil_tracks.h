#pragma once
// Tracks of bodies in a bed's surface, for readers on other threads: versions of its heights, made
// when a Snapshot asks and something has changed.
//
// Falling snow evens out hollows and heaps by its own depth: an estimate of the effect of wind and
// slides. A height is stored as of the time when it was set, together with the negative depth that
// had fallen by then, so that nothing has to be done until somebody reads it.

#include <memory>
#include <vector>

#include "instant/surface_heights.h"
#include "world/effects/soil_description.h"

namespace gloam {

class SoilTracks {
 public:
  explicit SoilTracks(const SoilDescription& soil);

  void reset();
  /// Goes on with what another bed of the same grid shows.
  void take_over(const SoilTracks& before);
  /// Says how much has fallen since time 0 where all of it lies [m].
  void let_fall(double fallen) { fallen_ = fallen; }
  /// Height of a cell against the undisturbed surface [m].
  float height(int cell) const {
    return track_height(height_[static_cast<size_t>(cell)], fallen_on(cell));
  }
  void set_height(int cell, float height);
  /// As kept, for track_height(). Null where nothing has changed since the beginning.
  const std::shared_ptr<const SurfaceHeights>& field();

 private:
  struct Box {
    int low_x, low_y, high_x, high_y;  // cells, inclusive
    void add(const Box& other);
    bool empty() const { return low_x > high_x; }
  };
  struct Version {
    std::shared_ptr<SurfaceHeights> heights;
    Box stale;  // part that it does not have yet
  };
  float fallen_on(int cell) const {
    return static_cast<float>(soil_.share_of(static_cast<size_t>(cell)) * fallen_);
  }
  Box nothing() const { return {nx_, ny_, -1, -1}; }
  Box everything() const { return {0, 0, nx_ - 1, ny_ - 1}; }
  void publish();

  const SoilDescription& soil_;
  const int nx_, ny_;
  double fallen_ = 0;  // [m]
  std::vector<float> height_;
  Box changed_;  // since shown_ was made
  std::vector<Version> versions_;
  std::shared_ptr<const SurfaceHeights> shown_;
};

}  // namespace gloam

#pragma once
// What bodies have left of a bed's surface, for whoever looks: versions of its heights that are
// made when a Snapshot asks and something has changed.
//
// Where snow falls, hollows and heaps are evened out by as much as falls: an estimate of what wind
// and slides do. A height is kept as what it was when it was set, and what had fallen by then with
// its sign against it, so that nothing has to be done until somebody looks.

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
  /// Of a cell against the undisturbed surface [m].
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
    Box stale;  // what it does not have yet
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

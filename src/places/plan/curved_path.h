#pragma once
// The level, gently curved axis of a tunnel, and surfaces and colliders along it.

#include <string>
#include <utility>
#include <vector>

#include "geometry/solid.h"
#include "gloam/scene/environment.h"
#include "gloam/types.h"
#include "places/dice.h"
#include "places/prop.h"

namespace gloam {

class CurvedPath {
 public:
  struct Shape {
    double length;  ///< [m]
    double curve;   ///< minimum radius of curvature [m]
    double beyond;  ///< continuation at either end [m]
  };
  /// A point of the path at z = 0. s: along the path from its western end [m]; heading [rad].
  struct Station {
    double s, x, y, heading;
  };

  /// Bends left and right. The world's origin is a quarter of the length from the western end, and
  /// looks along +x.
  CurvedPath(const Shape& shape, Dice* dice);

  const std::vector<Station>& stations() const { return stations_; }  ///< one per metre
  double first() const { return stations_.front().s; }
  double last() const { return stations_.back().s; }
  Station at(double s) const;
  /// Stations from one to another, both included, at most `step` apart [m].
  std::vector<Station> within(double from, double to, double step = 1) const;

  /// In the world; `left` of the path [m].
  static Vec3f point(const Station& station, double left, double z);
  Pose pose(double s, double left, double z, double turned) const;

  /// A strip along the path between two lines (left, z) of the cross section; its front is to the
  /// left of the way from a to b, seen along the path.
  Solid strip(double from, double to, Vec2f a, Vec2f b) const;
  /// A round tube or cable along a line of the cross section.
  Solid cable(double from, double to, std::pair<double, double> line, double radius,
              int segments = 10) const;

  /// A box below the whole path, with its top at z = 0 and `margin` around [m].
  void collide_ground(PropPart* part, float margin) const;
  /// Floors LABEL_1 … of about 10 m of the path each, half as wide as `width` [m].
  std::vector<Region> regions(const std::string& label, double width, double height) const;

 private:
  double length_;
  std::vector<Station> stations_;
};

/// A box between two stations along a line of the cross section: `thick` to the right of the way
/// from p to q seen from behind, below 0 to the left [m].
void collide_strip(PropPart* part, const CurvedPath::Station& a, const CurvedPath::Station& b,
                   std::pair<Vec2f, Vec2f> line, double thick);

}  // namespace gloam

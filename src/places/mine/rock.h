#pragma once
// The rock around the drift of a mine: walls and crown as blasting leaves them, faces at both ends.

#include <utility>
#include <vector>

#include "gloam/scene/place.h"
#include "places/plan/curved_path.h"
#include "places/smooth_noise.h"

namespace gloam {

/// A recess in one wall.
struct Niche {
  double s;          ///< its middle along the path [m]
  double side;       ///< +1 left, -1 right
  double width = 4;  ///< along the path [m]
  double depth = 2;  ///< [m]
};

class MineRock {
 public:
  MineRock(const MineOptions& options, const CurvedPath& path, std::vector<Niche> niches);

  const CurvedPath& path() const { return path_; }
  double half() const { return half_; }  ///< half of the mean width [m]
  double wall() const { return wall_; }  ///< height at which the mean crown begins [m]
  const std::vector<Niche>& niches() const { return niches_; }

  /// The mean cross section, (left, z), without relief: u from 0 at the left foot over the crown to
  /// 1 at the right foot.
  Vec2f mean(double u) const;
  /// Height of the mean crown [m].
  double crown(double left) const;
  /// The cross section of the rock.
  Vec2f surface(double s, double u) const;
  /// Free distance between the path and the rock of a side up to head height, between two places
  /// along the path [m].
  double clear(double from, double to, double side) const;
  /// Does a niche of the side reach here?
  bool is_niche(double s, double side, double margin = 0) const;

  Solid walls(double from, double to) const;
  Solid face(bool west) const;
  void add_colliders(PropPart* part) const;

 private:
  double relief(double s, double around) const;
  double recess(double s, double side) const;

  const MineOptions& o_;
  const CurvedPath& path_;
  SmoothNoise noise_;
  std::vector<Niche> niches_;
  double half_, wall_, around_;  // around_: length of the mean cross section [m]
};

}  // namespace gloam

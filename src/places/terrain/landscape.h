#pragma once
// The lie of the land: heights of open country with a road, a pond and levelled sites, as a
// function of the place. World frame, z up, origin on level ground at z = 0 [m].

#include <optional>
#include <vector>

#include "base/vec.h"
#include "gloam/scene/place.h"
#include "places/dice.h"
#include "places/plan/floor_plan.h"
#include "places/smooth_noise.h"

namespace gloam {

/// A level rectangle for a building, turned.
struct BuildingSite {
  double x = 0, y = 0, heading = 0;  ///< place of its middle; its front looks along the heading
  double half_x = 0, half_y = 0;     ///< [m] along the heading, across it
  double z = 0;                      ///< height of its ground [m]
  /// Distance of a point outside of it [m]; 0 inside.
  double distance(double px, double py) const;
};

struct Pond {
  double x = 0, y = 0, radius = 0;  ///< [m] of its water, about
  double z = 0;                     ///< height of its surface [m]
};

class Landscape {
 public:
  explicit Landscape(const TerrainOptions& options);

  /// Height of the ground, also beyond its border [m].
  double height(double x, double y) const;
  /// Unit, upwards.
  Vec3f normal(double x, double y) const;

  /// y of the road's middle.
  double road_y(double x) const;
  double road_heading(double x) const;
  /// To its middle [m]; far where there is none.
  double from_road(double x, double y) const;
  /// 0 in the pond's middle, 1 on its shore, more outside; large where there is none.
  double pond_share(double x, double y) const;
  /// -1 dry and bare … 1 lush.
  double moisture(double x, double y) const { return tint_.sum(x / 14, y / 14, 3); }
  /// Displacement of a border between kinds of ground, about -1 … 1.
  double ragged(double x, double y) const { return ragged_.sum(x / 1.7, y / 1.7, 3); }

  const std::optional<Pond>& pond() const { return pond_; }
  const std::vector<BuildingSite>& sites() const { return sites_; }
  Rect area() const { return area_; }
  bool has_road() const { return o_.road > 0; }
  double road_width() const { return o_.road; }
  /// Is it free of road, water and buildings, by that much [m]?
  bool is_free(double x, double y, double margin) const;

 private:
  double hills(double x, double y) const;
  double country(double x, double y) const;  // hills with the level places in them
  void limit_slopes();
  void place_sites(Dice* dice);
  void place_pond(Dice* dice);
  void grade_road();
  double road_z(double x) const;

  TerrainOptions o_;
  Rect area_;
  SmoothNoise hills_, ragged_, tint_, rough_;
  double wave_ = 40, amplitude_ = 1, base_ = 0;  // [m]
  double bend_ = 0, bend_phase_ = 0, bend_wave_ = 60;
  std::vector<double> road_z_;  // every kRoadStep, from beyond the western border
  std::vector<BuildingSite> sites_;
  std::optional<Pond> pond_;
};

}  // namespace gloam

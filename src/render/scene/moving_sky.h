#pragma once
// The environment of a clear sky that changes with the hour: maps for heights of the sun, made when
// they are needed, turned to where the sun is.

#include <vector>

#include "render/scene/environment_table.h"
#include "world/sky/day_cycle.h"

namespace gloam {

struct MovingSun {
  Vec3f to_sun;       ///< unit, world
  Vec3f illuminance;  ///< of a surface that faces it [lx]; zero when it has set
};

class MovingSky {
 public:
  explicit MovingSky(const DayCycle& day) : day_(day) {}

  /// A function of `time` [s] alone. A map that it has to make takes a few tenths of a second.
  void update(double time);
  /// Valid until the next update.
  EnvironmentView view() const;
  const MovingSun& sun() const { return sun_; }

 private:
  struct Map {
    int row = 0;  ///< of sky_elevation()
    EnvironmentTable table;
    Vec3f sun;             ///< illuminance of a surface that faces it [lx]
    float brightness = 0;  ///< illuminance of level ground by it [lx], > 0
  };
  const Map& map_of(int row);

  DayCycle day_;
  std::vector<Map> maps_;  ///< the last that were needed, the latest last
  MovingSun sun_;
  int row_ = 0;
  float scale_ = 1;
};

}  // namespace gloam

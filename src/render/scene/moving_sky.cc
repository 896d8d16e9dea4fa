#include "render/scene/moving_sky.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace gloam {
namespace {

// Two around each of a few cameras' instants.
constexpr size_t kMostMaps = 8;

}  // namespace

const MovingSky::Map& MovingSky::map_of(int row) {
  const auto known =
      std::find_if(maps_.begin(), maps_.end(), [row](const Map& map) { return map.row == row; });
  if (known != maps_.end()) {
    std::rotate(known, known + 1, maps_.end());
    return maps_.back();
  }
  if (maps_.size() == kMostMaps) maps_.erase(maps_.begin());
  const SkyLight sky = sky_of_row(day_, row);
  Result<EnvironmentTable> table =
      EnvironmentTable::make(sky.width, sky.height, sky.texels, "moving sky");
  GLOAM_CHECK(table.ok(), "the generated sky must be finite and not negative");
  maps_.push_back(
      {row, std::move(table).value(), sky.sun_illuminance, luminance(sky.sky_illuminance)});
  return maps_.back();
}

void MovingSky::update(double time) {
  sun_.to_sun = to_sun_at(day_, time);
  const double at = sky_row(std::asin(std::clamp<double>(sun_.to_sun.z, -1, 1)));
  const int low = std::min(static_cast<int>(at), sky_count() - 2);
  const auto fraction = static_cast<float>(at - low);
  // Map shown: one of the two around the sun's elevation, as bright as between the two.
  const Map& below = map_of(low);
  const Vec3f sun_below = below.sun;
  const float bright_below = below.brightness;
  const Map& above = map_of(low + 1);
  sun_.illuminance = lerp(sun_below, above.sun, fraction);
  const float rise = std::log(above.brightness / bright_below);
  row_ = fraction < 0.5f ? low : low + 1;
  scale_ = std::exp(fraction < 0.5f ? rise * fraction : rise * (fraction - 1));
}

EnvironmentView MovingSky::view() const {
  const auto map =
      std::find_if(maps_.begin(), maps_.end(), [this](const Map& m) { return m.row == row_; });
  GLOAM_CHECK(map != maps_.end(), "update() must be called before view()");
  EnvironmentView view =
      map->table.view(turned_about_z(std::atan2(sun_.to_sun.y, sun_.to_sun.x)), scale_);
  view.changes = true;
  return view;
}

}  // namespace gloam

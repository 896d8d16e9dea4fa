// Open country: meadow, a gravel track, a pond, rocks, trees and what people left there.

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "places/furnish/interior.h"
#include "places/generators.h"
#include "places/plan/ground_zones.h"
#include "places/terrain/terrain_parts.h"

namespace gloam {
namespace {

constexpr double kMostSamples = 250000;  // samples of the ground: a limit for pictures and compiler

// A box above the ground of a rectangle.
Region region_of(const Landscape& land, const char* label, std::string name, const Rect& r) {
  double low = 1e9, high = -1e9;
  for (int i = 0; i <= 8; ++i)
    for (int k = 0; k <= 8; ++k) {
      const double z = land.height(r.x0 + r.width() * i / 8, r.y0 + r.depth() * k / 8);
      low = std::min(low, z), high = std::max(high, z);
    }
  return {std::move(name), label, {r.x0, r.y0, low}, {r.x1, r.y1, high + 2}};
}

void add_regions(const Landscape& land, Place* place) {
  const Rect a = land.area().grown(-1);
  if (land.has_road()) {
    const int count = std::max(1, static_cast<int>(std::lround(a.width() / 10)));
    for (int i = 0; i < count; ++i) {
      const double x0 = a.x0 + a.width() * i / count, x1 = a.x0 + a.width() * (i + 1) / count;
      const double y = land.road_y((x0 + x1) / 2), half = land.road_width() / 2;
      place->regions.push_back(
          region_of(land, "road", "road_" + std::to_string(i + 1), {x0, y - half, x1, y + half}));
    }
  }
  place->regions.push_back(region_of(land, "meadow", "meadow_1", {a.x0, a.y0, a.x1, -2}));
  place->regions.push_back(region_of(land, "meadow", "meadow_2", {a.x0, 2, a.x1, a.y1}));
  if (const auto& pond = land.pond()) {
    const double r = 1.6 * pond->radius;
    const Rect around{std::max(a.x0, pond->x - r), std::max(a.y0, pond->y - r),
                      std::min(a.x1, pond->x + r), std::min(a.y1, pond->y + r)};
    place->regions.push_back(region_of(land, "shore", "shore", around));
  }
  for (size_t i = 0; i < land.sites().size(); ++i) {
    const BuildingSite& s = land.sites()[i];
    place->regions.push_back(region_of(land, "barn", "barn_" + std::to_string(i + 1),
                                       {s.x - 1.2, s.y - 1.2, s.x + 1.2, s.y + 1.2}));
  }
}

void add_water(const Landscape& land, Workshop* shop, Place* place) {
  if (!land.pond()) return;
  const Pond& pond = *land.pond();
  constexpr int kAround = 96;
  Path points;
  for (int k = 0; k <= kAround; ++k) {
    const double a = 2 * M_PI * k / kAround;
    double r = pond.radius;
    while (land.pond_share(pond.x + r * std::cos(a), pond.y + r * std::sin(a)) < 1.08 &&
           r < 2 * pond.radius)
      r += 0.05;
    points.push_back({0, 0, 0});
    points.push_back({float(r * std::cos(a)), float(r * std::sin(a)), 0});
  }
  Prop p;
  p.label = "water";
  p.body().show("surface", shop->water(), Solid(sheet_facing_up(points, 2)));
  place->put(place->add(std::move(p)), "", {{pond.x, pond.y, pond.z}});
}

}  // namespace

Result<Place> make_terrain(const TerrainOptions& options) {
  Place place("terrain");
  const Landscape land(options);
  Workshop shop({"terrain", options.seed}, place.style, &place.materials);
  const double step =
      std::max(options.resolution, std::sqrt(options.length * options.width / kMostSamples));
  place.grounds.push_back({"ground", sample_landscape(land, land.area(), step), 1.0});
  show_ground(land, place.grounds[0].field, &shop, &place);
  show_country(land, place.grounds[0].field, &shop, &place);
  show_road_beyond(land, &shop, &place);
  add_water(land, &shop, &place);
  add_fence(land, options.seed, &shop, &place);
  add_barns(land, options.seed, &shop, &place);
  add_rocks(land, options, &place);
  add_trees(land, options, &place);
  add_grass(land, options, &shop, &place);
  add_litter(land, options, &shop, &place);
  add_regions(land, &place);
  Dice dice(options.seed, "light");
  place.sky = draw_sky(&dice, true);
  place.ev100 = 13.3;
  return place;
}

}  // namespace gloam

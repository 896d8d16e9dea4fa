// Trees and grass of open country.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/check.h"
#include "places/plan/ground_zones.h"
#include "places/terrain/terrain_parts.h"

namespace gloam {
namespace {

constexpr double kGrassPatch = 1.5;  // patch of grass, square [m]
constexpr int kGrassShapes = 3;
constexpr size_t kMostPatches = 2600;

// Would a trunk there touch a stone that can move?
bool has_loose(const Place& place, double x, double y) {
  constexpr double kMinRockDistance = 0.8;  // [m]
  return std::any_of(place.placements().begin(), place.placements().end(), [&](const Placement& p) {
    return p.loose && std::hypot(p.X_WP.p.x - x, p.X_WP.p.y - y) < kMinRockDistance;
  });
}

}  // namespace

int make(Place* place, const char* kind, uint64_t seed, Vec3 size) {
  const Result<int> made = place->make({kind, seed, size});
  GLOAM_CHECK(made.ok(), made.error().message.c_str());
  return *made;
}

Quat leaning(Vec3f n, double turned) {
  const double angle = std::acos(std::min(1.0, double(n.z)));
  const Quat lean = angle > 1e-4 ? turn({-n.y, n.x, 0}, angle) : Quat{};
  const double c = std::cos(turned / 2), s = std::sin(turned / 2);
  return {lean.w * c - lean.z * s, lean.x * c + lean.y * s, lean.y * c - lean.x * s,
          lean.w * s + lean.z * c};
}

Solid blades(const BladeOptions& o, Dice* dice) {
  TriangleMesh mesh;
  for (int i = 0; i < o.count; ++i) {
    // In a disc that reaches over its neighbours, so that no edge shows.
    const double from = dice->uniform(0, 2 * M_PI), out_by = 0.85 * std::sqrt(dice->uniform());
    const float x = float(out_by * o.square * std::cos(from)),
                y = float(out_by * o.square * std::sin(from));
    const float a = float(dice->uniform(0, 2 * kPi)), h = float(o.high * dice->uniform(0.35, 1));
    const float bend = h * float(dice->uniform(0.1, 0.75)),
                half = float(o.half_width * dice->uniform(0.65, 1.35));
    const Vec3f out{std::cos(a), std::sin(a), 0}, side{-std::sin(a) * half, std::cos(a) * half, 0};
    const Vec3f foot{x, y, -0.04f}, knee = foot + out * (0.3f * bend) + Vec3f{0, 0, 0.6f * h},
                                    tip = foot + out * bend + Vec3f{0, 0, h};
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3f p : {foot - side, foot + side, knee - side * 0.8f, knee + side * 0.8f, tip}) {
      mesh.positions.push_back(p);
      mesh.normals.push_back(normalize(Vec3f{-out.x, -out.y, 0.7f}));
    }
    for (const uint32_t k : {0u, 1u, 3u, 0u, 3u, 2u, 2u, 3u, 4u}) mesh.indices.push_back(first + k);
  }
  return Solid(std::move(mesh));
}

Pose on_ground(const Landscape& land, double x, double y, double turned) {
  return {{x, y, land.height(x, y)}, leaning(land.normal(x, y), turned)};
}

void add_trees(const Landscape& land, const TerrainOptions& o, Place* place) {
  Dice dice(o.seed, "trees");
  const Rect area = land.area();
  const auto tree = [&](bool far) {
    const double kind = dice.uniform();
    const uint64_t variant = static_cast<uint64_t>(dice.integer(0, 1));
    const double high = dice.pick<double>({6, 8, 10});
    if (!far && kind < 0.45) return make(place, "bush", variant, {1.6, 1.6, high / 6});
    return kind < 0.75 ? make(place, "tree", variant, {high, high, high})
                       : make(place, "conifer", variant, {high, high, 1.3 * high});
  };
  const int count = static_cast<int>(std::lround(std::min(o.trees * area.area() / 90, 150.0)));
  for (int i = 0; i < count; ++i) {
    const double x = dice.uniform(area.x0, area.x1), y = dice.uniform(area.y0, area.y1);
    const double turned = dice.uniform(0, 2 * M_PI);
    const int made = tree(false);
    if (!land.is_free(x, y, 2.2) || std::hypot(x, y) < 5 || has_loose(*place, x, y)) continue;
    place->put(made, "", {{x, y, land.height(x, y)}, turn({0, 0, 1}, turned)});
  }
  // Beyond the border they are drawn alone.
  std::map<int, std::vector<Pose>> beyond;
  for (int i = 0; i < 420; ++i) {
    const double a = dice.uniform(0, 2 * M_PI), out = 7 + 190 * dice.uniform();
    const double x = std::cos(a) * (area.x1 * 1.2 + out), y = std::sin(a) * (area.y1 * 1.2 + out);
    const double turned = dice.uniform(0, 2 * M_PI);
    const int made = tree(true);
    if (o.trees == 0 || land.from_road(x, y) < o.road / 2 + 3 ||
        land.moisture(x / 3, y / 3) < -0.12 || area.distance_to(x, y) < 4)
      continue;
    beyond[made].push_back({{x, y, land.height(x, y) - 0.05}, turn({0, 0, 1}, turned)});
  }
  for (auto& [made, poses] : beyond)
    place->scatter(made, fmt::format("forest/{}_{}", place->prop(made).label, made),
                   std::move(poses));
}

void add_grass(const Landscape& land, const TerrainOptions& o, Workshop* shop, Place* place) {
  if (o.grass == 0) return;
  Dice dice(o.seed, "grass");
  const std::array<std::string, 3> looks = {
      shop->blades("grass_dry", {0.145, 0.125, 0.052}, {0.090, 0.070, 0.032}),
      shop->blades("grass", {0.075, 0.092, 0.026}, {0.105, 0.098, 0.040}),
      shop->blades("grass_lush", {0.048, 0.076, 0.018}, {0.066, 0.080, 0.026})};
  std::array<int, 3 * kGrassShapes> props{};
  for (size_t i = 0; i < props.size(); ++i) {
    const double high =
        (0.10 + 0.22 * o.grass) * (0.7 + 0.3 * static_cast<double>(i % kGrassShapes));
    Prop p;
    p.label = "grass";
    const int count = static_cast<int>((900 + 3600 * o.grass) * (i % kGrassShapes == 0 ? 0.6 : 1));
    p.body().show("blades", looks[i / kGrassShapes],
                  blades({.high = high, .square = kGrassPatch, .count = count}, &dice));
    props[i] = place->add(std::move(p));
  }
  std::array<std::vector<Pose>, 3 * kGrassShapes> poses;
  const Rect all = land.area().grown(9);
  const double pitch = std::max(kGrassPatch, std::sqrt(all.area() / double(kMostPatches)));
  for (double y = all.y0; y < all.y1; y += pitch)
    for (double x = all.x0; x < all.x1; x += pitch) {
      const double px = x + dice.uniform(0, 0.4), py = y + dice.uniform(0, 0.4);
      const double turned = M_PI / 2 * dice.integer(0, 3) + dice.uniform(-0.2, 0.2);
      const int shape = dice.integer(0, 1);
      const double road = land.from_road(px, py) - o.road / 2;
      const double wet = land.moisture(px, py);
      bool bare = road < 0.5 || land.pond_share(px, py) < 1.12 || wet < -0.42 ||
                  land.normal(px, py).z < 0.87f;
      for (const BuildingSite& s : land.sites()) bare = bare || s.distance(px, py) < 1.1;
      if (bare) continue;
      const size_t tint = wet < -0.14 ? 0 : wet < 0.16 ? 1 : 2;
      const size_t kind = road < 2 || wet < -0.3 ? 0 : size_t(1 + shape);
      poses[tint * kGrassShapes + kind].push_back(on_ground(land, px, py, turned));
    }
  for (size_t i = 0; i < props.size(); ++i)
    if (!poses[i].empty())
      place->scatter(props[i], fmt::format("grass_{}", i + 1), std::move(poses[i]));
}

}  // namespace gloam

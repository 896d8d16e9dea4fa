// Pebbles beside the track and the water, reeds in the pond's edge: visible, without colliders.

#include <cmath>
#include <map>
#include <string>

#include "places/terrain/terrain_parts.h"

namespace gloam {
namespace {

// Patch of pebbles, square and flat: small where ground bends [m]
constexpr double kPebblePatch = 0.5;
constexpr int kPebbleShapes = 3;

// Stones of 1 to 5 cm, half in the ground: a foot, a shoulder and a top each.
Solid pebbles(int count, Dice* dice) {
  constexpr uint32_t kAround = 7;
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const float x = float(dice->uniform(-0.5, 0.5) * kPebblePatch),
                y = float(dice->uniform(-0.5, 0.5) * kPebblePatch);
    const float r = 0.006f + 0.02f * float(std::pow(dice->uniform(), 3)),
                high = r * float(dice->uniform(0.5, 0.9)), turned = float(dice->uniform(0, kPi));
    const float narrow = float(dice->uniform(0.6, 1));
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    const auto add = [&](float out, float z, float a) {
      const float u = out * r * std::cos(a), v = narrow * out * r * std::sin(a);
      const Vec3f p{u * std::cos(turned) - v * std::sin(turned),
                    u * std::sin(turned) + v * std::cos(turned), z};
      mesh.positions.push_back(p + Vec3f{x, y, 0});
      mesh.normals.push_back(normalize(p + Vec3f{0, 0, 0.4f * r}));
    };
    for (uint32_t k = 0; k < kAround; ++k) {
      const float a = 2 * kPi * float(k) / float(kAround), dent = float(dice->uniform(0.85, 1.1));
      add(dent, -0.01f, a);
      add(0.72f * dent, 0.75f * high, a);
    }
    add(0, high, 0);
    for (uint32_t k = 0; k < kAround; ++k) {
      const uint32_t a = first + 2 * k, b = first + 2 * ((k + 1) % kAround),
                     top = first + 2 * kAround;
      for (const uint32_t corner : {a, b, b + 1, a, b + 1, a + 1, a + 1, b + 1, top})
        mesh.indices.push_back(corner);
    }
  }
  return Solid(std::move(mesh));
}

class Litter {
 public:
  Litter(const Landscape& land, const TerrainOptions& options, Workshop* shop, Place* place)
      : land_(land), o_(options), dice_(options.seed, "litter"), shop_(shop), place_(place) {}

  void add() {
    if (o_.rocks > 0) add_pebbles();
    if (land_.pond() && o_.grass > 0) add_reeds();
  }

 private:
  void add_pebbles() {
    std::vector<Pose> poses[kPebbleShapes];
    const auto lay = [&](double x, double y) {
      const double turned = dice_.uniform(0, 2 * M_PI);
      const int shape = dice_.integer(0, kPebbleShapes - 1);
      poses[shape].push_back(on_ground(land_, x, y, turned));
    };
    const Rect area = land_.area().grown(-0.6);
    if (land_.has_road())
      for (double x = area.x0; x < area.x1; x += 0.9 * kPebblePatch)
        for (const double side : {-1.0, 1.0}) {
          const double away = land_.road_width() / 2 + dice_.uniform(-0.3, 0.6);
          lay(x, land_.road_y(x) + side * away);
        }
    if (const auto& pond = land_.pond()) {
      const int count = static_cast<int>(2 * M_PI * pond->radius / (0.75 * kPebblePatch));
      for (int k = 0; k < count; ++k) {
        const double a = 2 * M_PI * (k + dice_.uniform(0, 0.6)) / count,
                     share = dice_.uniform(0.98, 1.14);
        const Vec2f at = shore(*pond, a, share);
        if (area.distance_to(at.x, at.y) == 0) lay(at.x, at.y);
      }
    }
    const std::string stone = shop_->bedrock();
    for (int i = 0; i < kPebbleShapes; ++i)
      scatter("pebbles", stone, pebbles(static_cast<int>(6 + 11 * o_.rocks), &dice_),
              std::move(poses[i]));
  }

  // In thickets that leave bays of open water.
  void add_reeds() {
    const Pond& pond = *land_.pond();
    std::vector<Pose> poses[kPebbleShapes];
    const int count = static_cast<int>(2 * M_PI * pond.radius / 0.35);
    for (int k = 0; k < count; ++k) {
      const double a = 2 * M_PI * k / count, share = dice_.uniform(0.82, 1.04),
                   turned = dice_.uniform(0, 2 * M_PI);
      const int shape = dice_.integer(0, kPebbleShapes - 1);
      const Vec2f at = shore(pond, a, share);
      if (land_.ragged(at.x / 4, at.y / 4) < 0.02) continue;
      poses[shape].push_back({{at.x, at.y, land_.height(at.x, at.y)}, turn({0, 0, 1}, turned)});
    }
    const std::string look = shop_->blades("reeds", {0.10, 0.105, 0.040}, {0.17, 0.14, 0.07});
    for (auto& list : poses)
      scatter("reeds", look,
              blades({.high = 1.5, .square = 0.5, .count = 26, .half_width = 0.005}, &dice_),
              std::move(list));
  }

  // Point in that direction from the pond's middle at which the pond's share has that value.
  Vec2f shore(const Pond& pond, double a, double share) const {
    double r = 0.5 * pond.radius;
    while (r < 2 * pond.radius &&
           land_.pond_share(pond.x + r * std::cos(a), pond.y + r * std::sin(a)) < share)
      r += 0.05;
    return {float(pond.x + r * std::cos(a)), float(pond.y + r * std::sin(a))};
  }

  void scatter(const std::string& label, const std::string& material, const Solid& mesh,
               std::vector<Pose> poses) {
    if (poses.empty()) return;
    Prop p;
    p.label = label;
    p.body().show("pieces", material, mesh);
    const int made = place_->add(std::move(p));
    place_->scatter(made, label + "_" + std::to_string(++numbers_[label]), std::move(poses));
  }

  const Landscape& land_;
  const TerrainOptions& o_;
  Dice dice_;
  Workshop* shop_;
  Place* place_;
  std::map<std::string, int> numbers_;
};

}  // namespace

void add_litter(const Landscape& land, const TerrainOptions& options, Workshop* shop,
                Place* place) {
  Litter(land, options, shop, place).add();
}

}  // namespace gloam

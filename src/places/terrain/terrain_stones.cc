// Boulders and rocks of open country, those that are loose laid as they come to rest.

#include <algorithm>
#include <cmath>
#include <optional>

#include "places/plan/ground_zones.h"
#include "places/terrain/terrain_parts.h"

namespace gloam {
namespace {

constexpr Vec3 kRock{0.36, 0.28, 0.2};  // size of a rock [m]
// Distance of a rock's middle to the border: the fence is inside it
constexpr double kFenceClearance = 1.0;

// Pose of a stone at rest on three points of the ground's collider. Empty: it would slide, or the
// ground rises between them.
std::optional<Pose> lying(const HeightField& ground, const Prop& stone, double x, double y,
                          double turned) {
  constexpr double kSteepest = 0.12, kGap = 0.001;  // [m]
  const double c = std::cos(turned), s = std::sin(turned);
  std::vector<Vec3> feet;
  double bottom = 1;
  for (const PropCollider& part : stone.body().colliders) {
    if (part.shape == ColliderShape::kHull) {
      for (const Vec3f p : part.hull.positions) bottom = std::min(bottom, double(p.z));
      continue;
    }
    const Vec3& p = part.X_PG.p;
    const double px = c * p.x - s * p.y, py = s * p.x + c * p.y;
    feet.push_back({px, py, ground_height(ground, x + px, y + py)});
  }
  const double ax = feet[1].x - feet[0].x, ay = feet[1].y - feet[0].y, az = feet[1].z - feet[0].z,
               bx = feet[2].x - feet[0].x, by = feet[2].y - feet[0].y, bz = feet[2].z - feet[0].z;
  const double det = ax * by - ay * bx;
  const double dx = (az * by - ay * bz) / det, dy = (ax * bz - az * bx) / det;
  const double z = feet[0].z - dx * feet[0].x - dy * feet[0].y;
  if (std::hypot(dx, dy) > kSteepest) return {};
  constexpr int kRings = 3, kAround = 24;
  for (int k = 0; k < kRings * kAround; ++k) {
    const double a = 2 * M_PI * k / kAround, r = (1 + k / kAround) / (2.0 * kRings);
    const double px = r * kRock.x * std::cos(a), py = r * kRock.x * std::sin(a);
    if (ground_height(ground, x + px, y + py) - z - dx * px - dy * py > bottom) return {};
  }
  return Pose{{x, y, z + kGap}, leaning(normalize(Vec3f{float(-dx), float(-dy), 1}), turned)};
}

class Stones {
 public:
  Stones(const Landscape& land, const TerrainOptions& options, Place* place)
      : land_(land), o_(options), dice_(options.seed, "rocks"), place_(place) {}

  void add() {
    for (int i = count(110); i > 0; --i) add_boulder();
    for (int i = count(60); i > 0; --i) add_rock();
  }

 private:
  int count(double area_of_one) const {
    return static_cast<int>(
        std::lround(std::min(o_.rocks * land_.area().area() / area_of_one, 120.0)));
  }
  void add_boulder() {
    const Rect area = land_.area();
    const double x = dice_.uniform(area.x0, area.x1), y = dice_.uniform(area.y0, area.y1);
    const double big = 0.35 + 1.1 * std::pow(dice_.uniform(), 3),
                 turned = dice_.uniform(0, 2 * M_PI);
    const uint64_t variant = static_cast<uint64_t>(dice_.integer(0, 3));
    if (!land_.is_free(x, y, 0.9 + big) || std::hypot(x, y) < 3) return;
    const double size = std::ceil(big * 4) / 4;
    Pose pose = on_ground(land_, x, y, turned);
    pose.p.z -= 0.16 * size;
    place_->put(make(place_, "boulder", variant, {1.2 * size, size, 0.85 * size}), "", pose);
    stones_.push_back({x, y, 0.8 * size});
  }
  void add_rock() {
    const Rect area = land_.area();
    const double x = dice_.uniform(area.x0, area.x1), y = dice_.uniform(area.y0, area.y1);
    const double turned = dice_.uniform(0, 2 * M_PI);
    const uint64_t variant = static_cast<uint64_t>(dice_.integer(0, 4));
    const bool loose = dice_.chance(o_.loose);
    const double radius = std::hypot(kRock.x, kRock.y) / 2;
    if (!land_.is_free(x, y, kFenceClearance) || std::hypot(x, y) < 2 || is_taken(x, y, radius))
      return;
    const int made = make(place_, "rock", variant, kRock);
    std::optional<Pose> pose;
    if (loose) pose = lying(place_->grounds[0].field, place_->prop(made), x, y, turned);
    const bool lies = pose.has_value();
    if (!lies) {
      pose = on_ground(land_, x, y, turned);
      pose->p.z -= 0.04;
    }
    place_->put(made, "", *pose, lies);
    stones_.push_back({x, y, radius});
  }
  bool is_taken(double x, double y, double radius) const {
    return std::any_of(stones_.begin(), stones_.end(), [&](const Stone& s) {
      return std::hypot(s.x - x, s.y - y) < s.radius + radius;
    });
  }

  struct Stone {
    double x, y, radius;
  };
  const Landscape& land_;
  const TerrainOptions& o_;
  Dice dice_;
  Place* place_;
  std::vector<Stone> stones_;
};

}  // namespace

void add_rocks(const Landscape& land, const TerrainOptions& options, Place* place) {
  Stones(land, options, place).add();
}

}  // namespace gloam

// Splashes, and drips from edges.

#include <algorithm>

#include "base/parallel.h"
#include "render/cpu/particles/streak_finder.h"

namespace gloam {
namespace {

constexpr float kFarthestSplash = 6.0f;  // [m]
constexpr float kLeastCrown = 3;         // [px] across, of one that is drawn
constexpr float kSplashGravity = 9.81f;

}  // namespace

void StreakFinder::find_splashes(const ParticleSet& set, uint32_t row,
                                 std::vector<Streak>* out) const {
  const ParticleClass& kind = set.classes[row];
  const float far = min(reach(kDropletSize * kind.diameter), kFarthestSplash);
  if (set.kind != ParticleKind::kDrop || far <= 2 * kNearestParticle || !splashes(kind)) return;
  const double now = middle();
  const auto cell_of = [](float x) { return static_cast<int64_t>(std::floor(x / kSplashCell)); };
  const int64_t low = cell_of(eye_.y - far), rows = cell_of(eye_.y + far) - low + 1;
  std::vector<std::vector<Streak>> found(static_cast<size_t>(rows));
  parallel_for("splashes", rows, [&](int64_t line) {
    std::vector<Splash> landed;
    for (int64_t i = cell_of(eye_.x - far); i <= cell_of(eye_.x + far); ++i)
      gloam::find_splashes(set, row, i, low + line, now - splash_life(kind), now, &landed);
    for (const Splash& splash : landed) land(kind, splash, far, &found[static_cast<size_t>(line)]);
  });
  for (const auto& part : found) out->insert(out->end(), part.begin(), part.end());
}

bool StreakFinder::way_down(Vec3f from, float* way) const {
  Ray down;
  down.o = from;
  down.d = {0, 0, -1};
  RayHit hit;
  if (!view_.tracer.trace(down, false, &hit)) return false;
  *way = hit.t;
  return true;
}

// On what lies highest there, if the sky is open above.
void StreakFinder::land(const ParticleClass& kind, const Splash& splash, float far,
                        std::vector<Streak>* out) const {
  const Vec3f from{splash.at.x, splash.at.y, eye_.z + kFarthestParticle};
  const Vec3f to{splash.at.x - eye_.x, splash.at.y - eye_.y, 0};
  float way = 0;
  if (dot(to, to) > far * far || !way_down(from, &way)) return;
  const Vec3f ground = from - Vec3f{0, 0, way};
  if (is_open(ground, 0.05f)) add_splash(kind, splash, ground, far, out);
}

void StreakFinder::add_splash(const ParticleClass& kind, const Splash& splash, Vec3f ground,
                              float far, std::vector<Streak>* out) const {
  const auto t = static_cast<float>(middle() - splash.time);
  for (int n = 0; n < kSplashDroplets; ++n) {
    const SplashDroplet d = splash_droplet(kind, splash, n);
    const Vec3f p = d.from + d.velocity * t - Vec3f{0, 0, 0.5f * kSplashGravity * t * t};
    if (p.z > 0)
      add({ParticleKind::kDrop, d.diameter, d.velocity - Vec3f{0, 0, kSplashGravity * t}},
          ground + p, far, splash.bits, out);
  }
  add_crown(crown_at(kind, t), splash, ground, far, out);
}

// A wall of staves and a rim of chords.
void StreakFinder::add_crown(const Crown& crown, const Splash& splash, Vec3f ground, float far,
                             std::vector<Streak>* out) const {
  constexpr int kParts = 16;
  const float distance = length(ground - eye_), scale = view_.camera.fx / distance;
  Vec2f uv;
  if (!(crown.cover > 0) || distance < kNearestParticle || distance > far ||
      2 * crown.radius * scale < kLeastCrown || !projector_.project(ground, 0, &uv))
    return;
  const Vec3f light = light_of(ParticleKind::kDrop, ground, uv, splash.bits);
  const auto add_line = [&](Vec3f a, Vec3f b, float width, float cover) {
    Streak s;
    s.distance = length((a + b) * 0.5f - eye_);
    s.radius = 0.5f * width * scale + blur_at(s.distance);
    s.cover = cover * 0.5f * width * scale / s.radius;
    s.light = light;
    if (projector_.project(a, 0, &s.from) && projector_.project(b, 0, &s.to) && is_in_picture(s))
      out->push_back(s);
  };
  const float turn = uniform_float(splash.bits.v[3]);
  const auto around = [&](int i) {
    const float angle = 2 * kPi * (static_cast<float>(i) + turn) / kParts;
    return Vec3f{std::cos(angle), std::sin(angle), 0};
  };
  const Vec3f up{0, 0, crown.height};
  for (int i = 0; i < kParts; ++i) {
    const Vec3f foot = around(i) * crown.radius, rim = around(i) * crown.rim_radius + up;
    const Vec3f next = around(i + 1) * crown.rim_radius + up;
    add_line(ground + foot, ground + rim, 2 * kPi / kParts * crown.rim_radius,
             kWallCover * crown.cover);
    add_line(ground + rim, ground + next, crown.rim, crown.cover);
  }
}

void StreakFinder::find_drips(uint64_t seed, std::vector<Streak>* out) const {
  const std::vector<DripEdge>& edges = view_.weather.drips;
  constexpr int64_t kChunk = 32;
  const auto chunks = (static_cast<int64_t>(edges.size()) + kChunk - 1) / kChunk;
  std::vector<std::vector<Streak>> found(static_cast<size_t>(chunks));
  parallel_for("drips", chunks, [&](int64_t chunk) {
    const auto first = static_cast<size_t>(chunk * kChunk);
    for (size_t i = first; i < std::min(first + kChunk, edges.size()); ++i)
      add_drips(edges[i], seed, &found[static_cast<size_t>(chunk)]);
  });
  for (const auto& part : found) out->insert(out->end(), part.begin(), part.end());
}

// Tip: end of the highest obstacle on the way from the edge's cell to the one beside it.
bool StreakFinder::find_tip(const DripEdge& edge, float along, Vec3f* tip) const {
  constexpr float kDropHeight = 0.5f, kHeightTolerance = 0.1f, kEdgeOffset = 0.003f;  // [m]
  constexpr int kHalvings = 6;
  const Vec3f out{edge.out.x, edge.out.y, 0}, side{-edge.out.y, edge.out.x, 0};
  float in = 0, far = 1, top = 0;
  const auto is_roof = [&](float fraction) {
    const Vec3f from = edge.from + side * (along * edge.way) + out * (fraction * edge.way) +
                       Vec3f{0, 0, kDropHeight};
    float way = 0;
    if (!way_down(from, &way) || std::fabs(way - kDropHeight) > kHeightTolerance) return false;
    top = from.z - way;
    return true;
  };
  if (!is_roof(0)) return false;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5f * (in + far);
    (is_roof(middle) ? in : far) = middle;
  }
  *tip = edge.from + side * (along * edge.way) + out * (far * edge.way + kEdgeOffset);
  tip->z = top;
  return true;
}

void StreakFinder::add_drips(const DripEdge& edge, uint64_t seed, std::vector<Streak>* out) const {
  const Vec3f to{edge.from.x - eye_.x, edge.from.y - eye_.y, 0};
  const float far = reach(kLargestDrip);
  if (dot(to, to) > far * far) return;
  const double now = middle();
  // Drops land on the lowest ground at the latest.
  const auto deepest = static_cast<double>(edge.from.z - view_.weather.shelter->lowest);
  const DripFall last(kSmallestDrip);
  const double seen = last.time(std::max(deepest, 0.0)) +
                      splash_life({kLargestDrip, 0, static_cast<float>(last.last_speed)});
  std::vector<Drip> drips;
  gloam::find_drips(edge, seed, now - seen, now, &drips);
  for (const Drip& drip : drips) {
    const DripFall fall(drip.diameter);
    const double age = now - drip.time;
    Vec3f tip;
    float way = 0;
    if (!find_tip(edge, drip.along, &tip) && !find_tip(edge, 0, &tip)) continue;
    if (!way_down(tip, &way)) continue;
    const double landing = fall.time(static_cast<double>(way));
    if (age < landing) {
      const Vec3f p = tip - Vec3f{0, 0, static_cast<float>(fall.depth(age))};
      const Vec3f velocity{0, 0, -static_cast<float>(fall.speed(age))};
      add({ParticleKind::kDrop, drip.diameter, velocity}, p, far, drip.bits, out);
      continue;
    }
    const ParticleClass kind{drip.diameter, 0, static_cast<float>(fall.speed(landing))};
    const Splash splash{{tip.x, tip.y}, drip.time + landing, drip.bits};
    if (splashes(kind) && now - splash.time < splash_life(kind))
      add_splash(kind, splash, tip - Vec3f{0, 0, way}, min(far, kFarthestSplash), out);
  }
}

}  // namespace gloam

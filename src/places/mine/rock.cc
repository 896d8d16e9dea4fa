#include "places/mine/rock.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kMesh = 0.12;              // between vertices along the path [m]
constexpr int kColumns = 110;               // facets of the cross section
constexpr double kChunk = 0.9;              // size of the chunks that break off [m]
constexpr double kHead = 1.9;               // up to which walls are followed by colliders [m]
constexpr double kFacet = 1, kThick = 3.5;  // of colliders: along the path, outwards [m]
constexpr int kRings = 9;                   // of the faces at both ends

// Planes of broken chunks of one metre around seeds of a jittered grid, their lower envelope.
double chunks(uint64_t seed, double x, double y) {
  const auto i0 = static_cast<int64_t>(std::floor(x)), j0 = static_cast<int64_t>(std::floor(y));
  double lowest = 1e9;
  for (int64_t i = i0 - 1; i <= i0 + 1; ++i) {
    for (int64_t j = j0 - 1; j <= j0 + 1; ++j) {
      const Philox4 d = philox4x32(seed, static_cast<uint64_t>(i), static_cast<uint64_t>(j));
      const auto part = [](uint32_t bits) { return double(bits) / 4294967296.0 * 2 - 1; };
      const double dx = x - double(i) - 0.5 - 0.4 * part(d.v[0]),
                   dy = y - double(j) - 0.5 - 0.4 * part(d.v[1]);
      const double height = 0.8 * part(d.v[2]), slope = 0.9 * part(d.v[3]);
      lowest = std::min(lowest, height + slope * (dx - dy) + 1.1 * (dx * dx + dy * dy));
    }
  }
  return lowest;
}

}  // namespace

MineRock::MineRock(const MineOptions& options, const CurvedPath& path, std::vector<Niche> niches)
    : o_(options), path_(path), noise_(options.seed), niches_(std::move(niches)) {
  half_ = o_.width / 2;
  wall_ = 0.45 * o_.height;
  const double a = half_, b = o_.height - wall_;
  // Half an ellipse (Ramanujan 1914) on two walls.
  around_ = 2 * wall_ + M_PI / 2 * (3 * (a + b) - std::sqrt((3 * a + b) * (a + 3 * b)));
}

Vec2f MineRock::mean(double u) const {
  const double foot = wall_ / around_;
  if (u < foot) return {float(half_), float(wall_ * u / foot)};
  if (u > 1 - foot) return {float(-half_), float(wall_ * (1 - u) / foot)};
  const double angle = M_PI * (u - foot) / (1 - 2 * foot);
  return {float(half_ * std::cos(angle)), float(wall_ + (o_.height - wall_) * std::sin(angle))};
}

// Chunks of two sizes over slow undulation; -1 … 1.
double MineRock::relief(double s, double around) const {
  const double large = chunks(o_.seed, s / kChunk, around / kChunk),
               small = chunks(o_.seed + 1, s / (0.4 * kChunk), around / (0.4 * kChunk));
  const double slow = noise_.sum(s / 3.5, around / 3.5, 4);
  return std::clamp(0.65 * large + 0.28 * small + 0.5 * slow, -1.0, 1.0);
}

double MineRock::crown(double left) const {
  const double share = left / half_;
  return wall_ + (o_.height - wall_) * std::sqrt(std::max(1 - share * share, 0.0));
}

double MineRock::recess(double s, double side) const {
  double deepest = 0;
  for (const Niche& niche : niches_)
    if (niche.side == side)
      deepest = std::max(
          deepest, niche.depth * (1 - smooth_between(niche.width / 2 - 0.35, niche.width / 2 + 0.35,
                                                     std::abs(s - niche.s))));
  return deepest;
}

bool MineRock::is_niche(double s, double side, double margin) const {
  return std::any_of(niches_.begin(), niches_.end(), [&](const Niche& niche) {
    return niche.side == side && std::abs(s - niche.s) < niche.width / 2 + 0.35 + margin;
  });
}

Vec2f MineRock::surface(double s, double u) const {
  const Vec2f p = mean(u);
  const double foot = wall_ / around_;
  Vec2f normal{p.x > 0 ? 1.0f : -1.0f, 0};
  if (u > foot && u < 1 - foot) {
    const float a = float(half_), b = float(o_.height - wall_);
    const Vec2f slope{p.x / (a * a), (p.y - float(wall_)) / (b * b)};
    normal = slope * (1 / std::hypot(slope.x, slope.y));
  }
  const float out = float(o_.relief * relief(s, u * around_));
  const double side = p.x > 0 ? 1 : -1;
  const double low = 1 - smooth_between(0.62 * o_.height, 0.85 * o_.height, p.y);
  const float back = float(side * low * recess(s, side));
  return {p.x + out * normal.x + back,
          std::max(p.y + out * normal.y, 0.0f) - (p.y <= 0 ? 0.1f : 0)};
}

double MineRock::clear(double from, double to, double side) const {
  double least = 1e9;
  const double end = std::min(kHead, o_.height * 0.6) / around_;
  for (double s = from; s <= to + 1e-9; s += kMesh)
    for (double u = 0; u <= end; u += 0.15 / around_)
      least = std::min(least, side * double(surface(s, side > 0 ? u : 1 - u).x));
  return least;
}

Solid MineRock::walls(double from, double to) const {
  std::vector<Vec3f> points;
  for (const CurvedPath::Station& k : path_.within(from, to, kMesh))
    for (int i = kColumns; i >= 0; --i) {
      const Vec2f q = surface(k.s, double(i) / kColumns);
      points.push_back(CurvedPath::point(k, q.x, q.y));
    }
  return sheet(points, kColumns + 1);
}

// The cross section shrinks to a point, and bulges outwards.
Solid MineRock::face(bool west) const {
  const double end = west ? 0 : o_.length, out = west ? -1 : 1;
  const Vec2f middle{0, float(0.45 * o_.height)};
  std::vector<Vec3f> points;
  for (int ring = 0; ring <= kRings; ++ring) {
    const float share = float(ring) / kRings;
    for (int i = 0; i <= kColumns + 1; ++i) {  // from foot to foot, and along the floor
      const int k = i % (kColumns + 1);
      const Vec2f rim = surface(end, double(west ? k : kColumns - k) / kColumns);
      const Vec2f q = rim + (middle - rim) * share;
      const double bulge = std::sin(share * M_PI / 2) * 0.5 +
                           o_.relief * relief(40 + q.x * 1.3, 40 + q.y * 1.3) * (ring > 0);
      const CurvedPath::Station at = path_.at(end);
      const Vec3f p = CurvedPath::point(at, q.x, ring == kRings ? middle.y : q.y);
      points.push_back(p + Vec3f{float(std::cos(at.heading)), float(std::sin(at.heading)), 0} *
                               float(out * std::max(bulge, 0.0)));
    }
  }
  return sheet(points, kColumns + 2);
}

void MineRock::add_colliders(PropPart* part) const {
  // Boxes of a wall reach far outwards, so that the sides of niches are closed.
  const int facets = std::max(1, static_cast<int>(std::lround(o_.length / kFacet)));
  for (int i = 0; i < facets; ++i) {
    const double from = o_.length * i / facets, to = o_.length * (i + 1) / facets;
    const CurvedPath::Station a = path_.at(from), b = path_.at(to);
    const float left = float(clear(from, to, 1)), right = -float(clear(from, to, -1));
    const float top = float(std::min(kHead, o_.height * 0.6));
    collide_strip(part, a, b, {{left, top}, {left, -0.2f}}, -kThick);
    collide_strip(part, a, b, {{right, -0.2f}, {right, top}}, -kThick);
  }
  constexpr int kArch = 6, kLong = 4;
  const int sections = std::max(1, static_cast<int>(std::lround(o_.length / kLong)));
  const double inner = 1 - o_.relief / o_.height;
  for (int i = 0; i < sections; ++i) {
    const CurvedPath::Station a = path_.at(o_.length * i / sections),
                              b = path_.at(o_.length * (i + 1) / sections);
    for (int k = 0; k < kArch; ++k) {
      const double foot = wall_ / around_, span = (1 - 2 * foot) / kArch;
      const Vec2f p = mean(foot + span * k), q = mean(foot + span * (k + 1));
      const float z = float(inner);
      collide_strip(part, a, b, {{p.x, p.y * z}, {q.x, q.y * z}}, 0.4);
    }
  }
  for (const bool west : {true, false}) {
    const CurvedPath::Station k = path_.at(west ? -0.2 : o_.length + 0.2);
    part->collide_box(CurvedPath::point(k, 0, o_.height / 2),
                      {0.2f, float(half_ + 3), float(o_.height / 2 + 1)},
                      turn({0, 0, 1}, k.heading));
  }
}

}  // namespace gloam

// The shell of a car: body and cabin.

#include <algorithm>
#include <cmath>

#include "places/props/parts/car_body.h"

namespace gloam {
namespace {

constexpr float kBelt = kCarBelt;
constexpr float kWheelArch = kCarSize.front_axle.radius + 0.055f, kUnder = kCarUnder;
constexpr float kTumble = 12;  // angle by which the cabin's sides lean in [deg]

Profile arc(float x, float z, float radius, float from, float to, int steps) {
  Profile out;
  for (int k = 0; k <= steps; ++k) {
    const float a = from + (to - from) * float(k) / float(steps);
    out.push_back({x + radius * std::cos(a), z + radius * std::sin(a)});
  }
  return out;
}

// Along the inner normals of a closed counter-clockwise outline.
Profile inset(const Profile& outline, float by) {
  Profile out;
  const size_t n = outline.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec2f along = outline[(i + 1) % n] - outline[(i + n - 1) % n];
    const float l = std::sqrt(along.x * along.x + along.y * along.y);
    out.push_back({outline[i].x - along.y / l * by, outline[i].y + along.x / l * by});
  }
  return out;
}

constexpr size_t kUndersidePoints =
    34;  // first points of a side view: arches and sill, from rear to front

// The flat end of a shell: a strip between what is below and what is above.
Solid flank(const Path& ring, bool left) {
  const Path low(ring.begin(), ring.begin() + kUndersidePoints);
  const Path high(ring.rbegin(), ring.rend() - kUndersidePoints);
  const auto shares = [](const Path& chain) {
    std::vector<float> out{0};
    for (size_t i = 1; i < chain.size(); ++i)
      out.push_back(out.back() + length(chain[i] - chain[i - 1]));
    for (float& t : out) t /= out.back();
    return out;
  };
  const std::vector<float> below = shares(low), above = shares(high);
  std::vector<float> all = below;
  all.insert(all.end(), above.begin(), above.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const auto at = [](const Path& chain, const std::vector<float>& t, float share) {
    size_t i = 1;
    while (i + 1 < t.size() && t[i] < share) ++i;
    const Vec3f p =
        chain[i - 1] + (chain[i] - chain[i - 1]) * ((share - t[i - 1]) / (t[i] - t[i - 1]));
    return Vec3f{p.x, -p.z, p.y};
  };
  if (left) std::reverse(all.begin(), all.end());
  std::vector<Vec3f> points;
  for (const float t : all) points.push_back(at(low, below, t));
  for (const float t : all) points.push_back(at(high, above, t));
  return sheet(points, static_cast<int>(all.size()));
}

// A body of this side view: edges of the given radius, ends that are round in plan, sides that lean
// in above and below the widest height.
Solid shell(const Profile& outline, float half, float radius, float round_ends) {
  std::vector<Path> rings;
  const auto add = [&](float y, float by) {
    Path ring;
    for (const Vec2f q : inset(outline, by)) {
      const float share = std::fabs(y) / half, end = max(std::fabs(q.x) - 1.0f, 0.0f);
      const float lean = 1 - 0.10f * (q.y - 0.60f) * (q.y - 0.60f) / 0.16f;
      ring.push_back({q.x - std::copysign(round_ends * end * end * share * share * share, q.x), q.y,
                      -y * lean});
    }
    rings.push_back(ring);
  };
  const float levels[][2] = {{1, 1},         {1, 1},          {0.995f, 0.62f},
                             {0.985f, 0.3f}, {0.965f, 0.08f}, {0.94f, 0},
                             {0.75f, 0},     {0.5f, 0},       {0.25f, 0}};
  for (const auto& level : levels) add(half * level[0], radius * level[1]);
  add(0, 0);
  for (size_t i = std::size(levels); i-- > 0;) add(-half * levels[i][0], radius * levels[i][1]);
  Solid whole = loft(rings).turned(Axis::kX, 90);
  whole += flank(rings.front(), true);
  whole += flank(rings.back(), false);
  return whole;
}

Profile side_view() {
  const float front = kCarSize.front_axle.x, rear = kCarSize.rear_axle.x, z = 0.302f;
  const float low = std::asin((kUnder - z) / kWheelArch);  // angle where an arch meets the sill
  Profile out;
  for (const float x : {rear, front}) {
    const Profile arch = arc(x, z, kWheelArch, kPi - low, low, 16);
    out.insert(out.end(), arch.begin(), arch.end());
  }
  const Profile top = rounded({{1.70f, 0.20f},
                               {1.93f, 0.22f},
                               {1.985f, 0.34f},
                               {1.975f, 0.52f},
                               {1.90f, 0.68f},
                               {1.62f, 0.80f},
                               {1.10f, 0.885f},
                               {0.72f, kBelt},
                               {-0.6f, kBelt + 0.025f},
                               {-1.60f, kBelt + 0.04f},
                               {-1.86f, kBelt - 0.01f},
                               {-1.945f, 0.75f},
                               {-1.93f, 0.60f},
                               {-1.985f, 0.52f},
                               {-1.975f, 0.34f},
                               {-1.90f, 0.27f},
                               {-1.72f, 0.22f}},
                              0.09f, 4);
  out.insert(out.end(), top.begin(), top.end());
  return out;
}

// Outline of the cabin at its middle, z up to the roof; `in` moves all inwards.
Profile cabin_view(float in) {
  return inset(rounded_outline({{0.83f, kBelt - 0.03f},
                                {0.16f, 1.365f},
                                {-0.15f, 1.44f},
                                {-0.65f, kCarSize.height},
                                {-1.25f, 1.43f},
                                {-1.50f, 1.385f},
                                {-1.83f, kBelt - 0.03f}},
                               0.11f, 4),
               in);
}

// Half its width there: less towards the roof [m].
float cabin_half(float z) { return 0.755f - (z - kBelt) * std::tan(kTumble * kPi / 180); }

// `less` narrow; `edge`: by how much its sides are smaller than its middle.
Solid cabin(const Profile& outline, float less, float edge) {
  std::vector<Path> rings;
  for (const float share :
       {1.0f, 0.98f, 0.93f, 0.8f, 0.4f, 0.0f, -0.4f, -0.8f, -0.93f, -0.98f, -1.0f}) {
    Path ring;
    const float s = max(std::fabs(share) - 0.92f, 0.0f), by = edge * s * s / 0.0064f;
    for (const Vec2f q : inset(outline, by))
      ring.push_back({q.x - clamp(0.077f + 0.127f * q.x, -0.05f, 0.14f) * share * share, q.y,
                      -share * (cabin_half(q.y) - less)});
    rings.push_back(ring);
  }
  Solid whole = loft(rings).turned(Axis::kX, 90);
  for (const float side : {-1.0f, 1.0f}) {
    Profile flat;
    for (const Vec3f q : side > 0 ? rings.front() : rings.back()) flat.push_back({q.x, q.y});
    // Leaned as the sides are: about the belt.
    whole += plate_y(flat, -0.002f, 0.002f)
                 .moved(0, 0, -kBelt)
                 .turned(Axis::kX, side * kTumble)
                 .moved(0, side * (0.755f - less), kBelt);
  }
  return whole;
}

// On a side of the cabin, `out` over its glass; (x, z) as if it stood upright.
Solid on_side(const Profile& outline, float side, float thick) {
  const Solid plate = side > 0 ? plate_y(outline, 0, thick) : plate_y(outline, -thick, 0);
  return plate.moved(0, 0, -kBelt).turned(Axis::kX, side * kTumble).moved(0, side * 0.755f, kBelt);
}

}  // namespace

void add_car_cabin(PropPart* b, Workshop* shop, const std::string& paint,
                   const std::string& black) {
  b->show("windows", shop->glass(), cabin(cabin_view(0.012f), 0.008f, 0.026f));
  // Roof: the upper part of the cabin's side view.
  Profile roof;
  const Profile view = cabin_view(-0.004f);
  for (const Vec2f q : view)
    if (q.y > 1.35f) roof.push_back(q);
  for (size_t i = roof.size(); i-- > 0;) roof.push_back({roof[i].x * 0.99f, roof[i].y - 0.03f});
  b->show("roof", paint, cabin(roof, 0.004f, 0));
  for (const float side : {-1.0f, 1.0f}) {
    const auto pillar = [&](const std::string& look, const char* name, const Profile& outline) {
      b->show(name, look, on_side(outline, side, 0.012f));
    };
    pillar(paint, "pillars",
           {{0.68f, kBelt - 0.02f}, {0.78f, kBelt - 0.02f}, {0.03f, 1.42f}, {-0.03f, 1.39f}});
    pillar(paint, "pillars",
           {{-1.84f, kBelt - 0.02f}, {-1.30f, kBelt - 0.02f}, {-1.22f, 1.42f}, {-1.52f, 1.39f}});
    pillar(paint, "pillars", {{-1.50f, 1.36f}, {0.06f, 1.36f}, {-0.2f, 1.435f}, {-1.3f, 1.435f}});
    pillar(black, "posts",
           {{-0.44f, kBelt - 0.02f}, {-0.34f, kBelt - 0.02f}, {-0.38f, 1.38f}, {-0.46f, 1.38f}});
    pillar(black, "belts",
           {{-1.34f, kBelt - 0.02f},
            {0.76f, kBelt - 0.03f},
            {0.72f, kBelt + 0.0f},
            {-1.33f, kBelt + 0.02f}});
    b->show("mirrors", paint,
            rounded_box({0.11f, 0.19f, 0.12f}, 0.035f, 3).moved(0.57f, side * 0.90f, 1.0f) +
                bar({0.58f, side * 0.74f, 0.95f}, {0.58f, side * 0.86f, 0.98f}, 0.022f, 0.018f));
    b->show("mirror_glass", shop->mirror(),
            panel(0.15f, 0.085f).turned(Axis::kZ, 180).moved(0.513f, side * 0.90f, 1.0f));
  }
  // Interior, as seen through the windows.
  const std::string cloth = shop->fabric({0.10, 0.10, 0.105}),
                    dark = shop->plastic({0.05, 0.05, 0.052}, 0.6);
  b->show("inside", dark, slab({-1.70f, -0.66f, kBelt - 0.02f}, {0.66f, 0.66f, kBelt + 0.015f}, 0));
  b->show("inside", dark, slab({0.30f, -0.64f, kBelt}, {0.66f, 0.64f, kBelt + 0.05f}, 0.03f, 2));
  for (const float y : {-0.36f, 0.36f}) {
    for (const float x : {-0.42f, -1.18f}) {
      b->show("seats", cloth,
              rounded_box({0.12f, 0.44f, 0.36f}, 0.05f, 2)
                      .turned(Axis::kY, -12)
                      .moved(x, y, kBelt + 0.06f) +
                  rounded_box({0.09f, 0.24f, 0.14f}, 0.04f, 2).moved(x - 0.06f, y, kBelt + 0.31f));
    }
  }
  Path rim;
  for (int k = 0; k <= 24; ++k)
    rim.push_back(
        {0.17f * std::cos(2 * kPi * float(k) / 24), 0.17f * std::sin(2 * kPi * float(k) / 24), 0});
  b->show("inside", dark,
          tube(rim, 0.013f, 8).turned(Axis::kY, -65).moved(0.20f, 0.36f, kBelt + 0.04f));
}

Solid car_shell() { return shell(side_view(), kCarSide, 0.05f, 0.30f); }

}  // namespace gloam

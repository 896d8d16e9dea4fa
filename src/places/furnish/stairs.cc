// A half-turn stair: up along -y's side, a landing, back along +y's.

#include <cmath>

#include "places/furnish/shell.h"

namespace gloam {
namespace {

constexpr float kRiser = 0.18f, kGoing = 0.28f, kTread = 0.035f, kRailHeight = 0.92f;

struct Flight {
  float x0, z0;     // the first riser's foot
  float direction;  // sign of x
  float y0, y1;
  int treads;  // between floors
  float riser, going;
};

void add_flight(Workshop& shop, const Flight& f, PropPart* p) {
  const std::string wood = shop.wood(Axis::kY), paint = shop.paint(shop.style.trim, 0.4);
  for (int i = 0; i <= f.treads; ++i) {
    const float x = f.x0 + f.direction * float(i) * f.going, z = f.z0 + float(i) * f.riser;
    const float back = x + f.direction * 0.02f;
    p->show("risers", paint,
            slab({std::min(x, back), f.y0, z}, {std::max(x, back), f.y1, z + f.riser - kTread},
                 0.001f));
    if (i == f.treads) break;
    const float nose = x - f.direction * 0.025f, end = x + f.direction * (f.going + 0.01f),
                top = z + f.riser;
    p->show("treads", wood,
            slab({std::min(nose, end), f.y0, top - kTread}, {std::max(nose, end), f.y1, top},
                 0.006f, 2));
    const float far = x + f.direction * f.going;
    p->collide_box({std::min(nose, far), f.y0, std::max(top - 2 * f.riser, 0.0f)},
                   {std::max(nose, far), f.y1, top});
  }
  // The closed underside and the strings along it.
  const float run = float(f.treads) * f.going, rise = float(f.treads) * f.riser,
              long_side = std::hypot(run, rise);
  const float angle = std::atan2(rise, run) * 180 / kPi * -f.direction;
  const Vec3f middle{f.x0 + f.direction * run / 2, (f.y0 + f.y1) / 2,
                     f.z0 + rise / 2 + f.riser * 0.35f};
  const auto sloped = [&](float width, float height, float y, float drop) {
    return rounded_box({long_side + 0.1f, width, height}, 0.003f)
        .turned(Axis::kY, angle)
        .moved(middle.x, y, middle.z - drop);
  };
  p->show("soffit", paint, sloped(f.y1 - f.y0, 0.02f, middle.y, 0.20f));
  for (const float y : {f.y0 - 0.015f, f.y1 + 0.015f})
    p->show("strings", paint, sloped(0.03f, 0.30f, y, 0.04f));
}

// Handrail between two points of the floor line with balusters below.
void add_railing(Workshop& shop, Vec3f from, Vec3f to, float spacing, PropPart* p) {
  const std::string wood = shop.wood(Axis::kX), paint = shop.paint(shop.style.trim, 0.4);
  const Vec3f up{0, 0, kRailHeight};
  p->show("rail", wood, tube({from + up, to + up}, 0.024f, 12));
  const int count = std::max(1, static_cast<int>(length(to - from) / spacing));
  for (int i = 1; i < count; ++i) {
    const Vec3f foot = lerp(from, to, float(i) / float(count));
    p->show("balusters", paint, bar(foot, foot + up, 0.010f, 0.010f, 8));
  }
  for (const Vec3f& foot : {from, to})
    p->show("posts", wood,
            slab({foot.x - 0.03f, foot.y - 0.03f, foot.z},
                 {foot.x + 0.03f, foot.y + 0.03f, foot.z + kRailHeight + 0.05f}, 0.006f));
  p->collide_capsule(from + up, to + up, 0.024f);
  const Vec3f half = (to + from) * 0.5f + up * 0.5f;
  const Vec3f along = to - from;
  if (std::fabs(along.z) < 1e-4f) {
    const float yaw = std::atan2(along.y, along.x);
    p->collide_box(half, {length(along) / 2, 0.012f, kRailHeight / 2}, turn({0, 0, 1}, yaw));
  }
}

}  // namespace

Prop make_stairs(Workshop& shop, double width_size, double depth_size, double rise_size) {
  const float width = float(width_size), depth = float(depth_size), rise = float(rise_size);
  const int half = static_cast<int>(std::ceil(rise / kRiser / 2));
  const float riser = rise / float(2 * half), gap = 0.12f, side = width / 2;
  const float landing = side - 0.02f;
  const float going = std::min(kGoing, (depth - landing - 0.2f) / float(half - 1));
  const float edge = depth - landing, start = edge - going * float(half - 1);
  Prop p;
  PropPart& b = p.body();
  add_flight(shop, {start, 0, 1, -side + 0.03f, -gap / 2, half - 1, riser, going}, &b);
  add_flight(shop, {edge, rise / 2, -1, gap / 2, side - 0.03f, half - 1, riser, going}, &b);
  // The landing, and the floor that the upper flight arrives on.
  const Vec3f low{edge, -side, rise / 2 - 0.16f}, high{depth, side, rise / 2};
  b.show("landing", shop.wood(Axis::kY), slab({low.x, low.y, high.z - kTread}, high, 0.004f));
  b.show("landing_body", shop.paint(shop.style.trim, 0.4),
         slab(low, {high.x, high.y, high.z - kTread}, 0.003f));
  b.collide_box(low, high);
  const Vec3f top_low{-0.06f, 0, rise - 0.22f}, top_high{start, side, rise};
  b.show("landing", shop.wood(Axis::kY),
         slab({top_low.x, top_low.y, rise - kTread}, top_high, 0.004f));
  b.show("landing_body", shop.paint(shop.style.trim, 0.4),
         slab(top_low, {start, side, rise - kTread}, 0.003f));
  b.collide_box(top_low, top_high);
  // Between the flights, and around the hole above.
  add_railing(shop, {start, -gap / 2 - 0.03f, 0.05f}, {edge, -gap / 2 - 0.03f, rise / 2}, 0.13f,
              &b);
  add_railing(shop, {edge, gap / 2 + 0.03f, rise / 2}, {start, gap / 2 + 0.03f, rise}, 0.13f, &b);
  add_railing(shop, {0.03f, -side + 0.03f, rise}, {0.03f, 0.03f, rise}, 0.11f, &b);
  add_railing(shop, {0.03f, 0.03f, rise}, {start, 0.03f, rise}, 0.11f, &b);
  b.mass = 400;
  return p;
}

}  // namespace gloam

// The counterbalance truck.

#include <cmath>

#include "places/catalogue.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/labels.h"
#include "places/vehicles.h"

namespace gloam {
namespace {

constexpr float kFace = 0.72f;             // front of the fork carriage
constexpr float kForkEnd = kFace + 1.15f;  // tips
constexpr float kTail = -1.83f;            // end of the counterweight
constexpr float kHalf = 0.57f;             // half width over the front wheels
constexpr float kMastTop = 2.12f, kGuard = 2.14f;
constexpr float kFront = kForkliftSize.front_axle.x;

struct Paints {
  std::string body, grey, black, steel;
};

void add_chassis(PropPart* b, Workshop* shop, const Paints& paint) {
  // Frame and step plates low between the wheels; its nose carries the mast.
  b->show("frame", paint.grey,
          plate_y(rounded_outline({{-1.2f, 0.14f},
                                   {-0.18f, 0.14f},
                                   {-0.10f, 0.42f},
                                   {0.06f, 0.62f},
                                   {0.42f, 0.62f},
                                   {0.42f, 0.86f},
                                   {-1.2f, 0.86f}},
                                  0.03f),
                  -0.36f, 0.36f));
  for (const float side : {-1.0f, 1.0f}) {
    const float in = side * 0.36f, out = side * (kHalf - 0.02f);
    b->show("sills", paint.body,
            slab({-0.98f, min(in, out), 0.20f}, {-0.16f, max(in, out), 0.46f}, 0.02f, 2));
    b->show("steps", paint.black,
            slab({-0.62f, side * (kHalf + 0.005f) - 0.07f, 0.455f},
                 {-0.18f, side * (kHalf + 0.005f) + 0.01f * side - 0.0f, 0.475f}, 0.004f));
    // Wings over the drive wheels.
    Profile wing;
    for (int k = 0; k <= 8; ++k) {
      const float a = kPi * (0.05f + 0.62f * float(k) / 8);
      wing.push_back({kFront + 0.385f * std::cos(a), 0.31f + 0.385f * std::sin(a)});
    }
    for (int k = 8; k >= 0; --k) {
      const float a = kPi * (0.05f + 0.62f * float(k) / 8);
      wing.push_back({kFront + 0.36f * std::cos(a), 0.31f + 0.36f * std::sin(a)});
    }
    b->show("wings", paint.black,
            plate_y(wing, side > 0 ? 0.33f : -kHalf, side > 0 ? kHalf : -0.33f));
    b->show("cabin_floor", paint.black,
            slab({-0.30f, min(in, side * 0.1f) - 0.001f, 0.47f},
                 {0.08f, max(in, side * 0.1f), 0.482f}, 0.003f));
  }
  // Hood under the seat, with a seam, louvres and a latch.
  b->show("hood", paint.body,
          plate_y(rounded_outline({{-0.42f, 0.46f},
                                   {-0.36f, 0.90f},
                                   {-0.44f, 1.00f},
                                   {-1.36f, 1.03f},
                                   {-1.36f, 0.46f},
                                   {-0.9f, 0.46f}},
                                  0.07f, 4),
                  -0.49f, 0.49f));
  Solid louvres;
  for (int i = 0; i < 6; ++i)
    louvres += slab({-1.15f, -0.494f, 0.66f + 0.035f * float(i)},
                    {-0.85f, 0.494f, 0.675f + 0.035f * float(i)}, 0.002f);
  b->show("louvres", paint.black, louvres);
  b->show("seams", paint.black, slab({-1.365f, -0.492f, 0.86f}, {-0.44f, 0.492f, 0.866f}, 0));
  // Counterweight: cast iron, round at its end, a pin and a grille in it.
  Profile plan{{-1.04f, -kHalf + 0.02f}, {-1.04f, kHalf - 0.02f}, {-1.5f, kHalf - 0.02f},
               {-1.74f, 0.40f},          {kTail, 0.20f},          {kTail, -0.20f},
               {-1.74f, -0.40f},         {-1.5f, -kHalf + 0.02f}};
  const Profile ccw = rounded_outline(plan, 0.10f, 4);
  Profile inset = ccw;
  for (Vec2f& q : inset) q = {-1.30f + (q.x + 1.30f) * 0.955f, q.y * 0.955f};
  b->show("weight", paint.grey, extrude(ccw, 0.52f, 1.02f));
  b->show("weight", paint.grey, extrude(inset, 1.02f, 1.06f));
  // Below the axle it leaves the wheels free.
  b->show("weight", paint.grey, slab({-1.76f, -0.33f, 0.20f}, {-1.04f, 0.33f, 0.53f}, 0.03f, 2));
  b->show("weight", paint.grey, slab({-1.74f, -0.44f, 0.30f}, {-1.56f, 0.44f, 0.53f}, 0.04f, 2));
  b->show("grille", paint.black,
          slab({kTail - 0.002f, -0.14f, 0.62f}, {kTail + 0.01f, 0.14f, 0.86f}, 0.003f));
  b->show("pin", paint.steel,
          cylinder(0.018f, 0.42f, 0.62f, 0.003f, 12).moved(kTail + 0.05f, 0, 0));
  for (const float side : {-1.0f, 1.0f})
    b->show("rear_lights", shop->plastic({0.55, 0.03, 0.03}, 0.15),
            rounded_box({0.02f, 0.07f, 0.13f}, 0.006f)
                .turned(Axis::kZ, -side * 38)
                .moved(-1.715f, side * 0.44f, 0.90f));
  b->show("hazard", stripes(shop, {0.92, 0.66, 0.02}, {0.04, 0.04, 0.04}),
          panel(0.38f, 0.095f).turned(Axis::kZ, 180).moved(kTail - 0.0012f, 0, 0.935f));
}

void add_place_of_driver(PropPart* b, Workshop* shop, const Paints& paint) {
  // Cowl, steering wheel on its column, three levers, pedals.
  b->show(
      "cowl", paint.black,
      plate_y(rounded_outline(
                  {{0.10f, 0.60f}, {0.40f, 0.60f}, {0.40f, 1.06f}, {0.30f, 1.14f}, {0.14f, 1.06f}},
                  0.04f, 3),
              -0.45f, 0.45f));
  b->show("cowl", paint.black,
          bar({0.16f, 0.08f, 0.98f}, {0.00f, 0.08f, 1.20f}, 0.035f, 0.026f, 14));
  const auto lean = [](const Solid& s) {
    return s.turned(Axis::kY, -36).moved(-0.01f, 0.08f, 1.215f);
  };
  Path rim;
  for (int k = 0; k <= 28; ++k)
    rim.push_back({0.165f * std::cos(2 * kPi * float(k) / 28),
                   0.165f * std::sin(2 * kPi * float(k) / 28), 0.02f});
  b->show("wheel", shop->plastic({0.03, 0.03, 0.03}, 0.5), lean(tube(rim, 0.013f, 8)));
  for (const float a : {90.0f, 210.0f, 330.0f})
    b->show(
        "wheel", shop->plastic({0.03, 0.03, 0.03}, 0.5),
        lean(slab({0.02f, -0.014f, 0.006f}, {0.16f, 0.014f, 0.018f}, 0.004f).turned(Axis::kZ, a)));
  b->show("wheel", shop->plastic({0.03, 0.03, 0.03}, 0.5),
          lean(cylinder(0.045f, -0.005f, 0.026f, 0.006f, 20)) +
              lean(cylinder(0.016f, 0.02f, 0.085f, 0.008f, 12).moved(-0.135f, 0.06f, 0)));
  for (int i = 0; i < 3; ++i) {
    const float y = -0.14f - 0.07f * float(i);
    b->show("levers", paint.steel, bar({0.24f, y, 1.10f}, {0.16f, y, 1.27f}, 0.006f, 0.006f, 8));
    b->show("knobs", paint.black, ball(0.021f, 14).moved(0.157f, y, 1.278f));
  }
  b->show("display", shop->plastic({0.02, 0.025, 0.03}, 0.1),
          slab({0.16f, -0.08f, 1.112f}, {0.28f, 0.0f, 1.13f}, 0.004f).turned(Axis::kY, 0));
  for (const float y : {-0.22f, -0.08f})
    b->show("pedals", paint.black,
            beam({0.04f, y, 0.51f}, {0.11f, y, 0.60f}, 0.07f, 0.012f, 0.003f));
  // Seat.
  const std::string vinyl = shop->leather({0.045, 0.045, 0.05});
  const auto pad = [&](Vec3f size, float radius) {
    return cushion(size, 0.10f, radius, 3, 1, 0.001f);
  };
  b->show("seat", vinyl,
          pad({0.48f, 0.48f, 0.13f}, 0.045f).turned(Axis::kY, -5).moved(-0.72f, 0, 1.115f));
  b->show("seat", vinyl,
          pad({0.11f, 0.46f, 0.52f}, 0.045f).turned(Axis::kY, -12).moved(-0.99f, 0, 1.39f));
  for (const float side : {-1.0f, 1.0f}) {
    b->show(
        "seat", vinyl,
        pad({0.42f, 0.08f, 0.09f}, 0.03f).turned(Axis::kY, -5).moved(-0.74f, side * 0.22f, 1.165f));
    b->show("arms", paint.black,
            tube(smooth_path({{-0.98f, side * 0.27f, 1.22f},
                              {-0.82f, side * 0.29f, 1.30f},
                              {-0.56f, side * 0.28f, 1.27f},
                              {-0.54f, side * 0.27f, 1.12f}}),
                 0.014f, 8));
  }
  b->show("seat_base", paint.black, slab({-1.0f, -0.20f, 1.0f}, {-0.5f, 0.20f, 1.06f}, 0.01f));
  b->show("belt", shop->plastic({0.62, 0.10, 0.05}, 0.5),
          slab({-0.92f, -0.255f, 1.09f}, {-0.86f, -0.235f, 1.17f}, 0.004f));
  // Guard over the head: four posts, a rim and bars.
  const auto post = [&](const Path& path) {
    b->show("guard", paint.black, tube(rounded_path(path, 0.12f), 0.027f, 10));
  };
  for (const float side : {-1.0f, 1.0f}) {
    post({{0.36f, side * 0.47f, 0.88f},
          {0.08f, side * 0.44f, kGuard - 0.04f},
          {-1.10f, side * 0.44f, kGuard - 0.06f},
          {-1.30f, side * 0.47f, 1.02f}});
    b->show("lamps", paint.black,
            bar({0.10f, side * 0.49f, 1.80f}, {0.19f, side * 0.49f, 1.80f}, 0.04f, 0.065f, 20));
    b->show("lenses", shop->ceramic({0.86, 0.87, 0.88}),
            bar({0.185f, side * 0.49f, 1.80f}, {0.197f, side * 0.49f, 1.80f}, 0.058f, 0.05f, 20));
  }
  for (const float x : {0.06f, -1.10f})
    b->show("guard", paint.black,
            bar({x, -0.45f, kGuard - 0.05f}, {x, 0.45f, kGuard - 0.05f}, 0.025f, 0.025f, 10));
  for (int i = 0; i < 7; ++i) {
    const float x = -0.08f - 0.14f * float(i);
    b->show(
        "bars", paint.black,
        slab({x - 0.006f, -0.44f, kGuard - 0.075f}, {x + 0.006f, 0.44f, kGuard - 0.025f}, 0.002f));
  }
  b->show("beacon_foot", paint.black,
          cylinder(0.05f, kGuard - 0.045f, kGuard - 0.015f, 0.003f, 20).moved(-1.05f, 0, 0));
  b->show("beacon", shop->plastic({0.95, 0.40, 0.02}, 0.08),
          cylinder(0.042f, kGuard - 0.015f, kGuard + 0.075f, 0.012f, 20).moved(-1.05f, 0, 0));
}

void add_mast(PropPart* b, PropPart* fork, Workshop* shop, const Paints& paint) {
  // Two pairs of channels one within the other, cylinders, chains, crossheads.
  const auto channel = [&](float x, float y, float deep, float side, float z0, float z1) {
    const float w = 0.06f * side, t = 0.016f * side;
    Profile c{{-deep / 2, 0},          {deep / 2, 0},          {deep / 2, w},
              {deep / 2 - 0.016f, w},  {deep / 2 - 0.016f, t}, {-deep / 2 + 0.016f, t},
              {-deep / 2 + 0.016f, w}, {-deep / 2, w}};
    if (side < 0) c = Profile(c.rbegin(), c.rend());
    b->show("mast", paint.grey, extrude(c, z0, z1).moved(x, y, 0));
  };
  for (const float side : {-1.0f, 1.0f}) {
    channel(0.515f, side * 0.375f, 0.14f, -side, 0.10f, kMastTop - 0.06f);
    channel(0.555f, side * 0.355f, 0.12f, -side, 0.13f, kMastTop);
    b->show("rods", shop->metal("chrome"),
            cylinder(0.02f, 1.2f, kMastTop - 0.05f, 0.002f, 14).moved(0.455f, side * 0.27f, 0));
    b->show("cylinders", paint.black,
            cylinder(0.034f, 0.12f, 1.25f, 0.004f, 16).moved(0.455f, side * 0.27f, 0));
    for (int k = 0; k < 30; ++k)
      b->show("chains", paint.steel,
              rounded_box({0.012f, 0.022f, 0.034f}, 0.004f)
                  .moved(0.575f, side * 0.16f, 0.72f + 0.042f * float(k)));
    b->show("tilt", paint.black,
            bar({0.40f, side * 0.31f, 0.50f}, {0.12f, side * 0.31f, 0.56f}, 0.03f, 0.03f, 12));
    b->show("hoses", shop->rubber(),
            tube(smooth_path({{0.60f, side * 0.08f, 0.55f},
                              {0.58f, side * 0.08f, 1.2f},
                              {0.57f, side * 0.085f, 1.98f},
                              {0.52f, side * 0.09f, 2.0f},
                              {0.49f, side * 0.09f, 1.2f}}),
                 0.011f, 6));
  }
  for (const float z : {0.16f, 1.16f})
    b->show("mast", paint.grey,
            slab({0.435f, -0.375f, z - 0.05f}, {0.475f, 0.375f, z + 0.05f}, 0.006f));
  b->show("mast", paint.grey,
          slab({0.43f, -0.36f, kMastTop - 0.15f}, {0.47f, 0.36f, kMastTop - 0.07f}, 0.006f));
  b->show("mast", paint.grey,
          slab({0.535f, -0.35f, kMastTop - 0.055f}, {0.58f, 0.35f, kMastTop - 0.005f}, 0.006f));
  // Carriage of class 2: two hook bars, the load's back rest, forks of 45 x 110 mm.
  const float back = kFace - 0.045f;
  for (const float z : {0.14f, 0.48f})
    fork->show("carriage", paint.black,
               slab({back - 0.035f, -0.50f, z}, {back, 0.50f, z + 0.075f}, 0.006f));
  for (const float side : {-1.0f, 1.0f}) {
    fork->show("carriage", paint.black,
               slab({back - 0.085f, side * 0.26f - 0.02f, 0.10f},
                    {back - 0.03f, side * 0.26f + 0.02f, 0.66f}, 0.005f));
    fork->show("rest", paint.black,
               slab({back - 0.03f, side * 0.485f - 0.015f, 0.55f},
                    {back, side * 0.485f + 0.015f, 1.22f}, 0.004f));
    const float y = side * 0.23f;
    // The blade thins to its tip; the shank hooks over the bars.
    fork->show("forks", shop->paint({0.04, 0.04, 0.042}, 0.38),
               plate_y(rounded_outline({{back, 0.035f},
                                        {kFace, 0.028f},
                                        {kForkEnd, 0.05f},
                                        {kForkEnd, 0.062f},
                                        {kFace + 0.03f, 0.075f},
                                        {kFace, 0.10f},
                                        {kFace, 0.60f},
                                        {back, 0.60f}},
                                       0.01f, 2),
                       y - 0.055f, y + 0.055f));
    fork->show("forks", shop->paint({0.04, 0.04, 0.042}, 0.38),
               slab({back - 0.02f, y - 0.05f, 0.553f}, {back + 0.01f, y + 0.05f, 0.60f}, 0.005f));
  }
  for (int i = 0; i < 5; ++i)
    fork->show("rest", paint.black,
               slab({back - 0.025f, -0.33f + 0.165f * float(i) - 0.008f, 0.55f},
                    {back - 0.005f, -0.33f + 0.165f * float(i) + 0.008f, 1.2f}, 0.003f));
  fork->show("rest", paint.black, slab({back - 0.03f, -0.5f, 1.19f}, {back, 0.5f, 1.22f}, 0.005f));
}

Prop forklift(Workshop& shop) {
  const Vec3 color = shop.color(shop.dice.pick({Vec3{0.88, 0.52, 0.03}, Vec3{0.72, 0.09, 0.06},
                                                Vec3{0.86, 0.66, 0.05}, Vec3{0.25, 0.42, 0.16}}));
  const Paints paint{shop.paint(color, 0.28), shop.paint({0.20, 0.205, 0.21}, 0.42),
                     shop.paint({0.028, 0.028, 0.03}, 0.45), shop.metal("steel")};
  Prop p;
  PropPart& b = p.body();
  PropPart& fork = p.parts.emplace_back();
  fork.name = "fork";
  fork.parent = 0;
  add_chassis(&b, &shop, paint);
  add_place_of_driver(&b, &shop, paint);
  add_mast(&b, &fork, &shop, paint);
  const Vec3 tyre = shop.dice.chance(0.3) ? Vec3{0.55, 0.54, 0.51}
                                          : Vec3{0.04, 0.04, 0.042};  // pale ones leave no marks
  add_wheels(
      kForkliftSize, 40,
      [&](PropPart* wheel, const VehicleAxle& axle, float) {
        add_wheel(wheel, &shop, {}, axle.radius, axle.width, tyre, {0.80, 0.80, 0.78});
        // Nuts, by which one sees it turn.
        for (int k = 0; k < 6; ++k)
          wheel->show("nuts", paint.black,
                      cylinder(0.014f, -axle.width * 0.28f, axle.width * 0.28f, 0.002f, 6)
                          .turned(Axis::kX, 90)
                          .moved(0.36f * axle.radius * std::cos(kPi * float(k) / 3), 0,
                                 0.36f * axle.radius * std::sin(kPi * float(k) / 3)));
      },
      &p);
  for (const float side : {-1.0f, 1.0f}) {
    fork.collide_box({kFace - 0.05f, side * 0.23f - 0.055f, 0.03f},
                     {kForkEnd, side * 0.23f + 0.055f, 0.075f});
    b.collide_capsule({0.35f, side * 0.47f, 0.9f}, {0.09f, side * 0.44f, kGuard - 0.08f}, 0.028f);
    b.collide_capsule({-1.12f, side * 0.44f, kGuard - 0.12f}, {-1.30f, side * 0.47f, 1.06f},
                      0.028f);
    b.show(
        "mirror", shop.mirror(),
        panel(0.13f, 0.10f).turned(Axis::kZ, 180 + side * 12).moved(0.055f, side * 0.54f, 1.93f));
    b.show("mirror_back", paint.black,
           rounded_box({0.015f, 0.14f, 0.11f}, 0.005f)
               .turned(Axis::kZ, side * 12)
               .moved(0.065f, side * 0.54f, 1.93f));
  }
  b.collide_box({kTail, -kHalf + 0.02f, 0.5f}, {-0.40f, kHalf - 0.02f, 1.05f});
  b.collide_box({-1.76f, -0.35f, 0.14f}, {0.42f, 0.35f, 0.5f});
  b.collide_box({0.10f, -0.45f, 0.5f}, {0.42f, 0.45f, 1.12f});
  b.collide_box({0.42f, -0.39f, 0.1f}, {0.60f, 0.39f, kMastTop});
  fork.collide_box({0.60f, -0.5f, 0.1f}, {kFace, 0.5f, 1.22f});
  b.collide_box({-1.12f, -0.46f, kGuard - 0.08f}, {0.09f, 0.46f, kGuard - 0.02f});
  b.collide_box({-1.05f, -0.24f, 1.05f}, {-0.50f, 0.24f, 1.20f})
      .collide_box({-1.08f, -0.24f, 1.2f}, {-0.90f, 0.24f, 1.66f});
  fork.mass = 160;
  b.mass = kForkliftSize.mass - 4 * 40 - fork.mass;
  p.front = 1.5f;
  return p;
}

constexpr PropKind kTrucks[] = {
    {"forklift", forklift, "counterbalance truck with mast, forks and overhead guard"},
};

}  // namespace

PropFamily trucks() { return kTrucks; }

}  // namespace gloam

// Vehicles: a car, and a cart.

#include "places/vehicles.h"

#include <cmath>

#include "places/catalogue.h"
#include "places/props/parts/car_body.h"

namespace gloam {
namespace {

void add_fittings(PropPart* b, Workshop* shop, const std::string& black) {
  const std::string chrome = shop->metal("chrome"), clear = shop->glass();
  const auto at_nose = [&](const char* name, const std::string& look, float y0, float y1, float z0,
                           float z1, float x, float lean) {
    b->show(
        name, look,
        slab({-0.02f, y0, z0}, {0.01f, y1, z1}, 0.006f, 2).turned(Axis::kY, lean).moved(x, 0, 0));
  };
  at_nose("grille", black, -0.42f, 0.42f, 0.30f, 0.44f, 1.97f, 0);
  b->show("grille", black, slab({1.90f, -0.40f, 0.60f}, {1.945f, 0.40f, 0.655f}, 0.008f, 2));
  b->show("badge", chrome, bar({1.93f, 0, 0.63f}, {1.955f, 0, 0.63f}, 0.045f, 0.042f, 20));
  const std::string white = shop->ceramic({0.86, 0.86, 0.85});
  b->show("plates", white, slab({1.985f, -0.26f, 0.455f}, {2.0f - 0.006f, 0.26f, 0.565f}, 0.002f));
  b->show("plates", white, slab({-1.975f, -0.26f, 0.64f}, {-1.935f, 0.26f, 0.75f}, 0.002f));
  for (const float s : {-1.0f, 1.0f}) {
    // Headlamps sit in the round of the nose: reflector and lens behind a clear cover.
    const auto corner = [&](const Solid& solid, float x, float y, float turn, float z) {
      return solid.turned(Axis::kZ, s * turn).moved(x, s * y, z);
    };
    b->show("lamp_housings", shop->metal("aluminium"),
            corner(rounded_box({0.12f, 0.34f, 0.13f}, 0.035f, 3), 1.79f, 0.60f, 24, 0.665f));
    b->show("lenses", white,
            corner(bar({0.055f, -0.07f, 0}, {0.066f, -0.07f, 0}, 0.048f, 0.042f, 20) +
                       bar({0.055f, 0.06f, 0}, {0.066f, 0.06f, 0}, 0.048f, 0.042f, 20),
                   1.79f, 0.60f, 24, 0.665f));
    b->show("lamp_rings", black,
            corner(bar({0.045f, -0.07f, 0}, {0.063f, -0.07f, 0}, 0.056f, 0.054f, 20) +
                       bar({0.045f, 0.06f, 0}, {0.063f, 0.06f, 0}, 0.056f, 0.054f, 20),
                   1.79f, 0.60f, 24, 0.665f));
    b->show("tail_lamps", shop->plastic({0.50, 0.02, 0.02}, 0.08),
            corner(rounded_box({0.10f, 0.20f, 0.20f}, 0.035f, 3), -1.845f, 0.66f, -18, 0.80f));
    // Seams of the doors, handles, sills.
    const float y = s * (kCarSide - 0.004f);
    const auto seam = [&](Vec2f from, Vec2f to) {
      b->show(
          "seams", black,
          beam({from.x, y - s * 0.012f, from.y}, {to.x, y - s * 0.012f, to.y}, 0.03f, 0.006f, 0));
    };
    seam({0.70f, 0.32f}, {0.72f, 0.80f});
    seam({-0.40f, 0.32f}, {-0.40f, 0.80f});
    for (const float x : {-0.26f, -1.0f})
      b->show(
          "handles", black,
          rounded_box({0.17f, 0.03f, 0.03f}, 0.012f, 2).moved(x, s * (kCarSide - 0.02f), 0.80f));
    b->show("sills", black,
            slab({-0.84f, min(y - s * 0.06f, y), kCarUnder - 0.01f},
                 {0.84f, max(y - s * 0.06f, y), kCarUnder + 0.07f}, 0.02f, 2));
  }
}

void add_road_wheel(PropPart* wheel, Workshop* shop, const VehicleAxle& axle, float side) {
  const float r = axle.radius, w = axle.width / 2, rim = 0.205f;
  const auto lie = [](const Solid& solid) { return solid.turned(Axis::kX, 90); };
  wheel->show("tyre", shop->rubber(),
              lie(lathe(rounded({{rim - 0.004f, -w * 0.72f},
                                 {rim + 0.03f, -w * 0.98f},
                                 {r - 0.03f, -w},
                                 {r, -w * 0.72f},
                                 {r, w * 0.72f},
                                 {r - 0.03f, w},
                                 {rim + 0.03f, w * 0.98f},
                                 {rim - 0.004f, w * 0.72f}},
                                0.02f, 3),
                        48)));
  const std::string alloy = shop->metal("aluminium"),
                    black = shop->plastic({0.03, 0.03, 0.032}, 0.5);
  wheel->show("rim", alloy, lie(ring(rim - 0.018f, rim, -w * 0.8f, w * 0.8f, 48)));
  const float face = side * w * 0.55f;
  for (int k = 0; k < 5; ++k)
    wheel->show(
        "rim", alloy,
        slab({0.03f, face - 0.016f, -0.024f}, {rim - 0.01f, face + 0.016f, 0.024f}, 0.008f, 2)
            .turned(Axis::kY, 72 * float(k)));
  wheel->show("rim", alloy, lie(cylinder(0.062f, -face - 0.02f, -face + 0.02f, 0.008f, 24)));
  wheel->show("brake", shop->metal("steel"), lie(cylinder(0.125f, -0.012f, 0.012f, 0.002f, 32)));
  wheel->show(
      "inside", black,
      lie(cylinder(rim - 0.015f, side > 0 ? 0.0f : -0.03f, side > 0 ? 0.03f : 0.0f, 0.002f, 32)));
}

Prop car(Workshop& shop) {
  Prop p;
  PropPart& b = p.body();
  const std::string paint =
      shop.paint(shop.color(shop.dice.pick({Vec3{0.62, 0.63, 0.65}, Vec3{0.10, 0.11, 0.12},
                                            Vec3{0.84, 0.84, 0.83}, Vec3{0.10, 0.20, 0.42},
                                            Vec3{0.58, 0.06, 0.06}})),
                 0.12);
  const std::string black = shop.plastic({0.03, 0.03, 0.032}, 0.5);
  b.show("body", paint, car_shell());
  // Floor and wheel houses, between the wheels.
  b.show("floor", black, slab({-1.80f, -0.58f, kCarUnder + 0.01f}, {1.80f, 0.58f, 0.70f}, 0.02f));
  add_car_cabin(&b, &shop, paint, black);
  add_fittings(&b, &shop, black);
  add_wheels(
      kCarSize, 18,
      [&](PropPart* wheel, const VehicleAxle& axle, float side) {
        add_road_wheel(wheel, &shop, axle, side);
      },
      &p);
  b.collide_box({-1.96f, -kCarSide + 0.02f, 0.30f}, {1.97f, kCarSide - 0.02f, 0.72f})
      .collide_box({-1.85f, -0.74f, 0.72f}, {1.0f, 0.74f, kCarBelt})
      .collide_box({-1.60f, -0.64f, kCarBelt}, {0.30f, 0.64f, 1.43f});
  b.mass = kCarSize.mass - 4 * 18;
  p.front = 1.5f;
  return p;
}

Prop cart(Workshop& shop) {
  const float x = 0.55f, y = kCartSize.width / 2, deck = 0.24f;
  Prop p;
  PropPart& b = p.body();
  const std::string paint = shop.paint(
      shop.color(
          shop.dice.pick({Vec3{0.05, 0.20, 0.46}, Vec3{0.85, 0.52, 0.05}, Vec3{0.12, 0.33, 0.20}})),
      0.35);
  const std::string black = shop.plastic({0.03, 0.03, 0.032}, 0.5),
                    steel = shop.metal("galvanised");
  b.show("deck", shop.wood("birch", Axis::kX),
         slab({-x + 0.01f, -y + 0.01f, deck - 0.015f}, {x - 0.01f, y - 0.01f, deck}, 0.002f));
  b.show("frame", paint, slab({-x, -y, deck - 0.06f}, {x, y, deck - 0.012f}, 0.012f, 2));
  b.show("drive", black, slab({-0.30f, -0.16f, 0.06f}, {0.28f, 0.16f, deck - 0.05f}, 0.02f, 2));
  b.show("bumper", shop.rubber(),
         slab({x - 0.01f, -y + 0.01f, deck - 0.07f}, {x + 0.0f, y - 0.01f, deck + 0.004f}, 0.004f));
  // A handle bent from one tube, with a shelf of bars.
  const float back = -x + 0.02f, top = kCartSize.height - 0.016f;
  b.show("handle", steel,
         tube(rounded_path({{back, -y + 0.05f, deck - 0.03f},
                            {back - 0.05f, -y + 0.05f, top},
                            {back - 0.05f, y - 0.05f, top},
                            {back, y - 0.05f, deck - 0.03f}},
                           0.09f, 6),
              0.015f, 12));
  for (const float z : {0.45f, 0.68f})
    b.show("handle", steel,
           bar({back - 0.025f, -y + 0.05f, z}, {back - 0.025f, y - 0.05f, z}, 0.010f, 0.010f, 10));
  b.show("grip", black,
         bar({back - 0.05f, -0.2f, top}, {back - 0.05f, 0.2f, top}, 0.021f, 0.021f, 14));
  add_cartons(&b, &shop, {-x + 0.10f, -y + 0.06f, deck}, {x - 0.08f, y - 0.06f, deck + 0.38f});
  for (const float s : {-1.0f, 1.0f}) {
    b.show("forks", steel,
           slab({-0.40f, s * 0.29f - 0.035f, 0.10f}, {-0.32f, s * 0.29f - 0.029f, deck - 0.05f},
                0.001f) +
               slab({-0.40f, s * 0.29f + 0.029f, 0.10f}, {-0.32f, s * 0.29f + 0.035f, deck - 0.05f},
                    0.001f));
  }
  add_wheels(
      kCartSize, 1.5,
      [&](PropPart* wheel, const VehicleAxle& axle, float) {
        add_wheel(wheel, &shop, {}, axle.radius, axle.width, {0.05, 0.05, 0.052},
                  {0.55, 0.55, 0.53});
        // A valve, by which one sees it turn.
        wheel->show("valve", steel,
                    slab({0.45f * axle.radius, -axle.width * 0.42f, -0.006f},
                         {0.6f * axle.radius, axle.width * 0.42f, 0.006f}, 0.001f));
      },
      &p);
  b.collide_box({-x, -y, deck - 0.06f}, {x, y, deck + 0.38f})
      .collide_box({back - 0.07f, -y + 0.035f, deck + 0.38f},
                   {back + 0.015f, y - 0.035f, kCartSize.height});
  b.mass = kCartSize.mass - 4 * 1.5;
  p.surfaces.push_back({{-x + 0.12f, -y + 0.08f}, {x - 0.1f, y - 0.08f}, deck + 0.381f});
  return p;
}

constexpr PropKind kVehicles[] = {
    {"car", car, "hatchback of four metres"},
    {"cart", cart, "self-driving platform with a handle, loaded with cartons"},
};

}  // namespace

PropFamily vehicles() { return kVehicles; }

}  // namespace gloam

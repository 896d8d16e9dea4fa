// Barriers between people and trucks, and fire equipment.

#include <cmath>

#include "places/catalogue.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/labels.h"

namespace gloam {
namespace {

constexpr Vec3 kRed{0.68, 0.05, 0.05};

Prop traffic_cone(Workshop& shop) {
  const float height =
      std::clamp(shop.size({0.4f, 0.4f, shop.dice.chance(0.5) ? 0.5f : 0.75f}).z, 0.3f, 1.0f);
  const float half = 0.26f * std::sqrt(height), foot = 0.03f, r0 = 0.185f * height + 0.02f,
              r1 = 0.032f;
  Prop p;
  PropPart& b = p.body();
  const std::string orange = shop.plastic(shop.color({0.92, 0.22, 0.03}), 0.5);
  b.show("base", shop.rubber({0.06, 0.06, 0.062}),
         extrude(rounded_rectangle(2 * half, 2 * half, 0.05f, 4), 0, foot * 0.6f) +
             extrude(rounded_rectangle(2 * half - 0.03f, 2 * half - 0.03f, 0.045f, 4), foot * 0.6f,
                     foot));
  const auto radius = [&](float z) { return r0 + (r1 - r0) * (z - foot) / (height - foot); };
  b.show("cone", orange,
         lathe(rounded({{r0 + 0.02f, foot},
                        {r0, foot + 0.012f},
                        {r1, height - 0.004f},
                        {r1 - 0.006f, height},
                        {r1 - 0.012f, height - 0.004f},
                        {r1 - 0.008f, height - 0.12f}},
                       0.008f),
               32));
  // Bands of micro-prisms.
  const auto band = [&](float from, float to) {
    const float z0 = foot + (height - foot) * from, z1 = foot + (height - foot) * to, t = 0.0006f;
    b.show("bands", shop.reflex({0.90, 0.90, 0.90}),
           lathe({{radius(z0) + t, z0}, {radius(z1) + t, z1}}, 32));
  };
  band(0.62f, 0.82f);
  if (height > 0.6f) band(0.32f, 0.48f);
  const float z1 = foot + (height - foot) / 3, z2 = foot + (height - foot) * 2 / 3;
  b.collide_box({-half, -half, 0}, {half, half, foot});
  b.collide_cylinder((radius(foot) + radius(z1)) / 2, foot, z1)
      .collide_cylinder((radius(z1) + radius(z2)) / 2, z1, z2)
      .collide_cylinder((radius(z2) + r1) / 2, z2, height);
  b.mass = height > 0.6f ? 3.2 : 1.8;
  p.loose = true;
  return p;
}

Prop safety_barrier(Workshop& shop) {
  // Posts of square tube on plates, rails between; bolted to the floor.
  const Vec3f size = shop.size({0.2f, 1.8f, 1.1f});
  const float y = std::clamp(size.y, 0.8f, 6.0f) / 2, z = std::clamp(size.z, 0.35f, 1.3f);
  Prop p;
  PropPart& b = p.body();
  const std::string yellow = shop.paint(shop.color(kSafetyYellow), 0.36);
  const int posts = std::max(2, int(2 * y / 1.6f) + 1);
  for (int i = 0; i < posts; ++i) {
    const float at = (-y + 0.09f) + (2 * y - 0.18f) * float(i) / float(posts - 1);
    b.show("posts", yellow, slab({-0.05f, at - 0.05f, 0.01f}, {0.05f, at + 0.05f, z}, 0.008f, 2));
    b.show("posts", yellow, slab({-0.09f, at - 0.09f, 0}, {0.09f, at + 0.09f, 0.01f}, 0.002f));
    b.show("caps", shop.plastic(kSafetyBlack, 0.5),
           slab({-0.051f, at - 0.051f, z - 0.004f}, {0.051f, at + 0.051f, z + 0.012f}, 0.006f));
    for (const float sx : {-0.07f, 0.07f})
      for (const float sy : {-0.07f, 0.07f})
        b.show("bolts", shop.metal("galvanised"),
               cylinder(0.010f, 0.01f, 0.024f, 0.002f, 6).moved(sx, at + sy, 0));
    b.collide_box({-0.05f, at - 0.05f, 0}, {0.05f, at + 0.05f, z + 0.012f});
  }
  const int rails = z > 0.7f ? 2 : 1;
  for (int i = 0; i < rails; ++i) {
    const float top = z - 0.06f - 0.48f * float(i);
    // W-shaped guard rail on the front of the posts.
    const Profile w{{0.05f, -0.15f},   {0.072f, -0.13f},  {0.075f, -0.06f},  {0.052f, -0.03f},
                    {0.052f, 0.03f},   {0.075f, 0.06f},   {0.072f, 0.13f},   {0.05f, 0.15f},
                    {0.054f, 0.15f},   {0.076f, 0.132f},  {0.079f, 0.058f},  {0.056f, 0.028f},
                    {0.056f, -0.028f}, {0.079f, -0.058f}, {0.076f, -0.132f}, {0.054f, -0.15f}};
    const Profile ccw(w.rbegin(), w.rend());
    b.show("rails", yellow, plate_y(ccw, -y, y).moved(0, 0, top - 0.15f));
    b.collide_box({0.05f, -y, top - 0.30f}, {0.08f, y, top});
  }
  b.mass = posts * 14 * z + rails * 11 * 2 * y;
  return p;
}

Prop bollard(Workshop& shop) {
  const float z = std::clamp(shop.size({0.2f, 0.2f, 1.0f}).z, 0.4f, 1.5f), r = 0.076f;
  Prop p;
  PropPart& b = p.body();
  const std::string yellow = shop.paint(shop.color(kSafetyYellow), 0.36),
                    black = shop.paint(kSafetyBlack, 0.4);
  b.show("post", yellow,
         lathe(rounded({{r, 0.01f}, {r, z - 0.02f}, {r * 0.75f, z}, {0, z}}, 0.03f, 4), 32));
  for (const float at : {0.45f, 0.72f})
    b.show("bands", black, lathe({{r + 0.0006f, z * at}, {r + 0.0006f, z * at + 0.1f}}, 32));
  b.show("plate", yellow, slab({-0.11f, -0.11f, 0}, {0.11f, 0.11f, 0.012f}, 0.003f));
  for (const float sx : {-0.085f, 0.085f})
    for (const float sy : {-0.085f, 0.085f})
      b.show("bolts", shop.metal("galvanised"),
             cylinder(0.016f, 0.012f, 0.015f, 0.001f, 16).moved(sx, sy, 0) +
                 cylinder(0.011f, 0.014f, 0.032f, 0.002f, 6).moved(sx, sy, 0));
  b.collide_cylinder(r, 0.012f, z).collide_box({-0.11f, -0.11f, 0}, {0.11f, 0.11f, 0.012f});
  b.mass = 16 * z;
  return p;
}

// Bottle with its valve and hose; foot at the origin, front at +x. Height 0.54 m.
void add_extinguisher(PropPart* b, Workshop* shop, Vec3f at) {
  const float r = 0.08f, shoulder = 0.40f;
  Profile dome{{0, 0.012f},
               {r * 0.75f, 0.012f},
               {r * 0.9f, 0},
               {r, 0.03f},
               {r, shoulder},
               {r * 0.9f, shoulder + 0.035f},
               {r * 0.55f, shoulder + 0.06f},
               {0.026f, shoulder + 0.07f},
               {0.026f, shoulder + 0.085f},
               {0, shoulder + 0.085f}};
  b->show("bottle", shop->paint(kRed, 0.25), lathe(rounded(dome, 0.015f, 3), 32).moved(at));
  b->show(
      "foot", shop->plastic(kSafetyBlack, 0.5),
      lathe(rounded({{0.06f, 0}, {r + 0.003f, 0}, {r + 0.003f, 0.035f}, {r, 0.036f}}, 0.004f), 32)
          .moved(at));
  const std::string brass = shop->metal("brass"), black = shop->plastic(kSafetyBlack, 0.45);
  b->show("valve", brass,
          (cylinder(0.018f, shoulder + 0.08f, shoulder + 0.12f, 0.002f, 16) +
           bar({0, 0, shoulder + 0.1f}, {0, 0.035f, shoulder + 0.1f}, 0.010f, 0.010f, 12))
              .moved(at));
  b->show("handles", shop->metal("black"),
          (beam({-0.03f, 0, shoulder + 0.125f}, {0.10f, 0, shoulder + 0.115f}, 0.022f, 0.008f) +
           beam({-0.025f, 0, shoulder + 0.135f}, {0.095f, 0, shoulder + 0.165f}, 0.024f, 0.007f))
              .moved(at));
  b->show(
      "gauge", shop->plastic({0.85, 0.85, 0.83}),
      bar({0.012f, -0.012f, shoulder + 0.1f}, {0.03f, -0.012f, shoulder + 0.1f}, 0.015f, 0.016f, 16)
          .moved(at));
  b->show("pin", shop->plastic({0.85, 0.62, 0.05}),
          tube({{0.02f, 0.012f, shoulder + 0.145f},
                {0.03f, 0.035f, shoulder + 0.15f},
                {0.03f, 0.045f, shoulder + 0.13f},
                {0.02f, 0.02f, shoulder + 0.128f}},
               0.0025f, 6)
              .moved(at));
  b->show("hose", shop->rubber(),
          tube(smooth_path({{0, 0.03f, shoulder + 0.1f},
                            {0, 0.075f, shoulder + 0.09f},
                            {0.005f, 0.105f, shoulder},
                            {0.005f, 0.1f, 0.2f},
                            {0.005f, 0.092f, 0.1f}}),
               0.0085f, 8)
              .moved(at));
  b->show("nozzle", black,
          bar({0.005f, 0.092f, 0.14f}, {0.005f, 0.09f, 0.05f}, 0.011f, 0.017f, 12).moved(at));
  std::vector<Vec3f> points;
  for (const float z : {0.14f, 0.33f})
    for (int k = 0; k <= 8; ++k) {
      const float a = -0.8f + 1.6f * float(k) / 8;
      points.push_back({(r + 0.0006f) * std::cos(a), (r + 0.0006f) * std::sin(a), z});
    }
  b->show("label", extinguisher_label(shop), sheet(points, 9).moved(at));
  b->collide_cylinder(r, at.z, at.z + shoulder + 0.05f, at.x, at.y)
      .collide_box(at + Vec3f{-0.03f, -0.03f, shoulder + 0.05f},
                   at + Vec3f{0.1f, 0.03f, shoulder + 0.17f});
}

Prop fire_extinguisher(Workshop& shop) {
  // On a stand with its sign: 6 kg of powder in 9 kg.
  Prop p;
  PropPart& b = p.body();
  const std::string steel = shop.metal("galvanised");
  b.show("stand", shop.paint({0.30, 0.31, 0.32}, 0.4),
         slab({-0.16f, -0.17f, 0}, {0.16f, 0.17f, 0.012f}, 0.004f) +
             bar({-0.115f, 0, 0.012f}, {-0.115f, 0, 1.22f}, 0.014f, 0.014f, 14));
  add_extinguisher(&b, &shop, {0.01f, 0, 0.012f});
  b.show("hook", steel, slab({-0.11f, -0.025f, 0.40f}, {-0.06f, 0.025f, 0.406f}, 0.001f));
  b.show("sign", extinguisher_picture(&shop), panel(0.2f, 0.2f).moved(-0.0985f, 0, 1.13f));
  b.show("sign_board", shop.plastic(kRed, 0.4),
         slab({-0.103f, -0.101f, 1.029f}, {-0.0988f, 0.101f, 1.231f}, 0.0015f));
  b.collide_box({-0.16f, -0.17f, 0}, {0.16f, 0.17f, 0.012f})
      .collide_box({-0.13f, -0.1f, 1.03f}, {-0.098f, 0.1f, 1.23f})
      .collide_cylinder(0.014f, 0.012f, 1.03f, -0.115f, 0);
  b.mass = 17;
  p.front = 0.5f;
  return p;
}

Prop wall_extinguisher(Workshop& shop) {
  Prop p;
  PropPart& b = p.body();
  add_extinguisher(&b, &shop, {0.098f, 0, -0.27f});
  b.show("bracket", shop.metal("galvanised"),
         slab({0, -0.03f, -0.2f}, {0.004f, 0.03f, 0.2f}, 0.001f) +
             slab({0, -0.02f, 0.175f}, {0.1f, 0.02f, 0.18f}, 0.001f) +
             ring(0.0805f, 0.083f, -0.1f, -0.07f, 32).moved(0.098f, 0, 0) +
             slab({0, -0.02f, -0.1f}, {0.016f, 0.02f, -0.07f}, 0.001f));
  b.show("sign", extinguisher_picture(&shop), panel(0.2f, 0.2f).moved(0.0045f, 0, 0.52f));
  b.show("sign_board", shop.plastic(kRed, 0.4),
         slab({0, -0.101f, 0.419f}, {0.004f, 0.101f, 0.621f}, 0.0015f));
  b.mass = 9.5;
  p.front = 0.5f;
  return p;
}

Prop exit_sign(Workshop& shop) {
  // Box of 30 x 15 cm lit from within, on the wall: 200 cd/m² in its white.
  Prop p;
  PropPart& b = p.body();
  b.show("box", shop.plastic({0.85, 0.85, 0.84}),
         slab({0, -0.165f, -0.095f}, {0.045f, 0.165f, 0.09f}, 0.008f, 2));
  b.show("face", exit_picture(&shop, 200), panel(0.31f, 0.155f).moved(0.0456f, 0, 0));
  b.show("led", shop.glow({0.1, 0.9, 0.2}, 300), ball(0.003f, 8).moved(0.04f, 0.12f, -0.095f));
  b.collide_box({0, -0.165f, -0.095f}, {0.046f, 0.165f, 0.09f});
  b.mass = 0.9;
  return p;
}

Prop hazard_sign(Workshop& shop) {
  const float edge = std::clamp(shop.size({0.01f, 0.3f, 0.3f}).y, 0.1f, 0.8f);
  Prop p;
  PropPart& b = p.body();
  b.show("board", shop.plastic({0.88, 0.88, 0.86}),
         slab({0, -edge / 2, -edge / 2}, {0.004f, edge / 2, edge / 2}, 0.0015f));
  b.show("face", warning_picture(&shop, shop.dice.integer(0, 3)),
         panel(edge - 0.006f, edge - 0.006f).moved(0.0044f, 0, 0));
  for (const float s : {-1.0f, 1.0f})
    for (const float e : {-1.0f, 1.0f})
      b.show("screws", shop.metal("steel"),
             ball(0.005f * std::max(0.5f, edge / 0.3f), 8)
                 .scaled({0.4f, 1, 1})
                 .moved(0.0045f, s * edge * 0.46f, e * edge * 0.46f));
  b.collide_box({0, -edge / 2, -edge / 2}, {0.005f, edge / 2, edge / 2});
  b.mass = 1400 * 0.004 * edge * edge;
  return p;
}

Prop first_aid_box(Workshop& shop) {
  Prop p;
  PropPart& b = p.body();
  const std::string white = shop.paint({0.86, 0.87, 0.86}, 0.3),
                    green = shop.plastic({0.0, 0.45, 0.26}, 0.35);
  b.show("box", white, slab({0, -0.15f, -0.20f}, {0.075f, 0.15f, 0.20f}, 0.008f, 2));
  b.collide_box({0, -0.15f, -0.20f}, {0.075f, 0.15f, 0.20f});
  b.mass = 3.2;
  PropPart& d = p.hang(
      "door", {0.092f, 0.15f, 0},
      {.axis = {0, 0, -1}, .low = -1.8, .high = 0, .initial = 0, .damping = 0.05, .friction = 0.1});
  d.show("leaf", white, slab({-0.013f, -0.30f, -0.20f}, {0.013f, 0, 0.20f}, 0.007f, 2));
  d.show("cross", aid_picture(&shop), panel(0.16f, 0.16f).moved(0.0136f, -0.15f, 0.03f));
  d.show("catch", green, slab({0.008f, -0.298f, -0.025f}, {0.022f, -0.272f, 0.025f}, 0.004f));
  d.collide_box({-0.013f, -0.30f, -0.20f}, {0.013f, 0, 0.20f});
  d.mass = 0.9;
  p.front = 0.4f;
  return p;
}

Prop wall_phone(Workshop& shop) {
  Prop p;
  PropPart& b = p.body();
  const std::string body = shop.plastic(shop.color({0.08, 0.085, 0.09}), 0.3),
                    grey = shop.plastic({0.62, 0.63, 0.62}, 0.4);
  b.show(
      "base", body,
      plate_y(rounded_outline({{0, -0.11f}, {0.05f, -0.11f}, {0.035f, 0.11f}, {0, 0.11f}}, 0.01f),
              -0.075f, 0.075f));
  Solid keys;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column)
      keys += rounded_box({0.008f, 0.014f, 0.010f}, 0.003f)
                  .moved(0.0465f - 0.00105f * float(row) * 1.0f, 0.018f + 0.018f * float(column),
                         -0.07f + 0.017f * float(row));
  b.show("keys", grey, keys);
  b.show("display", shop.plastic({0.25, 0.30, 0.26}, 0.1),
         rounded_box({0.004f, 0.055f, 0.03f}, 0.001f)
             .turned(Axis::kY, -4)
             .moved(0.0395f, 0.036f, 0.04f));
  b.show("handset", body,
         tube(smooth_path({{0.055f, -0.045f, -0.09f},
                           {0.085f, -0.045f, -0.05f},
                           {0.085f, -0.045f, 0.05f},
                           {0.055f, -0.045f, 0.09f}}),
              0.014f, 10) +
             bar({0.05f, -0.045f, -0.085f}, {0.078f, -0.045f, -0.09f}, 0.026f, 0.02f, 16) +
             bar({0.05f, -0.045f, 0.085f}, {0.078f, -0.045f, 0.09f}, 0.026f, 0.02f, 16));
  Path cord;
  for (int k = 0; k <= 160; ++k) {
    const float t = float(k) / 160, a = 2 * kPi * 20 * t;
    cord.push_back({0.035f + 0.008f * std::cos(a) - 0.01f * std::sin(kPi * t), -0.045f + 0.06f * t,
                    -0.115f - 0.14f * std::sin(kPi * t) + 0.008f * std::sin(a)});
  }
  b.show("cord", shop.rubber(), tube(cord, 0.0022f, 5));
  b.collide_box({0, -0.075f, -0.11f}, {0.05f, 0.075f, 0.11f})
      .collide_box({0.05f, -0.07f, -0.11f}, {0.098f, -0.02f, 0.11f});
  b.mass = 0.8;
  p.front = 0.4f;
  return p;
}

Prop hose_reel(Workshop& shop) {
  // Red reel on the wall: disc, 25 m of hose, valve.
  const float r = 0.28f, x0 = 0.06f, x1 = 0.22f;
  Prop p;
  PropPart& b = p.body();
  // A profile (r, x) about the reel's axle; z of the lathe becomes x.
  const auto on_x = [](const Profile& profile) {
    return lathe(rounded(profile, 0.006f), 40).turned(Axis::kY, 90);
  };
  const std::string red = shop.paint(shop.color(kRed), 0.3), steel = shop.metal("galvanised");
  for (const float x : {x0, x1})
    b.show("discs", red,
           on_x({{0, x - 0.004f},
                 {r - 0.012f, x - 0.004f},
                 {r - 0.006f, x - 0.009f},
                 {r, x},
                 {r - 0.006f, x + 0.009f},
                 {r - 0.012f, x + 0.004f},
                 {0, x + 0.004f}}));
  b.show("hub", shop.plastic(kSafetyBlack, 0.45),
         on_x({{0, x1}, {0.05f, x1}, {0.045f, x1 + 0.03f}, {0, x1 + 0.03f}}));
  Path coil;
  const float hose = 0.0155f, wound = r * 0.84f;
  const int turns = int((x1 - x0 - 0.03f) / (2.03f * hose));
  for (int k = 0; k <= turns * 32; ++k) {
    const float a = 2 * kPi * float(k) / 32;
    coil.push_back({x0 + 0.006f + hose + 2.03f * hose * float(k) / 32, wound * std::cos(a),
                    wound * std::sin(a)});
  }
  // The end hangs down with the nozzle.
  const float end = coil.back().x;
  b.show("hose", shop.rubber({0.36, 0.05, 0.05}),
         tube(coil, hose, 8) + tube(smooth_path({{end, wound, 0},
                                                 {end, wound + 0.005f, -0.1f},
                                                 {end + 0.02f, wound - 0.02f, -0.24f},
                                                 {end + 0.03f, wound - 0.06f, -0.34f}}),
                                    hose, 8));
  b.show("hose", shop.rubber({0.36, 0.05, 0.05}),
         on_x({{wound - 0.01f, x0 + 0.005f},
               {wound, x0 + 0.005f},
               {wound, x1 - 0.005f},
               {wound - 0.01f, x1 - 0.005f}}));
  b.show("nozzle", shop.metal("brass"),
         bar({end + 0.03f, wound - 0.06f, -0.34f}, {end + 0.045f, wound - 0.1f, -0.44f}, 0.018f,
             0.013f, 14));
  b.show("bracket", steel,
         slab({0, -0.09f, -0.16f}, {0.006f, 0.09f, 0.16f}, 0.002f) +
             bar({0.005f, 0, 0}, {x0, 0, 0}, 0.03f, 0.03f, 16));
  b.show(
      "pipe", red,
      tube(rounded_path(
               {{0.03f, -r - 0.06f, 0.45f}, {0.03f, -r - 0.06f, -0.02f}, {0.03f, -0.03f, -0.02f}},
               0.05f),
           0.017f, 12));
  b.show("valve", shop.metal("brass"),
         bar({0.03f, -r - 0.06f, 0.14f}, {0.03f, -r - 0.06f, 0.24f}, 0.026f, 0.026f, 14));
  b.show("valve_wheel", red,
         ring(0.028f, 0.04f, 0.075f, 0.087f, 20).turned(Axis::kY, 90).moved(0, -r - 0.06f, 0.19f) +
             bar({0.03f, -r - 0.06f, 0.19f}, {0.085f, -r - 0.06f, 0.19f}, 0.009f, 0.009f, 10) +
             slab({0.077f, -r - 0.092f, 0.185f}, {0.085f, -r - 0.028f, 0.195f}, 0.002f));
  b.collide_cylinder(Vec3f{x0 - 0.01f, 0, 0}, Vec3f{x1 + 0.01f, 0, 0}, r)
      .collide_capsule({0.03f, -r - 0.06f, 0.43f}, {0.03f, -r - 0.06f, 0}, 0.02f);
  p.front = 0.5f;
  b.mass = 30;
  return p;
}

Prop convex_mirror(Workshop& shop) {
  const float r = std::clamp(shop.size({0.2f, 0.6f, 0.6f}).y, 0.3f, 1.0f) / 2, deep = r * 0.28f,
              stand = 0.13f;
  Prop p;
  PropPart& b = p.body();
  const auto hang = [&](const Solid& s) { return s.turned(Axis::kY, 90 + 14).moved(stand, 0, 0); };
  Profile dome{};
  const float big = (r * r + deep * deep) / (2 * deep);  // radius of the sphere
  for (int k = 0; k <= 10; ++k) {
    const float q = r * (1 - float(k) / 10);
    dome.push_back({q, deep - big + std::sqrt(big * big - q * q)});
  }
  b.show("mirror", shop.mirror(), hang(lathe(dome, 40)));
  b.show("rim", shop.rubber({0.05, 0.05, 0.05}),
         hang(lathe(rounded({{r - 0.004f, -0.014f},
                             {r + 0.012f, -0.014f},
                             {r + 0.012f, 0.012f},
                             {r - 0.006f, 0.012f}},
                            0.006f),
                    40)));
  b.show("back", shop.plastic(shop.color({0.80, 0.16, 0.04}), 0.4),
         hang(lathe(rounded({{0, -0.03f}, {r * 0.7f, -0.02f}, {r, -0.010f}}, 0.02f), 40)));
  b.show("arm", shop.metal("galvanised"),
         slab({0, -0.06f, -0.06f}, {0.006f, 0.06f, 0.06f}, 0.002f) +
             bar({0.003f, 0, 0}, {stand - 0.02f, 0, 0}, 0.017f, 0.017f, 12));
  const Vec3f along{std::cos(14 * kPi / 180), 0, -std::sin(14 * kPi / 180)}, foot{stand, 0, 0};
  b.collide_cylinder(foot - along * 0.015f, foot + along * (0.1f * deep), r)
      .collide_cylinder(foot, foot + along * (0.7f * deep), 0.55f * r)
      .collide_capsule({0.02f, 0, 0}, {stand - 0.03f, 0, 0}, 0.018f);
  b.mass = 4 + 12 * r * r;
  return p;
}

Prop floor_line(Workshop& shop) {
  // Two-component paint, a third of a millimetre; nothing to trip over.
  const Vec3f size = shop.size({3.0f, 0.1f, 0.01f});
  const float x = std::clamp(size.x, 0.05f, 100.0f) / 2, y = std::clamp(size.y, 0.03f, 2.0f) / 2;
  Prop p;
  PropPart& b = p.body();
  b.show("paint", shop.paint(shop.color(kSafetyYellow), 0.55),
         slab({-x, -y, 0}, {x, y, 0.0008f}, 0));
  b.mass = 1600 * 0.0008 * 4 * x * y;
  return p;
}

constexpr PropKind kSafety[] = {
    {"traffic_cone", traffic_cone, "cone with reflecting bands, 0.5 or 0.75 m"},
    {"safety_barrier", safety_barrier, "guard rail on posts"},
    {"bollard", bollard, "steel post bolted to the floor"},
    {"fire_extinguisher", fire_extinguisher, "extinguisher on a stand with its sign"},
    {"wall_extinguisher", wall_extinguisher, "extinguisher on the wall below its sign"},
    {"exit_sign", exit_sign, "lit exit sign; on the wall"},
    {"hazard_sign", hazard_sign, "warning sign; on the wall"},
    {"first_aid_box", first_aid_box, "cabinet with a hinged door; on the wall"},
    {"wall_phone", wall_phone, "telephone; on the wall"},
    {"hose_reel", hose_reel, "fire hose on its reel; on the wall"},
    {"convex_mirror", convex_mirror, "mirror for blind corners; on the wall"},
    {"floor_line", floor_line, "painted strip along x; nothing collides with it"},
};

}  // namespace

PropFamily safety() { return kSafety; }

}  // namespace gloam

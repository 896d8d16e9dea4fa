// Racks for goods, and guards that save them from trucks.

#include <cmath>

#include "places/catalogue.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/labels.h"

namespace gloam {
namespace {

constexpr Vec3 kRackBlue{0.05, 0.20, 0.46}, kRackOrange{0.86, 0.32, 0.03};

// Upright between two beams' ends: a channel 100 mm wide, open to the frame's inside, with rows of
// holes on its face.
void add_upright(PropPart* b, Workshop* shop, float x, float y, float face, float height) {
  const std::string blue = shop->paint(kRackBlue, 0.38);
  const float w = 0.05f, deep = 0.07f, t = 0.004f;
  Profile c{{0, -w},
            {0, w},
            {-deep, w},
            {-deep, w - 0.022f},
            {-deep + t, w - 0.022f},
            {-deep + t, w - t},
            {-t, w - t},
            {-t, -w + t},
            {-deep + t, -w + t},
            {-deep + t, -w + 0.022f},
            {-deep, -w + 0.022f},
            {-deep, -w}};
  const float turn = face > 0 ? 0 : 180;
  b->show("uprights", blue, extrude(c, 0.006f, height).turned(Axis::kZ, turn).moved(x, y, 0));
  Solid holes;
  for (float z = 0.12f; z < height - 0.05f; z += 0.1f)  // drop-shaped, at 50 mm in truth
    for (const float side : {-0.028f, 0.028f})
      holes += panel(0.013f, 0.032f).moved(0.0004f, side, z);
  b->show("holes", shop->paint({0.015, 0.015, 0.02}, 0.9),
          holes.turned(Axis::kZ, turn).moved(x, y, 0));
  const float inner = x - face * 0.035f;
  b->show("feet", shop->metal("galvanised"),
          slab({inner - 0.06f, y - 0.075f, 0}, {inner + 0.06f, y + 0.075f, 0.006f}, 0.001f) +
              cylinder(0.012f, 0.006f, 0.022f, 0.002f, 6).moved(x + face * 0.012f, y + 0.062f, 0) +
              cylinder(0.012f, 0.006f, 0.022f, 0.002f, 6).moved(x + face * 0.012f, y - 0.062f, 0));
}

void add_frame(PropPart* b, Workshop* shop, float half, float y, float height) {
  add_upright(b, shop, half, y, 1, height);
  add_upright(b, shop, -half, y, -1, height);
  // Braces: level at both ends, zigzag between.
  const std::string steel = shop->metal("galvanised");
  const float in = half - 0.06f;
  const int fields = std::max(1, int((height - 0.3f) / 0.85f));
  const float pitch = (height - 0.3f) / float(fields);
  for (const float z : {0.15f, height - 0.15f})
    b->show("braces", steel, beam({-in, y, z}, {in, y, z}, 0.025f, 0.04f));
  for (int i = 0; i < fields; ++i) {
    const float z = 0.15f + pitch * float(i), side = i % 2 == 0 ? 1.0f : -1.0f;
    b->show("braces", steel,
            beam({-side * in, y, z + 0.04f}, {side * in, y, z + pitch - 0.02f}, 0.025f, 0.04f));
  }
}

Prop pallet_rack(Workshop& shop) {
  const Vec3f size = shop.size({1.1f, 2.8f, 5.35f});
  const float depth = std::clamp(size.x, 0.6f, 1.4f), pitch = std::clamp(size.y, 1.2f, 4.0f),
              height = std::clamp(size.z, 1.2f, 14.0f), x = depth / 2, y = pitch / 2;
  // Beams at least 1.4 m apart; the frames stand 0.25 m above the highest.
  const int levels = std::clamp(int((height - 0.25f) / 1.4f), 1, 6);
  const float step = (height - 0.25f) / float(levels), tall = 0.12f, beam_y = y - 0.052f;
  Prop p;
  PropPart& b = p.body();
  for (const float side : {-1.0f, 1.0f}) {
    add_frame(&b, &shop, x, side * y, height);
    b.collide_box({-x, side * y - 0.05f, 0}, {x, side * y + 0.05f, height});
  }
  const int deck = shop.dice.integer(0, 2);  // none, wire, board
  const std::string orange = shop.paint(shop.color(kRackOrange), 0.36),
                    steel = shop.metal("galvanised");
  p.surfaces.push_back({{-x, -y + 0.06f}, {x, y - 0.06f}, 0, step - tall - 0.05f});
  for (int level = 1; level <= levels; ++level) {
    const float top = step * float(level);
    for (const float side : {-1.0f, 1.0f}) {
      const float at = side * (x - 0.028f);
      b.show("beams", orange,
             slab({at - 0.025f, -beam_y, top - tall}, {at + 0.025f, beam_y, top}, 0.005f));
      for (const float end : {-1.0f, 1.0f}) {
        // Hooked angle that laps around the upright's face.
        const float ye = end * beam_y;
        b.show("beams", orange,
               slab({at - 0.03f, min(ye, ye - end * 0.005f), top - 0.19f},
                    {at + 0.03f, max(ye, ye - end * 0.005f), top + 0.01f}, 0.001f) +
                   slab({side * x + (side > 0 ? 0.0f : -0.004f),
                         end > 0 ? ye - 0.004f : ye - 0.046f, top - 0.19f},
                        {side * x + (side > 0 ? 0.004f : 0.0f), end > 0 ? ye + 0.046f : ye + 0.004f,
                         top + 0.01f},
                        0.001f));
      }
    }
    b.show("signs", place_label(&shop),
           panel(0.2f, 0.05f).moved(x - 0.0024f, -pitch * 0.25f, top - tall / 2));
    b.show("signs", place_label(&shop),
           panel(0.2f, 0.05f).moved(x - 0.0024f, pitch * 0.25f, top - tall / 2));
    float stand = top;
    const float inner = x - 0.055f;
    if (deck == 1) {
      // Wire mesh that hangs over the beams, on three channels.
      const float r = 0.0025f;
      const int nx = int(depth / 0.1f), ny = int((pitch - 0.12f) / 0.05f);
      Solid mesh;
      for (int i = 0; i <= ny; ++i) {
        const float wy = -beam_y + 0.01f + (2 * beam_y - 0.02f) * float(i) / float(ny);
        mesh += tube({{-x + 0.004f, wy, top + 0.003f}, {x - 0.004f, wy, top + 0.003f}}, r, 4);
      }
      for (int i = 0; i <= nx; ++i) {
        const float wx = -x + 0.02f + (depth - 0.04f) * float(i) / float(nx);
        mesh +=
            tube({{wx, -beam_y + 0.008f, top + 0.007f}, {wx, beam_y - 0.008f, top + 0.007f}}, r, 4);
      }
      b.show("decks", steel, mesh);
      for (int i = 0; i < 3; ++i) {
        const float wy = (float(i) - 1) * pitch * 0.3f;
        b.show("channels", steel,
               slab({-inner, wy - 0.02f, top - 0.038f}, {inner, wy + 0.02f, top}, 0.003f));
      }
      stand = top + 0.0095f;
    } else if (deck == 2) {
      b.show("decks", shop.chipboard(),
             slab({-x + 0.01f, -beam_y + 0.006f, top}, {x - 0.01f, 0.0f, top + 0.022f}, 0.001f));
      b.show("decks", shop.chipboard(),
             slab({-x + 0.01f, 0.002f, top}, {x - 0.01f, beam_y - 0.006f, top + 0.022f}, 0.001f));
      stand = top + 0.022f;
    } else {
      for (int i = 0; i < 4; ++i) {  // bars under pallets that lie askew
        const float wy = (float(i) - 1.5f) * pitch * 0.22f;
        b.show(
            "channels", steel,
            slab({-inner, wy - 0.025f, top - 0.045f}, {inner, wy + 0.025f, top - 0.002f}, 0.003f));
      }
    }
    b.collide_box({-x, -beam_y, top - tall}, {x, beam_y, stand});
    const float free = level < levels ? step - tall - (stand - top) : 2.0f;
    p.surfaces.push_back({{-x, -y + 0.06f}, {x, y - 0.06f}, stand, free});
  }
  b.show("load_sign", load_sign(&shop), panel(0.2f, 0.15f).moved(x + 0.0006f, -y, 1.6f));
  // Uprights 6 kg/m, beams 5 kg/m, decks 12 kg/m², braces a third of the frames.
  b.mass =
      4 * 6.0 * height * 1.3 + levels * (2 * 5.0 * pitch + (deck > 0 ? 12.0 : 3.0) * depth * pitch);
  p.front = 1.2f;
  return p;
}

Prop shelf_rack(Workshop& shop) {
  // Boltless: posts of angles, steps of rails, boards; bins and cartons on it.
  const Vec3f size = shop.size({0.45f, 1.0f, 1.9f});
  const float x = std::clamp(size.x, 0.25f, 0.9f) / 2, y = std::clamp(size.y, 0.5f, 2.4f) / 2,
              z = std::clamp(size.z, 0.8f, 3.0f);
  const int levels = std::max(2, int(z / 0.42f));
  Prop p;
  PropPart& b = p.body();
  const bool blue = shop.dice.chance(0.5);
  const std::string post = blue ? shop.paint(shop.color(kRackBlue), 0.4) : shop.metal("galvanised");
  const std::string rail = blue ? shop.paint(kRackOrange, 0.4) : post;
  for (const float sx : {-1.0f, 1.0f}) {
    for (const float sy : {-1.0f, 1.0f}) {
      const auto leg = [&](float ax, float ay) {
        const Vec3f from{sx * x, sy * y, 0.004f}, to{sx * (x - ax), sy * (y - ay), z};
        return slab({min(from.x, to.x), min(from.y, to.y), from.z},
                    {max(from.x, to.x), max(from.y, to.y), to.z}, 0.0008f);
      };
      b.show("posts", post, leg(0.0018f, 0.035f) + leg(0.035f, 0.0018f));
      b.show("feet", shop.plastic({0.05, 0.05, 0.05}),
             slab({sx * (x - 0.018f) - 0.02f, sy * (y - 0.018f) - 0.02f, 0},
                  {sx * (x - 0.018f) + 0.02f, sy * (y - 0.018f) + 0.02f, 0.02f}, 0.003f));
      Solid slots;
      for (float h = 0.08f; h < z - 0.04f; h += 0.05f)
        slots += panel(0.006f, 0.02f).moved(0.0004f, 0, h);
      b.show("slots", shop.paint({0.02, 0.02, 0.02}, 0.9),
             slots.turned(Axis::kZ, sx > 0 ? 0 : 180).moved(sx * x, sy * (y - 0.018f), 0));
    }
    b.collide_box({-x, sx * y - (sx > 0 ? 0.035f : 0), 0}, {x, sx * y + (sx > 0 ? 0 : 0.035f), z});
  }
  for (int level = 0; level < levels; ++level) {
    const float top = 0.1f + (z - 0.12f) * float(level) / float(levels - 1);
    for (const float s : {-1.0f, 1.0f}) {
      b.show("rails", rail,
             slab({s * (x - 0.004f) - 0.002f, -y + 0.004f, top - 0.05f},
                  {s * (x - 0.004f) + 0.002f, y - 0.004f, top + 0.003f}, 0.001f));
      b.show("rails", rail,
             slab({-x + 0.004f, s * (y - 0.004f) - 0.002f, top - 0.05f},
                  {x - 0.004f, s * (y - 0.004f) + 0.002f, top + 0.003f}, 0.001f));
    }
    b.show("boards", shop.chipboard(),
           slab({-x + 0.008f, -y + 0.008f, top - 0.012f}, {x - 0.008f, y - 0.008f, top}, 0.001f));
    b.collide_box({-x, -y, top - 0.05f}, {x, y, top + 0.003f});
    const float room = level + 1 < levels ? (z - 0.12f) / float(levels - 1) - 0.06f : 1.0f;
    p.surfaces.push_back({{-x + 0.02f, -y + 0.04f}, {x - 0.02f, y - 0.04f}, top + 0.003f, room});
  }
  b.mass = 4 * 0.9 * z + levels * (9.0 * 4 * x * y + 4.0 * (x + y));
  p.front = 0.7f;
  return p;
}

// Boltless shelves with their contents.
Prop stocked_shelf(Workshop& shop) {
  Prop p = shelf_rack(shop);
  PropPart& b = p.body();
  double goods = 0;
  const std::vector<PropSurface> shelves = std::move(p.surfaces);
  p.surfaces.clear();
  for (const PropSurface& s : shelves) {
    const float deep = s.high.x - s.low.x;
    const int kind = shop.dice.integer(0, 3);
    float at = s.low.y;
    const Vec3 color = shop.dice.pick({Vec3{0.05, 0.22, 0.55}, Vec3{0.68, 0.10, 0.07},
                                       Vec3{0.80, 0.62, 0.06}, Vec3{0.10, 0.40, 0.20}});
    while (kind > 0) {
      const float wide = kind == 1 ? 0.15f : float(shop.dice.uniform(0.2, 0.38));
      if (at + wide > s.high.y) break;
      const float tall =
          min(s.clearance - 0.03f, kind == 1 ? 0.13f : float(shop.dice.uniform(0.14, 0.32)));
      const Vec3f low{s.low.x + 0.01f, at + 0.006f, s.z},
          high{low.x + deep - 0.02f, at + wide - 0.006f, s.z + tall};
      if (kind == 1) {  // open-fronted bin: its sides fall towards the front
        const Profile side{{low.x, low.z},
                           {high.x, low.z},
                           {high.x, low.z + tall * 0.45f},
                           {high.x - 0.09f, high.z},
                           {low.x, high.z}};
        const std::string pp = shop.plastic(color, 0.38);
        const std::string name = "bins_" + std::to_string(&s - shelves.data());
        b.show(name, pp,
               plate_y(side, low.y, low.y + 0.003f) + plate_y(side, high.y - 0.003f, high.y));
        b.show(name, pp, slab(low, {high.x, high.y, low.z + 0.003f}, 0.001f));
        b.show(
            name, pp,
            slab({high.x - 0.003f, low.y, low.z}, {high.x, high.y, low.z + tall * 0.45f}, 0.001f));
        b.show(name, pp, slab(low, {low.x + 0.003f, high.y, high.z}, 0.001f));
        b.show("tags", place_label(&shop),
               panel(0.09f, 0.0225f)
                   .moved(high.x + 0.0006f, (low.y + high.y) / 2, low.z + tall * 0.25f));
        for (int k = 0; k < 5; ++k)
          b.show("parts", shop.metal("galvanised"),
                 cylinder(0.012f, 0, 0.05f, 0.002f, 10)
                     .turned(Axis::kX, float(shop.dice.uniform(40, 140)))
                     .turned(Axis::kZ, float(shop.dice.uniform(0, 360)))
                     .moved(float(shop.dice.uniform(low.x + 0.06, high.x - 0.06)),
                            (low.y + high.y) / 2, low.z + 0.03f));
      } else {
        add_cartons(&b, &shop, low, high);
      }
      b.collide_box(low, high);
      goods += 150.0 * wide * deep * tall;
      at += wide + (kind == 1 ? 0 : float(shop.dice.uniform(0, 0.08)));
    }
    if (kind == 0) p.surfaces.push_back(s);
  }
  b.mass += goods;
  return p;
}

Prop rack_guard(Workshop& shop) {
  // Bent plate of 6 mm with a foot, bolted down before an upright.
  const float height = std::clamp(shop.size({0.16f, 0.2f, 0.4f}).z, 0.3f, 1.2f);
  Prop p;
  PropPart& b = p.body();
  Profile u;
  for (int k = 0; k <= 10; ++k) {
    const float a = -kPi / 2 + kPi * float(k) / 10;
    u.push_back({0.02f + 0.06f * std::cos(a), 0.08f * std::sin(a)});
  }
  u.push_back({-0.06f, 0.08f});
  u.push_back({-0.06f, 0.074f});
  for (int k = 10; k >= 0; --k) {
    const float a = -kPi / 2 + kPi * float(k) / 10;
    u.push_back({0.02f + 0.054f * std::cos(a), 0.074f * std::sin(a)});
  }
  u.push_back({-0.06f, -0.074f});
  u.push_back({-0.06f, -0.08f});
  const Vec3 yellow = shop.color({0.90, 0.62, 0.02});
  b.show("guard", shop.paint(yellow, 0.4), extrude(u, 0.004f, height));
  b.show("guard", shop.paint(yellow, 0.4),
         slab({-0.08f, -0.125f, 0}, {0.09f, 0.125f, 0.008f}, 0.002f));
  for (const float sx : {-0.05f, 0.06f})
    for (const float sy : {-0.105f, 0.105f})
      b.show("bolts", shop.metal("galvanised"),
             cylinder(0.013f, 0.008f, 0.012f, 0.001f, 16).moved(sx, sy, 0) +
                 cylinder(0.009f, 0.01f, 0.022f, 0.002f, 6).moved(sx, sy, 0));
  std::vector<Vec3f> points;  // black bands around it
  for (const float z : {height * 0.42f, height * 0.62f})
    for (int k = 0; k <= 10; ++k) {
      const float a = -kPi / 2 + kPi * float(k) / 10;
      points.push_back({0.02f + 0.0606f * std::cos(a), 0.0806f * std::sin(a), z});
    }
  b.show("band", shop.paint({0.03, 0.03, 0.03}, 0.45), sheet(points, 11));
  b.collide_box({-0.06f, -0.08f, 0.008f}, {0.08f, 0.08f, height});
  b.collide_box({-0.08f, -0.125f, 0}, {0.09f, 0.125f, 0.008f});
  b.mass = 7850 * 0.006 * (0.36 * height + 0.17 * 0.25);
  return p;
}

Prop locker(Workshop& shop) {
  // Sheet steel, doors 0.3 m wide with slots, a turning latch and a number.
  const Vec3f size = shop.size({0.5f, 0.9f, 1.8f});
  const float x = std::clamp(size.x, 0.3f, 0.7f) / 2, z = std::clamp(size.z, 1.2f, 2.2f);
  const int doors = std::clamp(int(size.y / 0.3f + 0.05f), 1, 6);
  const float pitch = std::clamp(size.y / float(doors), 0.25f, 0.5f), y = pitch * float(doors) / 2;
  Prop p;
  PropPart& b = p.body();
  const std::string grey = shop.paint({0.62, 0.64, 0.65}, 0.4);
  const std::string color = shop.paint(
      shop.color(
          shop.dice.pick({Vec3{0.10, 0.26, 0.45}, Vec3{0.62, 0.64, 0.65}, Vec3{0.16, 0.38, 0.30}})),
      0.4);
  const float foot = 0.1f, t = 0.0012f, face = x - 0.02f;
  b.show("body", grey, slab({-x, -y, foot}, {-x + 2 * t, y, z}, 0.001f));
  b.show("body", grey,
         slab({-x, -y, z - 0.003f}, {face, y, z}, 0.001f) +
             slab({-x, -y, foot}, {face, y, foot + 0.003f}, 0.001f));
  for (int i = 0; i <= doors; ++i) {
    const float at = -y + pitch * float(i), half = 0.0015f, c = std::clamp(at, -y + half, y - half);
    b.show("body", grey, slab({-x, c - half, foot}, {face, c + half, z}, 0.0005f));
    b.collide_box({-x, c - half - 0.004f * float(i > 0), foot},
                  {face - 0.004f, c + half + 0.004f * float(i < doors), z});
  }
  b.collide_box({-x, -y, foot}, {-x + 0.01f, y, z});
  b.collide_box({-x, -y, z - 0.01f}, {face - 0.004f, y, z})
      .collide_box({-x, -y, 0}, {face - 0.004f, y, foot + 0.004f});
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f})
      b.show("feet", shop.plastic({0.05, 0.05, 0.05}),
             slab({sx * (x - 0.05f) - 0.02f, sy * (y - 0.03f) - 0.02f, 0},
                  {sx * (x - 0.05f) + 0.02f, sy * (y - 0.03f) + 0.02f, foot}, 0.003f));
  b.show("body", grey,
         slab({-x + 0.02f, -y + 0.01f, foot - 0.03f}, {face - 0.01f, y - 0.01f, foot}, 0.002f));
  for (int i = 0; i < doors; ++i) {
    const float y0 = -y + pitch * float(i);
    b.show("shelves", grey,
           slab({-x + 0.003f, y0 + 0.002f, z - 0.32f},
                {face - 0.03f, y0 + pitch - 0.002f, z - 0.318f}, 0));
    b.show("rods", shop.metal("steel"),
           bar({-0.02f, y0 + 0.003f, z - 0.36f}, {-0.02f, y0 + pitch - 0.003f, z - 0.36f}, 0.008f,
               0.008f, 8));
    // Hinged on its left as one looks at it, that is at the greater y.
    PropPart& d = p.hang("door_" + std::to_string(i + 1), {x - 0.01f, y0 + pitch - 0.006f, 0},
                         {.axis = {0, 0, -1},
                          .low = -1.5,
                          .high = 0,
                          .initial = 0,
                          .damping = 0.2,
                          .friction = 0.15});
    const float w = pitch - 0.010f;
    d.show("leaf", color, slab({-0.008f, -w, foot + 0.006f}, {0.010f, 0, z - 0.006f}, 0.004f));
    Solid slots;
    for (const float base : {foot + 0.16f, z - 0.25f})
      for (int k = 0; k < 5; ++k)
        slots += rounded_box({0.003f, w * 0.5f, 0.007f}, 0.001f)
                     .moved(0.0095f, -w / 2, base + 0.025f * float(k));
    d.show("slots", shop.paint({0.03, 0.03, 0.035}, 0.7), slots);
    d.show("latch", shop.metal("chrome"),
           bar({0.008f, -w + 0.035f, z * 0.55f}, {0.022f, -w + 0.035f, z * 0.55f}, 0.016f, 0.014f,
               16) +
               slab({0.02f, -w + 0.030f, z * 0.55f - 0.022f},
                    {0.030f, -w + 0.040f, z * 0.55f + 0.022f}, 0.003f));
    d.show("number", shop.paper({0.9, 0.9, 0.88}),
           slab({0.009f, -w / 2 - 0.03f, z - 0.11f}, {0.0108f, -w / 2 + 0.03f, z - 0.08f}, 0.001f));
    d.mass = 7850 * 0.0009 * w * (z - foot) * 1.15;
    d.collide_box({-0.008f, -w, foot + 0.006f}, {0.010f, 0, z - 0.006f});
  }
  b.mass = 7850 * 0.0009 * (2 * y * z + (doors + 1) * 2 * x * z + 8 * x * y) * 1.1;
  p.front = 0.7f;
  return p;
}

constexpr PropKind kRacks[] = {
    {"pallet_rack", pallet_rack, "one bay of a pallet rack; neighbours at a pitch of its width"},
    {"shelf_rack", stocked_shelf, "boltless shelves with bins and cartons"},
    {"rack_guard", rack_guard, "bent plate that protects a rack's upright"},
    {"locker", locker, "steel lockers with hinged doors"},
};

}  // namespace

PropFamily racks() { return kRacks; }

}  // namespace gloam

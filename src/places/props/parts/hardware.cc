#include "places/props/parts/hardware.h"

#include <cmath>

#include "places/props/parts/labels.h"

namespace gloam {

Solid beam(Vec3f from, Vec3f to, float width, float height, float radius) {
  const Vec3f d = to - from;
  const float flat = std::sqrt(d.x * d.x + d.y * d.y);
  const float degrees = 180 / kPi;
  return rounded_box({length(d), width, height}, radius)
      .turned(Axis::kY, -std::atan2(d.z, flat) * degrees)
      .turned(Axis::kZ, std::atan2(d.y, d.x) * degrees)
      .moved((from + to) * 0.5f);
}

Solid plate_y(const Profile& outline, float y0, float y1) {
  return extrude(outline, -y1, -y0).turned(Axis::kX, 90);
}

Solid plate_x(const Profile& outline, float x0, float x1) {
  return extrude(outline, x0, x1).turned(Axis::kX, 90).turned(Axis::kZ, 90);
}

Solid wire(Vec3f from, Vec3f to, float radius) { return tube({from, to}, radius, 6); }

Path rounded_path(const Path& corners, float radius, int steps) {
  Path out{corners.front()};
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec3f a = corners[i - 1], b = corners[i], c = corners[i + 1];
    const Vec3f from = b + normalize(a - b) * min(radius, 0.49f * length(a - b));
    const Vec3f to = b + normalize(c - b) * min(radius, 0.49f * length(c - b));
    for (int k = 0; k <= steps; ++k) {
      const float t = float(k) / float(steps);
      out.push_back(from * ((1 - t) * (1 - t)) + b * (2 * t * (1 - t)) + to * (t * t));
    }
  }
  out.push_back(corners.back());
  return out;
}

Solid bolt(Vec3f at, float size) {
  return cylinder(size / 2, 0, size * 0.35f, size * 0.06f, 6).turned(Axis::kY, 90).moved(at);
}

Solid ring(float r0, float r1, float z0, float z1, int segments) {
  return sharp_lathe({{r0, z0}, {r1, z0}, {r1, z1}, {r0, z1}, {r0, z0}}, segments);
}

void add_wheel(PropPart* part, Workshop* shop, Vec3f center, float radius, float width, Vec3 tyre,
               Vec3 hub) {
  const float w = width / 2, rim = radius * 0.62f;
  const Solid rubber = lathe(rounded({{rim, -w * 0.8f},
                                      {radius * 0.9f, -w},
                                      {radius, -w * 0.78f},
                                      {radius, w * 0.78f},
                                      {radius * 0.9f, w},
                                      {rim, w * 0.8f}},
                                     radius * 0.07f),
                             28);
  const Solid disc = sharp_lathe({{0, -w * 0.45f},
                                  {rim * 0.45f, -w * 0.45f},
                                  {rim * 0.55f, -w * 0.3f},
                                  {rim * 0.9f, -w * 0.3f},
                                  {rim * 0.94f, -w * 0.82f},
                                  {rim, -w * 0.82f},
                                  {rim, w * 0.82f},
                                  {rim * 0.94f, w * 0.82f},
                                  {rim * 0.9f, w * 0.3f},
                                  {rim * 0.55f, w * 0.3f},
                                  {rim * 0.45f, w * 0.45f},
                                  {0, w * 0.45f}},
                                 24);
  part->show("tyres", shop->rubber(tyre), rubber.turned(Axis::kX, 90).moved(center));
  part->show("hubs", shop->paint(hub, 0.35), disc.turned(Axis::kX, 90).moved(center));
}

void add_caster(PropPart* part, Workshop* shop, float x, float y, float top, float radius) {
  const Vec3f hub{x - radius * 0.35f, y, radius};
  part->show("casters", shop->metal("galvanised"),
             slab({x - 0.04f, y - 0.035f, top - 0.004f}, {x + 0.04f, y + 0.035f, top}, 0.001f) +
                 cylinder(0.022f, top - 0.02f, top - 0.004f, 0.002f, 16).moved(x, y, 0));
  for (const float side : {-1.0f, 1.0f}) {
    const float inner = side * 0.016f, outer = side * 0.0195f;
    part->show("casters", shop->metal("galvanised"),
               plate_y({{x - radius * 0.6f, radius * 0.75f},
                        {x - radius * 0.1f, radius * 0.75f},
                        {x + 0.025f, top - 0.018f},
                        {x - 0.028f, top - 0.018f}},
                       y + min(inner, outer), y + max(inner, outer)));
  }
  part->show(
      "casters", shop->metal("galvanised"),
      slab({x - 0.028f, y - 0.0195f, top - 0.022f}, {x + 0.025f, y + 0.0195f, top - 0.018f}, 0));
  const Solid wheel = lathe(rounded({{0.008f, -0.013f},
                                     {radius * 0.9f, -0.013f},
                                     {radius, -0.006f},
                                     {radius, 0.006f},
                                     {radius * 0.9f, 0.013f},
                                     {0.008f, 0.013f}},
                                    0.003f),
                            24);
  part->show("rollers", shop->rubber({0.09, 0.09, 0.095}), wheel.turned(Axis::kX, 90).moved(hub));
  part->show("axles", shop->metal("steel"),
             bar(hub + Vec3f{0, -0.023f, 0}, hub + Vec3f{0, 0.023f, 0}, 0.007f, 0.007f, 6));
}

void add_pallet(PropPart* part, Workshop* shop, Vec3f size) {
  // UIC 435-2: top boards of 145 and 100 mm, 22 mm thick, on cross boards, blocks and runners.
  const float x = size.x / 2, y = size.y / 2, board = 0.022f;
  const float deck = size.z - board, cross = deck - board;
  const float wide = min(0.145f, size.y * 0.18f), narrow = wide * 0.69f;
  const std::string wood = shop->rough_wood(Axis::kX), across = shop->rough_wood(Axis::kY);
  const int boards = std::max(5, int(size.y / 0.165f));
  for (int i = 0; i < boards; ++i) {
    const float t = float(i) / float(boards - 1);
    const float w = (i % 2 == 0 ? wide : narrow) / 2;
    const float at = (-y + wide / 2) * (1 - t) + (y - wide / 2) * t;
    const float shy = float(shop->dice.uniform(0, 0.003));
    part->show("boards", wood, slab({-x + shy, at - w, deck}, {x - shy, at + w, size.z}, 0.002f));
  }
  for (const float at : {-1.0f, 0.0f, 1.0f}) {
    const float middle = at * (x - 0.0725f);
    part->show("cross_boards", across,
               slab({middle - 0.0725f, -y, cross}, {middle + 0.0725f, y, deck}, 0.002f));
    for (const float side : {-1.0f, 0.0f, 1.0f}) {
      const float half = side == 0 ? wide / 2 : narrow / 2, center = side * (y - half);
      part->show("blocks", wood,
                 slab({middle - 0.0725f, center - half, board},
                      {middle + 0.0725f, center + half, cross}, 0.003f));
    }
  }
  for (const float side : {-1.0f, 0.0f, 1.0f}) {
    const float half = side == 0 ? wide / 2 : narrow / 2, center = side * (y - half);
    part->show("runners", wood, slab({-x, center - half, 0}, {x, center + half, board}, 0.003f));
    // The middle one bears nothing on a level floor: a third of the contacts.
    part->collide_box({-x, center - half, side == 0 ? 0.003f : 0}, {x, center + half, cross});
  }
  part->collide_box({-x, -y, cross}, {x, y, size.z});
}

void add_cartons(PropPart* part, Workshop* shop, Vec3f low, Vec3f high) {
  const Vec3f room = high - low;
  const auto count = [&](float length, double least, double most) {
    return std::max(1, int(length / shop->dice.uniform(least, most)));
  };
  const int nx = count(room.x, 0.28, 0.55), ny = count(room.y, 0.25, 0.45),
            nz = count(room.z, 0.22, 0.38);
  const Vec3f box{room.x / float(nx), room.y / float(ny), room.z / float(nz)};
  const std::string card = shop->cardboard(), tape = shop->plastic({0.62, 0.47, 0.28}, 0.25);
  const bool labels = shop->dice.chance(0.7);
  for (int iz = 0; iz < nz; ++iz) {
    for (int ix = 0; ix < nx; ++ix) {
      for (int iy = 0; iy < ny; ++iy) {
        const bool rim = ix == 0 || ix == nx - 1 || iy == 0 || iy == ny - 1;
        if (!rim && iz != nz - 1) continue;  // nobody sees the ones within
        const auto jitter = [&] { return float(shop->dice.uniform(-0.004, 0.004)); };
        const Vec3f middle{low.x + (float(ix) + 0.5f) * box.x + jitter(),
                           low.y + (float(iy) + 0.5f) * box.y + jitter(),
                           low.z + (float(iz) + 0.5f) * box.z};
        const Vec3f half = box * 0.5f - Vec3f{0.006f, 0.006f, 0.0005f};
        part->show("cartons", card, slab(middle - half, middle + half, 0.005f));
        const Vec3f strip{half.x + 0.0003f, 0.024f, half.z + 0.0003f};
        // Over the top and a hand down the ends.
        const Vec3f t = middle + Vec3f{0, 0, half.z};
        if (iz == nz - 1)
          part->show("tape", tape,
                     slab(t - Vec3f{strip.x - 0.004f, strip.y, 0.002f},
                          t + Vec3f{strip.x - 0.004f, strip.y, 0.0003f}, 0));
        for (const float end : {-1.0f, 1.0f}) {
          if (ix != (end < 0 ? 0 : nx - 1)) continue;
          const float face = middle.x + end * half.x;
          part->show("tape", tape,
                     slab({face - 0.0003f, middle.y - 0.024f, t.z - 0.06f},
                          {face + 0.0003f, middle.y + 0.024f, t.z - 0.004f}, 0));
          if (labels)
            part->show("labels", shipping_label(shop),
                       panel(0.105f, 0.0735f)
                           .turned(Axis::kZ, end > 0 ? 0 : 180)
                           .moved(face + end * 0.0006f, middle.y + half.y * 0.35f,
                                  middle.z - half.z * 0.15f));
        }
        for (const float side : {-1.0f, 1.0f}) {
          if (iy != (side < 0 ? 0 : ny - 1) || !labels) continue;
          part->show("marks", handling_mark(shop),
                     panel(0.09f, 0.06f)
                         .turned(Axis::kZ, side * 90)
                         .moved(middle.x + half.x * 0.5f, middle.y + side * (half.y + 0.0006f),
                                middle.z + half.z * 0.4f));
        }
      }
    }
  }
}

void add_sacks(PropPart* part, Workshop* shop, Vec3f low, Vec3f high) {
  const Vec3f room = high - low;
  const int layers = std::max(1, int(room.z / 0.125f + 0.5f));
  const float thick = room.z / float(layers);
  const Vec3 color = shop->color(shop->dice.pick({Vec3{0.80, 0.77, 0.70}, Vec3{0.62, 0.48, 0.32},
                                                  Vec3{0.86, 0.86, 0.84}, Vec3{0.55, 0.62, 0.66}}));
  const std::string paper = shop->paper(color), print = shop->paper({0.16, 0.30, 0.42});
  for (int layer = 0; layer < layers; ++layer) {
    const bool lengthwise = layer % 2 == 0;
    const int nx = std::max(1, int(room.x / (lengthwise ? 0.6f : 0.4f) + 0.1f));
    const int ny = std::max(1, int(room.y / (lengthwise ? 0.4f : 0.6f) + 0.1f));
    for (int ix = 0; ix < nx; ++ix) {
      for (int iy = 0; iy < ny; ++iy) {
        const float jx = float(shop->dice.uniform(-0.008, 0.008)),
                    jy = float(shop->dice.uniform(-0.008, 0.008)),
                    lean = float(shop->dice.uniform(-2, 2));
        const Vec3f at{low.x + (float(ix) + 0.5f) * room.x / float(nx) + jx,
                       low.y + (float(iy) + 0.5f) * room.y / float(ny) + jy,
                       low.z + (float(layer) + 0.5f) * thick};
        const Vec3f size{room.x / float(nx) - 0.012f, room.y / float(ny) - 0.012f, thick * 0.97f};
        part->show("sacks", paper,
                   cushion(size, 0.10f, thick * 0.40f, shop->dice.seed(), 0.9f, 0.006f)
                       .turned(Axis::kZ, lean)
                       .moved(at));
        for (const float end : {-1.0f, 1.0f}) {  // folded and glued ends, with a printed band
          const Vec3f half = lengthwise ? Vec3f{0.004f, size.y * 0.30f, thick * 0.11f}
                                        : Vec3f{size.x * 0.30f, 0.004f, thick * 0.11f};
          const Vec3f to = lengthwise ? Vec3f{end * (size.x / 2 - 0.002f), 0, 0}
                                      : Vec3f{0, end * (size.y / 2 - 0.002f), 0};
          part->show("bands", print, rounded_box(half * 2.0f, 0.003f).moved(at + to));
        }
      }
    }
  }
}

void add_drum(PropPart* part, Workshop* shop, Vec3f foot, float radius, float height, Vec3 color) {
  // Chimes at both ends, two rolling hoops, a lid that lies 12 mm deep.
  const float r = radius - 0.008f, hoop = 0.016f, h = height;
  Profile wall{{0, 0.012f}, {r - 0.01f, 0.012f}, {r - 0.006f, 0},
               {radius, 0}, {radius, 0.014f},    {r, 0.02f}};
  for (const float at : {0.34f, 0.66f}) {
    const float z = at * h;
    wall.insert(wall.end(),
                {{r, z - hoop}, {radius, z - 0.005f}, {radius, z + 0.005f}, {r, z + hoop}});
  }
  wall.insert(wall.end(), {{r, h - 0.02f},
                           {radius, h - 0.014f},
                           {radius, h},
                           {r - 0.006f, h},
                           {r - 0.01f, h - 0.012f},
                           {0, h - 0.012f}});
  part->show("drums", shop->paint(color, 0.32), lathe(rounded(wall, 0.004f), 40).moved(foot));
  const float spin = float(shop->dice.uniform(0, 360));
  const auto bung = [&](float size, float from) {
    return cylinder(size, h - 0.014f, h - 0.003f, 0.002f, 12)
        .moved(from, 0, 0)
        .turned(Axis::kZ, spin)
        .moved(foot);
  };
  part->show("bungs", shop->metal("galvanised"), bung(0.035f * radius / 0.29f, radius * 0.72f));
  part->show("bungs", shop->metal("galvanised"), bung(0.02f * radius / 0.29f, -radius * 0.74f));
}

}  // namespace gloam

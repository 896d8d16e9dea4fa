// Fillings of the openings of walls: doors with their frames, bare linings, windows.

#include <algorithm>
#include <cmath>

#include "places/furnish/shell.h"

namespace gloam {
namespace {

constexpr float kLiningWidth = 0.026f, kArchitrave = 0.062f, kProud = 0.012f, kLeaf = 0.040f,
                kDoorGap = 0.004f;

// Lining of the reveal and architraves on both faces; three boxes of the lining collide.
void add_door_frame(Workshop& shop, const Opening& o, float wall, PropPart* part) {
  const std::string paint = shop.paint(shop.style.trim, 0.4);
  const float y = float(o.width) / 2, z = float(o.head), x = wall / 2 + kProud;
  for (const float side : {-1.0f, 1.0f}) {
    const float a = side * (y - kLiningWidth), b = side * y;
    const Vec3f low{-x, std::min(a, b), 0}, high{x, std::max(a, b), z};
    part->show("frame", paint, slab(low, high, 0.002f));
    part->collide_box(low, high);
    for (const float face : {-1.0f, 1.0f}) {
      const float inner = face * (wall / 2), outer = face * x;
      const float from = side * (y - 0.006f), to = side * (y + kArchitrave);
      part->show("frame", paint,
                 slab({std::min(inner, outer), std::min(from, to), 0},
                      {std::max(inner, outer), std::max(from, to), z + kArchitrave}, 0.003f));
    }
  }
  const Vec3f low{-x, -y + kLiningWidth, z - kLiningWidth}, high{x, y - kLiningWidth, z};
  part->show("frame", paint, slab(low, high, 0.002f));
  part->collide_box(low, high);
  for (const float face : {-1.0f, 1.0f}) {
    const float inner = face * (wall / 2), outer = face * x;
    part->show("frame", paint,
               slab({std::min(inner, outer), -y + 0.006f, z - 0.006f},
                    {std::max(inner, outer), y - 0.006f, z + kArchitrave}, 0.003f));
  }
}

// A lever on a rose, on the face towards +x; `to_hinge` = direction of y in which it points.
Solid lever(float to_hinge) {
  Solid s = cylinder(0.026f, 0, 0.008f, 0.002f, 18).turned(Axis::kY, 90);
  const Path path = smooth_path({{0, 0, 0},
                                 {0.04f, 0, 0},
                                 {0.052f, to_hinge * 0.012f, 0},
                                 {0.052f, to_hinge * 0.06f, 0},
                                 {0.05f, to_hinge * 0.125f, 0}});
  s += tube(path, 0.0095f, 10);
  // Cylinder lock below.
  s += cylinder(0.017f, 0, 0.010f, 0.002f, 14).turned(Axis::kY, 90).moved(0, 0, -0.085f);
  return s;
}

struct LeafSize {
  float width, low, high;  // [m]
  float hinge;             // -1 or 1: side of y where the axis is
  float face;              // x of the leaf's middle from the axis
};

// Stiles, rails and sunk panels; `glazed` = the upper panels are glass.
void add_panelled(Workshop& shop, const LeafSize& l, const std::string& paint, int rows,
                  int columns, bool glazed, PropPart* leaf) {
  const float stile = 0.11f, rail = 0.13f, foot = 0.2f;
  const float y0 = -l.hinge * kDoorGap, y1 = -l.hinge * (l.width + kDoorGap);
  const float low = std::min(y0, y1), high = std::max(y0, y1);
  const auto piece = [&](float a, float b, float z0, float z1, float thick, float bevel) {
    return slab({l.face - thick / 2, a, z0}, {l.face + thick / 2, b, z1}, bevel);
  };
  leaf->show("leaf", paint, piece(low, low + stile, l.low, l.high, kLeaf, 0.002f));
  leaf->show("leaf", paint, piece(high - stile, high, l.low, l.high, kLeaf, 0.002f));
  const float column =
      (high - low - 2 * stile - float(columns - 1) * stile * 0.8f) / float(columns);
  const float inside = l.high - l.low - foot - rail;
  const float row = (inside - float(rows - 1) * rail) / float(rows);
  leaf->show("leaf", paint, piece(low + stile, high - stile, l.low, l.low + foot, kLeaf, 0.002f));
  leaf->show("leaf", paint, piece(low + stile, high - stile, l.high - rail, l.high, kLeaf, 0.002f));
  for (int r = 0; r < rows; ++r) {
    const float z = l.low + foot + float(r) * (row + rail);
    if (r > 0)
      leaf->show("leaf", paint, piece(low + stile, high - stile, z - rail, z, kLeaf, 0.002f));
    for (int c = 0; c < columns; ++c) {
      const float y = low + stile + float(c) * (column + stile * 0.8f);
      if (c > 0) leaf->show("leaf", paint, piece(y - stile * 0.8f, y, z, z + row, kLeaf, 0.002f));
      if (glazed && r == rows - 1) {
        leaf->show("glass", shop.glass(),
                   panel(column, row).moved(l.face, y + column / 2, z + row / 2));
        continue;
      }
      leaf->show("leaf", paint, piece(y, y + column, z, z + row, 0.018f, 0));
      const float in = 0.03f;  // the raised field
      leaf->show("leaf", paint,
                 piece(y + in, y + column - in, z + in, z + row - in, 0.030f, 0.005f));
    }
  }
}

}  // namespace

Prop make_door(Workshop& shop, const Opening& o, double wall_size, bool hinge_left, double angle) {
  const float wall = float(wall_size), y = float(o.width) / 2 - kLiningWidth,
              s = hinge_left ? 1.0f : -1.0f;
  Prop p;
  add_door_frame(shop, o, wall, &p.body());
  p.body().mass = 12;
  PropJoint hinge;
  hinge.axis = {0, 0, s};
  hinge.high = 1.62;
  hinge.initial = angle;
  hinge.damping = 0.6;
  hinge.friction = 0.8;
  PropPart& leaf = p.hang("leaf", {wall / 2 + kProud, s * y, 0}, hinge);
  const LeafSize l{2 * y - 2 * kDoorGap, 0.008f, float(o.head) - kLiningWidth - kDoorGap, s,
                   -kLeaf / 2};
  const std::string paint = shop.paint(shop.style.trim, 0.38);
  Dice style(shop.style.door, "door");
  switch (style.integer(0, 3)) {
    case 0:
      leaf.show(
          "leaf", paint,
          slab({l.face - kLeaf / 2, std::min(-s * kDoorGap, -s * (l.width + kDoorGap)), l.low},
               {l.face + kLeaf / 2, std::max(-s * kDoorGap, -s * (l.width + kDoorGap)), l.high},
               0.002f));
      break;
    case 1:
      add_panelled(shop, l, paint, 2, 1, false, &leaf);
      break;
    case 2:
      add_panelled(shop, l, paint, 3, 2, false, &leaf);
      break;
    default:
      add_panelled(shop, l, paint, 2, 2, false, &leaf);
  }
  const float handle = -s * (l.width - 0.055f);
  leaf.show(
      "handle", shop.metal(),
      lever(s).moved(0, handle, 1.03f) + lever(s).mirrored(Axis::kX).moved(-kLeaf, handle, 1.03f));
  Solid hinges;
  for (const float z : {0.22f, float(o.head) - 0.25f})
    hinges += cylinder(0.007f, z, z + 0.09f, 0.001f, 10);
  leaf.show("handle", shop.metal(), hinges.moved(0.004f, 0, 0));
  const float a = -s * kDoorGap, b = -s * (l.width + kDoorGap);
  leaf.collide_box({-kLeaf, std::min(a, b), l.low}, {0, std::max(a, b), l.high});
  leaf.mass = 22;
  return p;
}

Prop make_entrance(Workshop& shop, const Opening& o, double wall_size) {
  const float wall = float(wall_size), y = float(o.width) / 2 - kLiningWidth;
  Prop p;
  add_door_frame(shop, o, wall, &p.body());
  p.body().mass = 25;
  PropJoint hinge;
  hinge.axis = {0, 0, -1};  // it opens inwards
  hinge.high = 1.55;
  hinge.damping = 2;
  hinge.friction = 2;
  PropPart& leaf = p.hang("leaf", {-wall / 2 - kProud, y, 0}, hinge);
  const LeafSize l{2 * y - 2 * kDoorGap, 0.012f, float(o.head) - kLiningWidth - kDoorGap, 1,
                   0.028f};
  const Vec3 color = shop.dice.pick<Vec3>({{0.13, 0.22, 0.24},
                                           {0.42, 0.10, 0.09},
                                           {0.16, 0.17, 0.18},
                                           {0.16, 0.26, 0.18},
                                           {0.75, 0.73, 0.68}});
  const std::string paint = shop.paint(color, 0.35);
  add_panelled(shop, l, paint, 3, 2, true, &leaf);
  const float handle = -(l.width - 0.06f);
  leaf.show("handle", shop.metal(),
            lever(1).moved(l.face + kLeaf / 2, handle, 1.03f) +
                lever(1).mirrored(Axis::kX).moved(l.face - kLeaf / 2, handle, 1.03f));
  leaf.collide_box({l.face - kLeaf / 2, -(l.width + kDoorGap), l.low},
                   {l.face + kLeaf / 2, -kDoorGap, l.high});
  leaf.mass = 45;
  return p;
}

Prop make_arch(Workshop& shop, const Opening& opening, double wall) {
  Prop p;
  add_door_frame(shop, opening, float(wall), &p.body());
  p.body().mass = 10;
  return p;
}

Prop make_window(Workshop& shop, const Opening& o, double wall_size) {
  const float wall = float(wall_size), y = float(o.width) / 2, z0 = float(o.sill),
              z1 = float(o.head);
  const std::string paint = shop.paint(shop.style.trim, 0.35);
  const float frame = 0.052f, depth = 0.07f, x = wall / 2 - 0.13f;  // middle of the frame
  Prop p;
  PropPart& b = p.body();
  const auto box = [&](float ya, float yb, float za, float zb, float d, float bevel) {
    return slab({x - d / 2, ya, za}, {x + d / 2, yb, zb}, bevel);
  };
  b.show("frame", paint, box(-y, -y + frame, z0, z1, depth, 0.004f));
  b.show("frame", paint, box(y - frame, y, z0, z1, depth, 0.004f));
  b.show("frame", paint, box(-y + frame, y - frame, z0, z0 + frame, depth, 0.004f));
  b.show("frame", paint, box(-y + frame, y - frame, z1 - frame, z1, depth, 0.004f));
  const int sashes = o.width > 1.1 ? 2 : 1;
  const float sash = 0.046f, each = (2 * y - 2 * frame) / float(sashes);
  for (int i = 0; i < sashes; ++i) {
    const float a = -y + frame + float(i) * each + 0.002f, c = a + each - 0.004f;
    const float low = z0 + frame + 0.002f, high = z1 - frame - 0.002f, d = 0.055f;
    b.show("frame", paint, box(a, a + sash, low, high, d, 0.005f));
    b.show("frame", paint, box(c - sash, c, low, high, d, 0.005f));
    b.show("frame", paint, box(a + sash, c - sash, low, low + sash, d, 0.005f));
    b.show("frame", paint, box(a + sash, c - sash, high - sash, high, d, 0.005f));
    b.show("glass", shop.glass(),
           panel(c - a - 2 * sash, high - low - 2 * sash).moved(x, (a + c) / 2, (low + high) / 2));
    const float handle = i == 0 ? c - sash / 2 : a + sash / 2;
    const float middle = (low + high) / 2;
    b.show("handle", shop.metal(),
           rounded_box({0.012f, 0.028f, 0.07f}, 0.004f).moved(x - 0.033f, handle, middle) +
               bar({x - 0.055f, handle, middle}, {x - 0.055f, handle, middle - 0.11f}, 0.008f,
                   0.007f, 8) +
               bar({x - 0.03f, handle, middle}, {x - 0.056f, handle, middle}, 0.008f, 0.008f, 8));
  }
  // Boards below: within of wood, without of stone.
  if (z0 > 0.1f) {
    b.show("sill", shop.paint(shop.style.trim, 0.35),
           slab({-wall / 2 - 0.035f, -y - 0.03f, z0 - 0.024f},
                {x - depth / 2, y + 0.03f, z0 + 0.004f}, 0.005f, 2));
    p.surfaces.push_back(
        {{-wall / 2 - 0.02f, -y + 0.05f}, {x - depth / 2 - 0.02f, y - 0.05f}, z0 + 0.004f, 0.5f});
  }
  b.show("ledge", shop.concrete(),
         slab({x + depth / 2, -y - 0.02f, z0 - 0.03f}, {wall / 2 + 0.04f, y + 0.02f, z0}, 0.004f));
  b.collide_box({x - depth / 2, -y, z0}, {x + depth / 2, y, z1});
  b.mass = 30 * o.width * (o.head - o.sill);
  return p;
}

}  // namespace gloam

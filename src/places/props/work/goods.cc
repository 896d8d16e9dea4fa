// Goods of warehouses.

#include <cmath>

#include "places/catalogue.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/joinery.h"
#include "places/props/parts/labels.h"

namespace gloam {
namespace {

constexpr Vec3f kEuroPallet{1.2f, 0.8f, 0.144f};
constexpr double kEuroPalletMass = 24;  // UIC 435-2: 20 … 25 kg

double pallet_mass(Vec3f size) {
  return kEuroPalletMass * size.x * size.y / (kEuroPallet.x * kEuroPallet.y);
}

Prop pallet(Workshop& shop) {
  const Vec3f size = limited(shop.size(kEuroPallet), {0.5f, 0.5f, 0.12f}, {1.6f, 1.4f, 0.18f});
  Prop p;
  add_pallet(&p.body(), &shop, size);
  p.body().mass = pallet_mass(size);
  p.surfaces.push_back({{-size.x / 2, -size.y / 2}, {size.x / 2, size.y / 2}, size.z});
  p.loose = true;
  return p;
}

Prop goods_pallet(Workshop& shop) {
  const Vec3f size = limited(shop.size({1.2f, 0.8f, float(shop.dice.uniform(0.9, 1.6))}),
                             {0.6f, 0.6f, 0.4f}, {1.4f, 1.4f, 2.4f});
  const Vec3f base{size.x, size.y, kEuroPallet.z};
  Prop p;
  PropPart& b = p.body();
  add_pallet(&b, &shop, base);
  Vec3f low{-size.x / 2 + 0.012f, -size.y / 2 + 0.012f, base.z};
  Vec3f high{size.x / 2 - 0.012f, size.y / 2 - 0.012f, size.z};
  double density;  // density of the goods, air between them included [kg/m³]
  const int kind = shop.dice.pick({0, 0, 0, 0, 1, 1, 2});
  bool wrapped = shop.dice.chance(0.45);
  if (kind == 0) {
    add_cartons(&b, &shop, low, high);
    density = shop.dice.uniform(90, 320);
  } else if (kind == 1) {
    high.z = low.z + 0.125f * std::max(2.0f, std::floor((high.z - low.z) / 0.125f));
    add_sacks(&b, &shop, low, high);
    density = 700;  // flour, cement: bulk
  } else {
    // 60-litre drums, 0.38 m wide.
    const int nx = std::max(1, int(size.x / 0.385f)), ny = std::max(1, int(size.y / 0.385f));
    high.z = base.z + std::min(0.62f, size.z - base.z);
    const Vec3 color = shop.color(
        shop.dice.pick({Vec3{0.10, 0.22, 0.52}, Vec3{0.12, 0.12, 0.13}, Vec3{0.62, 0.08, 0.07}}));
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        add_drum(&b, &shop,
                 {size.x * ((float(i) + 0.5f) / float(nx) - 0.5f),
                  size.y * ((float(j) + 0.5f) / float(ny) - 0.5f), base.z},
                 0.19f, high.z - base.z, color);
    density = 650;
    wrapped = false;
  }
  if (wrapped) {
    // One hose of film around all, drawn over the pallet's edge.
    const Profile outline = rounded_rectangle(size.x - 0.004f, size.y - 0.004f, 0.035f, 3);
    std::vector<Vec3f> points;
    const int rows = 2, columns = int(outline.size()) + 1;
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {
        const Vec2f q = outline[size_t(c) % outline.size()];
        points.push_back({q.x, q.y, r == 0 ? base.z - 0.03f : high.z + 0.006f});
      }
    b.show("film", shop.film(), sheet(points, columns));
  }
  // One box for the pallet's deck and what lies on it.
  const PropCollider deck = b.colliders.back();
  b.colliders.pop_back();
  b.collide_box({low.x, low.y, float(deck.X_PG.p.z) - deck.size.z}, high);
  const Vec3f box = high - low;
  b.mass = pallet_mass(base) + density * box.x * box.y * box.z;
  p.loose = false;
  return p;
}

Prop carton(Workshop& shop) {
  // Folding boxes of post and trade.
  const Vec3f usual = shop.dice.pick({Vec3f{0.40f, 0.30f, 0.20f}, Vec3f{0.60f, 0.40f, 0.40f},
                                      Vec3f{0.30f, 0.20f, 0.15f}, Vec3f{0.45f, 0.35f, 0.33f},
                                      Vec3f{0.35f, 0.60f, 0.30f}, Vec3f{0.40f, 0.40f, 0.45f}});
  const Vec3f size = limited(shop.size(usual), {0.1f, 0.1f, 0.06f}, {1.2f, 1.2f, 1.2f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, board = 0.004f;
  Prop p;
  PropPart& b = p.body();
  const std::string card = shop.cardboard(), tape = shop.plastic({0.62, 0.47, 0.28}, 0.2);
  // Flaps meet in the middle along the longer side.
  const bool along_x = x > y;
  b.show("box", card, slab({-x, -y, 0}, {x, y, z - board}, 0.003f, 2));
  const float gap = 0.0012f;
  for (const float side : {-1.0f, 1.0f}) {
    const Vec3f inner = along_x ? Vec3f{x - 0.001f, 0, 0} : Vec3f{0, y - 0.001f, 0};
    const Vec3f from =
        along_x ? Vec3f{-inner.x, side * gap, z - board} : Vec3f{side * gap, -inner.y, z - board};
    const Vec3f to = along_x ? Vec3f{inner.x, side * (y - 0.001f), z - 0.0004f}
                             : Vec3f{side * (x - 0.001f), inner.y, z - 0.0004f};
    b.show("flaps", card,
           slab({min(from.x, to.x), min(from.y, to.y), from.z},
                {max(from.x, to.x), max(from.y, to.y), to.z}, 0.0015f));
  }
  const float half = along_x ? x : y, down = min(0.07f, z * 0.4f);
  const auto put = [&](Vec3f low, Vec3f high) {
    Solid strip = slab(low, high, 0);
    b.show("tape", tape, along_x ? strip : strip.turned(Axis::kZ, 90));
  };
  put({-half, -0.025f, z - 0.0004f}, {half, 0.025f, z});
  put({half, -0.025f, z - down}, {half + 0.0004f, 0.025f, z});
  put({-half - 0.0004f, -0.025f, z - down}, {-half, 0.025f, z});
  // The glued seam of the blank, at a corner.
  b.show("box", card,
         slab({-x - 0.0006f, y - 0.035f, 0.002f}, {-x, y - 0.001f, z - board - 0.002f}, 0));
  const float fit = min(1.0f, min(size.y / 0.24f, size.z / 0.14f));
  if (shop.dice.chance(0.8))
    b.show("label", shipping_label(&shop),
           panel(0.15f * fit, 0.105f * fit).moved(x + 0.0005f, -y * 0.35f, z * 0.42f));
  for (const float side : {-1.0f, 1.0f})
    b.show("marks", handling_mark(&shop),
           panel(0.105f * fit, 0.07f * fit)
               .turned(Axis::kZ, side * 90)
               .moved(x * 0.4f, side * (y + 0.0005f), z * 0.66f));
  b.collide_box({-x, -y, 0}, {x, y, z});
  b.mass = shop.dice.uniform(70, 260) * size.x * size.y * size.z;  // goods and air
  p.surfaces.push_back({{-x, -y}, {x, y}, z});
  p.loose = true;
  return p;
}

Prop sack_pile(Workshop& shop) {
  const Vec3f size = limited(shop.size({1.2f, 0.8f, 0.125f * float(shop.dice.integer(2, 5))}),
                             {0.6f, 0.6f, 0.125f}, {2.4f, 2.4f, 1.2f});
  Prop p;
  const Vec3f low{-size.x / 2, -size.y / 2, 0};
  Vec3f high{size.x / 2, size.y / 2, size.z};
  add_sacks(&p.body(), &shop, low, high);
  for (PropVisual& visual : p.body().visuals)  // the floor flattens the lowest
    for (Vec3f& q : visual.mesh.positions) q.z = max(q.z, 0.0f);
  p.body().collide_box(low + Vec3f{0.02f, 0.02f, 0}, high - Vec3f{0.02f, 0.02f, 0});
  p.body().mass = 800.0 * size.x * size.y * size.z;  // 25 kg in 50 x 38 x 12 cm
  return p;
}

Prop crate(Workshop& shop) {
  const Vec3f usual =
      shop.dice.pick({Vec3f{0.8f, 0.6f, 0.5f}, Vec3f{1.1f, 0.8f, 0.8f}, Vec3f{0.6f, 0.6f, 0.6f}});
  const Vec3f size = limited(shop.size(usual), {0.3f, 0.3f, 0.25f}, {2.4f, 2.4f, 2.0f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, skid = 0.08f, board = 0.018f;
  Prop p;
  PropPart& b = p.body();
  // A box of boards, battens around its edges and across its sides, on two skids.
  const auto boards = [&](float from, float to) { return std::max(2, int((to - from) / 0.12f)); };
  const int rows = boards(skid, z - 0.02f);
  for (int i = 0; i < rows; ++i) {
    const float z0 = skid + (z - 0.02f - skid) * float(i) / float(rows);
    const float z1 = skid + (z - 0.02f - skid) * float(i + 1) / float(rows) - 0.003f;
    for (const float side : {-1.0f, 1.0f}) {
      const float fx = side * (x - 0.022f), gx = side * (x - 0.022f - board);
      b.show("boards_y", shop.rough_wood(Axis::kY),
             slab({min(fx, gx), -y + 0.025f, z0}, {max(fx, gx), y - 0.025f, z1}, 0.002f));
      const float fy = side * (y - 0.022f), gy = side * (y - 0.022f - board);
      b.show("boards_x", shop.rough_wood(Axis::kX),
             slab({-x + 0.025f, min(fy, gy), z0}, {x - 0.025f, max(fy, gy), z1}, 0.002f));
    }
  }
  const int lid = boards(-y, y);
  for (int i = 0; i < lid; ++i)
    b.show("boards_x", shop.rough_wood(Axis::kX),
           slab({-x, -y + size.y * float(i) / float(lid) + 0.0015f, z - 0.02f},
                {x, -y + size.y * float(i + 1) / float(lid) - 0.0015f, z}, 0.002f));
  const float w = 0.07f, t = 0.022f;
  const auto frame = [&](float half, float out, bool on_x, float side) {
    // Four battens and a brace on a side; `half` = half its width, `out` = its plane.
    const auto put = [&](Vec3f from, Vec3f to, const char* name, Axis grain) {
      Solid s = beam(from, to, t, w, 0.003f);
      b.show(name, shop.rough_wood(grain), on_x ? s.turned(Axis::kZ, 90) : s);
    };
    const float at = (on_x ? -side : side) * (out - t / 2);
    const Axis level = on_x ? Axis::kY : Axis::kX;
    const char* name = on_x ? "battens_y" : "battens_x";
    put({-half, at, skid + w / 2}, {half, at, skid + w / 2}, name, level);
    put({-half, at, z - 0.02f - w / 2}, {half, at, z - 0.02f - w / 2}, name, level);
    for (const float end : {-1.0f, 1.0f})
      put({end * (half - w / 2), at, skid + w}, {end * (half - w / 2), at, z - 0.02f - w}, "posts",
          Axis::kZ);
    const float dx = half - w, dz = 0.5f * (z - 0.02f + skid);
    const float rise = (z - 0.02f - skid) / 2 - w;
    const float shy = 0.5f * w * std::min(1.0f, rise / dx);
    put({-(dx - shy), at, dz - rise + shy}, {dx - shy, at, dz + rise - shy},
        on_x ? "braces_y" : "braces_x", level);
  };
  for (const float side : {-1.0f, 1.0f}) {
    frame(x, y, false, side);
    frame(y - t, x, true, side);
    b.show(
        "skids", shop.rough_wood(Axis::kX),
        slab({-x, side * (y - 0.06f) - 0.05f, 0}, {x, side * (y - 0.06f) + 0.05f, skid}, 0.004f));
    b.collide_box({-x, side * (y - 0.06f) - 0.05f, 0}, {x, side * (y - 0.06f) + 0.05f, skid});
  }
  b.collide_box({-x, -y, skid}, {x, y, z});
  b.mass = 12 * (size.x * size.y + size.x * z + size.y * z) * 2 +
           shop.dice.uniform(40, 200) * size.x * size.y * z;  // boards of 12 kg/m²; what is in it
  p.surfaces.push_back({{-x, -y}, {x, y}, z});
  p.loose = b.mass < 100;
  return p;
}

constexpr PropKind kGoods[] = {
    {"pallet", pallet, "EUR pallet of boards and blocks"},
    {"goods_pallet", goods_pallet, "pallet of cartons, sacks or drums, some in film"},
    {"carton", carton, "closed cardboard box with tape and labels"},
    {"sack_pile", sack_pile, "layers of paper sacks"},
    {"crate", crate, "wooden crate with battens on skids"},
};

}  // namespace

PropFamily goods() { return kGoods; }

}  // namespace gloam

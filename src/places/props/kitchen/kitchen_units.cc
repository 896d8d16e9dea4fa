// Cabinets of kitchens. Base units make a row: worktops 0.60 m deep end where the unit does and are
// all of one height, fronts stand 2 cm behind their edge.

#include <algorithm>

#include "places/props/parts/kitchen_unit.h"

namespace gloam {

KitchenUnit kitchen_unit(Workshop& shop, float width) {
  const Vec3f size = shop.size({0.60f, width, 0.90f});
  return {std::clamp(size.x, 0.45f, 0.80f) / 2, std::clamp(size.y, 0.30f, 1.20f) / 2,
          std::clamp(size.z, 0.80f, 1.00f)};
}

void add_plinth(Workshop& shop, PropPart* part, const KitchenUnit& u) {
  const Vec3f low{-u.x + 0.05f, -u.y, 0}, high{u.front() - 0.055f, u.y, kPlinth};
  const Vec3 color = shop.style.wooden_fronts ? Vec3{0.16, 0.155, 0.15} : shop.style.cabinet;
  part->show("plinth", shop.paint(shop.color(color), 0.45), slab(low, high, 0.001f));
  part->collide_box(low, high);
}

static std::string worktop_material(Workshop& shop) {
  if (shop.style.worktop == "marble") return shop.marble();
  if (shop.style.worktop == "concrete") return shop.concrete({0.30, 0.30, 0.305});
  return shop.wood(Axis::kY);
}

void add_worktop(Workshop& shop, Prop* p, const KitchenUnit& u) {
  PropPart& b = p->body();
  const Profile edge = rounded({{u.x, u.top() + 0.01f},
                                {u.x, u.z},
                                {-u.x, u.z},
                                {-u.x, u.top()},
                                {u.x, u.top()},
                                {u.x, u.top() + 0.01f}},
                               0.003f);
  b.show("worktop", worktop_material(shop),
         extrude(Profile(edge.begin(), edge.end() - 1), -u.y, u.y).turned(Axis::kX, 90));
  b.collide_box({-u.x, -u.y, u.top()}, {u.x, u.y, u.z});
  p->surfaces.push_back({{-u.x + 0.03f, -u.y + 0.02f}, {u.x - 0.04f, u.y - 0.02f}, u.z, 0.45f});
}

namespace {

std::string melamine(Workshop& shop) { return shop.plastic({0.88, 0.88, 0.86}, 0.45); }

// Plinth and carcass, without doors or worktop.
void add_base(Workshop& shop, PropPart* b, const KitchenUnit& u) {
  add_plinth(shop, b, u);
  add_carcass(b, "carcass", melamine(shop), {-u.x, -u.y, kPlinth},
              {u.front() - kFrontBoard - 0.002f, u.y, u.top()});
  b->mass = 700.0 * (0.016 * (4 * u.x * u.top() + 8 * u.x * u.y) + 4 * u.x * u.y * kWorktop);
}

void add_shelf(Workshop& shop, PropPart* b, const KitchenUnit& u) {
  const float z = (kPlinth + u.top()) / 2;
  const Vec3f low{-u.x + 0.01f, -u.y + 0.017f, z - 0.008f},
      high{u.front() - 0.06f, u.y - 0.017f, z + 0.008f};
  b->show("carcass", melamine(shop), slab(low, high, 0.001f));
  b->collide_box(low, high);
}

// One door, or two above 0.62 m of width, from z0 to z1.
void add_doors(Workshop& shop, Prop* p, const KitchenUnit& u, float z0, float z1) {
  const float y = u.y - kGap, height = z1 - z0, handle = height - 0.12f;
  if (2 * u.y <= 0.62f) {
    const float side = shop.dice.chance(0.5) ? 1.0f : -1.0f;
    hang_door(shop, p, "door", {u.front(), -side * y, z0}, side * 2 * y, height, handle);
    return;
  }
  hang_door(shop, p, "door_left", {u.front(), -y, z0}, y - kGap, height, handle);
  hang_door(shop, p, "door_right", {u.front(), y, z0}, -y + kGap, height, handle);
}

void add_drawer(Workshop& shop, Prop* p, const KitchenUnit& u, const std::string& name, float z0,
                float z1) {
  hang_drawer(shop, p, name, {u.front(), -u.y + kGap, z0}, 2 * (u.y - kGap), z1 - z0,
              2 * u.x - 0.11f);
}

Prop kitchen_cabinet(Workshop& shop) {
  const KitchenUnit u = kitchen_unit(shop, shop.dice.pick({0.40f, 0.50f, 0.60f, 0.80f, 0.90f}));
  Prop p;
  add_base(shop, &p.body(), u);
  add_worktop(shop, &p, u);
  const float z0 = kPlinth + kGap, z1 = u.top() - 2 * kGap, tall = z1 - z0;
  const int kind = shop.dice.integer(0, 2);
  if (kind == 0) {  // three drawers
    const float first = z1 - 0.22f * tall, second = first - 0.39f * tall;
    add_drawer(shop, &p, u, "drawer_1", first + kGap, z1);
    add_drawer(shop, &p, u, "drawer_2", second + kGap, first - kGap);
    add_drawer(shop, &p, u, "drawer_3", z0, second - kGap);
  } else {
    add_shelf(shop, &p.body(), u);
    const float split = kind == 1 ? z1 : z1 - 0.22f * tall;
    if (kind == 2) add_drawer(shop, &p, u, "drawer", split + kGap, z1);
    add_doors(shop, &p, u, z0, kind == 1 ? z1 : split - kGap);
  }
  p.front = 0.9f;
  return p;
}

// One door at +y; the blind half at -y is for the row that comes from the side.
Prop corner_cabinet(Workshop& shop) {
  KitchenUnit u = kitchen_unit(shop, 1.10f);
  u.y = max(u.y, 0.5f);
  Prop p;
  PropPart& b = p.body();
  add_base(shop, &b, u);
  add_worktop(shop, &p, u);
  add_shelf(shop, &b, u);
  const float z0 = kPlinth + kGap, z1 = u.top() - 2 * kGap, split = -u.y + 2 * u.x + 0.05f;
  PropPart blind;
  show_front(shop, &blind, {-u.y, z0}, {split - kGap, z1});
  b.show("front", blind.visuals[0].material, Solid(blind.visuals[0].mesh).moved(u.front(), 0, 0));
  b.collide_box({u.front() - kFrontBoard, -u.y, z0}, {u.front(), split - kGap, z1});
  hang_door(shop, &p, "door", {u.front(), u.y - kGap, z0}, split - u.y + 2 * kGap, z1 - z0,
            z1 - z0 - 0.12f);
  p.front = 0.9f;
  return p;
}

Prop sink_cabinet(Workshop& shop) {
  const KitchenUnit u = kitchen_unit(shop, 0.80f);
  Prop p;
  PropPart& b = p.body();
  // Without a roof: the bowl hangs there.
  add_plinth(shop, &b, u);
  const float inner = u.front() - kFrontBoard - 0.002f, t = 0.016f;
  for (const float side : {-1.0f, 1.0f}) {
    const float y0 = side > 0 ? u.y - t : -u.y, y1 = side > 0 ? u.y : -u.y + t;
    b.show("carcass", melamine(shop), slab({-u.x, y0, kPlinth}, {inner, y1, u.top()}, 0.001f));
    b.collide_box({-u.x, y0, kPlinth}, {inner, y1, u.top()});
  }
  b.show("carcass", melamine(shop),
         slab({-u.x, -u.y + t, kPlinth}, {inner, u.y - t, kPlinth + t}, 0.001f));
  b.show("carcass", melamine(shop),
         slab({-u.x, -u.y + t, kPlinth + t}, {-u.x + 0.008f, u.y - t, u.top()}, 0));
  b.collide_box({-u.x, -u.y + t, kPlinth}, {inner, u.y - t, kPlinth + t});

  // Steel bowl on the side of -y, with a draining board where there is room.
  const float bowl = min(0.40f, 2 * u.y - 0.12f), rim = 0.012f, deep = 0.17f;
  const Vec2f low{-u.x + 0.115f, u.y > 0.38f ? -u.y + 0.06f : -bowl / 2};
  const Vec2f high{u.x - 0.075f, low.y + bowl};
  const bool drains = u.y - high.y > 0.22f;
  const Vec2f outer_low{low.x - 0.06f, low.y - 0.03f};
  const Vec2f outer_high{high.x + 0.025f, drains ? u.y - 0.03f : high.y + 0.03f};
  const Vec2f whole_low{-u.x, -u.y}, whole_high{u.x, u.y};
  const Vec2f cut_low = outer_low + Vec2f{0.01f, 0.01f},
              cut_high = outer_high - Vec2f{0.01f, 0.01f};
  const Path around = ring(whole_low, whole_high, 0, u.z),
             below = ring(whole_low, whole_high, 0, u.top());
  const Path hole = ring(cut_low, cut_high, 0.02f, u.z),
             hole_low = ring(cut_low, cut_high, 0.02f, u.top());
  b.show("worktop", worktop_material(shop),
         loft({hole_low, below, below, around, around, hole, hole, hole_low}));
  const std::string steel = shop.metal("steel");
  const float z = u.z + 0.001f;
  const Path edge = ring(outer_low, outer_high, 0.025f, z + 0.001f);
  const Path mouth = ring(low, high, 0.05f, z + 0.001f);
  const Vec2f in{0.03f, 0.03f};
  const Path floor = ring(low + in, high - in, 0.05f, z - deep);
  const Vec3f drain{(low.x + high.x) / 2, (low.y + high.y) / 2, z - deep - 0.004f};
  b.show("sink", steel,
         loft({ring(outer_low, outer_high, 0.025f, z - 0.0015f), edge, edge,
               ring(low - Vec2f{rim, rim}, high + Vec2f{rim, rim}, 0.06f, z), mouth,
               ring(low + Vec2f{0.004f, 0.004f}, high - Vec2f{0.004f, 0.004f}, 0.05f, z - 0.006f),
               ring(low + in * 0.5f, high - in * 0.5f, 0.05f, z - deep + 0.025f),
               ring(low + in * 0.7f, high - in * 0.7f, 0.05f, z - deep + 0.008f), floor,
               point_of(floor, drain)}));
  b.show("drain", shop.metal("chrome"),
         cylinder(0.04f, drain.z, drain.z + 0.005f, 0.002f, 32).moved(drain.x, drain.y, 0));
  for (int i = 0; i < 8; ++i)  // its strainer
    b.show("strainer", shop.paint({0.03, 0.03, 0.03}),
           cylinder(0.0035f, 0, 0.0055f, 0.0005f, 8)
               .moved(0.022f, 0, 0)
               .turned(Axis::kZ, 45 * float(i))
               .moved(drain));
  b.show("pipe", shop.plastic({0.85, 0.85, 0.84}),
         tube(smooth_path({{drain.x, drain.y, drain.z},
                           {drain.x, drain.y, 0.50f},
                           {drain.x - 0.04f, drain.y, 0.46f},
                           {drain.x - 0.08f, drain.y, 0.50f},
                           {-u.x + 0.02f, drain.y, 0.52f}}),
              0.02f, 10));
  if (drains) {
    for (float y = high.y + 0.06f; y < outer_high.y - 0.03f; y += 0.022f)
      b.show("sink", steel,
             bar({low.x, y, z + 0.0005f}, {high.x - 0.02f, y, z - 0.001f}, 0.003f, 0.003f, 8));
  }
  show_tap(shop, &b, {low.x - 0.03f, drain.y, u.z}, 0.30f, 0.20f);
  b.collide_box({-u.x, -u.y, u.top()}, {low.x, u.y, u.z});
  b.collide_box({high.x, -u.y, u.top()}, {u.x, u.y, u.z});
  b.collide_box({low.x, -u.y, u.top()}, {high.x, low.y, u.z});
  b.collide_box({low.x, high.y, u.top()}, {high.x, u.y, u.z});
  b.collide_box({low.x, low.y, z - deep - 0.01f}, {high.x, high.y, z - deep});
  b.mass = 22 + 30 * u.y;
  add_doors(shop, &p, u, kPlinth + kGap, u.top() - 2 * kGap);
  p.front = 0.9f;
  return p;
}

Prop wall_cabinet(Workshop& shop) {
  const Vec3f size = shop.size({0.35f, shop.dice.pick({0.40f, 0.50f, 0.60f, 0.80f}), 0.72f});
  const KitchenUnit u{std::clamp(size.x, 0.2f, 0.5f), std::clamp(size.y, 0.3f, 1.2f) / 2,
                      std::clamp(size.z, 0.3f, 1.2f)};
  const float z = u.z / 2, inner = u.x - kFrontBoard - 0.002f;
  Prop p;
  PropPart& b = p.body();
  add_carcass(&b, "carcass", melamine(shop), {0, -u.y, -z}, {inner, u.y, z});
  for (int i = 1; i <= int(u.z / 0.3f); ++i) {
    const float at = -z + u.z * float(i) / float(int(u.z / 0.3f) + 1);
    b.show("carcass", melamine(shop),
           slab({0.008f, -u.y + 0.017f, at - 0.008f}, {inner - 0.02f, u.y - 0.017f, at + 0.008f},
                0.001f));
    b.collide_box({0.008f, -u.y + 0.017f, at - 0.008f}, {inner - 0.02f, u.y - 0.017f, at + 0.008f});
  }
  b.mass = 700.0 * 0.016 * (2 * u.x * u.z + 8 * u.x * u.y);
  const float y = u.y - kGap, low = -z + kGap, tall = u.z - 2 * kGap;
  if (2 * u.y <= 0.62f) {
    const float side = shop.dice.chance(0.5) ? 1.0f : -1.0f;
    hang_door(shop, &p, "door", {u.x, -side * y, low}, side * 2 * y, tall, 0.12f);
  } else {
    hang_door(shop, &p, "door_left", {u.x, -y, low}, y - kGap, tall, 0.12f);
    hang_door(shop, &p, "door_right", {u.x, y, low}, -y + kGap, tall, 0.12f);
  }
  return p;
}

constexpr PropKind kKitchenUnits[] = {
    {"kitchen_cabinet", kitchen_cabinet, "base unit with worktop, doors or drawers"},
    {"corner_cabinet", corner_cabinet, "base unit for corners; its half at -y is blind"},
    {"sink_cabinet", sink_cabinet, "base unit with steel sink and tap"},
    {"wall_cabinet", wall_cabinet, "kitchen cabinet on a wall"},
};

}  // namespace

PropFamily kitchen_units() { return kKitchenUnits; }

}  // namespace gloam

// Low and narrow tables, desks.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// Square tubes at the corners, joined below the top: a welded frame.
Solid steel_frame(float x, float y, float z, float t) {
  Solid frame;
  for (const float i : {-1.0f, 1.0f}) {
    for (const float j : {-1.0f, 1.0f}) {
      const float cx = i * (x - t / 2), cy = j * (y - t / 2);
      frame += slab({cx - t / 2, cy - t / 2, 0}, {cx + t / 2, cy + t / 2, z}, 0.0025f);
    }
    frame +=
        slab({i * (x - t / 2) - t / 2, -y + t, z - t}, {i * (x - t / 2) + t / 2, y - t, z}, 0.002f);
    frame +=
        slab({-x + t, i * (y - t / 2) - t / 2, z - t}, {x - t, i * (y - t / 2) + t / 2, z}, 0.002f);
  }
  return frame;
}

Prop coffee_table(Workshop& shop) {
  const Vec3f size =
      limited(shop.size({float(shop.dice.uniform(0.48, 0.62)), float(shop.dice.uniform(0.9, 1.2)),
                         float(shop.dice.uniform(0.38, 0.45))}),
              {0.35f, 0.45f, 0.28f}, {1.1f, 1.8f, 0.55f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, top = 0.028f;
  Prop p;
  PropPart& b = p.body();
  b.show("top", shop.wood(Axis::kY), slab({-x, -y, z - top}, {x, y, z}, 0.009f, 3));
  if (shop.dice.chance(0.5)) {
    b.show("frame", shop.metal("black"), steel_frame(x - 0.015f, y - 0.02f, z - top, 0.024f));
    b.show("shelf", shop.wood(Axis::kY),
           slab({-x + 0.03f, -y + 0.045f, 0.13f}, {x - 0.03f, y - 0.045f, 0.147f}, 0.004f));
    b.collide_box({-x + 0.02f, -y + 0.03f, 0.13f}, {x - 0.02f, y - 0.03f, 0.147f});
    collide_legs(&b, x - 0.027f, y - 0.032f, z - top, 0.015f);
    p.surfaces.push_back(
        {{-x + 0.05f, -y + 0.07f}, {x - 0.05f, y - 0.07f}, 0.147f, z - top - 0.17f});
  } else {
    for (const float side : {-1.0f, 1.0f}) {
      b.show("rails", shop.wood(Axis::kY),
             slab({side * (x - 0.07f) - 0.009f, -y + 0.09f, z - 0.085f},
                  {side * (x - 0.07f) + 0.009f, y - 0.09f, z - top}, 0.002f));
      b.show("ends", shop.wood(Axis::kX),
             slab({-x + 0.07f, side * (y - 0.09f) - 0.009f, z - 0.085f},
                  {x - 0.07f, side * (y - 0.09f) + 0.009f, z - top}, 0.002f));
    }
    b.show("legs", shop.wood(Axis::kZ),
           round_legs(x - 0.08f, y - 0.10f, z - top, 0.013f, 0.023f, 0.035f));
    collide_legs(&b, x - 0.06f, y - 0.08f, z - 0.085f, 0.022f);
  }
  b.collide_box({-x, -y, z - top - 0.02f}, {x, y, z});
  b.mass = 6 + 26.0 * double(size.x * size.y);  // oak of 700 kg/m³: the top alone is 20 kg/m²
  p.surfaces.push_back({{-x + 0.03f, -y + 0.03f}, {x - 0.03f, y - 0.03f}, z});
  p.front = 0.4f;
  return p;
}

Prop side_table(Workshop& shop) {
  const Vec3f size = limited(
      shop.size({float(shop.dice.uniform(0.38, 0.48)), 0, float(shop.dice.uniform(0.45, 0.60))}),
      {0.28f, 0, 0.35f}, {0.7f, 10, 0.75f});
  const float r = size.x / 2, z = size.z, top = 0.022f;
  Prop p;
  PropPart& b = p.body();
  b.show("top", shop.wood(Axis::kX), cylinder(r, z - top, z, 0.006f, 48));
  if (shop.dice.chance(0.5)) {
    const std::string metal = shop.metal(shop.dice.chance(0.7) ? "black" : "brass");
    b.show("stand", metal,
           lathe(rounded({{0, 0},
                          {0.7f * r, 0},
                          {0.69f * r, 0.008f},
                          {0.03f, 0.022f},
                          {0.016f, 0.05f},
                          {0.016f, z - 0.06f},
                          {0.05f, z - top},
                          {0, z - top}},
                         0.01f, 3),
                 40));
    b.collide_cylinder(0.7f * r, 0, 0.018f);
    b.collide_cylinder(0.02f, 0.018f, z - top);
  } else {
    for (int k = 0; k < 3; ++k) {
      const float a = 2 * kPi * (float(k) + 0.5f) / 3, c = std::cos(a), s = std::sin(a);
      const Solid leg = bar({0.88f * r * c, 0.88f * r * s, 0.004f},
                            {0.6f * r * c, 0.6f * r * s, z - top}, 0.011f, 0.019f, 14);
      b.show("legs", shop.wood(Axis::kZ), standing(leg));
      b.show("stretchers", shop.wood(Axis::kX),
             bar({0, 0, 0.42f * z}, {0.72f * r * c, 0.72f * r * s, 0.42f * z}, 0.009f, 0.009f));
      b.collide_cylinder({0.86f * r * c, 0.86f * r * s, 0.03f},
                         {0.62f * r * c, 0.62f * r * s, z - top}, 0.014f);
      b.collide_cylinder(0.013f, 0, 0.06f, 0.86f * r * c, 0.86f * r * s);
    }
  }
  b.collide_cylinder(r, z - top, z);
  b.mass = 2.5 + 700.0 * M_PI * double(r * r * top);
  p.surfaces.push_back({{-0.66f * r, -0.66f * r}, {0.66f * r, 0.66f * r}, z});
  return p;
}

Prop desk(Workshop& shop) {
  const Vec3f size = limited(
      shop.size({float(shop.dice.uniform(0.65, 0.75)), float(shop.dice.uniform(1.2, 1.6)), 0.74f}),
      {0.5f, 0.8f, 0.68f}, {1.0f, 2.2f, 0.8f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, top = 0.027f;
  const bool drawers = shop.dice.chance(0.7) && size.y > 1.0f;
  Prop p;
  PropPart& b = p.body();
  b.show("top", shop.wood(Axis::kY), slab({-x, -y, z - top}, {x, y, z}, 0.004f, 2));
  // A grommet for cables, and the tray below it.
  b.show("grommet", shop.plastic({0.135, 0.135, 0.14}),
         cylinder(0.032f, z - 0.001f, z + 0.0025f, 0.001f, 24).moved(-x + 0.08f, 0.25f * y, 0));
  b.show("frame", shop.metal("black"), steel_frame(x - 0.03f, y - 0.03f, z - top, 0.04f));
  b.show("frame", shop.metal("black"),
         slab({-x + 0.06f, -0.6f * y, z - 0.12f}, {-x + 0.062f, 0.6f * y, z - top}, 0));
  collide_legs(&b, x - 0.05f, y - 0.05f, z - top, 0.022f);
  b.collide_box({-x, -y, z - top}, {x, y, z});
  b.mass = 12 + 19.0 * double(size.x * size.y);  // chipboard of 680 kg/m³, steel frame
  if (drawers) {
    // A pedestal under the right end, open towards the front.
    const float w = 0.40f, y0 = -y + 0.085f, y1 = y0 + w, z0 = 0.06f, z1 = z - top - 0.045f,
                deep = size.x - 0.17f;
    const float face = x - 0.075f, t = 0.016f;
    const std::string body =
        shop.paint(shop.dice.chance(0.5) ? Vec3{0.86, 0.86, 0.84} : Vec3{0.16, 0.17, 0.18});
    b.show("pedestal", body,
           slab({face - deep, y0, z0}, {face, y0 + t, z1}, 0.001f) +
               slab({face - deep, y1 - t, z0}, {face, y1, z1}, 0.001f) +
               slab({face - deep, y0, z1 - t}, {face, y1, z1}, 0.001f) +
               slab({face - deep, y0, z0}, {face, y1, z0 + t}, 0.001f) +
               slab({face - deep, y0, z0}, {face - deep + 0.005f, y1, z1}, 0));
    b.show("castors", shop.plastic({0.135, 0.135, 0.14}),
           round_legs(deep / 2 - 0.05f, w / 2 - 0.04f, z0, 0.018f, 0.018f, 0)
               .moved(face - deep / 2, (y0 + y1) / 2, 0));
    b.collide_box({face - deep, y0, 0.02f}, {face, y0 + t, z1});
    b.collide_box({face - deep, y1 - t, 0.02f}, {face, y1, z1});
    b.collide_box({face - deep, y0 + t, z0}, {face - deep + t, y1 - t, z1});
    b.mass += 14;
    FrontLook look = front_look(shop, body);
    look.pull_material = shop.metal();
    const float tall = z1 - z0;
    const float cuts[4] = {z0, z0 + 0.44f * tall, z0 + 0.72f * tall, z1};
    for (int k = 0; k < 3; ++k)
      add_drawer(&p, shop,
                 k == 0   ? "drawer_low"
                 : k == 1 ? "drawer_middle"
                          : "drawer_top",
                 face, {y0, cuts[k]}, {y1, cuts[k + 1]}, deep - 0.05f, look);
  }
  p.surfaces.push_back({{-x + 0.03f, -y + 0.03f}, {x - 0.03f, y - 0.03f}, z});
  p.front = 0.8f;
  return p;
}

Prop console_table(Workshop& shop) {
  const Vec3f size =
      limited(shop.size({float(shop.dice.uniform(0.32, 0.40)), float(shop.dice.uniform(0.9, 1.2)),
                         float(shop.dice.uniform(0.76, 0.84))}),
              {0.25f, 0.6f, 0.65f}, {0.5f, 1.8f, 1.0f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, top = 0.022f, apron = 0.13f, t = 0.018f;
  const float leg = 0.036f, face = x - 0.035f;
  Prop p;
  PropPart& b = p.body();
  b.show("top", shop.wood(Axis::kY), slab({-x, -y, z - top}, {x, y, z}, 0.006f, 2));
  for (const float i : {-1.0f, 1.0f}) {
    for (const float j : {-1.0f, 1.0f}) {
      const float cx = i > 0 ? face - leg / 2 + 0.018f : -x + leg / 2 + 0.01f,
                  cy = j * (y - leg / 2 - 0.01f);
      b.show(
          "legs", shop.wood(Axis::kZ),
          slab({cx - leg / 2, cy - leg / 2, 0}, {cx + leg / 2, cy + leg / 2, z - top}, 0.004f, 2));
      b.collide_box({cx - leg / 2, cy - leg / 2, 0}, {cx + leg / 2, cy + leg / 2, z - top});
    }
  }
  const float inside = y - leg - 0.01f;
  b.show("apron", shop.wood(Axis::kY),
         slab({-x + 0.018f, -inside, z - top - apron}, {-x + 0.018f + t, inside, z - top}, 0.001f));
  for (const float j : {-1.0f, 1.0f})
    b.show("ends", shop.wood(Axis::kX),
           slab({-x + 0.04f, j * (y - 0.02f) - t / 2, z - top - apron},
                {face - 0.02f, j * (y - 0.02f) + t / 2, z - top}, 0.001f));
  const bool shelf = shop.dice.chance(0.6);
  if (shelf) {
    b.show("shelf", shop.wood(Axis::kY),
           slab({-x + 0.02f, -y + 0.02f, 0.16f}, {face, y - 0.02f, 0.178f}, 0.003f));
    b.collide_box({-x + 0.02f, -y + 0.02f, 0.16f}, {face, y - 0.02f, 0.178f});
    p.surfaces.push_back(
        {{-x + 0.04f, -y + 0.07f}, {face - 0.04f, y - 0.07f}, 0.178f, z - apron - 0.25f});
  }
  b.collide_box({-x, -y, z - top}, {x, y, z});
  b.collide_box({-x + 0.018f, -inside, z - top - apron}, {-x + 0.06f, inside, z - top});
  const int count = size.y > 0.8f ? 2 : 1;
  const FrontLook look = front_look(shop, shop.wood(Axis::kY));
  for (int k = 0; k < count; ++k) {
    const float w = 2 * inside / float(count), y0 = -inside + w * float(k);
    add_drawer(&p, shop, k == 0 ? "drawer_right" : "drawer_left", face, {y0, z - top - apron},
               {y0 + w, z - top - 0.002f}, size.x - 0.10f, look);
  }
  b.mass = 5 + 28.0 * double(size.x * size.y);
  p.surfaces.push_back({{-x + 0.02f, -y + 0.03f}, {x - 0.02f, y - 0.03f}, z});
  p.front = 0.5f;
  return p;
}

constexpr PropKind kSmallTables[] = {
    {"coffee_table", coffee_table, "low table before a sofa, with a steel frame or wooden legs"},
    {"side_table", side_table, "small round table on a foot or three legs"},
    {"desk", desk, "writing desk with a steel frame, with or without drawers"},
    {"console_table", console_table, "narrow table at a wall, with drawers"},
};

}  // namespace

PropFamily small_tables() { return kSmallTables; }

}  // namespace gloam

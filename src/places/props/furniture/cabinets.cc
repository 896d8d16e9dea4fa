// Furniture with doors and drawers.

#include <fmt/format.h>

#include <cmath>

#include "places/props/parts/hardware.h"
#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

constexpr float kBoard = 0.018f;  // thickness of chipboard and panels [m]

// Wood of the place, or lacquer; the name for the fronts and for boards along an axis.
struct Finish {
  bool painted;
  Vec3 color;
  std::string along(Workshop& shop, Axis axis) const {
    return painted ? shop.paint(color, 0.38) : shop.wood(axis);
  }
};

Finish finish(Workshop& shop, double painted) {
  const bool paint = shop.dice.chance(painted);
  return {paint,
          shop.color(shop.dice.pick<Vec3>(
              {{0.86, 0.85, 0.82}, {0.80, 0.81, 0.80}, {0.33, 0.38, 0.40}, {0.72, 0.70, 0.64}}))};
}

// Sides, bottom, top and back of a case whose fronts lie at x = face, from z0 to z1.
void show_case(PropPart* b, Workshop& shop, const Finish& f, float back, float face, float y,
               float z0, float z1) {
  b->show("sides", f.along(shop, Axis::kZ),
          slab({back, -y, z0}, {face, -y + kBoard, z1 - kBoard}, 0.0015f) +
              slab({back, y - kBoard, z0}, {face, y, z1 - kBoard}, 0.0015f));
  b->show("decks", f.along(shop, Axis::kY),
          slab({back, -y, z1 - kBoard}, {face + kBoard, y, z1}, 0.003f, 2) +
              slab({back, -y + kBoard, z0}, {face, y - kBoard, z0 + kBoard}, 0.001f));
  b->show("back", shop.wood("birch", Axis::kZ),
          slab({back, -y + kBoard, z0}, {back + 0.005f, y - kBoard, z1 - kBoard}, 0));
}

// The hollow case in boxes, open to the front.
void collide_case(PropPart* b, float back, float face, float y, float z0, float z1) {
  b->collide_box({back, -y, z0}, {face, -y + kBoard, z1 - kBoard});
  b->collide_box({back, y - kBoard, z0}, {face, y, z1 - kBoard});
  b->collide_box({back, -y, z1 - kBoard}, {face + kBoard, y, z1});
  b->collide_box({back, -y + kBoard, z0}, {face, y - kBoard, z0 + kBoard});
  b->collide_box({back, -y + kBoard, z0 + kBoard}, {back + 0.01f, y - kBoard, z1 - kBoard});
}

// Chipboard of 680 kg/m³.
double case_mass(float depth, float width, float height, int boards_across) {
  return 680.0 * 0.018 *
         double(2 * depth * height + float(boards_across) * depth * width + 0.3f * width * height);
}

void show_plinth(PropPart* b, const std::string& material, float back, float face, float y,
                 float z) {
  b->show("plinth", material,
          slab({back + 0.02f, -y + 0.002f, 0}, {face - 0.03f, y - 0.002f, z}, 0.001f));
  b->collide_box({back + 0.02f, -y + 0.002f, 0}, {face - 0.03f, y - 0.002f, z});
}

Prop wardrobe(Workshop& shop) {
  const Vec3f size = limited(shop.size({0.60f, float(shop.dice.uniform(0.95, 1.25)),
                                        float(shop.dice.uniform(1.95, 2.15))}),
                             {0.40f, 0.7f, 1.4f}, {0.75f, 1.6f, 2.6f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, foot = 0.07f, pull = 0.033f;
  const float face = x - kBoard - pull;
  const Finish f = finish(shop, 0.55);
  Prop p;
  PropPart& b = p.body();
  show_case(&b, shop, f, -x, face, y, foot, z);
  show_plinth(&b, f.along(shop, Axis::kY), -x, face, y, foot);
  collide_case(&b, -x, face, y, foot, z);
  // Inside: a shelf for hats, a rail, clothes on hangers.
  const float hat = z - 0.34f, rail = hat - 0.06f;
  b.show("decks", f.along(shop, Axis::kY),
         slab({-x + 0.01f, -y + kBoard, hat}, {face - 0.03f, y - kBoard, hat + kBoard}, 0.001f));
  b.collide_box({-x + 0.01f, -y + kBoard, hat}, {face - 0.03f, y - kBoard, hat + kBoard});
  b.show("rail", shop.metal("chrome"),
         bar({-0.02f, -y + kBoard, rail}, {-0.02f, y - kBoard, rail}, 0.0125f, 0.0125f));
  const Vec3 cloth[] = {{0.16, 0.20, 0.30},
                        {0.75, 0.73, 0.69},
                        {0.33, 0.14, 0.13},
                        {0.12, 0.12, 0.13},
                        {0.45, 0.50, 0.44}};
  float at = -y + 0.08f;
  for (int k = 0; k < 14 && at < y - 0.10f; ++k) {
    const float thick = float(shop.dice.uniform(0.025, 0.06)),
                wide = min(float(shop.dice.uniform(0.36, 0.44)), size.x - 0.12f),
                tall = min(float(shop.dice.uniform(0.65, 1.05)), rail - foot - 0.2f);
    const int tint = shop.dice.integer(0, 4);
    b.show(fmt::format("clothes_{}", tint), shop.fabric(cloth[tint], 0.0011),
           extrude(rounded_outline({{-0.5f * wide, -tall},
                                    {0.5f * wide, -tall},
                                    {0.48f * wide, -0.12f},
                                    {0.06f, -0.035f},
                                    {-0.06f, -0.035f},
                                    {-0.48f * wide, -0.12f}},
                                   0.05f, 2),
                   -thick / 2, thick / 2)
               .turned(Axis::kX, 90)
               .moved(-0.02f, at, rail - 0.03f));
    b.show("hooks", shop.metal("chrome"),
           tube({{-0.02f, at, rail - 0.065f},
                 {-0.02f, at, rail - 0.01f},
                 {-0.035f, at, rail + 0.012f},
                 {-0.02f, at, rail + 0.018f},
                 {-0.004f, at, rail + 0.008f}},
                0.002f, 6));
    at += thick + float(shop.dice.uniform(0.004, 0.05));
  }
  FrontLook look = front_look(shop, f.along(shop, Axis::kZ));
  look.pull = look.pull == 1 ? 1 : 0;
  look.pull_material = shop.metal();
  for (const bool low : {true, false}) {
    PropPart& leaf = add_door(&p, low ? "door_right" : "door_left", face, {low ? -y : 0, foot},
                              {low ? 0 : y, z - kBoard - 0.001f}, low, look);
    // A raised frame on the leaf.
    const float w = y - 0.003f, h = (z - kBoard - foot) / 2, side = low ? 1.0f : -1.0f;
    if (f.painted) {
      for (const float end : {-1.0f, 1.0f}) {
        leaf.show("leaf", look.material,
                  slab({-0.001f, min(0.06f * side, (w - 0.06f) * side), end * (h - 0.09f) - 0.03f},
                       {0.005f, max(0.06f * side, (w - 0.06f) * side), end * (h - 0.09f) + 0.03f},
                       0.002f));
        const float cy = side * (end < 0 ? 0.03f : w - 0.03f);
        leaf.show(
            "leaf", look.material,
            slab({-0.001f, cy - 0.03f, -h + 0.003f}, {0.005f, cy + 0.03f, h - 0.003f}, 0.002f));
      }
    }
  }
  b.mass = case_mass(size.x, size.y, z, 3) + 18;
  p.surfaces.push_back({{-x + 0.03f, -y + 0.03f}, {face, y - 0.03f}, z});
  p.front = 0.75f;
  return p;
}

Prop dresser(Workshop& shop) {
  const Vec3f size =
      limited(shop.size({float(shop.dice.uniform(0.44, 0.50)), float(shop.dice.uniform(0.8, 1.5)),
                         float(shop.dice.uniform(0.76, 0.95))}),
              {0.35f, 0.4f, 0.5f}, {0.6f, 2.0f, 1.4f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, pull = 0.033f,
              foot = float(shop.dice.pick({0.06, 0.13}));
  const float face = x - kBoard - pull;
  const Finish f = finish(shop, 0.45);
  Prop p;
  PropPart& b = p.body();
  show_case(&b, shop, f, -x, face, y, foot, z);
  collide_case(&b, -x, face, y, foot, z);
  if (foot < 0.1f) {
    show_plinth(&b, f.along(shop, Axis::kY), -x, face, y, foot);
  } else {
    b.show("legs", shop.wood(Axis::kZ),
           round_legs(x - 0.06f, y - 0.06f, foot, 0.013f, 0.02f).moved(-0.02f, 0, 0));
    collide_legs(&b, x - 0.05f, y - 0.05f, foot, 0.018f, -0.02f);
  }
  const int columns = y > 0.5f ? 2 : 1,
            rows = std::clamp(int(std::lround((z - foot) / 0.21f)), 2, 6);
  const FrontLook look = front_look(shop, f.along(shop, Axis::kY));
  const float z0 = foot + 0.002f, tall = (z - kBoard - 0.002f - z0) / float(rows),
              wide = size.y / float(columns);
  for (int c = 0; c < columns; ++c) {
    if (c > 0) {
      b.show("sides", f.along(shop, Axis::kZ),
             slab({-x, -kBoard / 2, foot}, {face, kBoard / 2, z - kBoard}, 0));
      b.collide_box({-x, -kBoard / 2, foot}, {face, kBoard / 2, z - kBoard});
    }
    for (int r = 0; r < rows; ++r)
      add_drawer(&p, shop,
                 fmt::format("drawer_{}{}", r + 1,
                             columns == 1 ? ""
                             : c == 0     ? "_right"
                                          : "_left"),
                 face, {-y + wide * float(c), z0 + tall * float(r)},
                 {-y + wide * float(c + 1), z0 + tall * float(r + 1)}, size.x - 0.12f, look);
  }
  b.mass = case_mass(size.x, size.y, z, 2);
  p.surfaces.push_back({{-x + 0.03f, -y + 0.03f}, {face, y - 0.03f}, z});
  p.front = 0.7f;
  return p;
}

Prop tv_stand(Workshop& shop) {
  const Vec3f size =
      limited(shop.size({float(shop.dice.uniform(0.40, 0.45)), float(shop.dice.uniform(1.3, 1.8)),
                         float(shop.dice.uniform(0.44, 0.55))}),
              {0.3f, 0.8f, 0.35f}, {0.55f, 2.6f, 0.8f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, foot = 0.12f, pull = 0.033f;
  const float face = x - kBoard - pull;
  const bool painted_fronts = shop.dice.chance(0.5);
  const Finish f{false, {}}, fronts{painted_fronts, shop.color({0.86, 0.85, 0.82})};
  Prop p;
  PropPart& b = p.body();
  show_case(&b, shop, f, -x, face, y, foot, z);
  collide_case(&b, -x, face, y, foot, z);
  b.show("legs", shop.metal("black"),
         round_legs(x - 0.07f, y - 0.10f, foot, 0.010f, 0.016f).moved(-0.02f, 0, 0));
  collide_legs(&b, x - 0.06f, y - 0.09f, foot, 0.015f, -0.02f);
  // Doors at the sides; an open bay with a shelf in the middle, or two drawers.
  const float mid = 0.30f * size.y / 2 + 0.06f;
  for (const float j : {-1.0f, 1.0f}) {
    b.show("sides", f.along(shop, Axis::kZ),
           slab({-x, j * mid - kBoard / 2, foot + kBoard},
                {face - 0.001f, j * mid + kBoard / 2, z - kBoard}, 0));
    b.collide_box({-x, j * mid - kBoard / 2, foot + kBoard},
                  {face - 0.001f, j * mid + kBoard / 2, z - kBoard});
  }
  const FrontLook look_y = front_look(shop, fronts.along(shop, Axis::kY));
  FrontLook look = look_y;
  look.material = fronts.along(shop, Axis::kZ);
  if (look.pull == 2) look.pull = 0, look.pull_material = shop.metal();
  const float top = z - kBoard - 0.001f;
  add_door(&p, "door_right", face, {-y, foot}, {-mid, top}, true, look);
  add_door(&p, "door_left", face, {mid, foot}, {y, top}, false, look);
  if (shop.dice.chance(0.5)) {
    const float half = (foot + top) / 2;
    add_drawer(&p, shop, "drawer_low", face, {-mid, foot}, {mid, half}, size.x - 0.12f, look_y);
    add_drawer(&p, shop, "drawer_top", face, {-mid, half}, {mid, top}, size.x - 0.12f, look_y);
  } else {
    const float shelf = foot + 0.55f * (z - foot);
    b.show("decks", f.along(shop, Axis::kY),
           slab({-x + 0.005f, -mid + kBoard / 2, shelf},
                {face - 0.02f, mid - kBoard / 2, shelf + 0.016f}, 0.001f));
    b.collide_box({-x + 0.01f, -mid + kBoard / 2, shelf},
                  {face - 0.02f, mid - kBoard / 2, shelf + 0.016f});
    // A receiver below, a game console above, and their cables.
    const std::string black = shop.plastic({0.11, 0.11, 0.113}, 0.4);
    b.show("receiver", black,
           slab({-x + 0.06f, -0.17f, foot + kBoard + 0.008f},
                {face - 0.05f, 0.17f, foot + kBoard + 0.068f}, 0.004f));
    b.show("receiver_feet", shop.rubber(),
           round_legs(0.09f, 0.13f, 0.009f, 0.014f, 0.014f, 0).moved(-0.02f, 0, foot + kBoard));
    b.show("display", shop.glow({0.35, 0.65, 0.9}, 40),
           slab({face - 0.0505f, 0.02f, foot + kBoard + 0.03f},
                {face - 0.0495f, 0.07f, foot + kBoard + 0.044f}, 0));
    b.show("dial", shop.metal("aluminium"),
           cylinder(0.016f, 0, 0.014f, 0.002f, 24)
               .turned(Axis::kY, 90)
               .moved(face - 0.05f, -0.11f, foot + kBoard + 0.038f));
    b.collide_box({-x + 0.06f, -0.17f, foot + kBoard},
                  {face - 0.05f, 0.17f, foot + kBoard + 0.068f});
  }
  b.mass = case_mass(size.x, size.y, z - foot, 2) + 3;
  p.surfaces.push_back({{-x + 0.03f, -y + 0.03f}, {face, y - 0.03f}, z});
  p.front = 0.5f;
  return p;
}

Prop nightstand(Workshop& shop) {
  const Vec3f size =
      limited(shop.size({float(shop.dice.uniform(0.36, 0.42)), float(shop.dice.uniform(0.40, 0.48)),
                         float(shop.dice.uniform(0.46, 0.58))}),
              {0.28f, 0.3f, 0.38f}, {0.5f, 0.6f, 0.75f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, foot = 0.14f, pull = 0.033f;
  const float face = x - kBoard - pull;
  const Finish f = finish(shop, 0.35);
  Prop p;
  PropPart& b = p.body();
  show_case(&b, shop, f, -x, face, y, foot, z);
  collide_case(&b, -x, face, y, foot, z);
  b.show("legs", shop.wood(Axis::kZ),
         round_legs(x - 0.055f, y - 0.045f, foot, 0.011f, 0.018f, 0.015f).moved(-0.02f, 0, 0));
  collide_legs(&b, x - 0.048f, y - 0.038f, foot, 0.016f, -0.02f);
  const FrontLook look = front_look(shop, f.along(shop, Axis::kY));
  const float top = z - kBoard - 0.001f, cut = top - 0.17f;
  if (shop.dice.chance(0.5)) {
    add_drawer(&p, shop, "drawer_low", face, {-y, foot}, {y, foot + (top - foot) / 2},
               size.x - 0.12f, look);
    add_drawer(&p, shop, "drawer_top", face, {-y, foot + (top - foot) / 2}, {y, top},
               size.x - 0.12f, look);
  } else {
    add_drawer(&p, shop, "drawer", face, {-y, cut}, {y, top}, size.x - 0.12f, look);
    b.show("decks", f.along(shop, Axis::kY),
           slab({-x, -y + kBoard, cut - kBoard}, {face, y - kBoard, cut - 0.002f}, 0.001f));
    b.collide_box({-x, -y + kBoard, cut - kBoard}, {face, y - kBoard, cut - 0.004f});
    const auto lay = [&](Vec3f book, float z_book, double turned) {
      const int tint = shop.dice.integer(0, kBookTints - 1);
      show_book(&b, shop, book, {-0.01f, -0.02f, foot + kBoard + z_book}, 0,
                float(shop.dice.uniform(-turned, turned)), tint, true);
    };
    lay({0.15f, 0.028f, 0.21f}, 0.0005f, 12);
    lay({0.13f, 0.022f, 0.19f}, 0.029f, 25);
  }
  b.mass = case_mass(size.x, size.y, z - foot, 3) + 1;
  p.surfaces.push_back({{-x + 0.02f, -y + 0.02f}, {face, y - 0.02f}, z});
  p.front = 0.4f;
  return p;
}

constexpr PropKind kCabinets[] = {
    {"wardrobe", wardrobe, "wardrobe with two hinged doors, clothes inside"},
    {"dresser", dresser, "chest of drawers; they slide"},
    {"tv_stand", tv_stand, "low sideboard with doors, drawers or a receiver"},
    {"nightstand", nightstand, "bedside cabinet with a drawer"},
};

}  // namespace

PropFamily cabinets() { return kCabinets; }

}  // namespace gloam

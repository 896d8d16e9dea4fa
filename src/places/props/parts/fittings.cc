#include "places/props/parts/fittings.h"

#include <cmath>

namespace gloam {

Path ring(Vec2f low, Vec2f high, float radius, float z, int steps) {
  Path out;
  const Vec2f middle = (low + high) * 0.5f;
  for (const Vec2f p : rounded_rectangle(high.x - low.x, high.y - low.y, radius, steps))
    out.push_back({middle.x + p.x, middle.y + p.y, z});
  return out;
}

Path oval(float x, float front, float back, float half_width, float z, float square) {
  constexpr int kPoints = 40;
  Path out;
  for (int i = 0; i < kPoints; ++i) {
    const float angle = 2 * kPi * float(i) / kPoints, c = std::cos(angle), s = std::sin(angle);
    const auto full = [&](float v) { return std::copysign(std::pow(std::fabs(v), 2 / square), v); };
    out.push_back({x + (c > 0 ? front : back) * full(c), half_width * full(s), z});
  }
  return out;
}

Path point_of(const Path& ring, Vec3f p) { return Path(ring.size(), p); }

void add_carcass(PropPart* part, const std::string& name, const std::string& material, Vec3f low,
                 Vec3f high, float thickness) {
  const float t = thickness;
  const auto board = [&](Vec3f a, Vec3f b) {
    part->show(name, material, slab(a, b, 0.001f));
    part->collide_box(a, b);
  };
  board(low, {high.x, low.y + t, high.z});
  board({low.x, high.y - t, low.z}, high);
  board({low.x, low.y + t, low.z}, {high.x, high.y - t, low.z + t});
  board({low.x, low.y + t, high.z - t}, {high.x, high.y - t, high.z});
  board({low.x, low.y + t, low.z + t}, {low.x + t / 2, high.y - t, high.z - t});
}

void add_handle(Workshop& shop, PropPart* part, Vec3f middle, Axis along, float length) {
  constexpr float kStand = 0.032f;
  const std::string metal = shop.metal();
  if (shop.style.metal == "brass") {
    const Profile turned = rounded(
        {{0, 0}, {0.010f, 0}, {0.006f, 0.010f}, {0.016f, 0.018f}, {0.015f, 0.027f}, {0, 0.030f}},
        0.004f);
    part->show("handle", metal, lathe(turned, 18).turned(Axis::kY, 90).moved(middle));
    part->collide_sphere(middle + Vec3f{0.016f, 0, 0}, 0.015f);
    return;
  }
  const Vec3f half = (along == Axis::kY ? Vec3f{0, 1, 0} : Vec3f{0, 0, 1}) * (length / 2);
  const Vec3f out{kStand, 0, 0};
  if (shop.style.metal == "black") {
    part->show("handle", metal,
               tube(smooth_path({middle - half, middle - half * 0.98f + out * 0.7f,
                                 middle - half * 0.85f + out, middle + half * 0.85f + out,
                                 middle + half * 0.98f + out * 0.7f, middle + half},
                                4),
                    0.005f, 10));
  } else {
    part->show("handle", metal, bar(middle - half + out, middle + half + out, 0.006f, 0.006f, 14));
    for (const float end : {-0.8f, 0.8f})
      part->show("handle", metal,
                 bar(middle + half * end, middle + half * end + out, 0.005f, 0.005f, 10));
  }
  part->collide_capsule(middle - half * 0.95f + out, middle + half * 0.95f + out, 0.006f);
}

void show_front(Workshop& shop, PropPart* part, Vec2f low, Vec2f high) {
  const bool is_wide = high.x - low.x > high.y - low.y;
  const std::string finish = shop.style.wooden_fronts
                                 ? shop.wood(is_wide ? Axis::kY : Axis::kZ)
                                 : shop.paint(shop.color(shop.style.cabinet), 0.38);
  const auto board = [&](float y0, float z0, float y1, float z1, float x0, float x1) {
    part->show("front", finish, slab({x0, y0, z0}, {x1, y1, z1}, 0.002f));
  };
  constexpr float kRail = 0.062f, kBack = -kFrontBoard;
  // Brass handles go with frame and panel, others with flat fronts.
  if (shop.style.metal != "brass" || high.y - low.y < 0.2f || high.x - low.x < 0.2f) {
    board(low.x, low.y, high.x, high.y, kBack, 0);
    return;
  }
  board(low.x, low.y, low.x + kRail, high.y, kBack, 0);
  board(high.x - kRail, low.y, high.x, high.y, kBack, 0);
  board(low.x + kRail, low.y, high.x - kRail, low.y + kRail, kBack, 0);
  board(low.x + kRail, high.y - kRail, high.x - kRail, high.y, kBack, 0);
  board(low.x + kRail - 0.005f, low.y + kRail - 0.005f, high.x - kRail + 0.005f,
        high.y - kRail + 0.005f, kBack + 0.002f, -0.008f);
}

PropJoint upright_hinge(float side, double high, double damping) {
  return {.axis = {0, 0, -side}, .low = 0, .high = high, .damping = damping, .friction = 0.15};
}

PropPart& hang_door(Workshop& shop, Prop* prop, const std::string& name, Vec3f corner, float width,
                    float height, float handle) {
  // It turns about the edge of its face, as concealed hinges make it do about, and so stays clear
  // of its neighbours.
  const float side = width > 0 ? 1.0f : -1.0f;
  PropPart& door = prop->hang(name, corner, upright_hinge(side));
  const float y0 = min(0.0f, width), y1 = max(0.0f, width);
  show_front(shop, &door, {y0, 0}, {y1, height});
  add_handle(shop, &door, {0, width - side * 0.045f, handle}, Axis::kZ, 0.16f);
  door.collide_box({-kFrontBoard, y0, 0}, {0, y1, height});
  door.mass = 700.0 * kFrontBoard * (y1 - y0) * height + 0.2;  // chipboard of 700 kg/m³
  return door;
}

PropPart& hang_drawer(Workshop& shop, Prop* prop, const std::string& name, Vec3f corner,
                      float width, float height, float depth) {
  PropPart& drawer = prop->hang(name, corner,
                                {.slides = true,
                                 .axis = {1, 0, 0},
                                 .low = 0,
                                 .high = depth * 0.85f,
                                 .damping = 8,
                                 .friction = 3});
  show_front(shop, &drawer, {0, 0}, {width, height});
  const float inset = 0.030f, t = 0.012f, x = -kFrontBoard;  // runners at both sides
  const float y0 = inset, y1 = width - inset, z0 = 0.02f, z1 = min(height - 0.025f, 0.20f);
  const auto board = [&](Vec3f a, Vec3f b) {
    drawer.show("box", shop.wood("birch", Axis::kX), slab(a, b, 0.001f));
    drawer.collide_box(a, b);
  };
  board({x - depth, y0, z0}, {x, y0 + t, z1});
  board({x - depth, y1 - t, z0}, {x, y1, z1});
  board({x - depth, y0 + t, z0}, {x - depth + t, y1 - t, z1});
  board({x - depth + t, y0 + t, z0}, {x, y1 - t, z0 + 0.008f});
  drawer.collide_box({-kFrontBoard, 0, 0}, {0, width, height});
  add_handle(shop, &drawer, {0, width / 2, height > 0.2f ? height - 0.05f : height / 2}, Axis::kY,
             0.16f);
  drawer.mass =
      700.0 * (kFrontBoard * width * height + depth * (width * 0.008f + 0.024f * z1)) + 0.4;
  return drawer;
}

void show_tap(Workshop& shop, PropPart* part, Vec3f foot, float height, float reach) {
  const std::string metal = bright_metal(shop);
  const float r = reach / 2, x = foot.x, y = foot.y, z = foot.z;
  Path neck{{x, y, z + 0.04f}, {x, y, z + height - r}};
  for (int i = 1; i <= 8; ++i) {
    const float angle = kPi * float(i) / 8;
    neck.push_back({x + r - r * std::cos(angle), y, z + height - r + r * std::sin(angle)});
  }
  neck.push_back({x + reach, y, z + height - r - 0.03f});
  part->show("tap", metal, cylinder(0.026f, z, z + 0.008f, 0.002f, 24).moved(x, y, 0));
  part->show("tap", metal, cylinder(0.021f, z + 0.006f, z + 0.075f, 0.004f, 24).moved(x, y, 0));
  part->show("tap", metal, tube(neck, 0.0105f, 14));
  part->show("tap", metal,
             cylinder(0.0125f, z + height - r - 0.042f, z + height - r - 0.02f, 0.002f, 18)
                 .moved(x + reach, y, 0));
  part->show("tap", metal,
             bar({x, y - 0.018f, z + 0.055f}, {x, y - 0.036f, z + 0.056f}, 0.014f, 0.014f, 16));
  part->show(
      "tap", metal,
      bar({x, y - 0.030f, z + 0.06f}, {x + 0.02f, y - 0.034f, z + 0.13f}, 0.005f, 0.004f, 10));
  part->collide_capsule({x, y, z + 0.02f}, {x, y, z + height - 0.02f}, 0.018f);
  part->collide_capsule({x, y, z + height - 0.02f}, {x + reach, y, z + height - 0.03f}, 0.012f);
}

Solid knob(float radius, float height, Vec3f at) {
  const Profile turned =
      rounded({{0, 0}, {radius, 0}, {radius * 0.92f, height}, {0, height}}, 0.003f);
  return (lathe(turned, radius < 0.012f ? 12 : 24) +
          slab({-0.0012f, 0, height - 0.002f}, {0.0012f, radius * 0.85f, height + 0.001f}, 0.0004f))
      .turned(Axis::kY, 90)
      .moved(at);
}

Solid draped(float width, float front, float back, float bar_radius, uint64_t seed,
             float thickness) {
  constexpr int kColumns = 25, kFall = 8, kBend = 6;
  Dice dice(seed, "draped");
  const float phase = float(dice.uniform(0, 6)), waves = float(dice.uniform(2.5, 4.5));
  const float r = bar_radius + thickness + 0.001f;
  std::vector<Vec3f> points;
  const auto row = [&](float x, float z) {
    const float loose = min(1.0f, max(0.0f, -z / 0.25f)), out = x > 0 ? 1.0f : -1.0f;
    for (int i = 0; i < kColumns; ++i) {
      const float u = 2 * float(i) / (kColumns - 1) - 1;
      const float fold =
          0.5f + 0.5f * std::sin(waves * kPi * u + phase + 0.6f * std::sin(2 * u - 9 * z));
      points.push_back({x + out * 0.018f * loose * fold, u * width / 2 * (1 - 0.03f * loose), z});
    }
  };
  for (int i = 0; i < kFall; ++i) row(r, -front * (1 - float(i) / kFall));
  for (int i = 0; i <= kBend; ++i) {
    const float angle = kPi * float(i) / kBend;
    row(r * std::cos(angle), r * std::sin(angle));
  }
  for (int i = 1; i <= kFall; ++i) row(-r, -back * float(i) / kFall);
  return sheet(points, kColumns, thickness);
}

std::string appliance_casing(Workshop& shop) {
  const double kind = shop.dice.uniform();
  const Vec3 usual = kind < 0.5 ? Vec3{0.90, 0.90, 0.89} : Vec3{0.10, 0.10, 0.105};
  const bool bare = kind > 0.65 && shop.color(usual) == usual;
  return bare ? shop.metal("steel") : shop.paint(shop.color(usual), 0.22);
}

std::string bright_metal(Workshop& shop) {
  return shop.style.metal == "steel" ? shop.metal("chrome") : shop.metal();
}

Vec3 towel_color(Workshop& shop) {
  return shop.dice.pick<Vec3>({{0.80, 0.78, 0.73},
                               {0.33, 0.42, 0.47},
                               {0.56, 0.42, 0.37},
                               {0.36, 0.42, 0.34},
                               {0.85, 0.84, 0.82},
                               {0.22, 0.23, 0.26}});
}

}  // namespace gloam

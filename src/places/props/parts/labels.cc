#include "places/props/parts/labels.h"

#include <fmt/format.h>

#include <cmath>

#include "places/canvas.h"

namespace gloam {
namespace {

constexpr Vec3 kWhite{0.92, 0.92, 0.91}, kSignBlack{0.05, 0.05, 0.05}, kGreen{0.0, 0.52, 0.30},
    kSignYellow{0.97, 0.78, 0.02}, kSignRed{0.72, 0.05, 0.06};

void arrow(Canvas* canvas, Vec2f tip, Vec2f d, float size, Vec3 color) {
  const Vec2f n{-d.y, d.x};
  const auto at = [&](float along, float across) {
    return tip + d * (along * size) + n * (across * size);
  };
  canvas->fill({at(0, 0), at(-0.45f, 0.42f), at(-0.45f, 0.16f), at(-1, 0.16f), at(-1, -0.16f),
                at(-0.45f, -0.16f), at(-0.45f, -0.42f)},
               color);
}

// Someone who runs to the left, about one high.
void runner(Canvas* canvas, Vec2f foot, float size, Vec3 color) {
  const auto at = [&](float x, float y) { return foot + Vec2f{x * size, y * size}; };
  const auto limb = [&](Vec2f a, Vec2f b, float w) { canvas->line(a, b, w * size, color); };
  canvas->disc(at(-0.03f, 0.90f), 0.085f * size, color);
  limb(at(0.02f, 0.72f), at(0.10f, 0.42f), 0.17f);
  limb(at(0.0f, 0.74f), at(-0.20f, 0.62f), 0.075f);
  limb(at(-0.20f, 0.62f), at(-0.30f, 0.73f), 0.07f);
  limb(at(0.03f, 0.74f), at(0.24f, 0.66f), 0.075f);
  limb(at(0.24f, 0.66f), at(0.28f, 0.48f), 0.07f);
  limb(at(0.08f, 0.42f), at(-0.14f, 0.34f), 0.10f);
  limb(at(-0.14f, 0.34f), at(-0.16f, 0.08f), 0.09f);
  limb(at(0.11f, 0.42f), at(0.22f, 0.20f), 0.10f);
  limb(at(0.22f, 0.20f), at(0.42f, 0.14f), 0.085f);
}

}  // namespace

std::string shipping_label(Workshop* shop) {
  return shop->picture(
      "shipping_label",
      [=] {
        Canvas c(200, 140, {0.93, 0.93, 0.92});
        c.bars({0.08f, 0.10f}, {1.35f, 0.42f}, 5, kSignBlack);
        for (int i = 0; i < 4; ++i)
          c.bars({0.08f, 0.52f + 0.1f * float(i)}, {i == 3 ? 1.25f : 0.8f, 0.57f + 0.1f * float(i)},
                 uint64_t(11 + i), {0.15, 0.15, 0.16}, true);
        c.rectangle({0.98f, 0.52f}, {1.34f, 0.76f}, kSignBlack)
            .rectangle({1.0f, 0.54f}, {1.32f, 0.74f}, kWhite);
        c.bars({1.05f, 0.58f}, {1.28f, 0.70f}, 3, kSignBlack, true);
        return c.image();
      },
      0.5);
}

std::string handling_mark(Workshop* shop) {
  return shop->picture(
      "handling_mark",
      [=] {
        const Vec3 card{0.68, 0.54, 0.40}, ink{0.16, 0.11, 0.08};
        Canvas c(150, 100, card);
        c.rectangle({0.03f, 0.03f}, {1.47f, 0.97f}, ink)
            .rectangle({0.06f, 0.06f}, {1.44f, 0.94f}, card);
        for (const float x : {0.28f, 0.60f}) arrow(&c, {x, 0.86f}, {0, 1}, 0.56f, ink);
        c.rectangle({0.14f, 0.16f}, {0.74f, 0.22f}, ink);
        c.fill({{0.92f, 0.86f},
                {1.30f, 0.86f},
                {1.24f, 0.52f},
                {1.14f, 0.46f},
                {1.14f, 0.24f},
                {1.26f, 0.16f},
                {0.96f, 0.16f},
                {1.08f, 0.24f},
                {1.08f, 0.46f},
                {0.98f, 0.52f}},
               ink);
        return c.image();
      },
      0.85);
}

std::string place_label(Workshop* shop) {
  return shop->picture(
      "place_label",
      [=] {
        Canvas c(200, 50, {0.93, 0.93, 0.92});
        c.rectangle({0, 0}, {0.35f, 1}, {0.95, 0.75, 0.1});
        c.bars({0.5f, 0.15f}, {2.4f, 0.85f}, 21, kSignBlack);
        c.bars({2.6f, 0.3f}, {3.8f, 0.7f}, 22, kSignBlack, true);
        return c.image();
      },
      0.5);
}

std::string load_sign(Workshop* shop) {
  return shop->picture(
      "load_sign",
      [=] {
        Canvas c(160, 120, {0.93, 0.93, 0.92});
        c.rectangle({0, 0.72f}, {1.34f, 1}, kSignYellow);
        c.fill({{0.08f, 0.76f}, {0.26f, 0.76f}, {0.17f, 0.95f}}, kSignBlack);
        c.bars({0.36f, 0.80f}, {1.2f, 0.92f}, 31, kSignBlack, true);
        for (int i = 0; i < 3; ++i) {
          const float y = 0.12f + 0.2f * float(i);
          c.rectangle({0.1f, y - 0.04f}, {0.5f, y - 0.02f}, kSignBlack);
          c.rectangle({0.18f, y - 0.02f}, {0.42f, y + 0.09f}, {0.55, 0.42, 0.25});
          c.bars({0.62f, y}, {1.2f, y + 0.08f}, uint64_t(40 + i), kSignBlack, true);
        }
        return c.image();
      },
      0.4);
}

std::string exit_picture(Workshop* shop, double luminance) {
  return shop->lit_picture(
      "exit_picture",
      [=] {
        // ISO 7010 E001: a runner, a door, an arrow.
        Canvas c(240, 120, kGreen);
        c.rectangle({0.10f, 0.10f}, {0.52f, 0.92f}, kWhite)
            .rectangle({0.15f, 0.10f}, {0.47f, 0.87f}, kGreen);
        runner(&c, {0.50f, 0.10f}, 0.76f, kWhite);
        arrow(&c, {1.86f, 0.5f}, {1, 0}, 0.62f, kWhite);
        return c.image();
      },
      luminance);
}

std::string warning_picture(Workshop* shop, int kind) {
  return shop->picture(
      fmt::format("warning_{}", kind),
      [=] {
        // ISO 7010 W001, W012 (voltage), W014 (industrial trucks), W004 (laser), simplified.
        Canvas c(160, 160, {0.90, 0.90, 0.88});
        c.fill({{0.02f, 0.07f}, {0.98f, 0.07f}, {0.5f, 0.95f}}, kSignBlack);
        c.fill({{0.10f, 0.12f}, {0.90f, 0.12f}, {0.5f, 0.85f}}, kSignYellow);
        if (kind == 0) {
          c.fill({{0.45f, 0.60f}, {0.55f, 0.60f}, {0.53f, 0.33f}, {0.47f, 0.33f}}, kSignBlack);
          c.disc({0.5f, 0.235f}, 0.05f, kSignBlack);
        } else if (kind == 1) {
          c.fill({{0.54f, 0.66f},
                  {0.42f, 0.40f},
                  {0.50f, 0.41f},
                  {0.46f, 0.18f},
                  {0.60f, 0.47f},
                  {0.515f, 0.46f}},
                 kSignBlack);
        } else if (kind == 2) {
          c.rectangle({0.34f, 0.24f}, {0.58f, 0.38f}, kSignBlack)
              .rectangle({0.60f, 0.20f}, {0.63f, 0.58f}, kSignBlack);
          c.rectangle({0.63f, 0.20f}, {0.76f, 0.225f}, kSignBlack);
          c.line({0.37f, 0.38f}, {0.40f, 0.54f}, 0.025f, kSignBlack)
              .line({0.40f, 0.54f}, {0.54f, 0.54f}, 0.025f, kSignBlack);
          c.line({0.44f, 0.40f}, {0.45f, 0.47f}, 0.05f, kSignBlack)
              .disc({0.455f, 0.505f}, 0.026f, kSignBlack);
          c.disc({0.40f, 0.22f}, 0.045f, kSignBlack).disc({0.54f, 0.22f}, 0.045f, kSignBlack);
        } else {
          c.disc({0.42f, 0.34f}, 0.06f, kSignBlack)
              .line({0.42f, 0.34f}, {0.72f, 0.34f}, 0.03f, kSignBlack);
          for (int i = 0; i < 8; ++i) {
            const float a = kPi * float(i) / 4;
            c.line({0.42f, 0.34f}, Vec2f{0.42f, 0.34f} + Vec2f{std::cos(a), std::sin(a)} * 0.13f,
                   0.02f, kSignBlack);
          }
        }
        return c.image();
      },
      0.4);
}

std::string extinguisher_picture(Workshop* shop) {
  return shop->picture(
      "extinguisher_sign",
      [=] {
        // ISO 7010 F001.
        Canvas c(120, 120, kSignRed);
        c.fill({{0.30f, 0.10f},
                {0.56f, 0.10f},
                {0.56f, 0.56f},
                {0.48f, 0.66f},
                {0.38f, 0.66f},
                {0.30f, 0.56f}},
               kWhite);
        c.rectangle({0.40f, 0.66f}, {0.46f, 0.76f}, kWhite);
        c.line({0.40f, 0.78f}, {0.56f, 0.83f}, 0.045f, kWhite)
            .line({0.44f, 0.73f}, {0.26f, 0.70f}, 0.035f, kWhite);
        c.line({0.26f, 0.70f}, {0.22f, 0.36f}, 0.035f, kWhite);
        c.fill({{0.70f, 0.10f},
                {0.86f, 0.10f},
                {0.90f, 0.30f},
                {0.80f, 0.60f},
                {0.74f, 0.40f},
                {0.66f, 0.30f}},
               kWhite);
        return c.image();
      },
      0.4);
}

std::string aid_picture(Workshop* shop) {
  return shop->picture(
      "aid_sign",
      [=] {
        Canvas c(96, 96, kGreen);
        c.rectangle({0.40f, 0.14f}, {0.60f, 0.86f}, kWhite)
            .rectangle({0.14f, 0.40f}, {0.86f, 0.60f}, kWhite);
        return c.image();
      },
      0.4);
}

std::string stripes(Workshop* shop, Vec3 color, Vec3 other) {
  const auto number = [](Vec3 v) {
    return int(v.x * 99) * 10000 + int(v.y * 99) * 100 + int(v.z * 99);
  };
  return shop->picture(
      fmt::format("stripes_{}_{}", number(color), number(other)),
      [=] {
        Canvas c(256, 64, color);
        for (int i = -1; i < 4; ++i) {
          const float x = float(i);
          c.fill({{x, 0}, {x + 0.5f, 0}, {x + 1.5f, 1}, {x + 1, 1}}, other);
        }
        return c.image();
      },
      0.45);
}

std::string extinguisher_label(Workshop* shop) {
  return shop->picture(
      "extinguisher_label",
      [=] {
        Canvas c(96, 144, {0.90, 0.90, 0.88});
        c.rectangle({0, 0.80f}, {0.67f, 1}, kSignRed)
            .bars({0.06f, 0.86f}, {0.6f, 0.94f}, 51, kWhite, true);
        for (int i = 0; i < 3; ++i) {
          const float x = 0.06f + 0.19f * float(i);
          c.rectangle({x, 0.54f}, {x + 0.16f, 0.74f}, kSignBlack)
              .rectangle({x + 0.015f, 0.555f}, {x + 0.145f, 0.725f}, kWhite);
          c.fill({{x + 0.04f, 0.58f}, {x + 0.12f, 0.58f}, {x + 0.08f, 0.70f}}, kSignRed);
        }
        for (int i = 0; i < 6; ++i)
          c.bars({0.06f, 0.08f + 0.07f * float(i)}, {0.6f, 0.12f + 0.07f * float(i)},
                 uint64_t(60 + i), kSignBlack, true);
        return c.image();
      },
      0.4);
}

}  // namespace gloam

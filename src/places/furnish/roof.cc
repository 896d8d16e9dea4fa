// A gable roof, its ridge along x.

#include <cmath>

#include "places/furnish/shell.h"

namespace gloam {

Prop make_roof(Workshop& shop, double width_size, double depth_size) {
  constexpr float kPitch = 30 * kPi / 180, kOverhang = 0.45f, kCourse = 0.34f;
  const float x = float(width_size) / 2, y = float(depth_size) / 2, ridge = y * std::tan(kPitch);
  Prop p;
  p.label = "roof";
  PropPart& b = p.body();
  // Gable walls: drawn in y and z, thick along x.
  const std::string plaster = shop.plaster({0.86, 0.84, 0.79});
  for (const float end : {-1.0f, 1.0f}) {
    const float from = end < 0 ? -x : x - 0.2f;
    b.show("gables", plaster,
           extrude({{-y, 0}, {y, 0}, {0, ridge}}, from, from + 0.2f)
               .turned(Axis::kX, 90)
               .turned(Axis::kZ, 90));
  }
  const Vec3 clay =
      shop.dice.pick<Vec3>({{0.42, 0.20, 0.14}, {0.25, 0.25, 0.27}, {0.33, 0.22, 0.17}});
  const std::string tiles = shop.plastic(clay, 0.75), board = shop.paint(shop.style.trim, 0.5);
  const float slope = (y + kOverhang) / std::cos(kPitch), length = 2 * x + 2 * kOverhang;
  const int courses = static_cast<int>(slope / kCourse);
  for (const float side : {-1.0f, 1.0f}) {
    const float degrees = -side * kPitch * 180 / kPi;
    // From the ridge down along the slope, `up` above the rafters.
    const auto place = [&](const Solid& s, float down, float up) {
      return s.turned(Axis::kX, degrees)
          .moved(0, side * (down * std::cos(kPitch) + up * std::sin(kPitch)),
                 ridge - down * std::sin(kPitch) + up * std::cos(kPitch));
    };
    b.show("deck", board, place(rounded_box({length, slope, 0.06f}, 0.004f), slope / 2, 0.05f));
    for (int i = 0; i < courses; ++i) {
      const float down = (float(i) + 0.5f) * slope / float(courses);
      const Solid course = rounded_box({length, slope / float(courses) + 0.06f, 0.022f}, 0.008f)
                               .turned(Axis::kX, -side * 3.0f);
      b.show("tiles", tiles, place(course, down, 0.105f));
    }
    const Vec3f middle{0, side * (slope / 2 * std::cos(kPitch) + 0.06f * std::sin(kPitch)),
                       ridge - slope / 2 * std::sin(kPitch) + 0.06f * std::cos(kPitch)};
    b.collide_box(middle, {length / 2, slope / 2, 0.05f}, turn({1, 0, 0}, -side * kPitch));
    // Gutter.
    const float edge = slope + 0.02f;
    const Vec3f at{0, side * edge * std::cos(kPitch), ridge - edge * std::sin(kPitch) + 0.05f};
    b.show("gutter", shop.metal("galvanised"),
           tube({{-length / 2, at.y, at.z}, {length / 2, at.y, at.z}}, 0.05f, 10));
  }
  b.show("tiles", tiles,
         tube({{-length / 2, 0, ridge + 0.13f}, {length / 2, 0, ridge + 0.13f}}, 0.09f, 12));
  b.mass = 60 * 2 * slope * length;  // tiles and timber, 60 kg/m²
  return p;
}

}  // namespace gloam

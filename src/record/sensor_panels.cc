#include "record/sensor_panels.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "record/canvas.h"

namespace gloam {
namespace {

/// Colours at even distances from 0 to 1.
Rgb8 ramp(std::span<const Rgb8> colors, float x) {
  const float at = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(colors.size() - 1);
  const size_t i = std::min(static_cast<size_t>(at), colors.size() - 2);
  const float t = at - static_cast<float>(i);
  Rgb8 out;
  for (size_t k = 0; k < 3; ++k) {
    out[k] = static_cast<uint8_t>(std::lround(static_cast<float>(colors[i][k]) * (1 - t) +
                                              static_cast<float>(colors[i + 1][k]) * t));
  }
  return out;
}

template <class Color>
Panel colored(const std::vector<float>& values, const Color& color) {
  Panel out;
  out.reserve(3 * values.size());
  for (const float value : values) {
    const Rgb8 rgb = color(value);
    out.insert(out.end(), rgb.begin(), rgb.end());
  }
  return out;
}

}  // namespace

Panel depth_panel(const std::vector<float>& depth, float far) {
  constexpr Rgb8 kColors[] = {{255, 255, 255}, {126, 198, 232}, {35, 96, 172}, {4, 12, 40}};
  constexpr Rgb8 kNone{70, 70, 70};
  return colored(
      depth, [&](float z) { return z > 0 && std::isfinite(z) ? ramp(kColors, z / far) : kNone; });
}

Panel thermal_panel(const std::vector<float>& kelvin, float cold, float hot) {
  constexpr Rgb8 kColors[] = {
      {0, 0, 8}, {72, 14, 106}, {186, 54, 84}, {249, 142, 8}, {252, 255, 210}};
  return colored(kelvin, [&](float k) { return ramp(kColors, (k - cold) / (hot - cold)); });
}

Panel lidar_panel(const LidarScan& scan, int width, int height, float reach) {
  constexpr Rgb8 kBack{16, 18, 22}, kRing{44, 48, 56}, kSurface{235, 240, 245},
      kMedium{255, 150, 40};
  Canvas canvas(width, height, kBack);
  const Vec2f middle{0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height)};
  const float per_metre = std::min(middle.x, middle.y) / reach;
  std::vector<Polyline> rings;
  for (float radius = 2; radius < 2 * reach; radius += 2) {
    constexpr int kCorners = 180;
    Polyline& ring = rings.emplace_back();
    for (int i = 0; i <= kCorners; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / kCorners;
      ring.push_back(middle + Vec2f{std::cos(angle), std::sin(angle)} * (radius * per_metre));
    }
  }
  canvas.stroke(rings, 1, kRing);
  // Media over surfaces: there are fewer, and they are what is looked for.
  for (const bool media : {false, true}) {
    for (size_t i = 0; i < scan.size(); ++i) {
      const bool is_medium = !scan.part.empty() && scan.part[i] == 0;
      if (is_medium != media || scan.return_number[i] != 0) continue;
      canvas.fill(static_cast<int>(std::lround(middle.x - scan.y[i] * per_metre)),
                  static_cast<int>(std::lround(middle.y - scan.x[i] * per_metre)), 1, 1,
                  media ? kMedium : kSurface);
    }
  }
  return canvas.pixels();
}

}  // namespace gloam

#include "render/film/tone_map.h"

#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "base/srgb.h"

namespace gloam {
namespace {

// Interleaved gradient noise, Jimenez 2014, "Next Generation Post Processing in Call of Duty":
// even in every neighbourhood, so it dithers nearly as well as blue noise without a table. 0..1.
float gradient_noise(int x, int y) {
  const float inner = 0.06711056f * static_cast<float>(x) + 0.00583715f * static_cast<float>(y);
  const float outer = 52.9829189f * (inner - std::floor(inner));
  return outer - std::floor(outer);
}

// Response of a channel: straight up to the top of the scale, and full at kFull.
constexpr float kFull = 1.5f;
float held(float x) {
  constexpr float kAbove = kFull - 1;
  return x < 1 ? x : kFull - kAbove * std::exp((1 - x) / kAbove);
}

// Neutral curve: what Fresnel adds to base colours, where the curve begins to bend, and how far it
// compresses the brightest channel.
constexpr float kF90 = 0.04f, kStart = 0.8f - kF90, kRoom = 1 - kStart;
constexpr float compressed(float peak) {
  return peak < kStart ? peak : 1 - kRoom * kRoom / (peak + kRoom - kStart);
}

float to_positive(float x) { return x > 0 ? min(x, 1e6f) : 0.0f; }  // also for NaN

}  // namespace

float max_luminance(float ev100) { return 1.2f * std::exp2(ev100); }

Vec3f tone_curve_neutral(Vec3f color) {
  constexpr float kDesaturation = 0.15f;
  const float lowest = min(color.x, min(color.y, color.z));
  const float offset = lowest < 2 * kF90 ? lowest - lowest * lowest / (4 * kF90) : kF90;
  color = color - Vec3f{offset, offset, offset};
  const float peak = max_component(color);
  if (peak < kStart) return color;
  const float new_peak = compressed(peak);
  const float keep = 1 / (kDesaturation * (peak - new_peak) + 1);
  return lerp(Vec3f{new_peak, new_peak, new_peak}, color * (new_peak / peak), keep);
}

Vec3f tone_curve_of_sensor(Vec3f color) {
  color = tone_curve_neutral({held(color.x), held(color.y), held(color.z)});
  // Value from which the curve bends, so that it ends at white.
  constexpr float kEnd = compressed(kFull - kF90);
  const float peak = max_component(color);
  if (peak <= kStart) return color;
  const float way = (peak - kStart) / (kEnd - kStart);
  return color * (1 + (1 - kEnd) * way * way / peak);
}

void tone_map(const std::vector<Vec3f>& radiance, int width, int height,
              const ToneMapSettings& settings, std::vector<uint8_t>* rgb) {
  const size_t n = static_cast<size_t>(width) * static_cast<size_t>(height);
  GLOAM_CHECK(radiance.size() == n, "the radiance does not match the size of the picture");
  rgb->resize(3 * n);
  const float scale = 1 / max_luminance(settings.ev100);
  parallel_for_range("tone_map", height, 16, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < width; ++x) {
        const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + x;
        const Vec3f light = radiance[i] * scale;
        Vec3f color{to_positive(light.x), to_positive(light.y), to_positive(light.z)};
        if (settings.neutral) color = tone_curve_of_sensor(color);
        const float threshold = settings.dither ? gradient_noise(x, y) : 0.5f;
        for (int c = 0; c < 3; ++c) {
          const float level = 255 * srgb_encode(clamp(color[c], 0, 1)) + threshold;
          (*rgb)[3 * i + static_cast<size_t>(c)] = static_cast<uint8_t>(min(level, 255.0f));
        }
      }
    }
  });
}

}  // namespace gloam

#include "render/film/color_map.h"

#include <cmath>

#include "base/srgb.h"
#include "base/vec.h"
#include "render/film/tone_map.h"

namespace gloam {
namespace {

uint8_t to_byte(float x) { return static_cast<uint8_t>(255 * clamp(x, 0, 1) + 0.5f); }

float polynomial(const float (&c)[6], float x) {
  float sum = 0;
  for (int i = 5; i >= 0; --i) sum = sum * x + c[i];
  return sum;
}

/// OKLCH to sRGB; hue in turns.
Rgb8 oklch_color(float lightness, float chroma, float hue) {
  const float a = chroma * std::cos(2 * kPi * hue), b = chroma * std::sin(2 * kPi * hue);
  const auto cube = [](float x) { return x * x * x; };
  const float l = cube(lightness + 0.3963377774f * a + 0.2158037573f * b);
  const float m = cube(lightness - 0.1055613458f * a - 0.0638541728f * b);
  const float s = cube(lightness - 0.0894841775f * a - 1.2914855480f * b);
  const float rgb[] = {4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
                       -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
                       -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s};
  Rgb8 out;
  for (size_t c = 0; c < 3; ++c) out[c] = to_byte(srgb_encode(clamp(rgb[c], 0, 1)));
  return out;
}

}  // namespace

Rgb8 turbo_color(float x) {
  static constexpr float kRed[] = {0.13572138f,   4.61539260f,    -42.66032258f,
                                   132.13108234f, -152.94239396f, 59.28637943f};
  static constexpr float kGreen[] = {0.09140261f,   2.19418839f, 4.84296658f,
                                     -14.18503333f, 4.27729857f, 2.82956604f};
  static constexpr float kBlue[] = {0.10667330f,   12.64194608f,  -60.58204836f,
                                    110.36276771f, -89.90310912f, 27.34824973f};
  x = x > 0 ? min(x, 1) : 0.0f;  // also for NaN
  return {to_byte(polynomial(kRed, x)), to_byte(polynomial(kGreen, x)),
          to_byte(polynomial(kBlue, x))};
}

Rgb8 label_color(uint32_t id) {
  if (id == 0) return {38, 42, 48};
  constexpr double kGoldenAngle = 0.38196601125;  // turns
  const double turns = static_cast<double>(id) * kGoldenAngle;
  // Ids 21 apart have nearly the same hue and the same lightness, hence two degrees of colour.
  const float lightness[] = {0.74f, 0.62f, 0.84f};
  const float chroma = (id / 3) % 2 == 0 ? 0.145f : 0.075f;
  return oklch_color(lightness[id % 3], chroma, static_cast<float>(turns - std::floor(turns)));
}

}  // namespace gloam

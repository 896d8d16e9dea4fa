#include "render/film/yuv.h"

#include <algorithm>

#include "base/check.h"

namespace gloam {
namespace {

// BT.709: Kr = 0.2126, Kb = 0.0722. Fixed point with 16 fraction bits; full-range RGB in, limited
// range out. Rows sum to 219 * 65536 / 255 (luma) and exactly 0 (chroma), so greys stay grey.
constexpr int kBits = 16;
constexpr double kScale = 65536.0;
constexpr double kKr = 0.2126, kKb = 0.0722, kKg = 1 - kKr - kKb;
constexpr int fixed(double x) { return static_cast<int>(x * kScale + (x < 0 ? -0.5 : 0.5)); }
constexpr int kYr = fixed(kKr * 219 / 255), kYg = fixed(kKg * 219 / 255),
              kYb = fixed(kKb * 219 / 255);
constexpr int kUr = fixed(-kKr / (2 * (1 - kKb)) * 224 / 255), kUb = fixed(0.5 * 224 / 255),
              kUg = -kUr - kUb;
constexpr int kVb = fixed(-kKb / (2 * (1 - kKr)) * 224 / 255), kVr = fixed(0.5 * 224 / 255),
              kVg = -kVr - kVb;

uint8_t to_byte(int x) { return static_cast<uint8_t>(std::clamp(x, 0, 255)); }

}  // namespace

void rgb_to_yuv420(int width, int height, std::span<const uint8_t> rgb, Yuv420* out) {
  GLOAM_CHECK(width > 0 && height > 0 &&
                  rgb.size() == 3 * static_cast<size_t>(width) * static_cast<size_t>(height),
              "the number of pixels does not match the image size");
  const int w = (width + 1) & ~1, h = (height + 1) & ~1;
  out->width = w;
  out->height = h;
  out->y.resize(static_cast<size_t>(w) * static_cast<size_t>(h));
  out->u.resize(out->y.size() / 4);
  out->v.resize(out->y.size() / 4);
  const auto pixel = [&](int x, int y) {
    x = std::clamp(x, 0, width - 1);
    y = std::min(y, height - 1);
    return rgb.data() +
           3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
  };
  for (int y = 0; y < h; ++y) {
    uint8_t* row = out->y.data() + static_cast<size_t>(y) * static_cast<size_t>(w);
    for (int x = 0; x < w; ++x) {
      const uint8_t* p = pixel(x, y);
      row[x] = to_byte(16 + ((kYr * p[0] + kYg * p[1] + kYb * p[2] + (1 << (kBits - 1))) >> kBits));
    }
  }
  // Horizontally 1 2 1 around the left sample, vertically 1 1: eight taps.
  for (int y = 0; y < h; y += 2) {
    const size_t start = static_cast<size_t>(y / 2) * static_cast<size_t>(w / 2);
    for (int x = 0; x < w; x += 2) {
      int sum[3] = {0, 0, 0};
      for (int dy = 0; dy < 2; ++dy) {
        const uint8_t *a = pixel(x - 1, y + dy), *b = pixel(x, y + dy), *c = pixel(x + 1, y + dy);
        for (int k = 0; k < 3; ++k) sum[k] += a[k] + 2 * b[k] + c[k];
      }
      constexpr int kShift = kBits + 3, kRound = 1 << (kShift - 1);
      const size_t i = start + static_cast<size_t>(x / 2);
      out->u[i] = to_byte(128 + ((kUr * sum[0] + kUg * sum[1] + kUb * sum[2] + kRound) >> kShift));
      out->v[i] = to_byte(128 + ((kVr * sum[0] + kVg * sum[1] + kVb * sum[2] + kRound) >> kShift));
    }
  }
}

}  // namespace gloam

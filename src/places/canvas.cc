#include "places/canvas.h"

#include <algorithm>
#include <cmath>

#include "base/rng.h"

namespace gloam {
namespace {

uint8_t byte(double x) { return static_cast<uint8_t>(std::lround(std::clamp(x, 0.0, 1.0) * 255)); }

bool inside(const Profile& outline, Vec2f p) {
  bool in = false;
  for (size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const Vec2f a = outline[i], b = outline[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
  }
  return in;
}

}  // namespace

Canvas::Canvas(int width, int height, Vec3 color) {
  image_.width = width, image_.height = height, image_.channels = 3;
  image_.texels.resize(static_cast<size_t>(width) * static_cast<size_t>(height) * 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) put(x, y, color, 1);
}

void Canvas::put(int x, int y, Vec3 color, float share) {
  uint8_t* texel = &image_.texels[3 * (static_cast<size_t>(y) * static_cast<size_t>(image_.width) +
                                       static_cast<size_t>(x))];
  const double rgb[3] = {color.x, color.y, color.z};
  for (int k = 0; k < 3; ++k)
    texel[k] = byte(double(texel[k]) / 255 * (1 - double(share)) + rgb[k] * double(share));
}

Canvas& Canvas::fill(const Profile& outline, Vec3 color) {
  constexpr int kSamples = 3;  // samples of a texel's edge
  const auto unit = static_cast<float>(image_.height);
  Vec2f low = outline[0], high = outline[0];
  for (const Vec2f p : outline) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const int x0 = std::max(0, int(low.x * unit)),
            x1 = std::min(image_.width - 1, int(high.x * unit));
  const int y0 = std::max(0, int((1 - high.y) * unit)),
            y1 = std::min(image_.height - 1, int((1 - low.y) * unit));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      int hits = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const int column = k % kSamples, row = k / kSamples;
        const float dx = (float(column) + 0.5f) / kSamples, dy = (float(row) + 0.5f) / kSamples;
        hits += inside(outline, {(float(x) + dx) / unit, 1 - (float(y) + dy) / unit});
      }
      if (hits > 0) put(x, y, color, float(hits) / (kSamples * kSamples));
    }
  }
  return *this;
}

Canvas& Canvas::rectangle(Vec2f low, Vec2f high, Vec3 color) {
  return fill({low, {high.x, low.y}, high, {low.x, high.y}}, color);
}

Canvas& Canvas::disc(Vec2f center, float radius, Vec3 color) {
  Profile round = circle(radius, 32);
  for (Vec2f& p : round) p = p + center;
  return fill(round, color);
}

Canvas& Canvas::line(Vec2f from, Vec2f to, float width, Vec3 color) {
  const Vec2f d = to - from;
  const float size = std::sqrt(d.x * d.x + d.y * d.y);
  const Vec2f n = Vec2f{-d.y, d.x} * (width / 2 / size);
  fill({from - n, to - n, to + n, from + n}, color);
  return disc(from, width / 2, color).disc(to, width / 2, color);
}

Canvas& Canvas::bars(Vec2f low, Vec2f high, uint64_t seed, Vec3 color, bool print) {
  const RandomStream random{seed, stream_id("canvas.bars")};
  const float pitch = print ? 0.75f * (high.y - low.y) : (high.x - low.x) / 60;
  uint64_t i = 0;
  for (float x = low.x; x < high.x; ++i) {
    const float wide = pitch * (print ? 0.5f + 0.5f * float(random.uniform(i, 0))
                                      : float(1 + int(random.uniform(i, 0) * 3)));
    const float shy = print ? 0.25f * (high.y - low.y) * float(random.uniform(i, 1)) : 0;
    const bool space = print && random.uniform(i, 2) < 0.2;
    if (!space) rectangle({x, low.y}, {std::min(x + wide, high.x), high.y - shy}, color);
    x += wide + pitch * (print ? 0.35f : float(1 + int(random.uniform(i, 3) * 2)));
  }
  return *this;
}

}  // namespace gloam

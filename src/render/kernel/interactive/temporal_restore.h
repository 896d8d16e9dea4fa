#pragma once
// Scales shown light to the noisy light of its neighbourhood: denoisers and clamps lose light of
// rare bright samples. Device-safe.

#include "render/kernel/film/light_gain.h"
#include "render/kernel/interactive/temporal.h"

namespace gloam::temporal {

/// Calls visit(pixel) for the pixels of a block and `margin` pixels around it.
template <class Visit>
GLOAM_HD void each_of_block(const TemporalPicture& p, int column, int row, int margin,
                            const Visit& visit) {
  constexpr int kBlock = TemporalPicture::kBlock;
  const int side = kBlock + 2 * margin;
  for (int k = 0; k < side * side; ++k) {
    const int x = kBlock * column + k % side - margin, y = kBlock * row + k / side - margin;
    if (p.holds(x, y)) visit(p.index(x, y));
  }
}

/// Standard errors by which the noisy light of a window may differ from the shown light by chance.
inline constexpr float kMostErrors = 3;
inline constexpr int kDetailRadius = 1;  ///< of the window [px]
/// History from which errors are known [pictures]. The first picture after a cut counts 16 and has
/// no deviation of its own, so it must have lost its weight.
inline constexpr float kLeastDetailAge = 40;

/// Makes the shown light of composed light: adds details of which the noisy light is certain, away
/// from borders, whose pixels differ from picture to picture. After compose() of all pixels.
GLOAM_HD void add_details(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  p.shown[i] = p.color[i];
  Vec3f noisy, composed;
  float variance = 0;
  for (int b = max(y - kDetailRadius, 0); b <= min(y + kDetailRadius, p.height - 1); ++b) {
    for (int a = max(x - kDetailRadius, 0); a <= min(x + kDetailRadius, p.width - 1); ++a) {
      const size_t j = p.index(a, b);
      const float mean = luminance(p.now.noisy[j]);
      if (p.now.age[j] < kLeastDetailAge || (p.now.part[j] & kBorder) != 0) return;
      noisy += p.now.noisy[j];
      composed += p.color[j];
      variance += max(p.now.square[j] - mean * mean, 0.0f) / (kMostNoisy - 1);
    }
  }
  const Vec3f lost = noisy - composed;
  const float much = fabsf(luminance(lost)), error = kMostErrors * sqrtf(variance);
  if (much <= error) return;
  const Vec3f gain = light_gain(composed + lost * (1 - error / much), composed, kMostWindowGain);
  p.shown[i] = {p.color[i].x * gain.x, p.color[i].y * gain.y, p.color[i].z * gain.z};
}

/// Sums the block's noisy and shown light, in units of its brightest pixel: a bright window does
/// not decide for the wall beside it. After add_details() of all pixels.
GLOAM_HD void sum_block(const TemporalPicture& p, int column, int row) {
  float brightest = 1e-9f;
  each_of_block(p, column, row, 2,
                [&](size_t i) { brightest = max(brightest, luminance(p.shown[i])); });
  BlockLight sum;
  each_of_block(p, column, row, 0, [&](size_t i) {
    sum.noisy += p.now.noisy[i];
    sum.shown += p.shown[i];
  });
  p.block(column, row) = {sum.noisy / brightest, sum.shown / brightest, 1 / brightest};
}

/// Scales the pixel's colour so that it keeps the noisy light of the blocks around. After
/// sum_block() of all blocks.
GLOAM_HD void restore(const TemporalPicture& p, int x, int y) {
  constexpr int kBlock = TemporalPicture::kBlock;
  constexpr float kReach = 4.5f;  // [blocks]
  const float u = (static_cast<float>(x) + 0.5f) / kBlock - 0.5f,
              v = (static_cast<float>(y) + 0.5f) / kBlock - 0.5f;
  BlockLight sum;
  float total = 0;
  const auto first = [](float at) { return max(static_cast<int>(ceilf(at - kReach)), 0); };
  const auto last = [](float at, int count) {
    return min(static_cast<int>(floorf(at + kReach)), count - 1);
  };
  for (int row = first(v); row <= last(v, p.block_rows()); ++row) {
    for (int column = first(u); column <= last(u, p.block_columns()); ++column) {
      const float weight = (kReach - fabsf(static_cast<float>(column) - u)) *
                           (kReach - fabsf(static_cast<float>(row) - v));
      const BlockLight& block = p.block(column, row);
      sum.noisy += block.noisy * weight;
      sum.shown += block.shown * weight;
      sum.unit += block.unit * weight;
      total += weight;
    }
  }
  Vec3f& color = p.shown[p.index(x, y)];
  const Vec3f gain = light_gain(sum.noisy, sum.shown, kMostWindowGain);
  // Pixels far brighter than the blocks around show lamps or the sky, which have no noise.
  const float share = min(total / (sum.unit * max(luminance(color), 1e-9f)), 1.0f);
  color = {color.x * lerp(1, gain.x, share), color.y * lerp(1, gain.y, share),
           color.z * lerp(1, gain.z, share)};
}

}  // namespace gloam::temporal

#pragma once
// Scales shown light to the noisy light of its neighbourhood: denoisers and clamps lose light of
// rare bright samples. Device-safe.

#include "render/kernel/film/light_gain.h"
#include "render/kernel/interactive/temporal_light.h"

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

/// Colour of a pixel that shows two objects, of the colours around: what a filter of the camera
/// does with finished pictures.
GLOAM_HD Vec3f blended(const TemporalPicture& p, int x, int y) {
  Vec3f sum;
  float total = 0;
  for (int b = max(y - 1, 0); b <= min(y + 1, p.height - 1); ++b) {
    for (int a = max(x - 1, 0); a <= min(x + 1, p.width - 1); ++a) {
      const float weight = (a == x ? 2.0f : 1.0f) * (b == y ? 2.0f : 1.0f);
      sum += p.color[p.index(a, b)] * weight;
      total += weight;
    }
  }
  return sum / total;
}

/// Makes the shown light of composed light: adds details of which the noisy light is certain, away
/// from borders, whose pixels differ from picture to picture. After compose() of all pixels.
GLOAM_HD void add_details(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  p.shown[i] = p.color[i];
  if (is_mixed(p.now.part[i]) && p.now.age[i] < kSettledAge) p.shown[i] = blended(p, x, y);
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

GLOAM_HD void add_sums(PixelSums* sums, const PixelSums& other, float weight) {
  sums->noisy += other.noisy * weight;
  sums->shown += other.shown * weight;
  sums->pixels += other.pixels * weight;
  sums->unit += other.unit * weight;
}

/// Sums the block's noisy and shown light, in units of its brightest pixel: a bright window does
/// not decide for the wall beside it. After add_details() of all pixels.
GLOAM_HD void sum_block(const TemporalPicture& p, int column, int row) {
  float brightest = 1e-9f;
  each_of_block(p, column, row, 2,
                [&](size_t i) { brightest = max(brightest, luminance(p.shown[i])); });
  BlockLight block;
  each_of_block(p, column, row, 0, [&](size_t i) {
    const PixelSums pixel{p.now.noisy[i] / brightest, p.shown[i] / brightest, 1, 1 / brightest};
    add_sums(is_mixed(p.now.part[i]) ? &block.border : &block.inside, pixel, 1);
  });
  p.block(column, row) = block;
}

/// Scales the pixel's colour so that it keeps the noisy light of like pixels in the blocks around.
/// After sum_block() of all blocks.
GLOAM_HD void restore(const TemporalPicture& p, int x, int y) {
  constexpr int kBlock = TemporalPicture::kBlock;
  constexpr float kReach = 4.5f;     // [blocks]
  constexpr float kUnlike = 0.002f;  // weight of other pixels, where few are like this one
  const float u = (static_cast<float>(x) + 0.5f) / kBlock - 0.5f,
              v = (static_cast<float>(y) + 0.5f) / kBlock - 0.5f;
  const size_t i = p.index(x, y);
  const bool mixed = is_mixed(p.now.part[i]);
  PixelSums sums;
  const auto first = [](float at) { return max(static_cast<int>(ceilf(at - kReach)), 0); };
  const auto last = [](float at, int count) {
    return min(static_cast<int>(floorf(at + kReach)), count - 1);
  };
  for (int row = first(v); row <= last(v, p.block_rows()); ++row) {
    for (int column = first(u); column <= last(u, p.block_columns()); ++column) {
      const float weight = (kReach - fabsf(static_cast<float>(column) - u)) *
                           (kReach - fabsf(static_cast<float>(row) - v));
      const BlockLight& block = p.block(column, row);
      add_sums(&sums, mixed ? block.border : block.inside, weight);
      add_sums(&sums, mixed ? block.inside : block.border, kUnlike * weight);
    }
  }
  Vec3f& color = p.shown[i];
  const Vec3f gain = light_gain(sums.noisy, sums.shown, kMostWindowGain);
  // Pixels far brighter than the blocks around show lamps or the sky, which have no noise.
  const float share = min(sums.pixels / (sums.unit * max(luminance(color), 1e-9f)), 1.0f);
  color = {color.x * lerp(1, gain.x, share), color.y * lerp(1, gain.y, share),
           color.z * lerp(1, gain.z, share)};
}

}  // namespace gloam::temporal

#pragma once
// Light that a history of the interactive tier shows on a card: brought back to recent light where
// it has changed, and spread over surfaces that are new in view. Device-safe.

#include "render/kernel/interactive/temporal.h"

namespace gloam::temporal {

/// Pixels around one that its recent light is compared with: so many to each side, and their
/// distance, which reaches over the blotches that a denoiser leaves [px].
inline constexpr int kWindow = 2, kWindowStep = 4;
/// Light farther from the recent light around than so many of its standard deviations has changed.
inline constexpr float kMostDeviations = 2;
/// Light that is shown of a pixel with a short history: places around it, the widest distance [px],
/// and the history that needs none [pictures]. Light of media is sampled too sparsely for less.
inline constexpr int kSpreadTaps = 24;
inline constexpr float kWidestSpread = 24;
inline constexpr float kSettledAge = 8, kSettledAgeInMedia = kMostAge;

/// Weight of another pixel's light for a pixel: 1 on the same surface.
GLOAM_HD float likeness(const TemporalPicture& p, size_t j, size_t i) {
  const uint32_t part = p.now.part[i];
  if (p.now.part[j] == part && (is_empty(part) || dot(p.now.normal[j], p.now.normal[i]) >= kFacing))
    return 1;
  // The light of media does not depend on the surfaces behind them.
  return p.clear == nullptr ? 0.0f : 1 - max(p.clear[i], p.clear[j]);
}

/// Brings a mean of many pictures back to the recent light of the pixels around, where shadows and
/// lamps have moved. After accumulate() of all pixels.
GLOAM_HD void settle(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  if (is_mixed(p.now.part[i])) return;
  Vec3f sum, squares;
  float count = 0;
  for (int k = 0; k < (2 * kWindow + 1) * (2 * kWindow + 1); ++k) {
    const int a = x + kWindowStep * (k % (2 * kWindow + 1) - kWindow);
    const int b = y + kWindowStep * (k / (2 * kWindow + 1) - kWindow);
    if (!p.holds(a, b)) continue;
    const float weight = likeness(p, p.index(a, b), i);
    const Vec3f recent = p.now.recent[p.index(a, b)];
    sum += recent * weight;
    squares += recent * recent * weight;
    count += weight;
  }
  if (count < 2) return;  // a pixel by itself knows no deviation
  const Vec3f mean = sum / count, light = p.now.light[i];
  const auto clamped = [&](float value, float center, float square) {
    const float reach = kMostDeviations * safe_sqrt(square - center * center);
    return clamp(value, max(center - reach, 0), center + reach);
  };
  p.now.light[i] = {clamped(light.x, mean.x, squares.x / count),
                    clamped(light.y, mean.y, squares.y / count),
                    clamped(light.z, mean.z, squares.z / count)};
}

/// Light of a pixel and of its surface around: the shorter its history, the wider. In fixed places,
/// so that a picture at rest does not flicker. After settle() of all pixels.
GLOAM_HD Vec3f shown_light(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  const uint32_t part = p.now.part[i];
  const float settled = part == kMediaPart ? kSettledAgeInMedia : kSettledAge;
  const float reach = kWidestSpread * max(1 - p.now.age[i] / settled, 0);
  Vec3f sum = p.now.light[i];
  float total = 1;
  for (int k = 1; !is_sky(part) && !is_mixed(part) && reach > 0 && k <= kSpreadTaps; ++k) {
    constexpr float kGoldenTurn = 0.381966f;  // a spiral of evenly dense places
    const float share = static_cast<float>(k) / kSpreadTaps, r = reach * sqrtf(share);
    const float turns = kGoldenTurn * static_cast<float>(k);
    float sine, cosine;
    sincos_turn(turns - floorf(turns), &sine, &cosine);
    const int a = x + static_cast<int>(floorf(r * cosine + 0.5f));
    const int b = y + static_cast<int>(floorf(r * sine + 0.5f));
    if (!p.holds(a, b)) continue;
    const float weight = (1 - 0.5f * share) * likeness(p, p.index(a, b), i);
    sum += p.now.light[p.index(a, b)] * weight;
    total += weight;
  }
  return sum / total;
}

/// Colour of a pixel that shows two objects as its own object around has it: pixels at borders lose
/// their history whenever the camera moves, and a denoiser alone leaves them dark or bright. A
/// quotient of sums, as the colours of such pixels may be far from their light.
GLOAM_HD Vec3f border_color(const TemporalPicture& p, int x, int y) {
  constexpr int kRadius = 3;  // [px]
  const size_t i = p.index(x, y);
  Vec3f light, colors;
  for (int b = max(y - kRadius, 0); b <= min(y + kRadius, p.height - 1); ++b) {
    for (int a = max(x - kRadius, 0); a <= min(x + kRadius, p.width - 1); ++a) {
      const size_t j = p.index(a, b);
      if (p.part[j] != p.part[i]) continue;
      light += p.now.light[j] * divisor(p, j);
      colors += reflected_color(p, j);
    }
  }
  const Vec3f own = reflected_color(p, i);
  return {own.x * light.x / colors.x, own.y * light.y / colors.y, own.z * light.z / colors.z};
}

/// Makes the pixel's colour, before restore().
GLOAM_HD void compose(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  const Vec3f color = shown_light(p, x, y) * divisor(p, i);
  const float known = min(p.now.age[i] / kSettledAge, 1);
  const bool unsure = is_mixed(p.now.part[i]) && known < 1;
  p.color[i] = unsure ? lerp(border_color(p, x, y), color, known) : color;
}

}  // namespace gloam::temporal

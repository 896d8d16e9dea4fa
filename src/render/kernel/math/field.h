#pragma once
// A scalar over space with its gradient, carried through arithmetic by the chain rule: heights made
// of patterns get their slope without finite differences. Device-safe.

#include "base/vec.h"

namespace gloam {

struct Field {
  float value = 0;
  Vec3f gradient;  ///< per metre, unless said otherwise

  friend GLOAM_HD Field operator+(Field a, Field b) {
    return {a.value + b.value, a.gradient + b.gradient};
  }
  friend GLOAM_HD Field operator-(Field a, Field b) {
    return {a.value - b.value, a.gradient - b.gradient};
  }
  friend GLOAM_HD Field operator*(Field a, Field b) {
    return {a.value * b.value, a.gradient * b.value + b.gradient * a.value};
  }
  friend GLOAM_HD Field operator+(Field a, float s) { return {a.value + s, a.gradient}; }
  friend GLOAM_HD Field operator-(Field a, float s) { return {a.value - s, a.gradient}; }
  friend GLOAM_HD Field operator*(Field a, float s) { return {a.value * s, a.gradient * s}; }
};

/// f(x), given f and its derivative at x.
GLOAM_HD Field compose(Field x, float f, float derivative) { return {f, x.gradient * derivative}; }

/// 0 below `lo`, 1 above `hi`, a cubic between. lo < hi.
GLOAM_HD float smooth_step(float lo, float hi, float x) {
  const float t = clamp((x - lo) / (hi - lo), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Distribution function of a bell of standard deviation `sigma` about 0: the sum of three uniform
/// numbers, within 0.01 of the normal distribution and exactly 0 and 1 beyond 3 sigma. A threshold
/// of a noise, blurred: if sigma² = (own softness)² + (variance that filtering took from x), the
/// mean over the surface stays what it was for normally distributed x.
GLOAM_HD Field soft_step(Field x, float sigma) {
  const float inv = 0.5f / max(sigma, 1e-6f), y = x.value * inv, a = fabsf(y);
  if (a >= 1.5f) return {y > 0 ? 1.0f : 0.0f, {}};
  const float tail = 1.5f - a;
  const float half = a <= 0.5f ? a * (0.75f - a * a * (1.0f / 3)) : 0.5f - tail * tail * tail / 6;
  const float density = a <= 0.5f ? 0.75f - a * a : 0.5f * tail * tail;
  return compose(x, y > 0 ? 0.5f + half : 0.5f - half, density * inv);
}
GLOAM_HD float soft_step(float x, float sigma) { return soft_step(Field{x, {}}, sigma).value; }

/// Mean of |x + e| for e of the same bell: |x| with a rounded tip.
GLOAM_HD Field soft_abs(Field x, float sigma) {
  const float scale = 2.0f * max(sigma, 1e-6f), y = x.value / scale, a = fabsf(y);
  const float sign = y > 0 ? 1.0f : -1.0f;
  if (a >= 1.5f) return compose(x, fabsf(x.value), sign);
  const float tail = 1.5f - a, tail3 = tail * tail * tail;
  if (a > 0.5f) return compose(x, scale * (a + tail3 * tail / 12), sign * (1.0f - tail3 / 3));
  const float y2 = y * y;
  return compose(x, scale * (0.40625f + y2 * (0.75f - y2 / 6)), y * (1.5f - y2 * (2.0f / 3)));
}

}  // namespace gloam

#pragma once
// Noises over space: gradient, value and cellular, and sums of octaves that lose what is finer than
// the footprint. All are functions of (position, seed) alone through an integer hash of the cell
// and the place within it, so they hold wherever a float still resolves the cell. Device-safe.
//
// | noise                       | mean | variance | range       |
// |-----------------------------|------|----------|-------------|
// | gradient_noise, value_noise | 0    | 1        | ±7.9, ±2.5  |
// | fbm                         | 0    | 1 − lost | ±7.9 √octaves |
// | turbulence                  | 1    | –        | [0, 9.9]    |
// | ridged                      | 0.5  | –        | [−4, 1]     |
// | cellular: F1                | 0.52 | 0.03     | [0, √3]     |

#include "render/kernel/math/field.h"
#include "render/kernel/math/sampler.h"

namespace gloam {

GLOAM_HD uint32_t hash_cell(int x, int y, int z, uint32_t seed) {
  return mix_bits((static_cast<uint32_t>(x) * 0x8DA6B343u) ^
                  (static_cast<uint32_t>(y) * 0xD8163841u) ^
                  (static_cast<uint32_t>(z) * 0xCB1AB31Fu) ^ (seed * 0x9E3779B9u));
}
/// Uniform in [0, 1), 16 bits; `part` 0 or 1 picks the half of the hash.
GLOAM_HD float hash_unit(uint32_t hash, int part) {
  return static_cast<float>(static_cast<int>((hash >> (16 * part)) & 0xFFFFu)) * 0x1p-16f;
}

/// x = cell + f with f in [0, 1). What is not a number or beyond 10^9 goes to a cell at the rim.
struct CellSplit {
  int cell;
  float f;
};
GLOAM_HD CellSplit split_cell(float x) {
  const float inside = clamp(x, -1e9f, 1e9f), base = floorf(inside);
  return {static_cast<int>(base), min(inside - base, 0.9999999f)};
}

/// Turns axes so that no cell plane lies along a wall or floor. A rotation (rows are orthonormal).
GLOAM_HD Vec3f turn_noise_axes(Vec3f p) {
  return {0.8f * p.x + 0.36f * p.y - 0.48f * p.z, -0.6f * p.x + 0.48f * p.y - 0.64f * p.z,
          0.8f * p.y + 0.6f * p.z};
}
GLOAM_HD Vec3f turn_noise_axes_back(Vec3f g) {
  return {0.8f * g.x - 0.6f * g.y, 0.36f * g.x + 0.48f * g.y + 0.8f * g.z,
          -0.48f * g.x - 0.64f * g.y + 0.6f * g.z};
}

/// Quintic fade of lattice noise and its derivative (Perlin 2002, "Improving noise").
struct NoiseFade {
  float w, dw;
  GLOAM_HD static NoiseFade at(float t) {
    return {t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f), 30.0f * sqr(t * (t - 1.0f))};
  }
};

/// Perlin's noise with gradients spread over a cube. `q` in cells; the gradient is per cell.
GLOAM_HD Field gradient_noise(Vec3f q, uint32_t seed) {
  const CellSplit cx = split_cell(q.x), cy = split_cell(q.y), cz = split_cell(q.z);
  float value[8], gx[8], gy[8], gz[8];
  for (int i = 0; i < 8; ++i) {
    const int dx = i & 1, dy = (i >> 1) & 1, dz = i >> 2;
    const uint32_t h = hash_cell(cx.cell + dx, cy.cell + dy, cz.cell + dz, seed);
    // 10 bits each, centred; the scale gives the noise unit variance.
    constexpr float kScale = 5.2363f / 511.5f, kShift = 5.2363f;
    gx[i] = static_cast<float>(static_cast<int>(h & 1023u)) * kScale - kShift;
    gy[i] = static_cast<float>(static_cast<int>((h >> 10) & 1023u)) * kScale - kShift;
    gz[i] = static_cast<float>(static_cast<int>((h >> 20) & 1023u)) * kScale - kShift;
    value[i] = gx[i] * (cx.f - static_cast<float>(dx)) + gy[i] * (cy.f - static_cast<float>(dy)) +
               gz[i] * (cz.f - static_cast<float>(dz));
  }
  // Blended along z, y, x in turn, halves of the arrays at a time, which compilers vectorise.
  const NoiseFade u = NoiseFade::at(cx.f), v = NoiseFade::at(cy.f), w = NoiseFade::at(cz.f);
  for (int i = 0; i < 4; ++i) {
    gx[i] = lerp(gx[i], gx[i + 4], w.w);
    gy[i] = lerp(gy[i], gy[i + 4], w.w);
    gz[i] = lerp(gz[i], gz[i + 4], w.w) + w.dw * (value[i + 4] - value[i]);
    value[i] = lerp(value[i], value[i + 4], w.w);
  }
  for (int i = 0; i < 2; ++i) {
    gx[i] = lerp(gx[i], gx[i + 2], v.w);
    gy[i] = lerp(gy[i], gy[i + 2], v.w) + v.dw * (value[i + 2] - value[i]);
    gz[i] = lerp(gz[i], gz[i + 2], v.w);
    value[i] = lerp(value[i], value[i + 2], v.w);
  }
  return {lerp(value[0], value[1], u.w),
          {lerp(gx[0], gx[1], u.w) + u.dw * (value[1] - value[0]), lerp(gy[0], gy[1], u.w),
           lerp(gz[0], gz[1], u.w)}};
}

/// Uniform values at the corners of cells, blended. `q` in cells; the gradient is per cell.
GLOAM_HD Field value_noise(Vec3f q, uint32_t seed) {
  const CellSplit cx = split_cell(q.x), cy = split_cell(q.y), cz = split_cell(q.z);
  float f[8];
  for (int i = 0; i < 8; ++i) {
    const uint32_t h =
        hash_cell(cx.cell + (i & 1), cy.cell + ((i >> 1) & 1), cz.cell + (i >> 2), seed);
    constexpr float kHalf = 2.4968f;  // gives unit variance
    f[i] = static_cast<float>(static_cast<int>(h >> 8)) * (kHalf * 0x1p-23f) - kHalf;
  }
  const NoiseFade u = NoiseFade::at(cx.f), v = NoiseFade::at(cy.f), w = NoiseFade::at(cz.f);
  const float low = lerp(lerp(f[0], f[1], u.w), lerp(f[2], f[3], u.w), v.w);
  const float high = lerp(lerp(f[4], f[5], u.w), lerp(f[6], f[7], u.w), v.w);
  return {
      lerp(low, high, w.w),
      {u.dw * lerp(lerp(f[1] - f[0], f[3] - f[2], v.w), lerp(f[5] - f[4], f[7] - f[6], v.w), w.w),
       v.dw * lerp(lerp(f[2] - f[0], f[3] - f[1], u.w), lerp(f[6] - f[4], f[7] - f[5], u.w), w.w),
       w.dw * (high - low)}};
}

/// Worley 1996, "A cellular texture basis function": one point per cell.
struct CellularNoise {
  float f1, f2;        ///< distance to the nearest and the second nearest point [cells]
  uint32_t id;         ///< hash of the nearest point
  Vec3f to_f1, to_f2;  ///< from those points to `q` [cells]
};
GLOAM_HD CellularNoise cellular_noise(Vec3f q, uint32_t seed) {
  const CellSplit cx = split_cell(q.x), cy = split_cell(q.y), cz = split_cell(q.z);
  CellularNoise out{1e9f, 1e9f, 0, {}, {}};
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const uint32_t h = hash_cell(cx.cell + x, cy.cell + y, cz.cell + z, seed);
        const Vec3f point{static_cast<float>(x) + static_cast<float>(h & 1023u) * 0x1p-10f,
                          static_cast<float>(y) + static_cast<float>((h >> 10) & 1023u) * 0x1p-10f,
                          static_cast<float>(z) + static_cast<float>((h >> 20) & 1023u) * 0x1p-10f};
        const Vec3f d = Vec3f{cx.f, cy.f, cz.f} - point;
        const float squared = dot(d, d);
        if (squared < out.f1) {
          out.f2 = out.f1;
          out.to_f2 = out.to_f1;
          out.f1 = squared;
          out.to_f1 = d;
          out.id = mix_bits(h);
        } else if (squared < out.f2) {
          out.f2 = squared;
          out.to_f2 = d;
        }
      }
    }
  }
  out.f1 = sqrtf(out.f1);
  out.f2 = sqrtf(out.f2);
  return out;
}

/// Share of a gradient noise's amplitude that is left after averaging over `footprint` cells (of a
/// square surface patch), fitted to measurement within 0.1. 0 from 2.85 cells on.
GLOAM_HD float noise_left(float footprint) {
  const float t = 1.0f - 0.1231f * footprint * footprint;
  return t > 0 ? sqr(t * t) : 0.0f;
}

struct Noise {
  Field field;
  float lost = 0;  ///< variance that the footprint took
};

/// One octave: `frequency` = cells per metre along each axis, `footprint` [m].
GLOAM_HD Noise filtered_noise(Vec3f p, Vec3f frequency, float footprint, uint32_t seed) {
  const float left = noise_left(footprint * max_component(frequency));
  if (left <= 0.0f) return {{}, 1.0f};
  const Field n = gradient_noise(turn_noise_axes(p * frequency), seed);
  return {{n.value * left, turn_noise_axes_back(n.gradient) * frequency * left},
          1.0f - left * left};
}

namespace noises {

/// Sum of `octaves` (1 to 8), each twice as fine and `gain` times as strong as the one before.
/// `shape(Noise)` makes a Field of each; weights have unit sum of squares, or unit sum.
template <class Shape>
GLOAM_HD Noise sum_octaves(Vec3f p, Vec3f frequency, int octaves, float gain, float footprint,
                           uint32_t seed, bool squares, const Shape& shape) {
  float total = 0, weight = 1;
  for (int i = 0; i < octaves; ++i, weight *= gain) total += squares ? weight * weight : weight;
  weight = squares ? 1.0f / sqrtf(total) : 1.0f / total;
  Noise sum;
  for (int i = 0; i < octaves; ++i, weight *= gain, frequency *= 2.03f) {
    const Noise n =
        filtered_noise(p, frequency, footprint, seed + 0x01000193u * static_cast<uint32_t>(i));
    sum.field = sum.field + shape(n) * weight;
    sum.lost += weight * weight * n.lost;
  }
  return sum;
}

/// Mean of |x| of a gradient noise.
inline constexpr float kMeanMagnitude = 0.8f;

}  // namespace noises

/// Fractal sum. `frequency` of the first octave along each axis [cells/m].
GLOAM_HD Noise fbm(Vec3f p, Vec3f frequency, int octaves, float gain, float footprint,
                   uint32_t seed) {
  return noises::sum_octaves(p, frequency, octaves, gain, footprint, seed, true,
                             [](const Noise& n) { return n.field; });
}
GLOAM_HD Noise fbm(Vec3f p, float frequency, int octaves, float gain, float footprint,
                   uint32_t seed) {
  return fbm(p, {frequency, frequency, frequency}, octaves, gain, footprint, seed);
}

/// Billows: the sum of magnitudes.
GLOAM_HD Field turbulence(Vec3f p, float frequency, int octaves, float gain, float footprint,
                          uint32_t seed) {
  return noises::sum_octaves(
             p, {frequency, frequency, frequency}, octaves, gain, footprint, seed, false,
             [](const Noise& n) {
               return soft_abs(n.field, sqrtf(n.lost)) * (1.0f / noises::kMeanMagnitude);
             })
      .field;
}

/// Crests where the noise crosses zero.
GLOAM_HD Field ridged(Vec3f p, float frequency, int octaves, float gain, float footprint,
                      uint32_t seed) {
  return Field{1, {}} - turbulence(p, frequency, octaves, gain, footprint, seed) * 0.5f;
}

}  // namespace gloam

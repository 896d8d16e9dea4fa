#pragma once
// Filtered texture look-ups: trilinear over mip levels by an isotropic footprint. Cube faces are
// clamped. Device-safe.

#include <cstring>

#include "render/kernel/scene_view.h"

#if defined(__SSE4_1__) && !defined(__CUDACC__)
#include <smmintrin.h>
#define GLOAM_SIMD_TEXELS  // the same arithmetic in the same order, four channels at once
#endif

namespace gloam {

struct Rgba {
  Vec3f rgb;
  float a = 1;
};

namespace texturing {

/// log2 of a positive x, a parabola between powers of two: error < 0.01.
GLOAM_HD float log2_of(float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  const float f = static_cast<float>(bits & 0x7FFFFFu) * 0x1p-23f;
  return static_cast<float>(static_cast<int>(bits >> 23) - 127) + f * (1.3465f - 0.3465f * f);
}

/// Coordinates in texels of level `level`; `row` grows downwards. Never above 1, which the weights'
/// rounding would make of white: what is opaque would let less than no light through.
GLOAM_HD Rgba bilinear(const SceneView& scene, const TextureLevel& level, float x, float row,
                       bool repeat_x, bool repeat_y) {
  const float fx = x * static_cast<float>(level.width) - 0.5f;
  const float fy = row * static_cast<float>(level.height) - 0.5f;
  const float bx = floorf(fx), by = floorf(fy);
  const float wx = fx - bx, wy = fy - by;
  int x0 = static_cast<int>(bx), y0 = static_cast<int>(by), x1 = x0 + 1, y1 = y0 + 1;
  const int w = level.width, h = level.height;
  if (repeat_x) {  // coordinates are in [0, 1): one step outside at most
    x0 = x0 < 0 ? x0 + w : x0;
    x1 = x1 >= w ? 0 : x1;
  }
  if (repeat_y) {
    y0 = y0 < 0 ? y0 + h : y0;
    y1 = y1 >= h ? 0 : y1;
  }
  x0 = x0 < 0 ? 0 : (x0 >= w ? w - 1 : x0);
  y0 = y0 < 0 ? 0 : (y0 >= h ? h - 1 : y0);
  x1 = x1 < 0 ? 0 : (x1 >= w ? w - 1 : x1);
  y1 = y1 < 0 ? 0 : (y1 >= h ? h - 1 : y1);
  const Texel* row0 = scene.texels.data + level.first + static_cast<size_t>(y0) * w;
  const Texel* row1 = scene.texels.data + level.first + static_cast<size_t>(y1) * w;
  const Texel* t[4] = {row0 + x0, row0 + x1, row1 + x0, row1 + x1};
  const float weight[4] = {(1 - wx) * (1 - wy), wx * (1 - wy), (1 - wx) * wy, wx * wy};
  constexpr float kScale = 1.0f / 65535.0f;
#ifdef GLOAM_SIMD_TEXELS
  __m128 sum = _mm_setzero_ps();
  for (int i = 0; i < 4; ++i) {
    const __m128i bits = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(t[i]));
    const __m128 texel = _mm_cvtepi32_ps(_mm_cvtepu16_epi32(bits));
    sum = _mm_add_ps(sum, _mm_mul_ps(texel, _mm_set1_ps(weight[i])));
  }
  alignas(16) float out[4];
  _mm_store_ps(out, _mm_min_ps(_mm_mul_ps(sum, _mm_set1_ps(kScale)), _mm_set1_ps(1.0f)));
  return {{out[0], out[1], out[2]}, out[3]};
#else
  Rgba sum{{0, 0, 0}, 0};
  for (int i = 0; i < 4; ++i) {
    sum.rgb += Vec3f{static_cast<float>(t[i]->r), static_cast<float>(t[i]->g),
                     static_cast<float>(t[i]->b)} *
               weight[i];
    sum.a += static_cast<float>(t[i]->a) * weight[i];
  }
  const auto scaled = [](float value) { return min(value * kScale, 1.0f); };
  return {{scaled(sum.rgb.x), scaled(sum.rgb.y), scaled(sum.rgb.z)}, scaled(sum.a)};
#endif
}

GLOAM_HD Rgba trilinear(const SceneView& scene, const TextureView& texture, int face, float x,
                        float row, float footprint, bool repeat_x, bool repeat_y) {
  // Footprint of one texel at level 0 is 2^-log2_size.
  const float lod = footprint > 0 ? log2_of(footprint) + texture.log2_size : 0.0f;
  const float top = static_cast<float>(texture.level_count - 1);
  const float level = clamp(lod, 0.0f, top);
  const float base = floorf(level);
  const TextureLevel* levels = scene.texture_levels.data + texture.first_level +
                               face * texture.level_count + static_cast<int>(base);
  const Rgba fine = bilinear(scene, levels[0], x, row, repeat_x, repeat_y);
  const float w = level - base;
  if (w < 0.01f || base >= top) return fine;
  const Rgba coarse = bilinear(scene, levels[1], x, row, repeat_x, repeat_y);
  return {lerp(fine.rgb, coarse.rgb, w), lerp(fine.a, coarse.a, w)};
}

/// A coordinate brought into the picture, 0 … 1.
GLOAM_HD float wrapped(float x, TextureWrap wrap) {
  if (wrap == TextureWrap::kClamp) return clamp(x, 0.0f, 1.0f);
  if (wrap == TextureWrap::kMirror) {
    const float turn = x - 2.0f * floorf(0.5f * x);
    return turn > 1.0f ? 2.0f - turn : turn;
  }
  return min(x - floorf(x), 0.9999999f);
}

}  // namespace texturing

/// `uv`: v grows upwards. `footprint`: width of what is seen, in texture lengths.
GLOAM_HD Rgba lookup_2d(const SceneView& scene, int texture, Vec2f uv, float footprint) {
  const TextureView& view = scene.textures[texture];
  return texturing::trilinear(scene, view, 0, texturing::wrapped(uv.x, view.wrap_u),
                              texturing::wrapped(1.0f - uv.y, view.wrap_v), footprint,
                              view.wrap_u == TextureWrap::kRepeat,
                              view.wrap_v == TextureWrap::kRepeat);
}

/// `direction` need not be unit. Faces right +X, left -X, up +Y, down -Y, front +Z, back -Z, laid
/// out as OpenGL's cube maps. `footprint`: angle seen, as a fraction of a face.
GLOAM_HD Rgba lookup_cube(const SceneView& scene, int texture, Vec3f d, float footprint) {
  const TextureView& view = scene.textures[texture];
  const float ax = fabsf(d.x), ay = fabsf(d.y), az = fabsf(d.z);
  int face;
  float s, t, m;
  if (ax >= ay && ax >= az) {
    face = d.x > 0 ? 0 : 1;
    m = ax;
    s = d.x > 0 ? -d.z : d.z;
    t = -d.y;
  } else if (ay >= az) {
    face = d.y > 0 ? 2 : 3;
    m = ay;
    s = d.x;
    t = d.y > 0 ? d.z : -d.z;
  } else {
    face = d.z > 0 ? 4 : 5;
    m = az;
    s = d.z > 0 ? d.x : -d.x;
    t = -d.y;
  }
  const float inv = m > 0 ? 0.5f / m : 0.0f;
  return texturing::trilinear(scene, view, view.face_count == 6 ? face : 0, s * inv + 0.5f,
                              t * inv + 0.5f, footprint, false, false);
}

}  // namespace gloam

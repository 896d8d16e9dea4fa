#include "render/scene/patterns/tile_baker.h"

#include <array>
#include <cmath>

#include "render/kernel/surface/baked_lookup.h"
#include "render/kernel/surface/shapes.h"
#include "render/scene/patterns/faced_triangle.h"

namespace gloam {
namespace {

constexpr int kMostSamples = (baking::kSide + 1) * (baking::kSide + 1);

int16_t slope(float x) {
  const float t = std::sqrt(min(std::fabs(x) / baking::kSteepest, 1.0f)) * 32767.0f + 0.5f;
  return static_cast<int16_t>(x < 0 ? -std::floor(t) : std::floor(t));
}

/// A texel whose values `wide` encodes in 16 bits and `narrow` in 8.
template <class Wide, class Narrow>
BakedTexel pack(const ProceduralSample& s, Vec2f slopes, Wide wide, Narrow narrow) {
  BakedTexel out;
  out.red = wide(s.base_color.x);
  out.green = wide(s.base_color.y);
  out.blue = wide(s.base_color.z);
  out.roughness = wide(s.roughness);
  out.slope_u = slope(slopes.x);
  out.slope_v = slope(slopes.y);
  out.metallic = narrow(s.metallic);
  out.coat_weight = narrow(s.coat_weight);
  out.fuzz = narrow(s.fuzz);
  out.mask = narrow(s.mask);
  return out;
}

/// A tile's place: corner of its cube along_face() and edge [m].
struct TilePlace {
  int face, table;
  Vec3f low;
  float edge;
};
TilePlace place_of(const PatternSurface& surface, uint64_t key) {
  constexpr uint64_t kMask = (1u << baking::kCubesLog2) - 1u;
  TilePlace out;
  const auto upper = static_cast<uint32_t>(key >> (3 * baking::kCubesLog2));
  out.face = static_cast<int>(upper & 7u);
  out.table = static_cast<int>((upper >> 3) - surface.first_table);
  out.edge = surface.texel * baking::kSide;
  for (int i = 0; i < out.table; ++i) out.edge *= baking::kSide;
  const auto cube = [&](int axis) {
    return static_cast<float>((key >> (static_cast<unsigned>(axis) * baking::kCubesLog2)) & kMask);
  };
  out.low = baking::along_face(surface.low, out.face) + Vec3f{cube(0), cube(1), cube(2)} * out.edge;
  return out;
}

/// The triangle that a sample is taken on.
struct Chosen {
  int triangle = -1;  ///< of the tile's
  float outside = 0, height = 0;
};

/// A triangle's samples are those around each part of it. Of several the nearest is taken, of those
/// above each other the outermost.
void choose_samples(const FacedTriangle& t, int index, const TilePlace& place, int intervals,
                    Chosen* chosen) {
  const float step = place.edge / static_cast<float>(intervals);
  const auto first = [&](float x) {
    return static_cast<int>(clamp(std::floor(x / step), 0.0f, static_cast<float>(intervals)));
  };
  const int i0 = first(t.low.x - place.low.x), i1 = first(t.high.x - place.low.x + step),
            j0 = first(t.low.y - place.low.y), j1 = first(t.high.y - place.low.y + step);
  const float side = (place.face & 1) != 0 ? -1.0f : 1.0f;
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const float u = place.low.x + static_cast<float>(i) * step,
                  v = place.low.y + static_cast<float>(j) * step;
      if (!t.touches(u, v, 1.001f * step)) continue;
      Chosen& best = chosen[j * (intervals + 1) + i];
      const float outside = max(t.outside(u, v), 0.0f), height = side * t.height(u, v);
      const bool nearer = outside < best.outside - 1e-4f * step,
                 equal = outside < best.outside + 1e-4f * step;
      if (best.triangle < 0 || nearer || (equal && height > best.height))
        best = {index, outside, height};
    }
  }
}

/// A normal that leans most to the face's side.
Vec3f towards_face(Vec3f n, int face) {
  if (baking::face_of(n) == face) return n;
  Vec3f along = baking::along_face(n, face);
  const float most = 1.001f * max(std::fabs(along.x), std::fabs(along.y));
  along.z = (face & 1) != 0 ? -most : most;
  return normalize(baking::from_face(along, face));
}

BakedTexel sample_at(const PatternSurface& surface, const FacedTriangle& t, const TilePlace& place,
                     Vec2f uv, float footprint) {
  ProceduralPoint at;
  at.p = baking::from_face({uv.x, uv.y, t.height(uv.x, uv.y)}, place.face);
  at.n = t.n;
  if (surface.is_round()) at.n = snap_to_shape(surface.shape, surface.size, &at.p);
  at.n = towards_face(at.n, place.face);
  at.footprint = footprint;
  if (surface.has_place) at.height = transform_point(surface.X_WG, at.p).z;
  const ProceduralSample s = eval_procedural(*surface.pattern, at);
  // A multiple of the normal changes nothing along the surface: the one that leaves no slope across
  // the tile.
  const Vec3f n = baking::along_face(at.n, place.face);
  const Vec3f g = baking::along_face(s.relief.gradient, place.face);
  const float across = g.z / n.z;
  return pack_texel(s, g.x - n.x * across, g.y - n.y * across);
}

}  // namespace

BakedTexel pack_texel(const ProceduralSample& s, float slope_u, float slope_v) {
  const auto wide = [](float x) {
    return static_cast<uint16_t>(clamp(x, 0.0f, 1.0f) * 65535.0f + 0.5f);
  };
  const auto narrow = [](float x) {
    return static_cast<uint8_t>(clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f);
  };
  return pack(s, {slope_u, slope_v}, wide, narrow);
}

BakedTexel pack_difference(const ProceduralSample& s, float slope_u, float slope_v) {
  const auto wide = [](float x) {
    return static_cast<uint16_t>(std::round(clamp(x, -1.0f, 1.0f) * 32767.0f) + 32767.0f);
  };
  const auto narrow = [](float x) {
    return static_cast<uint8_t>(std::round(clamp(x, -1.0f, 1.0f) * 127.0f) + 127.0f);
  };
  return pack(s, {slope_u, slope_v}, wide, narrow);
}

void bake_tile(const PatternSurface& surface, std::span<const CubeTriangle> triangles,
               BakedTexel* tile) {
  const TilePlace place = place_of(surface, triangles[0].key);
  std::vector<FacedTriangle> faced;
  for (const CubeTriangle& in : triangles)
    faced.push_back(*FacedTriangle::make(surface, in.triangle, place.face));
  for (int level = 0; level < baking::kLevels; ++level) {
    const int intervals = baking::kSide >> level;
    const float step = place.edge / static_cast<float>(intervals);
    std::array<Chosen, kMostSamples> chosen;
    for (size_t i = 0; i < faced.size(); ++i)
      choose_samples(faced[i], static_cast<int>(i), place, intervals, chosen.data());
    for (int row = 0; row <= intervals; ++row) {
      for (int column = 0; column <= intervals; ++column, ++tile) {
        const int triangle = chosen[static_cast<size_t>(row * (intervals + 1) + column)].triangle;
        if (triangle < 0) continue;
        const Vec2f uv{place.low.x + static_cast<float>(column) * step,
                       place.low.y + static_cast<float>(row) * step};
        *tile = sample_at(surface, faced[static_cast<size_t>(triangle)], place, uv,
                          kBakedFootprint * step);
      }
    }
  }
}

}  // namespace gloam

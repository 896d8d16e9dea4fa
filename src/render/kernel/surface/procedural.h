#pragma once
// Procedural materials by kind. To add one: a function in a header of procedural/, a line in
// of_kind and, for its usual look, a case in world/materials/procedural_description.cc.
// Device-safe.
//
// A sample is the mean over a square of `footprint` on the surface: details fade as they become
// smaller than it, thresholds widen by what their noise lost, joints are integrated. Heights are
// continuous except at borders between boards (and where the projection changes axis); they come
// with the exact gradient of what is left of them, so bumps fade as colours do.

#include "render/kernel/procedural/fabric.h"
#include "render/kernel/procedural/masonry.h"
#include "render/kernel/procedural/stone.h"
#include "render/kernel/procedural/wear.h"
#include "render/kernel/procedural/wood.h"

namespace gloam {

/// Noise between color_a and color_b with cells of `scale`, `depth` high.
GLOAM_HD ProceduralSample procedural_noise(const ProceduralDescription& d,
                                           const ProceduralPoint& at) {
  const float f = 1.0f / d.scale;
  Field n;
  switch (d.basis) {
    case NoiseBasis::kFbm:
      n = fbm(at.p, f, 5, 0.5f, at.footprint, d.seed).field * 0.2f + 0.5f;
      break;
    case NoiseBasis::kTurbulence:
      n = turbulence(at.p, f, 5, 0.5f, at.footprint, d.seed) * 0.5f;
      break;
    case NoiseBasis::kRidged:
      n = ridged(at.p, f, 5, 0.5f, at.footprint, d.seed);
      break;
    case NoiseBasis::kCells: {
      const float left = patterns::detail_left(at.footprint, 1.5f * d.scale);
      n.value = 0.521f * (1.0f - left);
      if (left > 0) {
        const CellularNoise cells = cellular_noise(turn_noise_axes(at.p * f), d.seed);
        n = n +
            Field{cells.f1, turn_noise_axes_back(cells.to_f1) * (f / max(cells.f1, 1e-6f))} * left;
      }
      break;
    }
  }
  ProceduralSample s;
  s.base_color = lerp(d.color_a, d.color_b, clamp(n.value, 0.0f, 1.0f));
  s.roughness = d.roughness;
  s.metallic = d.metallic;
  s.coat_weight = d.coat;
  s.coat_roughness = d.coat_roughness;
  s.relief = n * d.depth;
  return s;
}

namespace procedurals {

GLOAM_HD ProceduralSample of_kind(const ProceduralDescription& d, const ProceduralPoint& at) {
  switch (d.kind) {
    case ProceduralKind::kNoise:
      return procedural_noise(d, at);
    case ProceduralKind::kWood:
      return procedural_wood(d, at);
    case ProceduralKind::kMarble:
      return procedural_marble(d, at);
    case ProceduralKind::kConcrete:
      return procedural_concrete(d, at);
    case ProceduralKind::kBrick:
      return procedural_brick(d, at);
    case ProceduralKind::kTiles:
      return procedural_tiles(d, at);
    case ProceduralKind::kFabric:
      return procedural_fabric(d, at);
    case ProceduralKind::kScratches:
      return procedural_scratches(d, at);
    case ProceduralKind::kDirt:
      return procedural_dirt(d, at);
  }
  return {};
}

}  // namespace procedurals

/// Places beyond 1000 km, and what is no number, are brought back to there; a normal that is none
/// counts as +z. Colours, roughness and weights are in [0, 1].
GLOAM_HD ProceduralSample eval_procedural(const ProceduralDescription& d, ProceduralPoint at) {
  constexpr float kFar = 1e6f;
  at.p = {clamp(at.p.x, -kFar, kFar), clamp(at.p.y, -kFar, kFar), clamp(at.p.z, -kFar, kFar)};
  at.footprint = clamp(at.footprint, 0.0f, kFar);
  const float n2 = dot(at.n, at.n);
  if (!(n2 > 1e-6f && n2 < 1e6f)) at.n = {0, 0, 1};
  ProceduralSample s = procedurals::of_kind(d, at);
  const auto unit = [](float x) { return clamp(x, 0.0f, 1.0f); };
  s.base_color = {unit(s.base_color.x), unit(s.base_color.y), unit(s.base_color.z)};
  s.roughness = unit(s.roughness);
  s.mask = unit(s.mask);
  return s;
}

/// Unit normal of the surface with normal n (unit) under its relief.
GLOAM_HD Vec3f bumped_normal(Vec3f n, const Field& relief) {
  return normalize(n - patterns::in_surface(relief.gradient, n));
}

}  // namespace gloam

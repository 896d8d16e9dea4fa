// Baked patterns are what the formulas say, on every shape, at every footprint and for every kind.

#include <gtest/gtest.h>

#include "render/kernel/surface/baked_lookup.h"
#include "render/scene/patterns/pattern_store.h"
#include "render/test/probe.h"
#include "render/test/procedural_cases.h"

namespace gloam {
namespace {

/// A shape with one pattern, at the origin.
struct Patterned {
  Patterned(const ProceduralDescription& d, ShapeType shape, Vec3f size, int mesh_rings = 0) {
    MaterialDescription m;
    m.pattern = 0;
    scene.description.procedurals.push_back(d);
    const int material = scene.add_material(m);
    const int mesh = mesh_rings > 0 ? scene.add_mesh(make_ball(mesh_rings)) : -1;
    scene.add(shape, size, {}, material, 0, mesh);
  }
  PatternStore bake() const { return PatternStore::make(scene.description, scene.frame); }

  SceneBuilder scene;
};

/// Error of baked samples: root mean square over places, and of the formula's spread about its mean
/// there.
struct Errors {
  double albedo = 0, roughness = 0, slope = 0;
  double albedo_spread = 0, roughness_spread = 0, slope_spread = 0;
};

Vec3f unit_place(int i) {
  const RandomStream stream{7, stream_id("places")};
  const Philox4 d = stream.draw(0, static_cast<uint32_t>(i));
  return {uniform_float(d.v[0]), uniform_float(d.v[1]), uniform_float(d.v[2])};
}

/// Over places on the shape: `place` gives the i-th and its normal.
template <class Place>
Errors errors_of(const PatternStore& store, const ProceduralDescription& d, float footprint,
                 const Place& place) {
  constexpr int kPlaces = 400;
  const BakedView view = store.view();
  std::vector<ProceduralSample> exact;
  Vec3f mean, mean_slope;
  float mean_roughness = 0;
  Errors out;
  for (int i = 0; i < kPlaces; ++i) {
    ProceduralPoint at;
    at.p = place(i, &at.n);
    at.height = at.p.z;
    at.footprint = footprint;
    const ProceduralSample a = eval_procedural(d, at), b = baked_sample(view, 0, at);
    const Vec3f slope_a = patterns::in_surface(a.relief.gradient, at.n),
                slope_b = patterns::in_surface(b.relief.gradient, at.n);
    out.albedo += length_squared(a.base_color - b.base_color) / (3 * kPlaces);
    out.roughness += sqr(a.roughness - b.roughness) / kPlaces;
    out.slope += length_squared(slope_a - slope_b) / kPlaces;
    mean += a.base_color * (1.0f / kPlaces);
    mean_slope += slope_a * (1.0f / kPlaces);
    mean_roughness += a.roughness / kPlaces;
    exact.push_back(a);
  }
  for (const ProceduralSample& a : exact) {
    out.albedo_spread += length_squared(a.base_color - mean) / (3 * kPlaces);
    out.roughness_spread += sqr(a.roughness - mean_roughness) / kPlaces;
    out.slope_spread += length_squared(a.relief.gradient - mean_slope) / kPlaces;
  }
  for (double* x : {&out.albedo, &out.roughness, &out.slope, &out.albedo_spread,
                    &out.roughness_spread, &out.slope_spread})
    *x = std::sqrt(*x);
  return out;
}

Vec3f on_box(Vec3f half, int i, Vec3f* n) {
  Vec3f p = (unit_place(i) * 2.0f - Vec3f{1, 1, 1}) * half;
  const float side = i % 2 == 0 ? 1.0f : -1.0f;
  *n = i % 3 == 0 ? Vec3f{side, 0, 0} : (i % 3 == 1 ? Vec3f{0, side, 0} : Vec3f{0, 0, side});
  if (i % 3 == 0) p.x = side * half.x;
  if (i % 3 == 1) p.y = side * half.y;
  if (i % 3 == 2) p.z = side * half.z;
  return p;
}

/// Errors on a box at a footprint, with texels of a width.
Errors errors_on_box(const ProceduralDescription& d, Vec3f half, float texel, float footprint) {
  Patterned patterned(d, ShapeType::kBox, half);
  patterned.scene.description.pattern_baking.metres_per_texel = texel;
  const PatternStore store = patterned.bake();
  return errors_of(store, d, footprint, [&](int i, Vec3f* n) { return on_box(half, i, n); });
}

TEST(BakedPattern, IsTheFormulaForEveryKind) {
  for (const ProceduralCase& c : procedural_cases()) {
    SCOPED_TRACE(c.name);
    const float footprint = 0.2f * c.unit;
    const Vec3f half{8 * footprint, 6 * footprint, 4 * footprint};
    const Errors e = errors_on_box(c.d, half, 0.25f * footprint, footprint);
    EXPECT_LT(e.albedo, 0.25 * e.albedo_spread + 1e-3);
    EXPECT_LT(e.slope, 0.35 * e.slope_spread + 2e-3);
    EXPECT_LT(e.roughness, 0.25 * e.roughness_spread + 1e-3);
  }
}

}  // namespace
}  // namespace gloam

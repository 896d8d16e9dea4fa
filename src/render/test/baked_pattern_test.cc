// Baked patterns are what the formulas say, on every shape, at every footprint and for every kind.

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/rng.h"
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
  double mean = 0, baked_spread = 0;  ///< of the albedo: error of its mean, spread of the baked
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
  std::vector<ProceduralSample> exact, baked;
  Vec3f mean, mean_slope, baked_mean;
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
    baked_mean += b.base_color * (1.0f / kPlaces);
    exact.push_back(a);
    baked.push_back(b);
  }
  for (const ProceduralSample& a : exact) {
    out.albedo_spread += length_squared(a.base_color - mean) / (3 * kPlaces);
    out.roughness_spread += sqr(a.roughness - mean_roughness) / kPlaces;
    out.slope_spread += length_squared(a.relief.gradient - mean_slope) / kPlaces;
  }
  for (const ProceduralSample& b : baked)
    out.baked_spread += length_squared(b.base_color - baked_mean) / (3 * kPlaces);
  out.mean = length(baked_mean - mean);
  for (double* x : {&out.albedo, &out.baked_spread, &out.roughness, &out.slope, &out.albedo_spread,
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

/// A square of `half`, facing up.
Vec3f on_top(float half, int i, Vec3f* n) {
  *n = {0, 0, 1};
  const Vec3f p = (unit_place(i) * 2.0f - Vec3f{1, 1, 1}) * half;
  return {p.x, p.y, 0};
}

/// Errors on a square of eight details, with `texels` to a detail, at the footprint that they show.
Errors errors_on_square(const ProceduralCase& c, float texels) {
  const float detail = min(c.unit, 0.05f), half = 4 * detail, texel = detail / texels;
  Patterned patterned(c.d, ShapeType::kPlane, {half, half, 1});
  patterned.scene.description.pattern_baking.metres_per_texel = texel;
  const PatternStore store = patterned.bake();
  return errors_of(store, c.d, 1.6f * texel, [&](int i, Vec3f* n) { return on_top(half, i, n); });
}

TEST(BakedPattern, NearsTheFormulaForEveryKind) {
  for (const ProceduralCase& c : procedural_cases()) {
    SCOPED_TRACE(c.name);
    const Errors coarse = errors_on_square(c, 10), fine = errors_on_square(c, 40);
    EXPECT_LT(fine.albedo, 0.25 * fine.albedo_spread + 1e-3);
    EXPECT_LT(fine.albedo, max(coarse.albedo, 1e-3));
    EXPECT_LT(fine.roughness, 0.25 * fine.roughness_spread + 1e-3);
    EXPECT_LT(fine.slope, 0.6 * fine.slope_spread + 1e-3);
  }
}

TEST(BakedPattern, SidesOfABoxEachHaveTheirOwn) {
  for (const ProceduralCase& c : procedural_cases()) {
    SCOPED_TRACE(c.name);
    const float texel = 0.05f * c.unit;
    const Vec3f half{2 * c.unit, 1.5f * c.unit, c.unit};
    Patterned patterned(c.d, ShapeType::kBox, half);
    patterned.scene.description.pattern_baking.metres_per_texel = texel;
    const PatternStore store = patterned.bake();
    const Errors e =
        errors_of(store, c.d, 1.6f * texel, [&](int i, Vec3f* n) { return on_box(half, i, n); });
    EXPECT_LT(e.albedo, 0.4 * e.albedo_spread + 1e-3);
  }
}

TEST(BakedPattern, WhereMemoryIsShortDetailRepeats) {
  for (const ProceduralCase& c : procedural_cases()) {
    if (c.d.kind == ProceduralKind::kDirt) continue;  // its spread depends on heights
    SCOPED_TRACE(c.name);
    const float footprint = 0.3f * c.unit, half = 200 * c.unit;
    Patterned patterned(c.d, ShapeType::kPlane, {half, half, 1});
    PatternBaking& baking = patterned.scene.description.pattern_baking;
    baking.metres_per_texel = 0.05f * c.unit;
    baking.most_bytes = 2 << 20;
    const PatternStore store = patterned.bake();
    const Errors e =
        errors_of(store, c.d, footprint, [&](int i, Vec3f* n) { return on_top(half, i, n); });
    EXPECT_LT(e.mean, 0.2 * e.albedo_spread + 2e-3);
    // A map has few units, whose spread is not quite the pattern's.
    EXPECT_NEAR(e.baked_spread, e.albedo_spread, 0.45 * e.albedo_spread + 2e-3);
  }
}

TEST(BakedPattern, RoundShapesAndMeshesHaveTilesEverywhere) {
  ProceduralDescription d = default_procedural(ProceduralKind::kMarble);
  const auto check = [&](const Patterned& patterned, const auto& place) {
    const PatternStore store = patterned.bake();
    const Errors e = errors_of(store, d, 0.01f, place);
    EXPECT_LT(e.albedo, 0.25 * e.albedo_spread);
  };
  for (const ShapeType shape :
       {ShapeType::kSphere, ShapeType::kEllipsoid, ShapeType::kCapsule, ShapeType::kCylinder}) {
    const Vec3f size{0.06f, 0.08f, 0.05f};
    SCOPED_TRACE(static_cast<int>(shape));
    check(Patterned(d, shape, size), [&](int i, Vec3f* n) {
      Vec3f p = (unit_place(i) * 2.0f - Vec3f{1, 1, 1}) * Vec3f{0.06f, 0.06f, 0.08f};
      *n = snap_to_shape(shape, size, &p);
      return p;
    });
  }
  SCOPED_TRACE("mesh");
  const TriangleMesh ball = make_ball(20);
  Patterned mesh(d, ShapeType::kMesh, {}, 20);
  mesh.scene.description.pattern_baking.metres_per_texel = 0.01f;
  check(mesh, [&](int i, Vec3f* n) {
    const Vec3f random = unit_place(i);
    const auto triangle = static_cast<size_t>(random.x * static_cast<float>(ball.triangle_count()));
    const Vec3f a = ball.positions[ball.indices[3 * triangle]],
                b = ball.positions[ball.indices[3 * triangle + 1]],
                c = ball.positions[ball.indices[3 * triangle + 2]];
    *n = normalize(cross(b - a, c - a));
    const float u = random.y, v = random.z * (1 - u);
    return a * (1 - u - v) + b * u + c * v;
  });
}

TEST(BakedPattern, IsTheSameForAnyNumberOfThreads) {
  const Patterned patterned(default_procedural(ProceduralKind::kBrick), ShapeType::kBox,
                            {0.4f, 0.1f, 0.2f});
  const auto bytes = [&](int threads) {
    set_thread_count(threads);
    const PatternStore store = patterned.bake();
    const DeviceSpan<const BakedTexel> texels = store.view().texels;
    const auto* begin = reinterpret_cast<const uint8_t*>(texels.data);
    return std::vector<uint8_t>(begin, begin + texels.size * sizeof(BakedTexel));
  };
  const std::vector<uint8_t> one = bytes(1), four = bytes(4);
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(BakedPattern, PicturesAreAsByFormula) {
  ProceduralDescription d = default_procedural(ProceduralKind::kBrick);
  Patterned patterned(d, ShapeType::kBox, {0.6f, 0.4f, 0.5f});
  patterned.scene.description.sky.ambient = {1000, 1000, 1000};
  const CameraView view = SceneBuilder::camera(look_at({1.5f, 1.2f, 1}, {0, 0, 0}), 48, 36);
  const Film baked = patterned.scene.render(view, settings_of(8, 2));
  patterned.scene.description.pattern_baking.by_formula = true;
  const Film formula = patterned.scene.render(view, settings_of(8, 2));
  Vec3f sum, difference;
  for (size_t i = 0; i < baked.radiance.size(); ++i) {
    sum += formula.radiance[i];
    const Vec3f d_i = baked.radiance[i] - formula.radiance[i];
    difference += {std::fabs(d_i.x), std::fabs(d_i.y), std::fabs(d_i.z)};
  }
  EXPECT_GT(luminance(difference), 0);
  EXPECT_LT(luminance(difference), 0.08f * luminance(sum));
}

}  // namespace
}  // namespace gloam

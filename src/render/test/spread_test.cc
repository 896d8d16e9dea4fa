// Noise reduction by evenly spread sample points: noise of 16 samples against that of as many
// independent ones.

#include <gtest/gtest.h>

#include "render/test/panel.h"
#include "render/test/probe.h"

namespace gloam {
namespace {

/// Mean over pixels of the squared error of `count` samples' mean of estimate(sampler).
template <class Estimate>
double squared_error(double expected, int count, int log2_samples, const Estimate& estimate) {
  Mean error;
  for (uint32_t pixel = 0; pixel < 4096; ++pixel) {
    Mean mean;
    for (int i = 0; i < count; ++i) {
      mean.add(estimate(Sampler::make(5, 0, pixel & 63, pixel >> 6, static_cast<uint32_t>(i),
                                      static_cast<uint32_t>(log2_samples))));
    }
    error.add((mean.mean - expected) * (mean.mean - expected));
  }
  return error.mean;
}

/// Errors of one sample and of 16 of the estimate, the latter times 16: as many if samples are
/// independent.
template <class Estimate>
double share_of_independent(const Estimate& estimate) {
  Mean mean;
  for (uint32_t i = 0; i < 1u << 18; ++i)
    mean.add(estimate(Sampler::make(5, 1, i & 511, i >> 9, 0, 0)));
  return 16 * squared_error(mean.mean, 16, 4, estimate) / squared_error(mean.mean, 1, 0, estimate);
}

/// Light on a floor from a panel of two triangles and from the box beside it, whose choice, face
/// and place are drawn together.
TEST(Spread, OnePointOnSeveralLightsIsSpreadOverEachOfThem) {
  SceneBuilder b;
  const int mesh = b.add_mesh(make_panel());
  b.add(ShapeType::kMesh, {}, translation({0, 0, 1}), add_panel_material(&b, true), 0, mesh);
  b.add(ShapeType::kBox, {0.1f, 0.2f, 0.1f}, translation({0.9f, 0, 1}),
        b.add_emitter({60, 60, 60}));
  const Probe probe(b);
  const Vec3f p{0.2f, 0.1f, 0}, n{0, 0, 1};
  LightSampler light_sampler;
  light_sampler.prepare(probe.view, p, n);
  const double share = share_of_independent([&](Sampler sampler) {
    const LightSample s = light_sampler.sample(probe.view, p, sampler.next_2d(), 0);
    return s.pdf > 0 ? static_cast<double>(luminance(s.radiance) * max(s.wi.z, 0.0f) / s.pdf) : 0.0;
  });
  EXPECT_LT(share, 0.2);
}

/// A cosine-weighted direction meets a window that covers a part of the hemisphere.
TEST(Spread, DirectionsFindAWindowAboutAsOftenAsItIsWide) {
  const double share = share_of_independent([&](Sampler sampler) {
    const Vec3f d = sample_cosine_hemisphere(sampler.next_2d());
    return d.x > 0.1f && d.x < 0.7f && d.y > -0.4f && d.y < 0.5f ? 1.0 : 0.0;
  });
  EXPECT_LT(share, 0.3);
}

/// Also the draws of late vertices.
TEST(Spread, LateDrawsAreSpreadToo) {
  const double share = share_of_independent([](Sampler sampler) {
    for (int i = 0; i < 20; ++i) sampler.next_1d();
    const Vec2f u = sampler.next_2d();
    return static_cast<double>(u.x * u.y);
  });
  EXPECT_LT(share, 0.05);
}

/// A dim room's deep reflections count as much against its picture as a bright one's.
TEST(Spread, RouletteMakesLittleNoiseWhereTheFirstSurfaceIsDark) {
  const auto variance = [](int roulette_depth) {
    SceneBuilder b;
    const int walls = b.add_diffuse({0.8f, 0.8f, 0.8f}), dark = b.add_diffuse({0.1f, 0.1f, 0.1f});
    for (int k = 0; k < 6; ++k) {
      const Vec3f axis{k / 2 == 0 ? 1.0f : 0.0f, k / 2 == 1 ? 1.0f : 0.0f,
                       k / 2 == 2 ? 1.0f : 0.0f};
      const Vec3f p = axis * (k % 2 == 0 ? 1.05f : -1.05f), size = Vec3f{1, 1, 1} - axis * 0.95f;
      b.add(ShapeType::kBox, size, translation(p), k == 5 ? dark : walls);
    }
    b.add(ShapeType::kSphere, {0.2f, 0, 0}, translation({0, 0, 0.6f}), b.add_emitter({9, 9, 9}));
    RenderSettings settings = settings_of(32, 8);
    settings.roulette_depth = roulette_depth;
    const CameraView view = SceneBuilder::camera(look_at({-0.6f, 0, 0}, {0.2f, 0, -1}), 32, 24);
    double sum = 0;
    for (const Vec3f v : b.render(view, settings).variance) sum += static_cast<double>(v.y);
    return sum;
  };
  EXPECT_LT(variance(2), 1.3 * variance(100));
}

}  // namespace
}  // namespace gloam

// Transmittance, free paths and marching against closed forms and quadrature.

#include <gtest/gtest.h>

#include "render/test/media_probe.h"

namespace gloam {
namespace {

/// Length of the segment [0, tmax] inside the box, in double precision.
double length_in_box(const VolumeDescription& v, const Ray& ray, double tmax) {
  const Vec3f axes[3] = {v.X_WV.x, v.X_WV.y, v.X_WV.z};
  double begin = 0, end = tmax;
  for (int a = 0; a < 3; ++a) {
    const auto along = [&](Vec3f w) {
      return double(w.x) * axes[a].x + double(w.y) * axes[a].y + double(w.z) * axes[a].z;
    };
    const double o = along(ray.o - v.X_WV.p), d = along(ray.d), h = 0.5 * v.size[a];
    if (std::abs(d) < 1e-12) {
      if (std::abs(o) > h) return 0;
      continue;
    }
    begin = std::max(begin, std::min((-h - o) / d, (h - o) / d));
    end = std::min(end, std::max((-h - o) / d, (h - o) / d));
  }
  return std::max(0.0, end - begin);
}

const Vec3f kNothing{};
Vec3f no_source(const MarchStep&) { return kNothing; }

struct RayCase {
  const char* name;
  Ray ray;
  float tmax;
};
std::vector<RayCase> ray_cases() {
  return {{"along an axis", make_ray({-3, 0.1f, 0.05f}, {1, 0, 0}), 1e30f},
          {"against an axis", make_ray({0.2f, 0.1f, 5}, {0, 0, -1}), 1e30f},
          {"oblique", make_ray({-2, -1.5f, 1}, {1.1f, 0.9f, -0.55f}), 1e30f},
          {"from inside", make_ray({0.1f, 0.05f, 0}, {0.3f, -1, 0.2f}), 1e30f},
          {"ends inside", make_ray({-3, 0, 0}, {1, 0.05f, 0.02f}), 2.9f},
          {"ends before", make_ray({-3, 0, 0}, {1, 0, 0}), 1.2f},
          {"starts behind", make_ray({3, 0, 0}, {1, 0, 0}), 1e30f},
          {"misses", make_ray({-3, 2, 0}, {1, 0, 0}), 1e30f},
          {"zero length", make_ray({0, 0, 0}, {1, 0, 0}), 0.0f},
          {"of tiny length", make_ray({0, 0, 0}, {1, 1, 0}), 1e-6f}};
}

TEST(Medium, EvenMediaFollowBeerLambertExactly) {
  for (const bool is_turned : {false, true}) {
    MediaBuilder b;
    const Vec3f k{1.5f, 0.8f, 0.2f};
    VolumeDescription& box =
        b.add_box({2, 1, 0.6f}, {0.1f, 0, 0}, 0.9f, b.add_medium(k, {0.5f, 0.9f, 1}));
    if (is_turned) box.X_WV = rigid(normalize(Vec3f{1, 2, 0.5f}), 0.7f, {0.1f, 0, 0});
    const VolumeStore store = b.build();
    for (const RayCase& c : ray_cases()) {
      const double length = length_in_box(box, c.ray, c.tmax);
      Sampler sampler = draw(3);
      const Vec3f T = transmittance(store.view(), c.ray, c.tmax, {}, &sampler);
      const MarchResult m = march(store.view(), c.ray, c.tmax, 10.0f, 1, {}, true, no_source);
      for (int i = 0; i < 3; ++i) {
        const double expected = std::exp(-double(k[i]) * 0.9 * length);
        EXPECT_NEAR(T[i], expected, 2e-6) << c.name << ", band " << i;
        EXPECT_NEAR(m.transmittance[i], expected, 2e-6) << c.name << ", marched, band " << i;
      }
      EXPECT_EQ(transmittance(store.view(), c.ray, c.tmax, {}, &sampler), T)
          << c.name << ": exact, so without noise";
      EXPECT_EQ(meets_media(store.view(), c.ray, c.tmax), length > 0) << c.name;
      const Bands lidar = Bands::only(MediumBand::k1550nm);
      EXPECT_NEAR(transmittance(store.view(), c.ray, c.tmax, lidar, &sampler).x,
                  std::exp(-1.5 * 3 * 0.9 * length), 2e-6)
          << c.name << ", 1550 nm";
    }
  }
}

TEST(Medium, GridOfEqualValuesIsAnEvenMedium) {
  MediaBuilder even, grid;
  for (MediaBuilder* b : {&even, &grid}) {
    VolumeDescription& v =
        b->add_box({2, 1, 0.6f}, {0.1f, 0, 0}, 0.9f, b->add_medium({4, 2.5f, 1}, {0.5f, 0.9f, 1}));
    v.X_WV = rigid(normalize(Vec3f{1, 2, 0.5f}), 0.7f, {0.1f, 0, 0});
    if (b == &even) continue;
    v.nx = 37;
    v.ny = 20;
    v.nz = 9;
    v.density = grid_of(std::vector<float>(37 * 20 * 9, 0.9f));
    v.even_density = 0;
  }
  const VolumeStore a = even.build(), b = grid.build();
  int scattered = 0;
  for (const RayCase& c : ray_cases()) {
    for (uint32_t i = 0; i < 200; ++i) {
      Sampler s = draw(i), r = draw(i);
      const Vec3f S = transmittance(a.view(), c.ray, c.tmax, {}, &s);
      const Vec3f R = transmittance(b.view(), c.ray, c.tmax, {}, &r);
      EXPECT_LT(length(S - R), 1e-5f) << c.name;
      s = draw(i), r = draw(i);
      const MediumEvent e = sample_distance(a.view(), c.ray, c.tmax, {}, {1, 1, 1}, &s);
      const MediumEvent f = sample_distance(b.view(), c.ray, c.tmax, {}, {1, 1, 1}, &r);
      if (e.volume != f.volume) continue;  // the exit is a rounding away
      EXPECT_NEAR(e.t, f.t, 1e-5f * (1 + e.t)) << c.name;
      EXPECT_LT(length(e.weight - f.weight), 1e-4f) << c.name;
      scattered += e.volume >= 0 ? 1 : 0;
    }
  }
  EXPECT_GT(scattered, 500);
}

/// Three volumes that overlap: two grids, one of which glows, and fog around them.
MediaBuilder three_volumes() {
  MediaBuilder b;
  VolumeDescription noise = make_noise_volume(40, 24, 30, 1.5f, 5);
  noise.size = {1.6f, 1.1f, 1.3f};
  noise.X_WV = rigid(normalize(Vec3f{0.3f, 1, 0.4f}), 0.5f, {0.2f, 0.1f, 0});
  b.add(noise, b.add_medium({6, 3, 1}, {0.9f, 0.6f, 0.3f}, {0.6f, 0.6f, 0.6f}));
  VolumeDescription plume = make_plume(48, 0.8f, 3500);
  plume.X_WV.p = {-0.1f, 0, 0.2f};
  plume.fade = 0.1f;
  b.add(plume, b.add_medium({5, 6, 8}, {0.2f, 0.3f, 0.4f}, {}, 1));
  b.add_box({3, 2, 2}, {0, 0, 0}, 0.02f, b.add_medium({10, 14, 20}, {1, 1, 1}, {0.3f, 0, -0.3f}));
  return b;
}
std::vector<RayCase> rays_through() {
  return {{"across", make_ray({-2, 0.05f, 0}, {1, 0.02f, 0.03f}), 4},
          {"through the flame", make_ray({-2, 0.02f, -0.55f}, {1, 0.01f, 0.05f}), 4},
          {"up the plume", make_ray({-0.12f, 0.03f, -0.9f}, {0.02f, 0, 1}), 1.9f},
          {"oblique", make_ray({1.2f, 0.9f, 0.9f}, {-1, -0.8f, -0.9f}), 1e30f},
          {"short, inside", make_ray({0.2f, 0, 0}, {0, 0.5f, 1}), 0.3f}};
}

/// Difference in standard errors, forgiving the quadrature's own and shares of light of which some
/// ten thousand rays see too little for their mean to be normally distributed.
double z_of(const Mean& m, double expected) {
  constexpr double kRare = 1e-5;
  const double gap = std::max(0.0, std::abs(m.mean - expected) - 2e-5 * std::abs(expected) - kRare);
  return gap == 0 ? 0 : gap / (m.standard_error() + 1e-12);
}

TEST(Medium, TransmittanceOfOverlappingGridsIsUnbiased) {
  const VolumeStore store = three_volumes().build();
  const Bands all[] = {{}, Bands::only(MediumBand::k905nm)};
  for (const RayCase& c : rays_through()) {
    for (const Bands bands : all) {
      const RaySums expected = integrate_ray(store.view(), c.ray, min(c.tmax, 5), bands);
      Mean mean[3];
      for (uint32_t i = 0; i < 60000; ++i) {
        Sampler s = independent(i);
        const Vec3f T = transmittance(store.view(), c.ray, c.tmax, bands, &s);
        for (int k = 0; k < 3; ++k) mean[k].add(T[k]);
      }
      for (int k = 0; k < 3; ++k) {
        EXPECT_LT(z_of(mean[k], expected.transmittance[k]), 4.5)
            << c.name << ", band " << k << ": " << mean[k].mean << " for "
            << expected.transmittance[k];
        EXPECT_LT(mean[k].standard_error(), 0.004) << c.name;
      }
    }
  }
}

TEST(Medium, FreePathsAreUnbiasedPerBand) {
  const VolumeStore store = three_volumes().build();
  int glowing = 0;
  for (const Vec3f throughput : {Vec3f{1, 1, 1}, Vec3f{0.2f, 1, 3}}) {
    for (const RayCase& c : rays_through()) {
      const RaySums expected = integrate_ray(store.view(), c.ray, min(c.tmax, 5));
      ASSERT_GT(expected.scattered[1], 0.1) << c.name;
      glowing += expected.emission[1] > 1 ? 1 : 0;
      const Vec3f shares = band_probabilities(throughput);
      Mean passed[3], scattered[3], emission[3];
      for (uint32_t i = 0; i < 60000; ++i) {
        Sampler s = independent(i, 1);
        const MediumEvent e = sample_distance(store.view(), c.ray, c.tmax, {}, throughput, &s);
        EXPECT_LT(dot(shares, e.weight), 1.0001f);
        for (int k = 0; k < 3; ++k) {
          passed[k].add(e.volume < 0 ? e.weight[k] : 0);
          scattered[k].add(e.volume < 0 ? 0 : e.weight[k]);
          emission[k].add(e.emission[k]);
        }
      }
      for (int k = 0; k < 3; ++k) {
        EXPECT_LT(z_of(passed[k], expected.transmittance[k]), 4.5)
            << c.name << " passes, band " << k << ": " << passed[k].mean << " for "
            << expected.transmittance[k];
        EXPECT_LT(z_of(scattered[k], expected.scattered[k]), 4.5)
            << c.name << " scatters, band " << k << ": " << scattered[k].mean << " for "
            << expected.scattered[k];
        EXPECT_LT(z_of(emission[k], expected.emission[k]), 4.5)
            << c.name << " glows, band " << k << ": " << emission[k].mean << " for "
            << expected.emission[k];
      }
    }
  }
  EXPECT_GE(glowing, 4) << "there is something to see";
}

TEST(Medium, FreePathsFollowTheirDensity) {
  MediaBuilder b = three_volumes();
  for (MediumDescription& m : b.media) {  // grey: every weight is the albedo
    m.mass_extinction.fill(m.mass_extinction[0]);
    m.albedo.fill(1);
  }
  const VolumeStore store = b.build();
  const Ray ray = make_ray({-1.6f, 0.05f, 0}, {1, 0.02f, 0.03f});
  constexpr int kBins = 64, kDraws = 100000;
  constexpr float kFar = 3.2f;
  std::vector<double> expected(kBins + 1), observed(kBins + 1);
  double before = 1;
  for (int i = 0; i < kBins; ++i) {
    const double after = integrate_ray(store.view(), ray, kFar * (i + 1) / kBins, {}, 500 * (i + 1))
                             .transmittance[0];
    expected[i] = (before - after) * kDraws;
    before = after;
  }
  expected[kBins] = before * kDraws;
  for (uint32_t i = 0; i < kDraws; ++i) {
    Sampler s = independent(i, 2);
    const MediumEvent e = sample_distance(store.view(), ray, kFar, {}, {1, 1, 1}, &s);
    EXPECT_NEAR(e.weight.x, 1, 1e-4);
    ++observed[e.volume < 0 ? kBins : std::min(kBins - 1, static_cast<int>(e.t / kFar * kBins))];
  }
  double chi2 = 0;
  int bins = 0;
  for (int i = 0; i <= kBins; ++i) {
    if (expected[i] < 20) continue;
    chi2 += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
    ++bins;
  }
  EXPECT_GT(bins, 40);
  EXPECT_LT(chi2, bins + 4.5 * std::sqrt(2.0 * bins)) << "over " << bins << " bins";
}

TEST(Medium, MarchingConvergesToTheQuadrature) {
  const VolumeStore store = three_volumes().build();
  for (const RayCase& c : rays_through()) {
    const RaySums expected = integrate_ray(store.view(), c.ray, min(c.tmax, 5));
    const MarchResult m =
        march(store.view(), c.ray, c.tmax, 0.05f, 1000, {}, true,
              [](const MarchStep& step) { return step.medium.scattering * 100.0f; });
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(m.transmittance[k], expected.transmittance[k],
                  0.02 * expected.transmittance[k] + 1e-3)
          << c.name << ", band " << k;
      const double radiance = 100 * expected.scattered[k] + expected.emission[k];
      EXPECT_NEAR(m.radiance[k], radiance, 0.02 * radiance) << c.name << ", band " << k;
    }
  }
}

TEST(Medium, MarchTakesAboutTheStepsItIsAllowed) {
  const VolumeStore store = three_volumes().build();
  for (const int max_steps : {1, 8, 100}) {
    int steps = 0;
    march(store.view(), rays_through()[0].ray, 4, 1e-4f, max_steps, {}, true,
          [&](const MarchStep&) {
            ++steps;
            return Vec3f{};
          });
    EXPECT_LE(steps, max_steps + 40) << "cells on the way may end a step";
    EXPECT_GE(steps, max_steps / 2);
  }
}

TEST(Medium, WalksFromFarAwayEnd) {
  MediaBuilder b;
  VolumeDescription v;
  v.name = "speck";  // one thick voxel in a cell that is empty else
  v.nx = v.ny = v.nz = 8;
  std::vector<float> values(512);
  values[0] = 1;
  v.density = grid_of(values);
  b.add(v, b.add_medium({2e4f, 2e4f, 1e4f}, {1, 1, 1}));
  const VolumeStore store = b.build();
  for (uint32_t i = 0; i < 50; ++i) {
    Sampler s = draw(i);
    const Ray ray = make_ray({-1e5f, 0.1f, 0.2f}, {1, 0, 0});
    EXPECT_EQ(transmittance(store.view(), ray, 1e30f, {}, &s), (Vec3f{1, 1, 1}));
    EXPECT_EQ(sample_distance(store.view(), ray, 1e30f, {}, {1, 1, 1}, &s).volume, -1);
  }
}

TEST(Medium, SameDrawsSameAnswers) {
  const VolumeStore one = three_volumes().build();
  set_thread_count(1);
  const VolumeStore two = three_volumes().build();
  set_thread_count(0);
  const Ray ray = rays_through()[0].ray;
  for (uint32_t i = 0; i < 500; ++i) {
    Sampler s = draw(i), r = draw(i);
    EXPECT_EQ(transmittance(one.view(), ray, 4, {}, &s), transmittance(two.view(), ray, 4, {}, &r));
    const MediumEvent e = sample_distance(one.view(), ray, 4, {}, {1, 1, 1}, &s);
    const MediumEvent f = sample_distance(two.view(), ray, 4, {}, {1, 1, 1}, &r);
    EXPECT_EQ(e.t, f.t);
    EXPECT_EQ(e.volume, f.volume);
    EXPECT_EQ(e.weight, f.weight);
    EXPECT_EQ(e.emission, f.emission);
    EXPECT_EQ(s.next_1d(), r.next_1d());
  }
}

}  // namespace
}  // namespace gloam

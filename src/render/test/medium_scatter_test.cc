// Phase functions, glowing media, and whole random walks in closed surroundings.

#include <gtest/gtest.h>

#include "render/scene/black_body_table.h"
#include "render/test/media_probe.h"
#include "world/lights/black_body.h"

namespace gloam {
namespace {

TEST(Phase, HenyeyGreensteinIsNormalisedWithMeanCosineG) {
  for (const float g : {-0.9f, -0.3f, 0.0f, 0.0005f, 0.5f, 0.85f, 0.97f}) {
    double sum = 0, mean = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double z = -1 + 2 * (i + 0.5) / kSteps;
      const double share = henyey_greenstein(g, static_cast<float>(z)) * 4 * M_PI / kSteps;
      sum += share;
      mean += share * z;
    }
    EXPECT_NEAR(sum, 1, 1e-4) << "g " << g;
    EXPECT_NEAR(mean, g, 1e-4) << "g " << g;
  }
}

TEST(Phase, SamplesFollowTheirDensity) {
  const Bands bands;
  const Vec3f d = normalize(Vec3f{0.3f, -0.8f, -0.5f});
  const struct {
    float g[3];
    Vec3f shares;
  } cases[] = {{{0.7f, 0.7f, 0.7f}, {0.3f, 0.3f, 0.4f}},
               {{0.9f, 0.2f, -0.6f}, {0.2f, 0.5f, 0.3f}},
               {{0.9f, -0.8f, 0}, {0, 1, 0}},
               {{0.0005f, 0, 0}, {1, 0, 0}}};
  for (const auto& c : cases) {
    VolumeView volume;
    std::copy(c.g, c.g + 3, volume.g);
    constexpr int kRows = 40, kColumns = 8, kDraws = 200000;
    std::vector<double> observed(kRows * kColumns);
    Mean cosine, weight[3];
    const Frame frame = Frame::from_z(d);
    for (uint32_t i = 0; i < kDraws; ++i) {
      Sampler s = independent(i, 3);
      const float u_band = s.next_1d();
      const PhaseSample p = sample_phase(volume, bands, c.shares, d, u_band, s.next_2d());
      ASSERT_NEAR(length(p.wi), 1, 1e-5);
      float pdf = 0;
      const Vec3f value = eval_phase(volume, bands, c.shares, dot(d, p.wi), &pdf);
      EXPECT_NEAR(pdf, p.pdf, 2e-3f * pdf) << "a cosine near one, rounded twice";
      EXPECT_LT(length(p.weight * pdf - value), 5e-3f * length(value));
      const Vec3f local = frame.to_local(p.wi);
      const double turn = std::atan2(local.y, local.x) / (2 * M_PI) + 0.5;
      const int row = std::clamp(static_cast<int>((local.z + 1) * 0.5f * kRows), 0, kRows - 1);
      ++observed[row * kColumns + std::min(kColumns - 1, static_cast<int>(turn * kColumns))];
      cosine.add(local.z);
      for (int k = 0; k < 3; ++k) weight[k].add(p.weight[k]);
    }
    double chi2 = 0;
    int cells = 0;
    for (int row = 0; row < kRows; ++row) {
      double expected = 0;
      for (int i = 0; i < 400; ++i) {
        float pdf = 0;
        const float z = -1 + 2 * (row + (i + 0.5f) / 400) / kRows;
        eval_phase(volume, bands, c.shares, z, &pdf);
        expected += pdf * 4 * M_PI / kRows / 400 * kDraws / kColumns;
      }
      if (expected < 20) continue;
      for (int k = 0; k < kColumns; ++k, ++cells) {
        const double gap = observed[row * kColumns + k] - expected;
        chi2 += gap * gap / expected;
      }
    }
    EXPECT_GT(cells, 100);
    EXPECT_LT(chi2, cells + 4.5 * std::sqrt(2.0 * cells)) << "g " << c.g[0] << ", " << c.g[1];
    const double g = c.shares.x * c.g[0] + c.shares.y * c.g[1] + c.shares.z * c.g[2];
    EXPECT_NEAR(cosine.mean, g, 4.5 * cosine.standard_error());
    for (int k = 0; k < 3; ++k) {
      // A band without a share may stay out of reach; the others lose nothing.
      if (c.shares[k] > 0.1f) {
        EXPECT_NEAR(weight[k].mean, 1, 4.5 * weight[k].standard_error() + 1e-5) << "band " << k;
      }
    }
  }
}

TEST(Phase, OverlappingMediaScatterInProportion) {
  MediaBuilder b;
  b.add_box({2, 2, 2}, {}, 1, b.add_medium({2, 1, 3}, {0.9f, 0.5f, 0.2f}, {0.8f, 0.8f, 0.8f}));
  b.add_box({2, 2, 2}, {}, 0.5f, b.add_medium({3, 6, 1}, {1, 0.7f, 0.9f}, {-0.5f, -0.4f, 0}));
  const VolumeStore store = b.build();
  const MediumPoint point = medium_at(store.view(), {}, {});
  const float extinction[3] = {2 + 1.5f, 1 + 3, 3 + 0.5f};
  const float scattering[3] = {2 * 0.9f + 1.5f, 0.5f + 3 * 0.7f, 3 * 0.2f + 0.5f * 0.9f};
  const float toward[3] = {2 * 0.9f * 0.8f - 1.5f * 0.5f, 0.5f * 0.8f - 3 * 0.7f * 0.4f,
                           3 * 0.2f * 0.8f};
  Mean by_g[3];
  for (uint32_t i = 0; i < 100000; ++i) {
    Sampler s = independent(i, 4);
    const MediumEvent e =
        sample_distance(store.view(), make_ray({}, {1, 0.2f, 0}), 0.9f, {}, {1, 1, 1}, &s);
    for (int k = 0; k < 3; ++k) {
      const float w = e.volume < 0 ? 0 : e.weight[k];
      // Zero in the mean if the volumes are drawn as their scattering says.
      by_g[k].add(w * ((e.volume < 0 ? 0 : b.media[e.volume].g[k]) - toward[k] / scattering[k]));
    }
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(point.extinction[k], extinction[k], 1e-5);
    EXPECT_NEAR(point.scattering[k], scattering[k], 1e-5);
    EXPECT_NEAR(point.g_scattering[k], toward[k], 1e-5);
    EXPECT_NEAR(by_g[k].mean, 0, 4.5 * by_g[k].standard_error()) << "band " << k;
    EXPECT_LT(by_g[k].standard_error(), 0.01);
  }
  const float back = scattering_at(store.view(), {}, Bands::only(MediumBand::k905nm), -1).x;
  EXPECT_NEAR(
      back, 4 * 0.9f * henyey_greenstein(0.8f, -1) + 0.5f * 6 * henyey_greenstein(-0.5f, -1), 1e-4);
}

/// Radiance along a ray into media that stand in even surroundings. Nothing else is there.
Vec3f walk_in_surroundings(const MediaView& media, Ray ray, Vec3f surroundings, Sampler sampler,
                           Vec3f* throughput) {
  Vec3f radiance;
  *throughput = {1, 1, 1};
  for (int i = 0; i < 100000; ++i) {
    const MediumEvent e = sample_distance(media, ray, 1e30f, {}, *throughput, &sampler);
    radiance += *throughput * e.emission;
    *throughput *= e.weight;
    if (e.volume < 0) return radiance + *throughput * surroundings;
    if (max_component(*throughput) <= 0) return radiance;
    const float u = sampler.next_1d();
    const PhaseSample p = sample_phase(media.volumes[static_cast<uint32_t>(e.volume)], {},
                                       *throughput, ray.d, u, sampler.next_2d());
    ray.o = ray.o + ray.d * e.t;
    ray.d = p.wi;
    *throughput *= p.weight;
  }
  ADD_FAILURE() << "the path does not end";
  return radiance;
}

TEST(Medium, WhiteMediaInEvenLightCannotBeSeen) {
  MediaBuilder b;
  VolumeDescription plume = make_plume(20, 2, 293);
  b.add(plume, b.add_medium({12, 8, 4}, {1, 1, 1}));
  b.add_box({1, 1, 1}, {}, 1, b.add_medium({2, 3, 5}, {1, 1, 1}, {0.8f, 0.5f, -0.2f}));
  const VolumeStore store = b.build();
  Mean mean[3];
  for (uint32_t i = 0; i < 40000; ++i) {
    Vec3f throughput;
    const Vec3f radiance =
        walk_in_surroundings(store.view(), make_ray({-2, 0.05f, -0.3f}, {1, 0.02f, 0.1f}),
                             {1, 1, 1}, independent(i, 5), &throughput);
    EXPECT_NEAR(throughput.x + throughput.y + throughput.z, 3, 1e-3)
        << "energy is kept path by path";
    for (int k = 0; k < 3; ++k) mean[k].add(radiance[k]);
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k].mean, 1, 4.5 * mean[k].standard_error()) << "band " << k;
    EXPECT_LT(mean[k].standard_error(), 0.01) << "band " << k;
  }
}

TEST(Medium, GlowInEquilibriumWithItsSurroundingsCannotBeSeen) {
  const Vec3f light = black_body_luminance(2300);
  MediaBuilder b;
  VolumeDescription noise = make_noise_volume(30, 30, 30, 3, 8);
  noise.even_temperature = 2300;
  b.add(noise, b.add_medium({3, 4, 6}, {0.3f, 0.6f, 0.8f}, {0.5f, 0.5f, 0.5f}, 1));
  const VolumeStore store = b.build();
  Mean mean[3];
  for (uint32_t i = 0; i < 40000; ++i) {
    Vec3f throughput;
    const Vec3f radiance =
        walk_in_surroundings(store.view(), make_ray({-2, 0.05f, -0.3f}, {1, 0.02f, 0.1f}), light,
                             independent(i, 6), &throughput);
    for (int k = 0; k < 3; ++k) mean[k].add(radiance[k] / light[k]);
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k].mean, 1, 4.5 * mean[k].standard_error() + 5e-4) << "band " << k;
    EXPECT_LT(mean[k].standard_error(), 0.01) << "band " << k;
  }
}

TEST(Medium, SlabsGlowByTheirOpticalDepth) {
  const float temperature = 1500;
  const Vec3f light = black_body_luminance(temperature);
  for (const float depth : {0.01f, 0.7f, 60.0f}) {
    for (const bool is_grid : {false, true}) {
      MediaBuilder b;
      VolumeDescription& slab =
          b.add_box({1, 9, 9}, {}, depth, b.add_medium({1, 0.5f, 2}, {}, {}, 0.8f));
      slab.even_temperature = temperature;
      if (is_grid) {
        slab.nx = slab.ny = slab.nz = 12;
        slab.density = grid_of(std::vector<float>(12 * 12 * 12, depth));
        slab.temperature = grid_of(std::vector<float>(12 * 12 * 12, temperature));
      }
      const VolumeStore store = b.build();
      const Ray ray = make_ray({-3, 0, 0}, {1, 0, 0});
      Mean mean[3];
      for (uint32_t i = 0; i < 100000; ++i) {
        Sampler s = independent(i, 7);
        const MediumEvent e = sample_distance(store.view(), ray, 1e30f, {}, {1, 1, 1}, &s);
        for (int k = 0; k < 3; ++k) mean[k].add(e.emission[k]);
      }
      const MarchResult marched = march(store.view(), ray, 1e30f, 10.0f, 1, {}, true,
                                        [](const MarchStep&) { return Vec3f{}; });
      for (int k = 0; k < 3; ++k) {
        const double share = -std::expm1(-depth * b.media[0].mass_extinction[k]);
        const double expected = 0.8 * share * light[k];
        EXPECT_NEAR(mean[k].mean, expected, 4.5 * mean[k].standard_error() + 5e-4 * expected)
            << "optical depth " << depth << ", band " << k;
        EXPECT_NEAR(marched.radiance[k], expected, 2e-3 * expected)
            << "marched, optical depth " << depth << ", band " << k;
      }
    }
  }
}

TEST(BlackBody, MatchesWhatIsKnownOfIt) {
  // The candela of 1948: platinum at its freezing point has 60 cd/cm².
  EXPECT_NEAR(luminance(black_body_luminance(2041.4)), 6e5, 0.01 * 6e5);
  // CIE standard illuminant A, x = 0.44757, y = 0.40745, is one at 2856 K.
  const Vec3f rgb = black_body_luminance(2856);
  const double X = 0.4124 * rgb.x + 0.3576 * rgb.y + 0.1805 * rgb.z, Y = luminance(rgb);
  const double Z = 0.0193 * rgb.x + 0.1192 * rgb.y + 0.9505 * rgb.z;
  EXPECT_NEAR(X / (X + Y + Z), 0.44757, 0.003);
  EXPECT_NEAR(Y / (X + Y + Z), 0.40745, 0.003);
  EXPECT_EQ(black_body_luminance(1200).z, 0) << "blue is out of the gamut";
  const std::vector<Vec3f> values = make_black_body_table();
  const BlackBodyTable table{{values.data(), static_cast<uint32_t>(values.size())}};
  for (float t = 801; t < 9990; t *= 1.013f) {
    const Vec3f exact = black_body_luminance(t), found = table.at(t);
    EXPECT_LT(length(found - exact), 2e-4f * length(exact)) << t << " K";
  }
  EXPECT_EQ(table.at(799), Vec3f{});
  EXPECT_LT(luminance(table.at(800)), 0.01f) << "nothing that is seen is cut off";
  EXPECT_EQ(table.at(30000), table.at(10000));
  EXPECT_EQ(table.at(NAN), Vec3f{});
}

}  // namespace
}  // namespace gloam

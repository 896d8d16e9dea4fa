// LiDARs in participating media: against Beer and Lambert, quadratures, and the camera.

#include <cmath>

#include "render/kernel/lidar/lidar_particles.h"
#include "render/test/media_probe.h"
#include "sensors/lidar/lidar_presets.h"
#include "sensors/test/lidar_scene.h"
#include "world/media/medium_presets.h"

namespace gloam {
namespace {

constexpr size_t k905 = static_cast<size_t>(MediumBand::k905nm);
constexpr size_t k1550 = static_cast<size_t>(MediumBand::k1550nm);

MediumDescription medium(float k_905, float k_1550, float albedo = 0) {
  MediumDescription m;
  m.name = "medium";
  m.mass_extinction[k905] = k_905;
  m.mass_extinction[k1550] = k_1550;
  m.albedo.fill(albedo);
  return m;
}
/// A slab across the x axis.
void add_slab(SceneBuilder* b, float from, float to, float density) {
  VolumeDescription v;
  v.name = "slab";
  v.size = {to - from, 20, 20};
  v.X_WV.p = {0.5f * (from + to), 0, 0};
  v.even_density = density;
  b->description.volumes.push_back(v);
}

TEST(LidarInMedia, ASlabDimsByTwoWayBeerLambertInTheSensorsOwnBand) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 50, 50}, {10.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  b.description.media.push_back(medium(0.2f, 0.05f));
  add_slab(&b, 3, 7, 1.5f);
  for (const auto& [wavelength, k] : {std::pair(905, 0.2), std::pair(1550, 0.05)}) {
    LidarOptions options = pencil();
    options.wavelength = wavelength;
    const auto scan = scan_scene(b, options);
    ASSERT_EQ(scan->size(), 1u);
    EXPECT_NEAR(scan->intensity[0] / (50 * std::exp(-2 * k * 1.5 * 4)), 1, 1e-4) << wavelength;
    EXPECT_NEAR(scan->range[0], 10, 1e-4) << "a dimmer return is not a nearer one";
  }
}

TEST(LidarInMedia, WhatLiesBeforeTheLeastRangeDimsToo) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 50, 50}, {10.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  b.description.media.push_back(medium(0.1f, 0.1f));
  add_slab(&b, -5, 7, 1);
  LidarOptions options = pencil();
  options.min_range = 2;
  const auto scan = scan_scene(b, options);
  ASSERT_EQ(scan->size(), 1u);
  EXPECT_NEAR(scan->intensity[0] / (50 * std::exp(-2 * 0.1 * 7)), 1, 1e-4);
}

TEST(LidarInMedia, AnUnevenVolumeDimsAsItsIntegralSays) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 50, 50}, {10.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  b.description.media.push_back(medium(0.6f, 0.6f));
  VolumeDescription cloud = make_noise_volume(60, 40, 40, 1, 3);
  cloud.size = {6, 4, 4};
  cloud.X_WV.p = {5, 0.2f, 0.1f};
  b.description.volumes.push_back(cloud);
  LidarOptions options = pencil(24, 24);
  options.field_of_view = {{20, 20}};
  const auto scan = scan_scene(b, options);
  auto store = VolumeStore::make(b.description.media, b.description.volumes);
  ASSERT_TRUE(store.ok());
  double lowest = 1;
  for (size_t i = 0; i < scan->size(); ++i) {
    Ray ray;
    ray.d = normalize(point(*scan, i));
    const double t =
        integrate_ray(store->view(), ray, scan->range[i], Bands::only(MediumBand::k905nm), 4000)
            .transmittance[0];
    const double cosine = 10 / static_cast<double>(scan->range[i]);
    EXPECT_NEAR(scan->intensity[i] / (50 * cosine * t * t), 1, 0.02);
    lowest = std::min(lowest, t);
  }
  EXPECT_LT(lowest, 0.8) << "this test is about extinction";
}

TEST(LidarInMedia, TheCameraSeesTheSameExtinction) {
  // One volume for both; behind it a wall that glows for the one and reflects for the other.
  SceneBuilder b;
  MaterialDescription glow;
  glow.base_color = {0.5f, 0.5f, 0.5f};
  glow.specular_weight = 0;
  glow.emission = {100, 100, 100};
  add_wall(&b, {0.5f, 50, 50}, {10.5f, 0, 0}, b.add_material(glow));
  MediumDescription m = medium(0.3f, 0.3f);
  m.mass_extinction.fill(0.3f);
  b.description.media.push_back(m);
  VolumeDescription cloud = make_noise_volume(60, 40, 40, 1, 3);
  cloud.size = {6, 4, 4};
  cloud.X_WV.p = {5, 0, 0};
  b.description.volumes.push_back(cloud);
  const auto scan = scan_scene(b, pencil());
  ASSERT_EQ(scan->size(), 1u);

  const Affine3f X_WC{{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, 0}};  // looks along +x
  RenderSettings settings;
  settings.spp = 256;
  settings.max_depth = 1;
  settings.variance = true;
  const Film film = b.render(SceneBuilder::camera(X_WC, 8, 8, 0.01), settings);
  double mean = 0, variance = 0;
  for (size_t i = 0; i < film.radiance.size(); ++i) {
    mean += film.radiance[i].x / 64;
    variance += film.variance[i].x / 64 / 64;
  }
  const double one_way = mean / 100;
  EXPECT_NEAR(std::sqrt(scan->intensity[0] / 50), one_way,
              3 * std::sqrt(variance) / 100 + 0.005 * one_way);
  EXPECT_LT(one_way, 0.97) << "this test is about extinction";
}

/// pi beta Int exp(-2 k r) / r² dr from a to b, in a medium that begins at `begin`.
double backscatter(double k, double beta, double begin, double a, double b) {
  double sum = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double r = a + (b - a) * (i + 0.5) / n;
    sum += std::exp(-2 * k * (r - begin)) / (r * r);
  }
  return M_PI * beta * sum * (b - a) / n;
}

/// What a LiDAR that sees a plate of 10 % at 40 m gets back of `m` from 4 to 30 m.
std::shared_ptr<const LidarScan> scan_fog(const MediumDescription& m, float density = 1) {
  SceneBuilder b;
  b.description.media.push_back(m);
  add_slab(&b, 4, 30, density);
  LidarOptions options = pencil();
  options.pulse_length = 1;
  options.intensity = "signal";
  options.range_at_10_percent = 40;
  return scan_scene(b, options);
}

TEST(LidarInMedia, ThickFogAnswersAtTheRangeWhereItIsEntered) {
  const auto scan = scan_fog(medium(0.4f, 0.4f, 0.9f));
  ASSERT_EQ(scan->size(), 1u);
  EXPECT_EQ(scan->part[0], 0u) << "it is no surface";
  EXPECT_GT(scan->range[0], 4);
  EXPECT_LT(scan->range[0], 5);
  const double beta = 0.4 * 0.9 / (4 * M_PI);  // isotropic
  EXPECT_NEAR(scan->intensity[0] / backscatter(0.4, beta, 4, 4, 5), 1, 0.01);
}

TEST(LidarInMedia, DropsScatterBackAsMeasuredNotAsTheirPhaseFunctionSays) {
  MediumDescription fog = medium(0.4f, 0.4f, 1);
  fog.name = "fog";
  fog.g.fill(0.87f);
  const auto scan = scan_fog(fog);
  ASSERT_EQ(scan->size(), 1u);
  EXPECT_NEAR(scan->intensity[0] / backscatter(0.4, 0.4 / 18.8, 4, 4, 5), 1, 0.01);
}

TEST(LidarInMedia, ThinFogGivesNoFalseReturnsWithoutNoise) {
  EXPECT_EQ(scan_fog(medium(0.4f, 0.4f, 0.9f), 1e-3f)->size(), 0u);
}

// A lens takes the mean of thousands of speckles, so the echo of an even medium is the same in
// every beam, but for the receiver's own noise: a twelfth of the threshold.
TEST(LidarInMedia, FalseReturnsComeAsOftenAsTheReceiversNoiseSays) {
  SceneBuilder b;
  const float k = 0.3f, albedo = 0.9f;
  b.description.media.push_back(medium(k, k, albedo));
  add_slab(&b, 3.1f, 3.9f, 1e-2f);
  add_slab(&b, 6.1f, 6.9f, 1e-2f);
  const double signal = backscatter(1e-2 * k, 1e-2 * k * albedo / (4 * M_PI), 3.1, 3.1, 3.9);
  for (const double ratio : {0.85, 1.0, 1.15, 2.0}) {
    LidarOptions options = pencil(160, 160);
    options.pulse_length = 1;
    options.noise = true;
    options.range_noise = 0;
    options.range_at_10_percent = std::sqrt(0.1 * ratio / signal);
    const auto scan = scan_scene(b, options);
    constexpr double n = 160 * 160;
    // `ratio` = signal over threshold; sigma = threshold / 12.
    const double expected = 0.5 * std::erfc(12 * (1 - ratio) / std::sqrt(2.0));
    EXPECT_NEAR(static_cast<double>(scan->size()) / n, expected,
                3 * std::sqrt(expected * (1 - expected) / n) + 1e-3)
        << ratio;
    for (size_t i = 0; i < scan->size(); ++i) EXPECT_NEAR(scan->range[i], 3.5, 0.5) << ratio;
  }
}

/// A hall of dust in which one sees 12 m, as an OS1-64 does.
struct DustyHall {
  const MediumDescription& dust = *find_medium("dust");
  const float density = static_cast<float>(kKoschmieder / 12) / dust.mass_extinction[1];
  const double extinction = static_cast<double>(density * dust.mass_extinction[k905]);
  const LidarOptics optics = find_lidar_preset("OS1-64")->make().optics;

  /// O(r) exp(-2 k r) / r²
  double reached(double r) const {
    const double overlap = static_cast<double>(lidar::overlap(optics, static_cast<float>(r)));
    return overlap * std::exp(-2 * extinction * r) / (r * r);
  }
  /// The strongest of the dust's bins of half a metre beyond the least range.
  LidarEcho strongest() const {
    LidarEcho peak{0, 0, 0};
    constexpr int steps = 200;
    for (int bin = 1; bin < 20; ++bin) {
      double sum = 0, moment = 0;
      for (int i = 0; i < steps; ++i) {
        const double r = 0.5 * (bin + (i + 0.5) / steps);
        if (r < static_cast<double>(optics.min_range)) continue;
        sum += M_PI * extinction / 55 * reached(r) * 0.5 / steps;
        moment += M_PI * extinction / 55 * reached(r) * 0.5 / steps * r;
      }
      if (sum > static_cast<double>(peak.signal))
        peak = {static_cast<float>(moment / sum), static_cast<float>(sum), 0};
    }
    return peak;
  }
  std::shared_ptr<const LidarScan> scan_wall(double reflectance, double distance) const {
    SceneBuilder b;
    const auto albedo = static_cast<float>(reflectance);
    add_wall(&b, {0.5f, 50, 50}, {static_cast<float>(distance) + 0.5f, 0, 0},
             b.add_diffuse({albedo, albedo, albedo}));
    b.description.media.push_back(dust);
    VolumeDescription air;
    air.name = "hall";
    air.size = {40, 40, 40};
    air.even_density = density;
    b.description.volumes.push_back(air);
    LidarOptions options = pencil();
    options.range_at_10_percent = {};
    options.min_range = {};
    options.receiver_diameter = {};
    options.returns = "strongest";
    return scan_scene(b, options);
  }
};

// A beam ends at a matt wall up to the distance at which the LiDAR equation makes it weaker than
// the dust before the sensor, and in that dust beyond.
TEST(LidarInMedia, InAHallOfDustBeamsEndWhereTheLidarEquationSays) {
  const DustyHall hall;
  const LidarEcho dust = hall.strongest();
  ASSERT_GT(dust.signal, 2 * hall.optics.threshold) << "dust is seen";
  for (const double reflectance : {0.1, 0.3, 0.8}) {
    double crossing = 1.5;
    while (reflectance * hall.reached(crossing) > static_cast<double>(dust.signal))
      crossing += 0.01;
    std::printf("%.0f %%: walls up to %.1f m, transmission %.2f; dust at %.2f m, %.1f thresholds\n",
                100 * reflectance, crossing, std::exp(-hall.extinction * crossing),
                static_cast<double>(dust.range),
                static_cast<double>(dust.signal / hall.optics.threshold));
    const auto near = hall.scan_wall(reflectance, 0.93 * crossing);
    ASSERT_EQ(near->size(), 1u);
    EXPECT_NE(near->part[0], 0u);
    EXPECT_NEAR(near->range[0], 0.93 * crossing, 0.01);
    const auto far = hall.scan_wall(reflectance, 1.07 * crossing);
    ASSERT_EQ(far->size(), 1u);
    EXPECT_EQ(far->part[0], 0u);
    EXPECT_NEAR(far->range[0], dust.range, 0.1);
  }
}

}  // namespace
}  // namespace gloam

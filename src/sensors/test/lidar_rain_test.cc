// LiDARs in what falls: single drops, the overlap of beam and receiver.

#include <algorithm>
#include <cmath>

#include "render/kernel/lidar/lidar_particles.h"
#include "sensors/lidar/lidar_particle_table.h"
#include "sensors/lidar/lidar_presets.h"
#include "sensors/test/lidar_scene.h"

namespace gloam {
namespace {

/// A VLP-16 2 m above the ground and 30 m before a wall of 50 %, in rain or snow [mm/h].
SceneBuilder wall_scene(double rain, double snow = 0) {
  SceneBuilder b;
  add_wall(&b, {0.1f, 20, 6}, {30.1f, 0, 6}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  for (const ParticleSet& set : {rain > 0 ? rain_particles(rain) : snow_particles(snow)}) {
    if (!(rain > 0) && !(snow > 0)) break;
    b.description.weather.particles.push_back(set);
    VolumeDescription air;
    air.name = "weather/" + medium_of(set).name;
    air.medium = static_cast<int>(b.description.media.size());
    air.size = {500, 500, 100};
    air.even_density = set.water;
    b.description.media.push_back(medium_of(set));
    b.description.volumes.push_back(air);
  }
  return b;
}

LidarOptions vlp_16(bool noise = false) {
  LidarOptions options;
  options.name = "l";
  options.preset = "VLP-16";
  options.columns = 360;
  options.truth = true;
  options.noise = noise;
  options.position = {0, 0, 2};
  return options;
}

struct Count {
  size_t wall = 0, drops = 0, beams = 0;
  float nearest = 1e9f;
};
Count count(const LidarScan& scan) {
  Count c;
  c.beams = static_cast<size_t>(scan.beams);
  for (size_t i = 0; i < scan.size(); ++i) {
    ++(scan.part[i] != 0 ? c.wall : c.drops);
    if (scan.part[i] == 0) c.nearest = std::min(c.nearest, scan.range[i]);
  }
  return c;
}

TEST(LidarInRain, TheWallBehindItIsSeenAndFewBeamsEndAtDrops) {
  const size_t clear = count(*scan_scene(wall_scene(0), vlp_16())).wall;
  ASSERT_GT(clear, 100u);
  for (const bool noise : {false, true}) {
    for (const double rate : {1.0, 2.0, 5.0, 10.0, 25.0, 50.0}) {
      const Count c = count(*scan_scene(wall_scene(rate), vlp_16(noise)));
      EXPECT_GE(static_cast<double>(c.wall), 0.95 * static_cast<double>(clear)) << rate << noise;
      EXPECT_LE(static_cast<double>(c.drops), 0.05 * static_cast<double>(c.beams)) << rate << noise;
      std::printf("%s %.0f mm/h: wall %zu of %zu, drops %zu of %zu\n", noise ? "noisy" : "exact",
                  rate, c.wall, clear, c.drops, c.beams);
    }
  }
}

/// False points that one beam of a sensor must have in rain, on the mean: every drop whose echo on
/// the axis would be p0 is seen where the beam's profile leaves more than the threshold of it, in
/// the area pi a b / 2 ln(p0 / threshold) around the axis. Drops send back 0.0236 of their radius
/// squared [m²/sr] (van de Hulst 1957, 12.2, for n = 1.328).
double expected_points(const LidarOptics& optics, double rain) {
  constexpr double kStep = 0.02;  // [m]
  const ParticleSet drops = rain_particles(rain);
  double extinction = 0, sum = 0;
  for (const ParticleClass& c : drops.classes)
    extinction += static_cast<double>(c.number * 0.5f * kPi * sqr(c.diameter));
  for (double r = static_cast<double>(optics.min_range) + 0.5 * kStep;
       r < static_cast<double>(optics.max_range); r += kStep) {
    const auto range = static_cast<float>(r);
    const Vec2f half = lidar::half_widths(optics, range);
    const double area = static_cast<double>(0.5f * kPi * half.x * half.y);
    const double arrives = static_cast<double>(lidar::overlap(optics, range)) / (r * r) *
                           std::exp(-2 * extinction * r);
    for (const ParticleClass& c : drops.classes) {
      const double backscatter = 0.0236 * 0.25 * static_cast<double>(sqr(c.diameter));
      const double p0 = M_PI / area * backscatter * arrives;
      const double ratio = p0 / static_cast<double>(optics.threshold);
      const double rim = 2.0 * 1.5 * 1.5;  // no drops are drawn beyond 1.5 half widths
      if (ratio > 1)
        sum += static_cast<double>(c.number) * area * std::min(std::log(ratio), rim) * kStep;
    }
  }
  return sum;
}

// Beams that end before the wall, of the sensor as it is and of one that detects a twentieth of the
// light.
TEST(LidarInRain, FalsePointsAreAsManyAsDropsInTheBeamSay) {
  for (const double range : {35.0, 150.0}) {
    for (const double rate : {2.0, 10.0, 50.0}) {
      LidarOptions options = vlp_16();
      options.range_at_10_percent = range;
      options.returns = "all";
      options.pulse_length = 0.1;  // hardly any two drops are one echo
      options.max_range = 20;      // before the wall
      LidarOptics optics = find_lidar_preset("VLP-16")->make().optics;
      optics.threshold = lidar_threshold(range);
      optics.max_range = 20;
      const SceneBuilder scene = wall_scene(rate);
      double found = 0, beams = 0;
      for (int scan = 0; scan < 4; ++scan) {
        const Count c = count(*scan_scene(scene, options, 0, {}, scan));
        found += static_cast<double>(c.drops);
        beams += static_cast<double>(c.beams);
      }
      const double expected = beams * expected_points(optics, rate);
      std::printf("10 %% at %.0f m, %.0f mm/h: %.0f false points, expected %.1f, of %.0f beams\n",
                  range, rate, found, expected, beams);
      EXPECT_NEAR(found, expected, 4 * std::sqrt(expected) + 0.05 * expected + 1);
    }
  }
}

TEST(LidarInRain, FlakesAreSeenNearByAndLeaveMostOfTheWall) {
  const size_t clear = count(*scan_scene(wall_scene(0), vlp_16())).wall;
  const Count c = count(*scan_scene(wall_scene(0, 2), vlp_16()));
  std::printf("snow 2 mm/h: wall %zu of %zu, flakes %zu of %zu\n", c.wall, clear, c.drops, c.beams);
  EXPECT_GT(c.drops, c.beams / 1000) << "snow is full of echoes";
  EXPECT_LT(c.drops, c.beams / 2);
  EXPECT_GT(c.wall, clear / 2);
}

TEST(LidarInRain, DrawsAreKeyedBySeedScanAndBeam) {
  const SceneBuilder b = wall_scene(0, 5);
  const auto one = scan_scene(b, vlp_16()), same = scan_scene(b, vlp_16());
  EXPECT_EQ(one->range, same->range);
  EXPECT_NE(one->range, scan_scene(b, vlp_16(), 0, {}, 1)->range) << "of the next scan";
  EXPECT_NE(one->range, scan_scene(b, vlp_16(), 0, {}, 0, 2)->range) << "of another seed";
}

// A detector of everything, in drops of one size: their number is Poisson's, their signals are
// those of the cross-section in a Gaussian beam.
TEST(LidarInRain, ParticlesAreAsManyAndAsBrightAsTheirLawSays) {
  LidarOptics optics;
  optics.divergence = {4e-3f, 2e-3f};
  optics.beam_size = {0.01f, 0.01f};
  const std::vector<LidarParticle> drops{{500, 1e-8f}};
  const LidarParticle& drop = drops.front();
  const uint32_t k = 20;  // 10 m
  const Vec2f half = lidar::half_widths(optics, static_cast<float>(k + 1) * lidar::kCell);
  EXPECT_NEAR(half.x, std::hypot(0.005, 0.5 * 4e-3 * 10.5), 1e-6);
  std::vector<LidarCell> cells(k + 1);
  const float volume = kPi * half.x * half.y * sqr(lidar::kSampledBeamRadius) * lidar::kCell;
  cells[k].mean = drop.number * volume;
  const LidarParticles set{{drops.data(), 1}, {cells.data(), k + 1}, 1};
  optics.particles = {&set, 1};
  double number = 0, square = 0, signal = 0;
  constexpr int n = 20000;
  for (uint32_t beam = 0; beam < n; ++beam) {
    const lidar::CellParticles found(optics, {1, 2, beam}, 0, k);
    number += found.count();
    square += sqr(static_cast<float>(found.count()));
    for (int i = 0; i < found.count(); ++i) {
      EXPECT_EQ(lidar::cell_of(found[i].range), k);
      signal += static_cast<double>(found[i].signal) * sqr(found[i].range);
    }
  }
  const double mean = cells[k].mean;
  EXPECT_NEAR(number / n, mean, 4 * std::sqrt(mean / n));
  EXPECT_NEAR(square / n - sqr(static_cast<float>(number / n)), mean, 0.05 * mean);
  // pi Int beta dr, but for what lies beyond the rim.
  const double even = M_PI * 500 * 1e-8 * 0.5 * (1 - std::exp(-2 * 1.5 * 1.5));
  EXPECT_NEAR(signal / n / even, 1, 0.04);
}

TEST(LidarOverlap, GrowsAsTheDetectorsConeDoesAndIsWholeAfar) {
  LidarOptics optics;
  optics.receiver_diameter = 0.03f;
  optics.receiver_view = 6e-3f;
  // On one axis it is the cone's part of the lens; lenses side by side share half of it up close.
  EXPECT_NEAR(lidar::overlap(optics, 2), sqr(2 * 6e-3f / 0.03f), 1e-4);
  optics.receiver_offset = 0.015f;
  EXPECT_NEAR(lidar::overlap(optics, 0.1f), 0.5f * sqr(0.1f * 6e-3f / 0.03f), 2e-5);
  EXPECT_LT(lidar::overlap(optics, 5), 1);
  EXPECT_EQ(lidar::overlap(optics, 10.01f), 1);
  optics.receiver_offset = 0.03f;
  EXPECT_EQ(lidar::overlap(optics, 4.9f), 0) << "blind up to there";
  float before = 0;
  for (float r = 0; r < 20; r += 0.1f) {
    EXPECT_GE(lidar::overlap(optics, r), before - 1e-6f);
    before = lidar::overlap(optics, r);
  }
  optics.receiver_diameter = 0;
  EXPECT_EQ(lidar::overlap(optics, 0.01f), 1);
}

TEST(LidarOverlap, DimsWhatIsNearAndReflectivityIsCalibratedForIt) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 50, 50}, {2.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  LidarOptions options = pencil();
  options.receiver_diameter = 0.03;
  options.receiver_view = 0.34;
  const auto calibrated = scan_scene(b, options);
  options.intensity = "signal";
  const auto plain = scan_scene(b, options);
  ASSERT_EQ(plain->size(), 1u);
  EXPECT_NEAR(calibrated->intensity[0], 50, 0.1);
  EXPECT_LT(plain->intensity[0], 0.5 * 0.5 / 4);
  EXPECT_GT(plain->intensity[0], 0.02 * 0.5 / 4);
}

}  // namespace
}  // namespace gloam

// LiDARs in fog everywhere: what their beams end at, by visibility, against quadratures.

#include <algorithm>
#include <cmath>

#include "render/kernel/lidar/lidar_particles.h"
#include "sensors/lidar/lidar_presets.h"
#include "sensors/test/lidar_scene.h"
#include "world/media/medium_presets.h"

namespace gloam {
namespace {

constexpr size_t kBandOf905 = static_cast<size_t>(MediumBand::k905nm);

/// Fog around a sensor 2 m up, and a wall of 50 % at 20 m ahead.
SceneBuilder foggy_wall(double visibility) {
  SceneBuilder b;
  add_wall(&b, {0.1f, 20, 20}, {20.1f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  const MediumDescription& fog = *find_medium("fog");
  VolumeDescription air;
  air.name = "air";
  air.size = {500, 500, 200};
  air.even_density = static_cast<float>(kKoschmieder / visibility) /
                     fog.mass_extinction[static_cast<size_t>(MediumBand::kGreen)];
  b.description.media.push_back(fog);
  b.description.volumes.push_back(air);
  return b;
}

struct Ends {
  size_t wall = 0, fog = 0, beams = 0;
  double range_of_fog = 0;
};
Ends ends_of(const std::string& preset, double visibility, const char* returns, bool noise) {
  LidarOptions options;
  options.name = "l";
  options.preset = preset;
  options.columns = 180;
  options.returns = returns;
  options.truth = true;
  options.noise = noise;
  const auto scan = scan_scene(foggy_wall(visibility), options);
  Ends ends;
  ends.beams = static_cast<size_t>(scan->beams);
  for (size_t i = 0; i < scan->size(); ++i) {
    const bool ahead = std::fabs(scan->x[i] - 20) < 0.5f && std::fabs(scan->y[i]) < 4;
    if (scan->part[i] != 0 && ahead) ++ends.wall;
    if (scan->part[i] == 0) ++ends.fog, ends.range_of_fog = static_cast<double>(scan->range[i]);
  }
  return ends;
}

/// The strongest bin of the fog's echo over the threshold.
double fog_over_threshold(const LidarOptics& o, double visibility) {
  const MediumDescription& fog = *find_medium("fog");
  const double k =
      kKoschmieder / visibility * static_cast<double>(fog.mass_extinction[kBandOf905]) /
      static_cast<double>(fog.mass_extinction[static_cast<size_t>(MediumBand::kGreen)]);
  const auto bin = static_cast<double>(o.resolution);
  double most = 0;
  for (int i = 0; i < 60; ++i) {
    double sum = 0;
    constexpr int n = 100;
    for (int s = 0; s < n; ++s) {
      const double r = bin * (i + (s + 0.5) / n);
      if (r < static_cast<double>(o.min_range)) continue;
      sum += static_cast<double>(lidar::overlap(o, static_cast<float>(r))) * std::exp(-2 * k * r) /
             (r * r) * bin / n;
    }
    most = std::max(most, M_PI * k / 18.8 * sum);
  }
  return most / static_cast<double>(o.threshold);
}

// Bijelic, Gruber and Ritter 2018, "A benchmark for lidar sensors in fog: is detection breaking
// down?": sensors of this kind see some 25 m in fog of 40 to 50 m, and break down below.
TEST(LidarInFog, WallsAt20MetresAreSeenInFogOf70Metres) {
  for (const std::string preset : {"VLP-16", "HDL-32E", "HDL-64E"}) {
    const Ends clear = ends_of(preset, 1e6, "strongest", false);
    ASSERT_GT(clear.wall, 20u) << preset;
    for (const char* returns : {"strongest", "last"}) {
      for (const double visibility : {300.0, 150.0, 100.0, 70.0}) {
        const Ends ends = ends_of(preset, visibility, returns, false);
        // From 70 m on extinction alone takes beams that graze the wall.
        EXPECT_GE(ends.wall, visibility > 70 ? clear.wall : clear.wall * 3 / 4)
            << preset << ", " << visibility << " m";
        EXPECT_EQ(ends.fog, 0u) << preset << ", " << visibility << " m";
      }
    }
  }
}

TEST(LidarInFog, FogItselfIsRangedWhereTheLidarEquationLiftsItOverTheThreshold) {
  for (const std::string preset : {"VLP-16", "HDL-64E", "OS1-64"}) {
    const LidarOptics optics = find_lidar_preset(preset)->make().optics;
    double before = 0;
    for (const double visibility : {300.0, 200.0, 150.0, 100.0, 70.0, 50.0, 40.0, 30.0, 20.0}) {
      const double ratio = fog_over_threshold(optics, visibility);
      const Ends ends = ends_of(preset, visibility, "strongest", false);
      std::printf("%s, %.0f m: fog %.2f of the threshold, %zu of %zu beams end in it, wall %zu\n",
                  preset.c_str(), visibility, ratio, ends.fog, ends.beams, ends.wall);
      if (ratio < 0.97) {
        EXPECT_EQ(ends.fog, 0u) << preset << ", " << visibility << " m";
      } else if (ratio > 1.03) {
        EXPECT_GT(ends.fog, ends.beams / 3) << preset << ", " << visibility << " m";
        EXPECT_LT(ends.range_of_fog, 8) << "its near side";
      }
      EXPECT_GT(ratio, before) << "the echo grows with the density, without a step";
      EXPECT_LT(ratio, before == 0 ? 1e9 : 1.7 * before);
      before = ratio;
    }
  }
}

// The receiver's noise makes the onset gradual: a tenth of the threshold is a standard deviation.
TEST(LidarInFog, WithNoiseTheOnsetIsGradual) {
  const LidarOptics optics = find_lidar_preset("VLP-16")->make().optics;
  double visibility = 100;
  while (fog_over_threshold(optics, visibility) < 0.9) visibility -= 1;
  const Ends some = ends_of("VLP-16", visibility, "strongest", true);
  EXPECT_GT(some.fog, some.beams / 50);
  EXPECT_LT(some.fog, some.beams / 2);
}

TEST(LidarOverlap, NearByTheSideOfTheBeamAtTheLensIsSeenFirst) {
  LidarOptics o = find_lidar_preset("VLP-16")->make().optics;
  EXPECT_GT(o.receiver_offset, 0.5f * o.receiver_diameter) << "it leaves beside the lens";
  // Mean over a Gaussian of the beam's width across, by a fine sum.
  for (const float range : {0.7f, 1.5f, 3.0f, 6.0f, 12.0f}) {
    double sum = 0, weights = 0;
    for (int i = -400; i <= 400; ++i) {
      const double x = 0.0127 * i / 400;
      const double weight = std::exp(-2 * x * x / (0.00635 * 0.00635));
      sum += weight *
             static_cast<double>(lidar::overlap_of_point(o, range, o.receiver_offset + float(x)));
      weights += weight;
    }
    const double mean = sum / weights;
    EXPECT_NEAR(lidar::overlap(o, range), mean, 0.35 * mean + 1e-3) << range << " m";
  }
}

// Without it a sensor would be blind near by: dark things of 5 % are seen from 0.5 m on.
TEST(LidarInFog, NearThingsAreSeen) {
  for (const std::string preset : {"VLP-16", "HDL-32E", "HDL-64E", "OS1-64", "OS1-128", "Mid-40"}) {
    const LidarOptics o = find_lidar_preset(preset)->make().optics;
    for (float r = std::max(o.min_range, 0.5f); r < 10; r += 0.25f)
      EXPECT_GT(0.05f * lidar::overlap(o, r) / (r * r), o.threshold) << preset << " at " << r;
  }
}

}  // namespace
}  // namespace gloam

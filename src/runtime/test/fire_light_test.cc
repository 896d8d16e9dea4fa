// Light of fires, by the heat that they release.

#include <fmt/format.h>

#include <cmath>

#include "render/kernel/media/medium_march.h"
#include "render/scene/volume_store.h"
#include "scenes.h"
#include "sim/snapshots/pose_solver.h"
#include "world/lights/black_body.h"
#include "world/media/flame.h"
#include "world/render_description.h"

namespace gloam {
namespace {

World burner(const TempFolder& folder, double power, double voxel) {
  folder.write("floor.xml", R"(<mujoco><option timestep="0.01"/>
    <worldbody><geom type="plane" size="9 9 .1"/></worldbody></mujoco>)");
  return compile_text(folder, "fire.toml",
                      fmt::format(R"(
[environment]
file = "floor.xml"
[[gas]]
name = "air"
position = [0, 0, 1.5]
size = [2, 2, 3]
voxel = {}
fuel = "propane"
closed = ["-z"]
[[fire]]
name = "burner"
position = [0, 0, 0.15]
size = [0.5, 0.5, 0.2]
power = {}
)",
                                  voxel, power));
}

/// Light at 6 m from the burner, mean of a second.
struct FireLight {
  double illuminance = 0;  ///< of a plate that faces it [lx]
  double brightest = 0;    ///< in any direction [cd/m²]
};

/// Adds the light of an instant by rays side by side; what smoke scatters is lost.
void add_light(const MediaView& media, double weight, FireLight* out) {
  constexpr int kAcross = 64, kUp = 96;
  constexpr float kEdge = 0.05f / 6;  // of a ray's part of the plane at distance 1
  const Vec3f plate{0, -6, 1};
  for (int i = 0; i < kAcross * kUp; ++i) {
    const float x = (static_cast<float>(i % kAcross) + 0.5f - 0.5f * kAcross) * kEdge;
    const float z = (static_cast<float>(i / kAcross) + 0.5f - 0.3f * kUp) * kEdge;
    const Ray ray{plate, normalize(Vec3f{x, 1, z})};
    const MarchResult m =
        march(media, ray, 12, 0.05f, 1000, {}, true, [](const MarchStep&) { return Vec3f{}; });
    const double seen = static_cast<double>(luminance(m.radiance));
    const double cosine = static_cast<double>(ray.d.y);
    out->illuminance += weight * seen * std::pow(cosine, 4) * static_cast<double>(kEdge * kEdge);
    out->brightest = std::max(out->brightest, seen);
  }
}

FireLight light_of(double power, double voxel) {
  constexpr int kBegin = 15, kEnd = 25;  // ticks of 0.1 s
  const TempFolder folder;
  const World world = burner(folder, power, voxel);
  const RenderDescription description = *describe_for_rendering(*world.compiled());
  VolumeStore store = *VolumeStore::make(description.media, description.volumes);
  const auto simulation = simulate(world);
  const auto solver = *PoseSolver::create(simulation->latest().data().world);
  FireLight light;
  for (int tick = kBegin; tick < kEnd; ++tick) {
    EXPECT_TRUE(simulation->run_until(tick * 10).ok());
    PoseFrame frame;
    EXPECT_TRUE(solver->solve(simulation->latest(), frame).ok());
    store.follow(description.volumes, frame);
    add_light(store.view(), 1.0 / (kEnd - kBegin), &light);
  }
  std::printf("%.0f kW in voxels of %.2f m: %.2f lx, at most %.0f cd/m2\n", power * 1e-3, voxel,
              light.illuminance, light.brightest);
  return light;
}

TEST(FireLight, GrowsWithTheHeatAndNeverBeyondPlancksLaw) {
  const double planck = static_cast<double>(luminance(black_body_luminance(kFlameTemperature)));
  const double powers[] = {100e3, 200e3, 300e3, 600e3};
  double per_watt[4], mean = 0;
  for (int i = 0; i < 4; ++i) {
    const FireLight light = light_of(powers[i], 0.1);
    per_watt[i] = light.illuminance / powers[i];
    mean += per_watt[i] / 4;
    EXPECT_LE(light.brightest, planck) << powers[i] << " W";
  }
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(per_watt[i] / mean, 1, 0.2) << powers[i] << " W";
  // Light of thin flames: a fraction χ of the heat is radiated, by Planck's law at
  // kFlameTemperature.
  const double radiance = 5.670374e-8 * std::pow(double{kFlameTemperature}, 4) / kPi;
  const double thin = 0.29 / (4 * kPi * 36) * planck / radiance;  // [lx/W]
  EXPECT_LT(per_watt[0], thin);
  EXPECT_GT(per_watt[0], 0.7 * thin);
}

TEST(FireLight, DoesNotDependOnTheVoxels) {
  EXPECT_NEAR(light_of(100e3, 0.05).illuminance / light_of(100e3, 0.1).illuminance, 1, 0.2);
}

}  // namespace
}  // namespace gloam

// Smoke that is solved for, as cameras and LiDARs of a running simulation see it.

#include <gmock/gmock.h>

#include <cmath>

#include "render/kernel/media/medium_march.h"
#include "render/scene/volume_store.h"
#include "scenes.h"
#include "sim/snapshots/pose_solver.h"
#include "world/render_description.h"

namespace gloam {
namespace {

// A smoke machine before a wall that glows; nothing else is lit, so that no smoke shines.
World smoke_before_a_wall(const TempFolder& folder, double rate) {
  folder.write("wall.xml", R"(<mujoco><option timestep="0.005"/>
    <asset><material name="glow" rgba=".5 .5 .5 1" emission="1"/></asset>
    <worldbody><geom type="box" size=".1 6 6" pos="4.1 0 0" material="glow"/></worldbody></mujoco>)");
  return compile_text(folder, "smoke" + std::to_string(rate > 0) + ".toml", R"(
[environment]
file = "wall.xml"
[sky]
luminance = 0
[[gas]]
name = "air"
position = [2, 0, 0]
size = [3, 3, 2]
voxel = 0.1
rate = 20
[[smoke]]
name = "machine"
position = [2, 0.1, -0.7]
size = [0.5, 0.5, 0.2]
heat = 2000
rate = )" + std::to_string(rate) + R"(
[[camera]]
name = "eye"
look_at = [1, 0, 0]
fovy = 16
[[lidar]]
name = "beam"
preset = "Mid-40"
points = 400
field_of_view = [16, 16]
range_at_10_percent = 0
)");
}

struct Seen {
  PoseFrame frame;  // at the exposure and at the start of the scan
  std::shared_ptr<const CameraFrame> picture;
  std::shared_ptr<const LidarScan> scan;
};

constexpr int64_t kStep = 600;  // 3 s: a tick of the gas, a picture, the start of a scan

Seen look(const World& world) {
  Seen seen;
  const auto simulation = simulate(world);
  CameraRequest request;
  request.camera = "eye";
  request.rate = {1, 1};
  request.width = 16, request.height = 12;
  request.outputs = {"radiance"};
  request.render.spp = 1024;
  request.render.max_depth = 1;  // what the wall sends; nothing that smoke scatters
  request.render.denoise = false;
  request.required = true;
  EXPECT_TRUE(simulation->run_until(kStep).ok());
  const auto camera = simulation->open_camera(request, [&](auto frame) {
    if (frame->step == kStep) seen.picture = frame;
  });
  EXPECT_TRUE(camera.ok()) << camera.error().to_string();
  const auto lidar = simulation->open_lidar({"beam", true}, [&](auto scan) {
    if (seen.scan == nullptr && std::abs(scan->start - 3) < 1e-9) seen.scan = scan;
  });
  EXPECT_TRUE(lidar.ok()) << lidar.error().to_string();
  const Snapshot now = simulation->latest();
  EXPECT_TRUE((*PoseSolver::create(now.data().world))->solve(now, seen.frame).ok());
  EXPECT_TRUE(simulation->run_until(kStep + 40).ok());
  return seen;
}

/// Share of light that passes the smoke along a ray from the origin, by its concentration alone.
class Smoke {
 public:
  Smoke(const World& world, const PoseFrame& frame) {
    const RenderDescription d = *describe_for_rendering(*world.compiled());
    VolumeDescription volume = d.volumes.at(0);
    volume.density = frame.fields[0].density;
    volume.temperature = frame.fields[0].temperature;
    k_ = d.media[static_cast<size_t>(volume.medium)].mass_extinction;
    store_ = *VolumeStore::make(d.media, {volume});
  }
  double passes(Vec3f direction, MediumBand band) const {
    const VolumeView& view = store_.view().volumes[0];
    constexpr int kParts = 4000;
    double mass = 0;  // per area [kg/m²]
    for (int i = 0; i < kParts; ++i) {
      const Vec3f p = direction * (5.0f * (static_cast<float>(i) + 0.5f) / kParts);
      const Vec3f p_G = transform_point(view.X_GW, p);
      if (media::is_inside(view, p_G)) mass += media::density_at(view, p_G) * 5.0 / kParts;
    }
    return std::exp(-mass * k_[static_cast<size_t>(band)]);
  }

 private:
  std::array<float, kMediumBands> k_{};
  VolumeStore store_;
};

class LiveSmoke : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    smoky_ = new World(smoke_before_a_wall(*folder_, 2e-5));
    clear_ = new Seen(look(smoke_before_a_wall(*folder_, 0)));
    seen_ = new Seen(look(*smoky_));
  }
  static void TearDownTestSuite() {
    delete seen_;
    delete clear_;
    delete smoky_;
    delete folder_;
  }
  static inline TempFolder* folder_;
  static inline World* smoky_;
  static inline Seen *clear_, *seen_;
};

TEST_F(LiveSmoke, CamerasSeeTheIntegralOfItsConcentrationInEveryBand) {
  ASSERT_NE(clear_->picture, nullptr);
  ASSERT_NE(seen_->picture, nullptr);
  const Smoke smoke(*smoky_, seen_->frame);
  for (int c = 0; c < 3; ++c) {
    double with = 0, without = 0, expected = 0, thickest = 1;
    for (int i = 0; i < 12 * 16; ++i) {
      const float half = std::tan(8 * kPi / 180);
      const float u = (static_cast<float>(i % 16) + 0.5f - 8) / 6 * half;
      const float v = (static_cast<float>(i / 16) + 0.5f - 6) / 6 * half;
      const double passes = smoke.passes(normalize(Vec3f{1, -u, -v}), static_cast<MediumBand>(c));
      with += seen_->picture->radiance[static_cast<size_t>(3 * i + c)];
      without += clear_->picture->radiance[static_cast<size_t>(3 * i + c)];
      expected += passes / (12 * 16);
      thickest = std::min(thickest, passes);
    }
    std::printf("band %d: %.4f of the light passes, the integral says %.4f\n", c, with / without,
                expected);
    EXPECT_NEAR(with / without / expected, 1, 0.02) << "band " << c;
    EXPECT_LT(thickest, 0.6) << "this test is about extinction";
  }
}

TEST_F(LiveSmoke, LidarsSeeTheIntegralOfItsConcentrationInTheirBand) {
  ASSERT_NE(clear_->scan, nullptr);
  ASSERT_NE(seen_->scan, nullptr);
  ASSERT_EQ(seen_->scan->size(), clear_->scan->size());
  const Smoke smoke(*smoky_, seen_->frame);
  double worst = 0, thickest = 1;
  for (size_t i = 0; i < seen_->scan->size(); ++i) {
    const Vec3f beam{seen_->scan->x[i], seen_->scan->y[i], seen_->scan->z[i]};
    const double t = smoke.passes(normalize(beam), MediumBand::k905nm);
    const double seen = seen_->scan->intensity[i] / clear_->scan->intensity[i];
    worst = std::max(worst, std::abs(seen / (t * t) - 1));
    thickest = std::min(thickest, t * t);
    EXPECT_NEAR(seen / (t * t), 1, 0.02) << "beam " << i;
  }
  std::printf("worst beam %.4f off, the darkest keeps %.3f\n", worst, thickest);
  EXPECT_LT(thickest, 0.6) << "this test is about extinction";
}

}  // namespace
}  // namespace gloam

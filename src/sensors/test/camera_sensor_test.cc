// One camera, one instant: what its frame holds, against closed forms.
#include "sensors/camera/camera_sensor.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "base/rng.h"
#include "gloam/program.h"
#include "scene/test/temp_folder.h"
#include "sim/loop/simulator.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

// Two cameras look along +Y at a wall 4 m away; the second has its own size and a principal point
// off the middle. A ball 2 m away moves along +X by 1 m/s.
const char* const kRoom = R"(
<mujoco>
  <option timestep="0.01" gravity="0 0 0"/>
  <worldbody>
    <light pos="0 -1 3" dir="0 0.5 -1"/>
    <geom name="wall" type="box" size="20 0.5 20" pos="0 4.5 0" rgba="0.5 0.5 0.5 1"/>
    <camera name="plain" fovy="90" xyaxes="1 0 0 0 0 1"/>
    <camera name="sensor" xyaxes="1 0 0 0 0 1" resolution="200 100" sensorsize="0.02 0.01"
      focal="0.01 0.01" principal="0.001 0.0005"/>
    <camera name="parallel" projection="orthographic" fovy="2" xyaxes="1 0 0 0 0 1"/>
    <body name="ball" pos="0 2 0"><joint type="slide" axis="1 0 0"/>
      <geom name="ball" type="sphere" size="0.5" mass="1" rgba="0.9 0.1 0.1 1"/></body>
  </worldbody>
  <keyframe><key qvel="1"/></keyframe>
</mujoco>)";

class CameraSensorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    const auto scene = load_scene(folder_.write("room.xml", kRoom));
    ASSERT_TRUE(scene.ok()) << scene.error().to_string();
    auto world = World::compile(*scene);
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    world_ = std::move(*world);
    auto description = describe_for_rendering(*world_.compiled());
    ASSERT_TRUE(description.ok());
    description_ = std::move(*description);
    renderer_ = std::move(make_cpu_renderer(description_)).value();
    solver_ = std::move(PoseSolver::create(world_.compiled())).value();
    simulator_ = std::move(Simulator::create(world_.compiled(), {.pace = Pace::kLockstep})).value();
    static_cast<void>(simulator_->set_step_hook([](const mjModel*, mjData* d) {
      if (d->time == 0) d->qvel[0] = 1;
    }));
    simulator_->start();
  }

  PoseFrame poses_at(int64_t step) {
    if (step > simulator_->step_count()) {
      EXPECT_TRUE(simulator_->step(step - simulator_->step_count()).ok());
    }
    PoseFrame poses;
    EXPECT_TRUE(solver_->solve(simulator_->latest(), poses).ok());
    return poses;
  }

  static CameraRequest ask(const std::string& camera, std::vector<std::string> outputs) {
    CameraRequest request{.camera = camera, .width = 64, .height = 48};
    request.outputs = std::move(outputs);
    request.render = {.tier = RenderTier::kPath, .spp = 2, .denoise = false};
    return request;
  }
  std::unique_ptr<CameraSensor> make(const CameraRequest& request, uint64_t seed = 1) const {
    auto sensor = CameraSensor::create(description_, request, seed);
    if (!sensor.ok()) {
      ADD_FAILURE() << sensor.error().to_string();
      abort();
    }
    return std::move(*sensor);
  }
  std::shared_ptr<const CameraFrame> capture(CameraSensor& sensor, const PoseFrame& now,
                                             const PoseFrame& previous, int64_t index = 0) {
    return sensor.capture(*renderer_, turns_, now, previous, index);
  }
  static size_t pixel(const CameraFrame& frame, int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(frame.intrinsics.width) +
           static_cast<size_t>(x);
  }

  TempFolder folder_;
  World world_;
  RenderDescription description_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<PoseSolver> solver_;
  std::unique_ptr<Simulator> simulator_;
  RenderTurns turns_;
};

// A picture that other sensors interrupt, at other instants, is the same to the last bit.
TEST_F(CameraSensorTest, PicturesDoNotDependOnWhoRendersInBetween) {
  const PoseFrame now = poses_at(0), later = poses_at(50), last = poses_at(100);
  for (const RenderTier tier : {RenderTier::kPath, RenderTier::kDirect, RenderTier::kInteractive}) {
    CameraRequest request = ask("plain", {"radiance", "depth", "segmentation", "boxes"});
    request.width = 320;
    request.height = 240;
    request.render = {.tier = tier, .spp = 8, .denoise = tier == RenderTier::kDirect};
    const auto alone = capture(*make(request), now, now);
    std::atomic<bool> ends{false};
    std::atomic<int> turns{0};
    std::thread other([&] {
      const auto small = make(ask("sensor", {"depth"}));
      for (int i = 0; !ends; ++i) {
        const PoseFrame& then = i % 2 == 0 ? later : last;
        capture(*small, then, now, i);
        ++turns;
      }
    });
    while (turns == 0) std::this_thread::yield();
    const auto beside = capture(*make(request), now, now);
    ends = true;
    other.join();
    EXPECT_EQ(alone->radiance, beside->radiance) << to_string(tier);
    EXPECT_EQ(alone->depth, beside->depth) << to_string(tier);
    EXPECT_EQ(alone->instance, beside->instance) << to_string(tier);
  }
}

// Things at rest must not swim, and no pattern may move along with a camera.
TEST_F(CameraSensorTest, DenoisedPicturesHaveTheSameDrawsWhileTheCameraStands) {
  const PoseFrame now = poses_at(0);
  CameraRequest request = ask("plain", {"radiance"});
  const auto raw = make(request);
  EXPECT_NE(capture(*raw, now, now, 0)->radiance, capture(*raw, now, now, 1)->radiance)
      << "noise that stays is drawn anew: its mean converges";
  request.render.denoise = true;
  const auto clean = make(request);
  const auto first = capture(*clean, now, now, 0);
  EXPECT_EQ(first->radiance, capture(*clean, now, now, 1)->radiance);

  request.camera = "free";
  const auto free = make(request);
  const Quat towards_y = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};
  free->set_free_pose({{0, 1, 0}, towards_y});
  const auto here = capture(*free, now, now, 0);
  free->set_free_pose({{1e-5, 1, 0}, towards_y});
  EXPECT_NE(here->radiance, capture(*free, now, now, 1)->radiance);
}

TEST_F(CameraSensorTest, ExactChannelsAreThoseOfTheRoom) {
  auto sensor = make(ask("plain", {"depth", "segmentation", "normal"}));
  const PoseFrame now = poses_at(0);
  const auto frame = capture(*sensor, now, now);
  const Intrinsics& k = frame->intrinsics;
  const auto ball = world_.find_geom("ball")->id, wall = world_.find_geom("wall")->id;
  int on_ball = 0, on_edge = 0;
  for (int y = 0; y < k.height; ++y) {
    for (int x = 0; x < k.width; ++x) {
      // The ray (a, b, 1) through the pixel's centre, depth along the axis = its parameter.
      const double a = (x + 0.5 - k.cx) / k.fx, b = (y + 0.5 - k.cy) / k.fy;
      const double square = a * a + b * b + 1, root = 4 - square * (4 - 0.25);
      const size_t i = pixel(*frame, x, y);
      if (std::abs(root) < 0.02) {
        ++on_edge;
        continue;
      }
      const bool hits = root > 0;
      const double depth = hits ? (2 - std::sqrt(root)) / square : 4;
      EXPECT_NEAR(frame->depth[i], depth, 2e-4) << x << ", " << y;
      EXPECT_EQ(frame->part[i], static_cast<uint32_t>(hits ? ball : wall) + 1);
      EXPECT_EQ(frame->instance[i], description_.instances[frame->part[i] - 1].label.instance);
      EXPECT_EQ(frame->semantic[i], description_.instances[frame->part[i] - 1].label.semantic);
      const double normal_y = hits ? (depth - 2) / 0.5 : -1;
      EXPECT_NEAR(frame->normal[3 * i + 1], normal_y, 2e-3);
      on_ball += hits;
    }
  }
  EXPECT_GT(on_ball, 100);
  EXPECT_LT(on_edge, 60);
  EXPECT_TRUE(frame->rgb.empty() && frame->radiance.empty() && frame->albedo.empty() &&
              frame->motion.empty())
      << "only what was asked for";
}

TEST_F(CameraSensorTest, AnOrthographicCameraSeesAlongParallelRays) {
  auto sensor = make(ask("parallel", {"depth", "distance"}));
  const PoseFrame now = poses_at(0);
  const auto frame = capture(*sensor, now, now);
  const Intrinsics& k = frame->intrinsics;
  int on_ball = 0;
  for (int y = 0; y < k.height; ++y) {
    for (int x = 0; x < k.width; ++x) {
      const size_t i = pixel(*frame, x, y);
      const auto ray = pixel_ray(k, x + 0.5, y + 0.5);
      ASSERT_TRUE(ray.has_value());
      const double r2 = ray->p_C.x * ray->p_C.x + ray->p_C.y * ray->p_C.y;
      const double depth = r2 < 0.25 ? 2 - std::sqrt(0.25 - r2) : 4;
      if (std::abs(r2 - 0.25) < 0.01) continue;  // the ball's edge
      on_ball += r2 < 0.25;
      EXPECT_NEAR(frame->depth[i], depth, 1e-4 * depth) << x << ", " << y;
      EXPECT_EQ(frame->distance[i], frame->depth[i]);
    }
  }
  EXPECT_GT(on_ball, 300) << "24 px per metre";
}

TEST_F(CameraSensorTest, MotionIsTheFlowOfWhatMoved) {
  auto sensor = make(ask("plain", {"motion", "segmentation", "depth"}));
  const PoseFrame before = poses_at(1), now = poses_at(11);
  const auto frame = capture(*sensor, now, before);
  const auto ball = static_cast<uint32_t>(world_.find_geom("ball")->id) + 1;
  int moved = 0;
  for (size_t i = 0; i < frame->part.size(); ++i) {
    const float u = frame->motion[2 * i], v = frame->motion[2 * i + 1];
    if (frame->part[i] != ball) {
      EXPECT_NEAR(u, 0, 1e-3);
      continue;
    }
    ++moved;
    const double depth = frame->depth[i];  // 0.1 m sideways at this depth
    EXPECT_NEAR(u, 0.1 * frame->intrinsics.fx / depth, 5e-3);
    EXPECT_NEAR(v, 0, 1e-3);
  }
  EXPECT_GT(moved, 100);
}

TEST_F(CameraSensorTest, ASizeKeepsTheVerticalFieldOfViewAndThePrincipalPointsShare) {
  const auto size = [&](const std::string& camera, int width, int height) {
    CameraRequest request = ask(camera, {"depth"});
    request.width = width;
    request.height = height;
    return make(request)->intrinsics();
  };
  const Intrinsics own = size("sensor", 0, 0);
  EXPECT_EQ(own.width, 200);
  EXPECT_EQ(own.height, 100);
  EXPECT_NEAR(own.fy, 100, 1e-4);
  EXPECT_NEAR(own.cx, 90, 1e-4);
  EXPECT_NEAR(own.cy, 45, 1e-4);
  const Intrinsics doubled = size("sensor", 400, 200);
  EXPECT_NEAR(doubled.fy, 200, 1e-4);
  EXPECT_NEAR(doubled.cx, 180, 1e-4);
  EXPECT_NEAR(doubled.cy, 90, 1e-4);
  const Intrinsics square = size("sensor", 100, 100);
  EXPECT_NEAR(square.fy, 100, 1e-4) << "the sides are cut off, the height stays";
  EXPECT_NEAR(square.cx, 40, 1e-4);
  EXPECT_NEAR(size("plain", 50, 100).fy, 50, 1e-4) << "90 degrees";
  EXPECT_NEAR(size("parallel", 300, 100).fy, 50, 1e-4) << "2 m in 100 px";
}

TEST_F(CameraSensorTest, PicturesAreKeyedBySeedAndFrame) {
  const PoseFrame now = poses_at(0);
  const auto rgb = [&](const std::string& camera, uint64_t seed, int64_t index, int threads) {
    set_thread_count(threads);
    auto sensor = make(ask(camera, {"radiance"}), seed);
    const auto frame = capture(*sensor, now, now, index);
    set_thread_count(0);
    return frame->radiance;
  };
  const auto reference = rgb("plain", 1, 0, 1);
  EXPECT_EQ(rgb("plain", 1, 0, 4), reference);
  EXPECT_NE(rgb("plain", 2, 0, 1), reference);
  EXPECT_NE(rgb("plain", 1, 1, 1), reference);
}

TEST_F(CameraSensorTest, TheFreeCameraStandsWhereItWasPut) {
  auto sensor = make(ask("free", {"depth", "motion"}));
  const Quat towards_y = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};
  const PoseFrame now = poses_at(0);
  sensor->set_free_pose({{5, 1, 0}, towards_y});
  (void)capture(*sensor, now, now);
  sensor->set_free_pose({{5.1, 1, 0}, towards_y});
  const auto frame = capture(*sensor, now, now);
  EXPECT_NEAR(frame->X_WC.p.x, 5.1, 1e-6);
  const size_t middle = pixel(*frame, 32, 24);
  EXPECT_NEAR(frame->depth[middle], 3, 1e-4);
  // The camera went right by 0.1 m, so the wall went left.
  EXPECT_NEAR(frame->motion[2 * middle], -0.1 * frame->intrinsics.fx / 3, 5e-3);
}

TEST_F(CameraSensorTest, WhatItCannotDoIsAnError) {
  struct Case {
    const char* word;
    std::function<void(CameraRequest&)> change;
  };
  const std::vector<Case> cases = {
      {"plain", [](CameraRequest& r) { r.camera = "plane"; }},
      {"segmentation", [](CameraRequest& r) { r.outputs = {"segmentatoin"}; }},
      {"rate", [](CameraRequest& r) { r.rate = {-1, 1}; }},
      {"rate", [](CameraRequest& r) { r.rate = {1, 0}; }},
      {"0 x 48", [](CameraRequest& r) { r.width = 0; }},
      {"-64 x 48", [](CameraRequest& r) { r.width = -64; }},
      {"16385", [](CameraRequest& r) { r.height = 16385; }},
      {"spp", [](CameraRequest& r) { r.render.spp = 65537; }},
      {"error", [](CameraRequest& r) { r.render.error = 0; }},
      {"error", [](CameraRequest& r) { r.render.error = std::nan(""); }},
      {"path tier",
       [](CameraRequest& r) {
         r.render.tier = RenderTier::kDirect;
         r.render.spp = 64;
         r.render.error = 0.1;
       }},
      {"16",
       [](CameraRequest& r) {
         r.render.spp = 15;
         r.render.error = 0.1;
       }},
      {"max_depth", [](CameraRequest& r) { r.render.max_depth = -1; }},
  };
  for (const Case& one : cases) {
    CameraRequest request = ask("plain", {"rgb"});
    one.change(request);
    const auto sensor = CameraSensor::create(description_, request, 1);
    ASSERT_FALSE(sensor.ok()) << one.word;
    EXPECT_NE(sensor.error().to_string().find(one.word), std::string::npos)
        << sensor.error().to_string();
  }
}

TEST(Pose, BecomesAMatrixAndComesBack) {
  constexpr RandomStream kStream{3, stream_id("test.pose")};
  for (uint64_t i = 0; i < 2000; ++i) {
    std::array<double, 4> q{};
    for (uint32_t j = 0; j < 4; ++j) q[j] = 2 * kStream.uniform(i, j) - 1;
    // Half turns and identities, where a component of the quaternion is the square root of zero.
    for (uint64_t j = 0; j < 4; ++j) {
      if ((i >> j & 1) != 0 && i < 16) q[j] = 0;
    }
    mju_normalize4(q.data());
    if (q[0] < 0) {
      for (double& component : q) component = -component;
    }
    const Pose pose{{1, -2, 3}, {q[0], q[1], q[2], q[3]}};
    const Affine3f X = to_affine(pose);
    double R[9];
    mju_quat2Mat(R, q.data());
    EXPECT_NEAR(X.x.y, R[3], 1e-6);
    EXPECT_NEAR(X.y.x, R[1], 1e-6);
    EXPECT_NEAR(X.z.y, R[5], 1e-6);
    const Pose back = to_pose(X);
    const double dot = back.q.w * q[0] + back.q.x * q[1] + back.q.y * q[2] + back.q.z * q[3];
    EXPECT_NEAR(std::abs(dot), 1, 1e-6);
    EXPECT_EQ(back.p, pose.p);
  }
}

}  // namespace
}  // namespace gloam

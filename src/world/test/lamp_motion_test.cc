// Lamps that turn and swing, against closed forms.

#include "world/lights/lamp_motion.h"

#include <gmock/gmock.h>

#include "world/test/visual_test_model.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;
using visual_test::expect_near;

constexpr const char* kTurningModel =
    R"(<mujoco><worldbody><body name="car" pos="3 0 1"><freejoint/><geom size="1"/></body>
  </worldbody></mujoco>)";

RenderDescription with_lamp(LightOptions light) {
  CompiledWorld world = visual_test::compile(kTurningModel);
  world.scene.lights = {std::move(light)};
  return visual_test::describe(world);
}
LightOptions beacon(LightMotionOptions motion) {
  return {.name = "beacon",
          .type = LightType::kSpot,
          .body = "car",
          .position = {0, 0, 0.5},
          .look_at = Vec3{1, 0, 0.5},
          .flux = 100,
          .motion = motion};
}

TEST(LampMotion, ABeaconSweepsAboutTheVerticalAtItsRate) {
  const RenderDescription d = with_lamp(beacon({.spin = 60}));
  const LightDescription& light = d.lights.back();
  ASSERT_EQ(light.motion, 0);
  EXPECT_FALSE(light.is_static);
  const auto beam = [&](double time) { return -moved(d.motions[0], time, light.X_BL).z; };
  expect_near(beam(0), {1, 0, 0}, 1e-6f);
  expect_near(beam(0.25), {0, 1, 0}, 1e-6f);
  expect_near(beam(0.5), {-1, 0, 0}, 1e-6f);
  expect_near(beam(3600.75), {0, -1, 0}, 1e-6f);
  expect_near(moved(d.motions[0], 0.3, light.X_BL).p, {0, 0, 0.5f}, 1e-6f);
}

TEST(LampMotion, SpinsTheOtherWayAboutAnyAxisFromAnyPhase) {
  const RenderDescription d =
      with_lamp(beacon({.spin = -60, .axis = Vec3{0, 5, 0}, .phase = 0.25}));
  const Affine3f& X_BL = d.lights.back().X_BL;
  // A quarter about +Y takes +X to -Z; then back the other way.
  expect_near(-moved(d.motions[0], 0, X_BL).z, {0, 0, -1}, 1e-6f);
  expect_near(-moved(d.motions[0], 0.25, X_BL).z, {1, 0, 0}, 1e-6f);
}

TEST(LampMotion, AHangingLampSwingsAsAPendulum) {
  EXPECT_NEAR(pendulum_rate(0.994), 0.5, 1e-3) << "the seconds pendulum";
  const double quarter = 0.25 / pendulum_rate(2);
  const RenderDescription d = with_lamp({.name = "lamp",
                                         .type = LightType::kSphere,
                                         .position = {1, 0, 2},
                                         .flux = 100,
                                         .radius = 0.1,
                                         .motion = LightMotionOptions{.sway = 30, .cord = 2}});
  const InstanceDescription& ball = d.instances.back();
  ASSERT_EQ(ball.motion, 0);
  EXPECT_FALSE(ball.is_static);
  const auto p = [&](double time) { return moved(d.motions[0], time, ball.X_BG).p; };
  expect_near(p(0), {1, 0, 2}, 1e-6f);
  // About +X it goes towards +Y first.
  expect_near(p(quarter), {1, 1, 4 - std::sqrt(3.0f)}, 1e-5f);
  expect_near(p(2 * quarter), {1, 0, 2}, 1e-5f);
  expect_near(p(3 * quarter), {1, -1, 4 - std::sqrt(3.0f)}, 1e-5f);
}

}  // namespace
}  // namespace gloam

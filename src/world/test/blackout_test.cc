// [blackout] on the lamps of models and scenes.

#include "world/lights/blackout.h"

#include <gmock/gmock.h>

#include "world/test/visual_test_model.h"

namespace gloam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kLitRoom = R"(<mujoco>
  <visual><headlight ambient=".3 .3 .3" active="1"/></visual>
  <asset><material name="screen" emission="1"/><material name="wall"/></asset>
  <worldbody><light name="ceiling" pos="0 0 3"/><geom size="1" material="screen"/>
  <geom size="1" pos="3 0 0" material="wall"/></worldbody></mujoco>)";

class Blackout : public ::testing::Test {
 protected:
  Blackout() : world_(visual_test::compile(kLitRoom)) {
    world_.scene.lights = {
        {.name = "headlamp", .type = LightType::kSpot, .flux = 100},
        {.name = "panel",
         .type = LightType::kSphere,
         .flux = 100,
         .radius = 0.1,
         .schedule = LightScheduleOptions{.on_off = OnOffOptions{.period = 2, .duty = 0.5}}},
        {.name = "exit_sign", .type = LightType::kPoint, .flux = 10}};
  }
  RenderDescription describe(BlackoutOptions blackout) {
    world_.scene.blackout = std::move(blackout);
    return visual_test::describe(world_);
  }
  std::string error_of(BlackoutOptions blackout) {
    blackout.loc = {"scene.toml", 7, 1};
    world_.scene.blackout = std::move(blackout);
    return visual_test::refusal(world_);
  }
  static double level(const RenderDescription& d, int schedule, double time) {
    return schedule < 0 ? 1 : light_level(d.schedules[static_cast<size_t>(schedule)], time, 1, 0);
  }
  static double lamp(const RenderDescription& d, const std::string& name, double time) {
    for (const LightDescription& light : d.lights) {
      if (light.name == name) return level(d, light.schedule, time);
    }
    for (const MaterialDescription& material : d.materials) {
      if (material.name == name) return level(d, material.schedule, time);
    }
    ADD_FAILURE() << "no lamp " << name;
    return -1;
  }
  CompiledWorld world_;
};

TEST_F(Blackout, TakesOutEveryLampAndBringsItBack) {
  const RenderDescription d = describe({.at = 5, .until = 12});
  for (const char* name : {"ceiling", "headlight", "screen", "headlamp", "panel", "exit_sign"}) {
    EXPECT_EQ(lamp(d, name, 4.5), 1) << name;
    EXPECT_EQ(lamp(d, name, 5), 0) << name;
    EXPECT_EQ(lamp(d, name, 11.999), 0) << name;
    EXPECT_EQ(lamp(d, name, 12.5), 1) << name;
  }
  EXPECT_EQ(lamp(d, "panel", 3.5), 0) << "its own schedule goes on";
  EXPECT_EQ(lamp(d, "wall", 6), 1);
  EXPECT_EQ(level(d, d.sky.schedule, 6), 0) << "ambient light comes from lamps";
}

TEST_F(Blackout, SparesWhatItIsToldAndHasEmergencyLights) {
  const RenderDescription d =
      describe({.at = 5, .except = {"headl*", "screen"}, .emergency = {"exit_sign"}});
  for (const char* name : {"headlamp", "headlight", "screen"}) EXPECT_EQ(lamp(d, name, 6), 1);
  EXPECT_EQ(d.sky.schedule, -1) << "ambient goes with the headlight";
  EXPECT_EQ(lamp(d, "ceiling", 1e6), 0) << "without an end there is none";
  EXPECT_EQ(lamp(d, "exit_sign", 4), 0);
  EXPECT_EQ(lamp(d, "exit_sign", 6), 1);
}

TEST_F(Blackout, TubesStartAnew) {
  const RenderDescription d = describe({.at = 5, .until = 12, .starter = true});
  EXPECT_EQ(lamp(d, "ceiling", 4), 1);
  EXPECT_EQ(lamp(d, "ceiling", 12.1), 0) << "its electrodes are heated first";
  EXPECT_GT(lamp(d, "ceiling", 200), 0.99);
}

TEST_F(Blackout, LeavesTheSunAlone) {
  world_.scene.sky = SkyOptions{.sun_elevation = 30};
  const RenderDescription d = describe({.at = 5});
  EXPECT_EQ(lamp(d, "sun", 6), 1);
  EXPECT_EQ(lamp(d, "ceiling", 6), 0);
}

TEST_F(Blackout, NamesThatNothingHasAreErrors) {
  EXPECT_THAT(error_of({.at = 5, .except = {"headlmap"}}),
              AllOf(HasSubstr("scene.toml:7"), HasSubstr("named 'headlmap'"),
                    HasSubstr("did you mean 'headlamp'?")));
  EXPECT_THAT(error_of({.at = 5, .emergency = {"wall"}}), HasSubstr("named 'wall'"));
  EXPECT_EQ(error_of({.at = 5, .except = {"nothing*"}}), "");
}

}  // namespace
}  // namespace gloam

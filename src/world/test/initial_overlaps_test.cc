#include "world/compile/initial_overlaps.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class InitialOverlaps : public testing::Test {
 protected:
  InitialOverlaps() {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    folder_.write("ball.xml",
                  "<mujoco><worldbody><body name='ball'><freejoint/><geom size='0.2'/>"
                  "</body></worldbody></mujoco>");
    folder_.write("room.xml",
                  "<mujoco><worldbody><geom type='plane' size='5 5 1' name='ground'/>"
                  "<geom name='wall' type='box' size='0.1 5 1' pos='1 0 1'/>"
                  "<body name='bin' pos='-2 0 0.3'><geom type='box' size='.3 .3 .3'/></body>"
                  "</worldbody></mujoco>");
  }
  std::vector<std::string> told(const std::string& text) {
    folder_.write("scene.toml", text);
    const Result<Scene> scene = load_scene(folder_.path() / "scene.toml");
    if (!scene.ok()) return {scene.error().to_string()};
    const Result<World> world = World::compile(*scene);
    if (!world.ok()) return {world.error().to_string()};
    std::vector<std::string> out;
    for (const Error& e : world->notes()) out.push_back(e.to_string());
    return out;
  }
  std::vector<std::string> ball_at(const std::string& position, const std::string& more = "") {
    return told(
        "[environment]\nfile = 'room.xml'\n[[robot]]\nname = 'go'\nfile = 'ball.xml'\n"
        "position = " +
        position + "\n" + more);
  }
  TempFolder folder_;
};

TEST_F(InitialOverlaps, OfRobotsAreToldWithDepthAndPlace) {
  EXPECT_THAT(ball_at("[0, 0, 0.2]"), IsEmpty());
  EXPECT_THAT(ball_at("[0, 0, 0.195]"), IsEmpty());
  EXPECT_THAT(ball_at("[0, 0, 0.1]"),
              ElementsAre(AllOf(HasSubstr("scene.toml:3"),
                                HasSubstr("robot 'go' starts 0.1 m deep in 'ground'"),
                                HasSubstr("change its position"))));
  EXPECT_THAT(ball_at("[0.75, 0, 0.5]"),
              ElementsAre(HasSubstr("robot 'go' starts 0.05 m deep in 'wall'")));
  EXPECT_THAT(ball_at("[-2, 0, 0.75]"),
              ElementsAre(HasSubstr("robot 'go' starts 0.05 m deep in 'bin'")));
  EXPECT_THAT(ball_at("[0, 0, 0.5]",
                      "[[robot]]\nname = 'b'\nfile = 'ball.xml'\nposition = [0.3, 0, 0.5]\n"),
              ElementsAre(HasSubstr("'b/ball'")));
}

TEST_F(InitialOverlaps, OfLooseThingsAreTold) {
  EXPECT_THAT(told("[environment]\nfile = 'room.xml'\n[[prop]]\nname = 'cone'\nkind = "
                   "'traffic_cone'\nposition = [0, 0, -0.1]\nloose = true\n"),
              ElementsAre(AllOf(HasSubstr("scene.toml:3"), HasSubstr("prop 'cone' starts 0.1 m"))));
}

TEST_F(InitialOverlaps, BelowAllFloorsIsTold) {
  const auto bedroom = [&](double z) {
    return told(
        fmt::format("[environment.bedroom]\nseed = 1\n[[robot]]\nname = 'go'\nfile = "
                    "'ball.xml'\nposition = [0, 0, {}]\n",
                    z));
  };
  EXPECT_THAT(bedroom(0.25), IsEmpty());
  EXPECT_THAT(bedroom(-4),
              testing::Contains(HasSubstr("robot 'go' starts 4 m below the lowest floor")));
}

TEST_F(InitialOverlaps, OfABareModelAreItsOwnBusiness) {
  folder_.write("m.xml",
                "<mujoco><worldbody><geom type='plane' size='5 5 1'/><body><freejoint/>"
                "<geom size='0.2'/></body></worldbody></mujoco>");
  const Result<Scene> scene = load_scene(folder_.path() / "m.xml");
  ASSERT_TRUE(scene.ok());
  EXPECT_THAT(World::compile(*scene)->notes(), IsEmpty());
}

TEST_F(InitialOverlaps, SizesThatAKindCannotHaveAreTold) {
  EXPECT_THAT(told("[[prop]]\nname = 'c'\nkind = 'chair'\nsize = [50, 50, 50]\n"),
              ElementsAre(AllOf(HasSubstr("scene.toml:1"), HasSubstr("prop 'c': it is"),
                                HasSubstr("not 50 m"), HasSubstr("size of a chair"))));
  EXPECT_THAT(told("[[prop]]\nname = 'd'\nkind = 'desk'\nsize = [0.7, 1.6, 0.74]\n"), IsEmpty());
}

}  // namespace
}  // namespace gloam

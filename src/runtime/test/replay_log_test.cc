// Logged runs seen again: the same motion, another world to look at.

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "gloam/log.h"
#include "gloam/log_replay.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kDropped = R"(<mujoco model="drop"><option timestep="0.002"/>
<worldbody><light pos="0 0 4"/><geom name="floor" type="plane" size="5 5 .1"/>
<body name="box" pos="0 0 .6" euler="20 30 0"><freejoint/>
  <geom type="box" size=".2 .1 .1" rgba="1 0 0 1"/></body>
<body name="arm" pos="1 0 1"><joint name="swing" axis="0 1 0"/>
  <geom type="capsule" size=".05" fromto="0 0 0 .5 0 0"/></body></worldbody>
<actuator><motor name="swing" joint="swing"/></actuator></mujoco>)";

constexpr const char* kReplayed = R"(
[render]
tier = "path"
spp = 1
denoise = false
[record]
outputs = ["png", "depth_png", "state"]
[[robot]]
name = "toy"
file = "drop.xml"
[[push]]
body = "toy/box"
time = 0.1
velocity = [0.5, 0, 1]
[[camera]]
name = "eye"
position = [-3, -1, 1.5]
look_at = [0, 0, 0.3]
width = 48
height = 32
rate = 10
[sky]
sun_elevation = 40
)";

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Replays : public testing::Test {
 protected:
  Replays() {
    folder_.write("drop.xml", kDropped);
    folder_.write("s.toml", kReplayed);
    RunRequest request{.out = folder_.path() / "first"};
    request.log.file = log_ = folder_.path() / "run.mcap";
    request.log.topics = {"/tf"};
    request.duration = 0.4;
    const auto report =
        run_and_record(*World::compile(*load_scene(folder_.path() / "s.toml")), request, {});
    EXPECT_TRUE(report.ok() && report->status.ok());
  }
  Result<RunReport> replay(std::vector<std::pair<std::string, std::string>> settings,
                           const char* out) {
    LogReplay replay{.log = log_, .settings = std::move(settings)};
    replay.request.out = folder_.path() / out;
    return replay_log(replay, {});
  }
  std::string file(const char* out, const char* name) {
    const fs::path path = folder_.path() / out / name;
    EXPECT_TRUE(fs::exists(path)) << path;
    return text_of(path);
  }

  TempFolder folder_;
  fs::path log_;
};

TEST_F(Replays, AsItWasHasTheSamePixelsAndStates) {
  const auto report = replay({}, "again");
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  ASSERT_TRUE(report->status.ok()) << report->status.error().to_string();
  EXPECT_EQ(report->steps, 200);
  EXPECT_EQ(file("again", "state.csv"), file("first", "state.csv"));
  for (const char* name : {"eye/rgb/000003.png", "eye/depth/000003.png", "eye/poses.csv"})
    EXPECT_EQ(file("again", name), file("first", name)) << name;
}

TEST_F(Replays, UnderAnotherSkyMovesAlikeAndLooksOtherwise) {
  const auto report = replay({{"sky.sun_elevation", "3"},
                              {"weather.visibility", "8"},
                              {"override.toy.geom.floor.rgba", "[0, 0, 1, 1]"}},
                             "dusk");
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  ASSERT_TRUE(report->status.ok()) << report->status.error().to_string();
  EXPECT_EQ(file("dusk", "state.csv"), file("first", "state.csv"));
  EXPECT_EQ(file("dusk", "eye/depth/000003.png"), file("first", "eye/depth/000003.png"));
  EXPECT_NE(file("dusk", "eye/rgb/000003.png"), file("first", "eye/rgb/000003.png"));
}

TEST_F(Replays, OutputsAreThoseAskedForWhateverTheCameraSays) {
  LogReplay replay{
      .log = log_, .settings = {{"camera.eye.outputs", "['depth_png']"}}, .outputs = {"png"}};
  replay.request.out = folder_.path() / "png";
  replay.request.duration = 0.1;
  ASSERT_TRUE(replay_log(replay, {}).ok());
  EXPECT_TRUE(fs::exists(folder_.path() / "png" / "eye" / "rgb" / "000000.png"));
  EXPECT_FALSE(fs::exists(folder_.path() / "png" / "eye" / "depth"));
}

TEST_F(Replays, SettingThatChangesTheMotionIsRefusedByName) {
  const auto heavier =
      replay({{"sky.sun_elevation", "3"}, {"override.toy.geom..*.density", "2000"}}, "heavy");
  ASSERT_FALSE(heavier.ok());
  EXPECT_THAT(heavier.error().to_string(), HasSubstr("density"));
  EXPECT_FALSE(replay({{"sim.timestep", "0.001"}}, "fast").ok());
  EXPECT_THAT(replay({{"weather.visibilty", "8"}}, "typo").error().to_string(),
              HasSubstr("visibility"));
}

// Fog has no forces and the run no Commands: its scene, stepped, moves as what was followed.
TEST_F(Replays, ItsOwnLogHasTheSameStates) {
  LogReplay replay{.log = log_, .settings = {{"weather.visibility", "8"}}};
  replay.request.log.file = folder_.path() / "second.mcap";
  replay.request.log.topics = {"/tf"};
  ASSERT_TRUE(replay_log(replay, {}).ok());
  const auto found = verify_log(replay.request.log.file, "", {});
  ASSERT_TRUE(found.ok()) << found.error().to_string();
  EXPECT_TRUE(found->is_equal()) << found->where;
  EXPECT_EQ(found->steps, 200);
}

}  // namespace
}  // namespace gloam

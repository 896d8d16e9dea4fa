// Logged runs seen again: the same motion, another world to look at.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "gloam/log.h"
#include "gloam/log_player.h"
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
      replay({{"sky.sun_elevation", "3"}, {"override.toy.geom.\".*\".density", "2000"}}, "heavy");
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

TEST_F(Replays, OverlaysAddCamerasAndLidars) {
  folder_.write(
      "more.toml",
      "[[camera]]\nname = \"second\"\nposition = [3, 0, 1]\nlook_at = [0, 0, 0]\nwidth = 16\n"
      "height = 12\nrate = 10\n[[lidar]]\nname = \"roof\"\nbody = \"toy/arm\"\n");
  LogReplay replay{.log = log_, .overlays = {folder_.path() / "more.toml"}};
  replay.outputs = {"png", "lidar"};
  replay.request.out = folder_.path() / "more";
  const auto report = replay_log(replay, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  EXPECT_TRUE(fs::exists(folder_.path() / "more" / "second" / "rgb" / "000003.png"));
  EXPECT_EQ(file("more", "eye/rgb/000003.png"), file("first", "eye/rgb/000003.png"));
  folder_.write("heavy.toml", "[override.toy.geom.floor]\nfriction = \"2 1 1\"\n");
  replay.overlays = {folder_.path() / "heavy.toml"};
  const auto heavy = replay_log(replay, {});
  ASSERT_FALSE(heavy.ok());
  EXPECT_THAT(heavy.error().to_string(), HasSubstr("heavy.toml' changes the motion"));
}

/// Rows of state.csv by their first cell, the time.
std::map<double, std::vector<double>> states_of(const std::string& csv) {
  std::map<double, std::vector<double>> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);  // names
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    rows[row.at(0)] = row;
  }
  return rows;
}

// Logged 100 times a second, as state.csv is: there poses are what they were.
TEST_F(Replays, PeopleAreAddedAndWalkWhileBodiesMoveAsLogged) {
  folder_.write("people.toml", R"(
[[agent]]
name = "ada"
position = [0, 1.5, 0]
heading = -90
speed = 1.5
behavior = "spline"
route = [{ position = [0, 1.5, 0] }, { position = [0, -2, 0] }]
)");
  std::map<ReplayMotion, std::string> last;
  for (const ReplayMotion motion : {ReplayMotion::kStepped, ReplayMotion::kPoses}) {
    const std::string out = fmt::format("people{}", static_cast<int>(motion));
    LogReplay replay{.log = log_, .motion = motion, .overlays = {folder_.path() / "people.toml"}};
    replay.outputs = {"segmentation", "state"};
    replay.request.out = folder_.path() / out;
    const auto report = replay_log(replay, {});
    ASSERT_TRUE(report.ok()) << report.error().to_string();
    ASSERT_TRUE(report->status.ok()) << report->status.error().to_string();
    if (motion == ReplayMotion::kStepped) {
      EXPECT_EQ(file(out.c_str(), "state.csv"), file("first", "state.csv"));
    }
    const auto instances = [&](int frame) {
      return file(out.c_str(), fmt::format("eye/instance/{:06}.png", frame).c_str());
    };
    EXPECT_NE(instances(1), instances(3)) << "she walks";
    last[motion] = instances(3);
  }
  EXPECT_EQ(last[ReplayMotion::kStepped], last[ReplayMotion::kPoses]);
}

TEST_F(Replays, PosesAreThoseOfTheLog) {
  LogReplay replay{.log = log_, .motion = ReplayMotion::kPoses};
  replay.request.out = folder_.path() / "poses";
  const auto report = replay_log(replay, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  ASSERT_TRUE(report->status.ok()) << report->status.error().to_string();
  EXPECT_THAT(report->notes, testing::ElementsAre(HasSubstr("poses only")));
  EXPECT_EQ(file("poses", "eye/rgb/000003.png"), file("first", "eye/rgb/000003.png"));
  const auto first = states_of(file("first", "state.csv"));
  const auto poses = states_of(file("poses", "state.csv"));
  ASSERT_EQ(first.size(), poses.size());
  for (const auto& [time, row] : first)
    for (size_t i = 0; i < 1 + 8; ++i)  // time, qpos of box and arm
      EXPECT_NEAR(row[i], poses.at(time)[i], 1e-12) << time << " " << i;
}

// Another paint is another model: its bits are not promised, its poses are those of the log.
TEST_F(Replays, ChangedFilesLeaveThePoses) {
  std::string painted = kDropped;
  painted.replace(painted.find("1 0 0 1"), 7, "0 0 1 1");
  folder_.write("drop.xml", painted);
  const auto report = replay({}, "painted");
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  ASSERT_TRUE(report->status.ok()) << report->status.error().to_string();
  ASSERT_EQ(report->notes.size(), 1u);
  EXPECT_THAT(report->notes[0], HasSubstr("poses only"));
  EXPECT_THAT(report->notes[0], HasSubstr("drop.xml"));
  EXPECT_NE(file("painted", "eye/rgb/000003.png"), file("first", "eye/rgb/000003.png"));
  EXPECT_EQ(file("painted", "eye/depth/000003.png"), file("first", "eye/depth/000003.png"));
  EXPECT_FALSE(verify_log(log_, "", {}).ok());
}

TEST_F(Replays, ARunAnewIsAnother) {
  LogReplay replay{.log = log_,
                   .motion = ReplayMotion::kNewRun,
                   .settings = {{"override.toy.geom.\".*\".density", "2000"}}};
  replay.request.out = folder_.path() / "anew";
  const auto report = replay_log(replay, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  EXPECT_THAT(report->notes, testing::ElementsAre(HasSubstr("a new run")));
  EXPECT_EQ(report->steps, 200);
  EXPECT_NE(file("anew", "state.csv"), file("first", "state.csv"));
  replay.settings.clear();
  replay.request.out = folder_.path() / "same";
  ASSERT_TRUE(replay_log(replay, {}).ok());
  EXPECT_EQ(file("same", "state.csv"), file("first", "state.csv"));
}

TEST_F(Replays, VariantsAreDrawnOnceEachAndGoOn) {
  folder_.write("skies.toml", "[[randomize]]\noption = \"sky.sun_elevation\"\nuniform = [5, 80]\n");
  VariantRequest request{.replay = {.log = log_, .outputs = {"png"}},
                         .randomize = folder_.path() / "skies.toml",
                         .count = 2};
  request.replay.request.out = folder_.path() / "skies";
  const auto two = replay_variants(request, {});
  ASSERT_TRUE(two.ok()) << two.error().to_string();
  const std::string first = file("skies", "0000/eye/rgb/000001.png");
  EXPECT_NE(first, file("skies", "0001/eye/rgb/000001.png"));
  std::string summary = file("skies", "0001/summary.json");
  summary.replace(summary.find("finished"), 8, "recording");  // as if it had been stopped
  folder_.write("skies/0001/summary.json", summary);
  request.count = 3;
  const auto three = replay_variants(request, {});
  ASSERT_TRUE(three.ok()) << three.error().to_string();
  ASSERT_EQ(three->size(), 3u);
  EXPECT_TRUE((*three)[0].was_done);
  EXPECT_FALSE((*three)[1].was_done);
  EXPECT_EQ((*three)[2].seed, 3u);
  EXPECT_EQ(file("skies", "0000/eye/rgb/000001.png"), first);
  request.replay.settings = {{"weather.visibility", "8"}};
  EXPECT_THAT(replay_variants(request, {}).error().to_string(), HasSubstr("another log"));
}

// Where the run was at 0.2 s, stepped on, is where it came to.
TEST_F(Replays, AreGoneOnFrom) {
  const auto from = log_checkpoint(log_, "", 0, 0.205);
  ASSERT_TRUE(from.ok()) << from.error().to_string();
  EXPECT_EQ(from->step(), 100);
  RunRequest request{.out = folder_.path() / "rest", .duration = 0.2, .from = *from};
  request.log = {.file = folder_.path() / "rest.mcap", .topics = {"/tf"}};
  const auto report = run_and_record(from->world(), request, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  EXPECT_EQ(report->steps, 200);
  const auto first = states_of(file("first", "state.csv"));
  const auto rest = states_of(file("rest", "state.csv"));
  EXPECT_EQ(rest.size(), 21u);
  for (const auto& [time, row] : rest) EXPECT_EQ(row, first.at(time)) << time;
  const auto found = verify_log(request.log.file, "", {});  // from its beginning on
  ASSERT_TRUE(found.ok()) << found.error().to_string();
  EXPECT_TRUE(found->is_equal()) << found->where;
  EXPECT_TRUE(found->notes.empty());
  EXPECT_EQ(found->steps, 200);
  EXPECT_FALSE(log_checkpoint(log_, "", 1, 0.2).ok());
}

TEST_F(Replays, ArePlayedForwardsAndBack) {
  auto player = *LogPlayer::open({.log = log_});
  Simulation& simulation = player->simulation();
  EXPECT_DOUBLE_EQ(player->end(), 0.4);
  const auto first = states_of(file("first", "state.csv"));
  const auto height = [&] { return simulation.latest().state()[1 + 2]; };
  ASSERT_TRUE(player->seek(0.3).ok());
  EXPECT_EQ(simulation.latest().step(), 150);
  EXPECT_NEAR(height(), first.lower_bound(0.2999)->second[3], 1e-12);
  ASSERT_TRUE(player->seek(0.1).ok());
  EXPECT_NEAR(height(), first.lower_bound(0.0999)->second[3], 1e-12);
  ASSERT_TRUE(simulation.step(5).ok());
  EXPECT_EQ(simulation.latest().step(), 55);
  EXPECT_FALSE(player->seek(0.5).ok());
  ASSERT_TRUE(simulation.run_until(1000).ok());  // stands still at the end
  EXPECT_EQ(simulation.latest().step(), 200);
  ASSERT_TRUE(player->seek(0).ok());
  EXPECT_EQ(simulation.latest().step(), 0);
}

}  // namespace
}  // namespace gloam

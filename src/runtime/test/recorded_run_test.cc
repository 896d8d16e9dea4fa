// Whole recorded runs: what lies in the folder, and that it depends on World and seed alone.

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/files.h"
#include "base/hash.h"
#include "base/test/source_dir.h"
#include "gloam/program.h"
#include "gloam/run.h"
#include "scenes.h"
#include "world/world.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const char* const kCameras = R"(
[[camera]]
name = "side"
position = [0, -2, 1]
look_at = [0, 0, 0]
width = 32
height = 24
rate = 25
[sim]
duration = 0.4
seed = 5
[record]
outputs = ["png", "depth_png", "depth_exr", "segmentation", "motion_exr", "scene_flow_exr", "boxes_json", "normal_exr", "video", "metrics", "contact_sheet"]
)";

class RecordedRun : public ::testing::Test {
 protected:
  void SetUp() override { set_log_level(LogLevel::kOff); }
  void TearDown() override {
    set_log_level(LogLevel::kInfo);
    set_thread_count(0);
  }

  RunRequest request(const std::string& name) const {
    RunRequest request;
    request.out = folder_.path() / name;
    request.cameras = {"side", "a/rider"};
    request.width = 32;
    request.height = 24;
    request.simulation.seed = 5;
    return request;
  }
  RunReport run(const World& world, const RunRequest& request,
                const ProgressCallback& progress = {}) const {
    const Result<RunReport> report = run_and_record(world, request, progress);
    if (!report.ok()) {
      ADD_FAILURE() << report.error().to_string();
      abort();
    }
    return *report;
  }
  static Json summary(const RunReport& report) {
    return Json::parse(read_text_file(report.out / "summary.json").value());
  }
  /// Every file but the summary, which holds wall times, by its relative name.
  static std::map<std::string, std::vector<uint8_t>> files(const fs::path& folder) {
    std::map<std::string, std::vector<uint8_t>> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const fs::path name = entry.path().lexically_relative(folder);
      if (entry.is_regular_file() && name != "summary.json")
        files[name.string()] = read_file(entry.path()).value();
    }
    return files;
  }

  TempFolder folder_;
};

size_t count_lines(const fs::path& path) {
  const std::string text = read_text_file(path).value();
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

// Without pictures to record there is no camera, no label table, and nothing rendered.
TEST_F(RecordedRun, StateNeedsNoPictures) {
  const World world = flight(folder_, R"([sim]
duration = 0.1
[record]
outputs = ["state"]
)");
  RunRequest only = request("out");
  only.cameras.clear();
  const RunReport report = run(world, only);
  EXPECT_TRUE(report.status.ok());
  EXPECT_EQ(report.frames, 0);
  EXPECT_TRUE(summary(report)["cameras"].empty());
  std::istringstream table(read_text_file(report.out / "state.csv").value());
  std::string head, row;
  std::getline(table, head);
  EXPECT_EQ(head,
            "time_s,a/ball.x_m,a/ball.y_m,a/ball.z_m,a/ball.qw,a/ball.qx,a/ball.qy,a/ball.qz,"
            "a/ball.vx_mps,a/ball.vy_mps,a/ball.vz_mps,a/ball.wx_radps,a/ball.wy_radps,"
            "a/ball.wz_radps,a/ball.body.x_m,a/ball.body.y_m,a/ball.body.z_m,a/ball.body.qw,"
            "a/ball.body.qx,a/ball.body.qy,a/ball.body.qz");
  std::vector<double> last;
  while (std::getline(table, row)) {
    last.clear();
    std::istringstream fields(row);
    for (std::string field; std::getline(fields, field, ',');) last.push_back(std::stod(field));
  }
  ASSERT_EQ(last.size(), 21u);
  EXPECT_NEAR(last[0], 0.1, 1e-12);
  EXPECT_NEAR(last[1], 0.1, 1e-9) << "1 m/s along X";
  EXPECT_NEAR(last[8], 1, 1e-12);
  EXPECT_NEAR(last[14], 0.1, 1e-9) << "the pose of that instant, not of the step before";
}

TEST_F(RecordedRun, SettingsThatTheFileHasNotAreInTheSummary) {
  const World world = flight(folder_, std::string(kCameras));
  RunRequest only = request("as_written");
  const Scene& written = world.compiled()->written;
  Scene scene = written;
  scene.record.outputs = {"metrics"};
  const Json before = summary(run(*World::compile(scene), only))["settings"];
  EXPECT_FALSE(before.contains("record.outputs")) << "nothing of the run";
  for (const auto& [path, value] :
       {std::pair("sim.duration", "0.02"), std::pair("camera.side.fovy", "33"),
        std::pair("weather.visibility", "8"), std::pair("sim.seed", "6"),
        std::pair("render.spp", "2")})
    ASSERT_TRUE(set_option(scene, path, value).ok()) << path;
  only.out = folder_.path() / "changed";
  Json after = summary(run(*World::compile(scene), only))["settings"];
  EXPECT_EQ(after["sim.duration"], "0.02");
  EXPECT_EQ(after["camera.side.fovy"], "33.0");
  EXPECT_EQ(after["weather.visibility"], "8.0");
  EXPECT_EQ(after["spp"], "2");
  for (const char* path : {"sim.duration", "camera.side.fovy", "weather.visibility"})
    after.erase(path);
  after["spp"] = before["spp"];
  EXPECT_EQ(after, before) << "nothing else is another";
}

TEST_F(RecordedRun, HoldsWhatTheSceneAsksFor) {
  const World world = flight(folder_, kCameras);
  std::vector<double> done;
  const RunReport report = run(world, request("out"), [&](const Progress& progress) {
    done.push_back(progress.done);
    return true;
  });
  EXPECT_TRUE(report.status.ok()) << report.status.error().to_string();
  EXPECT_EQ(report.steps, 200);
  EXPECT_NEAR(report.sim_time, 0.4, 1e-9);
  EXPECT_EQ(report.frames, 11 + 9) << "25 Hz and the default of 20 Hz, from 0 to 0.4 s";
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  for (const std::string& file : report.written) EXPECT_TRUE(fs::exists(file)) << file;

  const Json json = summary(report);
  EXPECT_EQ(json["state"], "finished");
  EXPECT_EQ(json["exit_reason"], "completed");
  EXPECT_TRUE(json["recording_error"].is_null());
  EXPECT_EQ(json["seed"], 5);
  EXPECT_EQ(json["steps"], 200);
  EXPECT_EQ(json["timestep_s"], 0.002);
  EXPECT_EQ(json["planned_s"], 0.4);
  EXPECT_EQ(json["final_state_hash"], hash_to_hex(report.hash));
  EXPECT_EQ(json["versions"]["gloam"], version());
  EXPECT_EQ(json["versions"]["mujoco"], "4.0.1");
  EXPECT_EQ(json["scene"]["file"], "scene.toml");
  EXPECT_EQ(json["settings"]["tier"], "path");
  EXPECT_EQ(json["cameras"][0]["frames"], 11);
  EXPECT_EQ(json["cameras"][1]["frames"], 9);
  EXPECT_EQ(json["metrics"]["rows"], 41) << "100 Hz from 0 to 0.4 s";
  EXPECT_NEAR(json["results"]["a.path_length_m"], 0.4, 1e-6);
  EXPECT_GE(json["timings_s"]["total_s"], json["timings_s"]["run_s"]);
  EXPECT_EQ(count_lines(report.out / "metrics.csv"), 42u);
  EXPECT_EQ(count_lines(report.out / "side" / "poses.csv"), 12u);
  for (const char* kind : {"rgb", "depth", "depth_exr", "instance", "semantic", "part", "motion",
                           "scene_flow", "boxes", "normal"}) {
    const auto folder = fs::directory_iterator(report.out / "side" / kind);
    EXPECT_EQ(std::distance(fs::begin(folder), fs::end(folder)), 11) << kind;
  }
  EXPECT_GT(fs::file_size(report.out / "side.mp4"), 500u);
  EXPECT_TRUE(fs::exists(report.out / "contact_sheet.png"));
}

TEST_F(RecordedRun, CamerasWithoutANameAreRecordedAsWell) {
  const World world = compile_text(folder_, "unnamed.xml", R"(
<mujoco><worldbody><light pos="0 0 3"/><geom size="1"/>
  <camera pos="0 -5 0" xyaxes="1 0 0 0 0 1"/><camera name="camera_0" pos="0 -6 0" xyaxes="1 0 0 0 0 1"/>
  <camera pos="0 -7 0" xyaxes="1 0 0 0 0 1"/></worldbody></mujoco>)");
  std::vector<std::string> names;
  for (const NamedElement& camera : world.info().cameras) names.push_back(camera.name);
  EXPECT_EQ(names, (std::vector<std::string>{"camera_0_", "camera_0", "camera_2"}));
  for (size_t i = 0; i < names.size(); ++i)
    EXPECT_EQ(world.find_camera(names[i])->id, static_cast<int>(i));
  RunRequest all = request("out");
  all.cameras.clear();
  all.duration = 0.1;
  const RunReport report = run(world, all);
  EXPECT_TRUE(report.status.ok());
  for (const std::string& name : names)
    EXPECT_TRUE(fs::exists(report.out / (name + ".mp4"))) << name;
}

// The contract of determinism, on files: same World and seed, same bytes.
TEST_F(RecordedRun, FilesDoNotDependOnThreadsOrRepetition) {
  for (const std::string tier : {"direct", "path"}) {
    const World world =
        flight(folder_, std::string(kCameras) + "[render]\nspp = 2\ndenoise = " +
                            (tier == "path" ? "true" : "false") + "\ntier = \"" + tier + "\"\n");
    set_thread_count(1);
    const RunReport one = run(world, request(tier + "_one"));
    set_thread_count(4);
    const RunReport four = run(world, request(tier + "_four"));
    const RunReport again = run(world, request(tier + "_again"));
    EXPECT_EQ(one.hash, four.hash);
    EXPECT_EQ(one.hash, again.hash);
    const auto expected = files(one.out);
    EXPECT_GT(expected.size(), 60u);
    for (const RunReport& other : {four, again}) {
      const auto found = files(other.out);
      ASSERT_EQ(found.size(), expected.size());
      for (const auto& [name, bytes] : expected)
        EXPECT_TRUE(found.contains(name) && found.at(name) == bytes) << tier << " " << name;
    }
    RunRequest seeded = request(tier + "_seed");
    seeded.simulation.seed = 6;
    EXPECT_NE(files(run(world, seeded).out).at("side/rgb/000003.png"),
              expected.at("side/rgb/000003.png"))
        << "the seed is what the samples are drawn from";
  }
}

TEST_F(RecordedRun, PhysicsDoesNotDependOnBeingRecorded) {
  const World world = flight(folder_, kCameras);
  RunRequest silent = request("nothing");
  silent.out.clear();
  const RunReport unrecorded = run(world, silent);
  EXPECT_EQ(unrecorded.frames, 0);
  EXPECT_FALSE(fs::exists(folder_.path() / "nothing"));
  EXPECT_EQ(run(world, request("out")).hash, unrecorded.hash);
  auto bare = simulate(world, {.seed = 5});
  ASSERT_TRUE(bare->run_until(200).ok());
  EXPECT_EQ(bare->latest().hash(), unrecorded.hash);
}

// The main job itself: controller, contacts, two cameras in the furnished room.
TEST_F(RecordedRun, TheDemoDoesNotDependOnThreadsOrRecording) {
  ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
  const Result<Scene> scene = load_scene(source_dir() / "examples/demo.toml");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  const Result<World> world = World::compile(*scene);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  RunRequest recorded = request("one");
  recorded.cameras.clear();
  recorded.width = 96;
  recorded.height = 72;
  recorded.rate = {10, 1};
  recorded.duration = 0.5;
  RunRequest silent = recorded;
  silent.out.clear();
  const uint64_t hash = run(*world, silent).hash;
  set_thread_count(1);
  const RunReport one = run(*world, recorded);
  set_thread_count(4);
  recorded.out = folder_.path() / "four";
  const RunReport four = run(*world, recorded);
  EXPECT_EQ(one.hash, hash);
  EXPECT_EQ(four.hash, hash);
  EXPECT_EQ(one.frames, 12) << "of two cameras";
  const auto expected = files(one.out), found = files(four.out);
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [name, bytes] : expected)
    EXPECT_TRUE(found.contains(name) && found.at(name) == bytes) << name;
}

TEST_F(RecordedRun, AnInterruptedRunIsFinishedProperly) {
  const World world = flight(folder_, kCameras);
  RunRequest long_run = request("out");
  long_run.duration = 1e6;
  const fs::path picture = long_run.out / "side/rgb/000000.png";
  const RunReport report =
      run(world, long_run, [&](const Progress&) { return !fs::exists(picture); });
  ASSERT_FALSE(report.status.ok());
  EXPECT_EQ(report.status.error().exit_code(), 130);
  const Json json = summary(report);
  EXPECT_EQ(json["state"], "finished");
  EXPECT_EQ(json["exit_reason"], report.status.error().to_string());
  EXPECT_EQ(json["steps"], report.steps);
  EXPECT_GT(json["cameras"][0]["frames"], 0);
  EXPECT_EQ(json["metrics"]["rows"].get<size_t>() + 1, count_lines(report.out / "metrics.csv"));
}

TEST_F(RecordedRun, ADivergedRunKeepsWhatCameBefore) {
  folder_.write("flight.xml", "");
  const World world = compile_text(folder_, "unstable.xml", R"(
<mujoco><option timestep="0.01" gravity="0 0 0"/>
  <worldbody><light pos="0 0 3"/><camera name="c" pos="0 -2 0" xyaxes="1 0 0 0 0 1"/>
    <body><joint name="j" type="slide" stiffness="-60" springref="-0.001"/>
      <geom size="0.1" mass="0.001" contype="0" conaffinity="0"/></body>
  </worldbody></mujoco>)");
  RunRequest unstable = request("out");
  unstable.cameras = {"c"};
  unstable.duration = 100;
  const RunReport report = run(world, unstable);
  ASSERT_FALSE(report.status.ok());
  EXPECT_EQ(report.status.error().kind, ErrorKind::kDiverged);
  EXPECT_EQ(report.status.error().exit_code(), 3);
  EXPECT_LT(report.steps, 10000);
  const Json json = summary(report);
  EXPECT_NE(json["exit_reason"].get<std::string>().find("diverged"), std::string::npos);
  EXPECT_EQ(json["steps"], report.steps);
  EXPECT_GT(fs::file_size(report.out / "c.mp4"), 100u);
}

TEST_F(RecordedRun, WhatCannotStartLeavesNothingBehind) {
  const World world = flight(folder_, kCameras);
  struct Case {
    const char* word;  // that the message must hold
    std::function<void(RunRequest&)> change;
  };
  const std::vector<Case> cases = {
      {"a/rider", [](RunRequest& r) { r.cameras = {"a/ridr"}; }},
      {"16384", [](RunRequest& r) { r.width = -5; }},
      {"16384", [](RunRequest& r) { r.width = 0; }},
      {"16384", [](RunRequest& r) { r.height = 99999; }},
      {"1000", [](RunRequest& r) { r.rate = {1000, 1}; }},
      {"duration", [](RunRequest& r) { r.duration = 1e300; }},
      {"duration", [](RunRequest& r) { r.duration = std::numeric_limits<double>::infinity(); }},
      {"video", [](RunRequest& r) { r.width = r.height = 8; }},
      {"timestep", [](RunRequest& r) { r.simulation.timestep = 1e9; }},
      {"speed",
       [](RunRequest& r) {
         r.simulation.pace = Pace::kRealTime;
         r.simulation.speed = -1;
       }},
  };
  for (const Case& one : cases) {
    RunRequest broken = request("out");
    one.change(broken);
    const Result<RunReport> report = run_and_record(world, broken, {});
    ASSERT_FALSE(report.ok()) << one.word;
    EXPECT_NE(report.error().to_string().find(one.word), std::string::npos)
        << report.error().to_string();
    EXPECT_FALSE(fs::exists(folder_.path() / "out")) << one.word;
  }
  folder_.write("file", "in the way");
  RunRequest blocked = request("file/out");
  const Result<RunReport> report = run_and_record(world, blocked, {});
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().kind, ErrorKind::kIo);
  EXPECT_NE(report.error().to_string().find("file"), std::string::npos);
}

}  // namespace
}  // namespace gloam

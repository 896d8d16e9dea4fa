// Lists of streams and inputs, Snapshots by subscription, batches of Commands, calls from
// hooks, pictures of given Snapshots.

#include <gmock/gmock.h>

#include <atomic>

#include "gloam/controller.h"
#include "gloam/render.h"
#include "gloam/simulation.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

constexpr const char* kArm = R"(<mujoco model="arm"><option timestep="0.002"/>
<worldbody><light pos="0 0 3"/><geom name="floor" type="plane" size="2 2 .1"/>
<body name="upper" pos="0 0 1"><joint name="shoulder" axis="0 1 0" damping="1"/>
  <geom type="capsule" size=".05" fromto="0 0 0 .4 0 0"/>
  <body name="lower" pos=".4 0 0"><joint name="elbow" axis="0 1 0" damping="1"/>
    <geom type="capsule" size=".04" fromto="0 0 0 .3 0 0"/><site name="imu" pos=".1 0 0"/></body></body>
<body name="target" mocap="true" pos="1 0 1"><geom size=".05" contype="0" conaffinity="0"/></body>
</worldbody>
<actuator><motor name="s" joint="shoulder" ctrlrange="-5 5"/><motor name="e" joint="elbow"/></actuator>
<sensor><gyro name="gyro" site="imu"/></sensor></mujoco>)";

constexpr const char* kScene = R"(
[sim]
timestep = 0.002
[[robot]]
name = "left"
file = "arm.xml"
[[robot]]
name = "right"
file = "arm.xml"
position = [0, 2, 0]
[[camera]]
name = "eye"
body = "left/lower"
position = [0, 0, 0.1]
rate = 10
width = 32
height = 24
[[lidar]]
name = "roof"
preset = "VLP-16"
position = [-1, -1, 1]
rate = 5
[[lidar]]
name = "front"
preset = "OS1-64"
)";

class Streams : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("arm.xml", kArm);
    const Result<Scene> scene = parse_scene(kScene, folder_.path());
    ASSERT_TRUE(scene.ok()) << scene.error().to_string();
    const Result<World> world = World::compile(*scene);
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    world_ = *world;
  }
  std::unique_ptr<Simulation> start() {
    auto simulation = Simulation::create(world_, {.pace = Pace::kLockstep});
    EXPECT_TRUE(simulation.ok());
    return std::move(*simulation);
  }
  StreamInfo stream(StreamKind kind, const std::string& name) {
    for (const StreamInfo& info : world_.streams())
      if (info.kind == kind && info.name == name) return info;
    ADD_FAILURE() << "no stream " << name;
    return {};
  }
  static std::vector<std::string> lidar_topics(const Simulation& simulation) {
    std::vector<std::string> names;
    for (const TopicInfo& topic : *simulation.topics())
      if (topic.source.kind == TopicSource::Kind::kLidar) names.push_back(topic.name);
    return names;
  }
  Body body(const std::string& name) { return *world_.find_body(name); }

  TempFolder folder_;
  World world_;
};

TEST_F(Streams, OfAWorldAreListedWithFramesRatesAndParents) {
  const StreamInfo eye = stream(StreamKind::kCamera, "eye");
  EXPECT_EQ(eye.frame_id, "eye_optical_frame");
  EXPECT_EQ(eye.parent.id, body("left/lower").id);
  EXPECT_NEAR(eye.X_PS.p.z, 0.1, 1e-12);
  EXPECT_EQ(eye.rate, (Rational{10, 1}));
  EXPECT_THAT(eye.outputs, Contains("depth"));
  const StreamInfo roof = stream(StreamKind::kLidar, "roof");
  EXPECT_EQ(roof.rate, (Rational{5, 1}));
  EXPECT_EQ(roof.parent.id, 0);
  EXPECT_EQ(stream(StreamKind::kLidar, "front").rate, (Rational{10, 1})) << "its preset's";
  const StreamInfo gyro = stream(StreamKind::kSensor, "right/gyro");
  EXPECT_EQ(gyro.frame_id, "right/imu");
  EXPECT_EQ(gyro.parent.id, body("right/lower").id);
  EXPECT_NEAR(gyro.X_PS.p.x, 0.1, 1e-12);
  EXPECT_EQ(gyro.unit, "rad/s");
  EXPECT_EQ(gyro.rate.num, 0) << "the truth, at every step";
  EXPECT_THAT(gyro.outputs, SizeIs(3));
  EXPECT_THAT(stream(StreamKind::kJoints, "left").outputs,
              ElementsAre("left/shoulder", "left/elbow"));
  EXPECT_THAT(stream(StreamKind::kPoses, "world").outputs, Contains("right/upper"));
}

TEST_F(Streams, InputsHaveTheirActuatorsAndLimits) {
  std::vector<std::string> names, fields;
  for (const InputInfo& input : world_.inputs()) {
    if (input.kind == InputKind::kLiveField) {
      fields.push_back(input.name);
      EXPECT_GT(input.count, 0) << input.name;
      EXPECT_LT(input.low.at(0), input.high.at(0));
      continue;
    }
    names.push_back(std::string(to_string(input.kind)) + " " + input.name);
    if (input.kind != InputKind::kControls) continue;
    EXPECT_THAT(input.elements, ElementsAre(input.name + "/s", input.name + "/e"));
    EXPECT_EQ(input.low[0], -5);
    EXPECT_EQ(input.high[1], std::numeric_limits<double>::infinity());
  }
  EXPECT_THAT(names, ElementsAre("controls left", "controls right", "mocap left/target",
                                 "mocap right/target"));
  EXPECT_THAT(fields, Contains("body_mass"));
  EXPECT_THAT(fields, Not(Contains("height_field"))) << "there is none";
}

TEST_F(Streams, RobotsAndBodiesKnowEachOther) {
  const std::vector<RobotInfo> robots = world_.robots();
  ASSERT_THAT(robots, SizeIs(2));
  EXPECT_EQ(robots[1].name, "right");
  EXPECT_EQ(world_.find_robot("right")->id, 1);
  EXPECT_THAT(world_.find_robot("rigth").error().to_string(), HasSubstr("right"));
  EXPECT_THAT(robots[1].joints, SizeIs(2));
  EXPECT_EQ(robots[1].actuators[1].id, world_.find_actuator("right/e")->id);
  const BodyInfo lower = world_.bodies()[static_cast<size_t>(body("right/lower").id)];
  EXPECT_EQ(lower.name, "right/lower");
  EXPECT_EQ(lower.parent.id, body("right/upper").id);
  EXPECT_EQ(lower.robot.id, 1);
  EXPECT_EQ(world_.bodies()[0].robot.id, -1);
  EXPECT_EQ(world_.scene().cameras[0].name, "eye");
}

TEST_F(Streams, ASubscriberSeesEveryStepOrARate) {
  const auto simulation = start();
  std::vector<int64_t> all, some;
  {
    const auto every = simulation->open_snapshots(
        {.required = true}, [&](const Snapshot& s) { all.push_back(s.step()); });
    const auto tenth = simulation->open_snapshots(
        {.rate = {50, 1}, .required = true}, [&](const Snapshot& s) { some.push_back(s.step()); });
    ASSERT_TRUE(every.ok() && tenth.ok());
    EXPECT_FALSE(simulation->open_snapshots({.rate = {1000, 1}}, {}).ok()) << "faster than steps";
    EXPECT_FALSE(simulation->open_snapshots({.capacity = 0}, {}).ok());
    ASSERT_TRUE(simulation->step(40).ok());
    (*every)->flush();
    (*tenth)->flush();
  }
  ASSERT_EQ(all.size(), 41u);
  for (size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], static_cast<int64_t>(i));
  EXPECT_THAT(some, ElementsAre(0, 10, 20, 30, 40));
}

TEST_F(Streams, BatchesApplyTogetherOrNotAtAll) {
  const auto simulation = start();
  const Robot left = *world_.find_robot("left"), right = *world_.find_robot("right");
  const std::vector<Command> good = {{.step = 3, .what = SetControls{left, {1, 2}}},
                                     {.step = 3, .what = SetControls{right, {-1, -2}}}};
  ASSERT_TRUE(simulation->post(good).ok());
  std::vector<Command> bad = good;
  bad[1].what = SetControls{right, {5}};
  EXPECT_THAT(simulation->post(bad).error().to_string(), HasSubstr("2 actuators, not 1"));
  bad[1].what = SetControls{{7, 0}, {5, 5}};
  EXPECT_FALSE(simulation->post(bad).ok());
  ASSERT_TRUE(simulation->step(3).ok());
  const Actuator e = *world_.find_actuator("left/e");
  EXPECT_EQ(simulation->latest().control(e), 0);
  ASSERT_TRUE(simulation->step(1).ok());
  EXPECT_EQ(simulation->latest().control(e), 2);
  EXPECT_EQ(simulation->latest().control(*world_.find_actuator("right/s")), -1);
  const std::vector<LoggedCommand> log = simulation->take_command_log();
  ASSERT_THAT(log, SizeIs(2));
  EXPECT_EQ(log[1].command.step, 3);
  EXPECT_THAT(simulation->take_command_log(), SizeIs(0));
}

TEST_F(Streams, CallsFromAHookAreAnsweredOrRefusedAndNeverAbort) {
  const auto simulation = start();
  std::vector<std::string> refused;
  double time = -1;
  bool once = false;
  Simulation* raw = simulation.get();
  ASSERT_TRUE(simulation
                  ->set_step_hook([&, raw](const mjModel_*, mjData_*) {
                    if (std::exchange(once, true)) return;
                    time = raw->latest().time();
                    EXPECT_TRUE(raw->status().ok());
                    EXPECT_EQ(raw->stats().step, 0);
                    EXPECT_TRUE(raw->post(Command{.what = SetControls{{0, 0}, {1, 1}}}).ok());
                    raw->pause();
                    const auto note = [&](const Status& status) {
                      refused.push_back(status.ok() ? "ok" : status.error().message);
                    };
                    note(raw->step(1));
                    note(raw->set_step_hook({}));
                    note(raw->run_until(100));
                    note(raw->recompile(world_));
                    note(raw->open_snapshots({}, [](const Snapshot&) {}).ok()
                             ? Status()
                             : Status(raw->open_snapshots({}, [](const Snapshot&) {}).error()));
                  })
                  .ok());
  ASSERT_TRUE(simulation->step(3).ok());
  EXPECT_EQ(time, 0);
  ASSERT_THAT(refused, SizeIs(5));
  for (const std::string& why : refused) EXPECT_THAT(why, HasSubstr("step hook"));
}

TEST_F(Streams, APictureOfASnapshotIsTheStreams) {
  const auto simulation = start();
  CameraRequest request{.camera = "eye", .outputs = {"radiance", "depth"}, .required = true};
  request.render.spp = 2;
  request.render.denoise = false;
  std::vector<std::shared_ptr<const CameraFrame>> frames;
  std::vector<Snapshot> snapshots;
  {
    const auto camera = simulation->open_camera(
        request, [&](std::shared_ptr<const CameraFrame> frame) { frames.push_back(frame); });
    ASSERT_TRUE(camera.ok()) << camera.error().to_string();
    ASSERT_TRUE(simulation->post(Command{.what = SetControls{{0, 0}, {3, 3}}}).ok());
    for (int n = 0; n < 3; ++n) {
      snapshots.push_back(simulation->latest());
      ASSERT_TRUE(simulation->step(50).ok());  // 10 Hz
    }
    for (int i = 0; i < 5000 && frames.size() < 3; ++i) usleep(1000);
  }
  ASSERT_GE(frames.size(), 3u);
  Result<SceneRenderer> renderer = SceneRenderer::create(world_);
  ASSERT_TRUE(renderer.ok());
  for (size_t i = 0; i < 3; ++i) {
    const auto frame = renderer->render({&snapshots[i], 1}, request, static_cast<int64_t>(i));
    ASSERT_TRUE(frame.ok()) << frame.error().to_string();
    EXPECT_EQ((*frame)->depth, frames[i]->depth) << i;
    EXPECT_EQ((*frame)->radiance, frames[i]->radiance) << i;
  }
  EXPECT_NE(frames[0]->depth, frames[2]->depth);
  request.camera = "eyes";
  EXPECT_THAT(renderer->render({&snapshots[0], 1}, request).error().to_string(), HasSubstr("eye"));
  EXPECT_FALSE(renderer->render({}, request).ok());
  const auto scan = renderer->scan(std::vector<Snapshot>{snapshots[0], snapshots[2]}, {"roof"});
  ASSERT_TRUE(scan.ok()) << scan.error().to_string();
  EXPECT_GT((*scan)->size(), 100u);
  EXPECT_FALSE(renderer->scan({&snapshots[0], 1}, {"roof"}).ok());
}

TEST_F(Streams, ASnapshotOfAnotherWorldIsRefused) {
  Result<SceneRenderer> renderer = SceneRenderer::create(world_);
  ASSERT_TRUE(renderer.ok());
  SetUp();  // the same scene, compiled again
  const Snapshot other = start()->latest();
  EXPECT_THAT(renderer->render({&other, 1}, {.camera = "eye"}).error().to_string(),
              HasSubstr("another World"));
}

TEST(ParseScene, SettingsOfAControllerAreATableOfEitherKind) {
  TempFolder folder;
  folder.write("arm.xml", kArm);
  const auto no_controller = [](const ControllerRequest&) -> Result<std::unique_ptr<Controller>> {
    return std::unique_ptr<Controller>();
  };
  ASSERT_TRUE(register_controller("settings_alone", no_controller).ok());
  for (const char* params : {"params = { gain = 2.5, offset = [0, 1] }",
                             "[robot.controller.params]\ngain = 2.5\noffset = [0, 1]"}) {
    const Result<Scene> scene =
        parse_scene(std::string("[[robot]]\nname = \"a\"\nfile = \"arm.xml\"\n[robot.controller]\n"
                                "type = \"settings_alone\"\n") +
                        params,
                    folder.path());
    ASSERT_TRUE(scene.ok()) << scene.error().to_string();
    const ControllerOptions& options = scene->robots[0].controller;
    EXPECT_THAT(*controller_param(options, "gain"), ElementsAre(2.5)) << options.params.text;
    EXPECT_THAT(*controller_param(options, "offset"), ElementsAre(0, 1));
  }
}

TEST(ParseScene, NamesTheLineOfAMistakeAndFindsFilesInItsFolder) {
  TempFolder folder;
  const Result<Scene> bad = parse_scene("[sim]\n\ntimestpe = 1", folder.path());
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().loc.line, 3);
  const Result<Scene> missing =
      parse_scene("[[robot]]\nname = \"a\"\nfile = \"arm.xml\"", folder.path());
  EXPECT_THAT(missing.error().to_string(), HasSubstr("arm.xml"));
}

TEST_F(Streams, LossesOfAFeedCanBeReadWhileItsTopicsChange) {
  const auto simulation = start();
  auto feed = simulation->open_topics({.topics = {"/clock"}}, [](const TopicMessage&) {});
  ASSERT_TRUE(feed.ok()) << feed.error().to_string();
  std::atomic<bool> is_over{false};
  std::thread reader([&] {
    while (!is_over) {
      EXPECT_EQ((*feed)->dropped(), 0);
      EXPECT_TRUE((*feed)->status().ok());
    }
  });
  const std::vector<std::string> lidars = lidar_topics(*simulation);
  ASSERT_THAT(lidars, SizeIs(testing::Gt(1)));
  for (int n = 0; n < 300; ++n) {
    const std::vector<std::string> wanted =
        n % 3 == 0 ? lidars : std::vector<std::string>{n % 3 == 1 ? "/tf" : lidars[0]};
    ASSERT_TRUE((*feed)->set_topics(wanted).ok());
  }
  is_over = true;
  reader.join();
}

}  // namespace
}  // namespace gloam

// The Operator on a small scene: its run, entities, worlds, options and records, and what it
// refuses.

#include "bridge/operations/operator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <thread>

#include "bridge/test/lab.h"

namespace gloam::bridge {
namespace {
namespace fs = std::filesystem;

using OperatorTest = Lab;

void expect_ok(const Status& status) {
  EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().to_string());
}
template <class T>
void expect_error(const Result<T>& result, ErrorKind kind, const char* words) {
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, kind) << result.error().to_string();
  EXPECT_NE(result.error().to_string().find(words), std::string::npos)
      << result.error().to_string();
}
void expect_error(const Status& status, ErrorKind kind, const char* words) {
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().kind, kind) << status.error().to_string();
  EXPECT_NE(status.error().to_string().find(words), std::string::npos)
      << status.error().to_string();
}

TEST_F(OperatorTest, GoesThroughItsStates) {
  EXPECT_EQ(op().state(), RunState::kStopped);
  expect_ok(op().pause());
  EXPECT_EQ(op().state(), RunState::kPaused);
  expect_ok(op().step(3));
  EXPECT_EQ(simulation_->latest().step(), 3);
  EXPECT_EQ(op().state(), RunState::kPaused);
  expect_ok(op().play());
  EXPECT_EQ(op().state(), RunState::kPlaying);
  expect_error(op().step(1), ErrorKind::kUsage, "not paused");
  expect_ok(op().stop());
  EXPECT_EQ(op().state(), RunState::kStopped);
  EXPECT_EQ(simulation_->latest().step(), 0);
  expect_error(op().step(0), ErrorKind::kInput, "1 or more");
  EXPECT_FALSE(op().end_asked());
  op().ask_end();
  EXPECT_TRUE(op().end_asked());
}

TEST_F(OperatorTest, StepsTellHowFarTheyAreAndCanBeStopped) {
  int64_t last = 0;
  expect_ok(op().step(500, [&](int64_t done, int64_t left) {
    EXPECT_GT(done, last);
    EXPECT_EQ(done + left, 500);
    last = done;
    return true;
  }));
  EXPECT_EQ(last, 500);
  EXPECT_EQ(simulation_->latest().step(), 500);
  expect_error(op().step(1'000'000, [](int64_t done, int64_t) { return done < 10; }),
               ErrorKind::kInterrupted, "cancelled before all steps");
  EXPECT_LT(simulation_->latest().step(), 100'000);
  std::thread stepper([this] { (void)op().step(1'000'000'000); });
  while (simulation_->latest().step() < 2000) std::this_thread::yield();
  EXPECT_EQ(op().state(), RunState::kPaused);
  expect_error(op().step(1), ErrorKind::kUsage, "");
  expect_error(op().play(), ErrorKind::kUsage, "the simulation is stepping");
  expect_ok(op().pause());
  stepper.join();
  expect_ok(op().step(1));
}

TEST_F(OperatorTest, SpeedHasLimits) {
  expect_ok(op().set_speed(2));
  EXPECT_EQ(op().speed(), 2);
  expect_ok(op().set_speed({}));
  EXPECT_EQ(op().speed(), std::nullopt);
  for (const double speed : {0.0, -1.0, 1e9, std::nan("")})
    expect_error(op().set_speed(speed), ErrorKind::kInput, "0.001");
}

TEST_F(OperatorTest, ThePaceHasANameAndStaysWithAnotherSpeed) {
  expect_ok(op().set_pace("sensors"));
  EXPECT_EQ(simulation_->stats().pace, Pace::kSensors);
  expect_ok(op().set_speed(2));
  EXPECT_EQ(simulation_->stats().pace, Pace::kSensors);
  expect_ok(op().set_speed({}));
  EXPECT_EQ(simulation_->stats().pace, Pace::kFast);
  expect_ok(op().set_pace("realtime"));
  EXPECT_EQ(op().pace(), Pace::kRealTime);
  EXPECT_EQ(op().speed(), 2) << "as before";
  expect_error(op().set_pace("sensor"), ErrorKind::kUsage, "sensors");
  expect_error(op().set_pace("lockstep"), ErrorKind::kInput, "lockstep");
}

TEST_F(OperatorTest, ListsEntitiesByWhatTheyAre) {
  EXPECT_EQ(entity("arm").kind, EntityKind::kRobot);
  EXPECT_EQ(entity("crate").kind, EntityKind::kObject);
  EXPECT_EQ(entity("door").kind, EntityKind::kObject);
  EXPECT_EQ(entity("table").kind, EntityKind::kStatic);
  EXPECT_EQ(entity("seat").kind, EntityKind::kStatic);
  EXPECT_EQ(entity("hand").kind, EntityKind::kDynamic);
  EXPECT_EQ(op().entities().size(), 6u);
  expect_error(op().find_entity("crat"), ErrorKind::kInput, "did you mean 'crate'");
  expect_ok(op().set_info("crate", "of beer", {"heavy"}, EntityKind::kDynamic));
  EXPECT_EQ(entity("crate").description, "of beer");
  EXPECT_EQ(entity("crate").tags, std::vector<std::string>{"heavy"});
  EXPECT_EQ(entity("crate").category(), EntityKind::kDynamic);
  expect_error(op().set_info("no", "", {}, EntityKind::kRobot), ErrorKind::kInput, "no entity");
  expect_error(op().set_info("crate", std::string(5000, 'x'), {}, EntityKind::kRobot),
               ErrorKind::kInput, "4096");
}

TEST_F(OperatorTest, StatesFollowPhysics) {
  // Falls freely for 0.1 s from 2 m, spinning about its own long axis, which lies along x.
  const double half = std::sqrt(0.5);
  const Pose X = {{0, 0, 2}, {half, 0, half, 0}};
  expect_ok(op().set_entity_state(
      "crate", {.X_WE = X, .velocity = Vec3{1, 0, 0}, .angular_velocity = Vec3{2, 0, 0}}));
  const EntityState asked = op().entity_state("crate").value();
  EXPECT_EQ(asked.X_WE.p, X.p);  // counts before a step is taken
  EXPECT_EQ(asked.velocity.x, 1);
  expect_ok(op().step(50));
  const EntityState state = op().entity_state("crate").value();
  EXPECT_NEAR(state.X_WE.p.x, 0.1, 1e-9);
  EXPECT_NEAR(state.X_WE.p.z, 2 - 0.5 * 9.81 * 0.1 * (0.1 + 0.002), 1e-9);
  EXPECT_NEAR(state.velocity.z, -0.981, 1e-9);
  EXPECT_NEAR(state.angular_velocity.x, 2, 1e-9);
  EXPECT_NEAR(state.angular_velocity.y, 0, 1e-9);
  EXPECT_NEAR(state.acceleration.z, -9.81, 1e-6);
  EXPECT_NEAR(op().entity_state("table").value().acceleration.z, 0, 1e-9);
}

TEST_F(OperatorTest, MovesWhatCanBeMovedAndSaysWhyNot) {
  expect_ok(op().set_entity_state("hand", {.X_WE = Pose{{1, 1, 1}, {}}}));
  expect_ok(op().step(1));
  EXPECT_EQ(op().entity_state("hand").value().X_WE.p, (Vec3{1, 1, 1}));
  expect_error(op().set_entity_state("hand", {.velocity = Vec3{1, 0, 0}}), ErrorKind::kUnsupported,
               "mocap");
  expect_error(op().set_entity_state("arm", {.X_WE = Pose{}}), ErrorKind::kUnsupported,
               "fixed base");
  expect_error(op().set_entity_state("door", {.X_WE = Pose{}}), ErrorKind::kUnsupported, "joints");
  expect_error(op().set_entity_state("nobody", {.X_WE = Pose{}}), ErrorKind::kInput, "no entity");
  expect_error(op().set_entity_state("crate", {.X_WE = Pose{{}, {0, 0, 0, 0}}}), ErrorKind::kInput,
               "quaternion");
  expect_error(op().set_entity_state("crate", {.velocity = Vec3{std::nan(""), 0, 0}}),
               ErrorKind::kInput, "finite");
}

TEST_F(OperatorTest, BoundsHoldTheGeoms) {
  const Box crate = op().entity_bounds("crate").value();
  EXPECT_NEAR(crate.low.x, 0.9, 1e-9);
  EXPECT_NEAR(crate.high.y, 2.2, 1e-9);
  EXPECT_NEAR(crate.high.z, 1, 1e-9);
  const double half = std::sqrt(0.5);
  expect_ok(op().set_entity_state("crate", {.X_WE = Pose{{0, 0, 5}, {half, half, 0, 0}}}));
  expect_ok(op().step(1));
  const Box turned = op().entity_bounds("crate").value();
  EXPECT_NEAR(turned.high.y - turned.low.y, 1, 1e-3);
  EXPECT_NEAR(turned.high.z - turned.low.z, 0.4, 1e-3);
  const Box own = op().entity_bounds("crate", BoxFrame::kEntity).value();
  EXPECT_NEAR(own.low.y, -0.2, 1e-9);
  EXPECT_NEAR(own.high.z, 0.5, 1e-9);
  EXPECT_FALSE(op().entity_bounds("seat").value().is_empty());
  expect_error(op().entity_bounds("nobody"), ErrorKind::kInput, "no entity");
}

TEST_F(OperatorTest, SpawnsWhatIsAsked) {
  expect_ok(op().step(5));
  const SpawnResult ball = spawn_ball("ball");
  ASSERT_TRUE(ball.ok()) << ball.error.to_string();
  EXPECT_EQ(ball.name, "ball");
  EXPECT_TRUE(entity("ball").is_spawned);
  EXPECT_EQ(entity("ball").kind, EntityKind::kObject);  // nothing drives it
  EXPECT_NEAR(op().entity_state("ball").value().X_WE.p.z, 2, 1e-9);
  EXPECT_EQ(simulation_->latest().step(), 5);  // the run goes on
  EXPECT_EQ(spawn_ball("ball").failure, SpawnFailure::kNameTaken);
  EXPECT_EQ(spawn_ball("ball", true).name, "ball_2");
  EXPECT_EQ(spawn_ball("").failure, SpawnFailure::kNameTaken);  // the model is called "ball"
  EXPECT_EQ(spawn_ball("", true).name, "ball_3");

  const SpawnResult box = op().spawn({.name = "box", .text = kUrdf, .X_FE = {{0, 5, 3}, {}}});
  ASSERT_TRUE(box.ok()) << box.error.to_string();
  expect_ok(op().step(50));
  EXPECT_LT(op().entity_state("box").value().velocity.z, -0.9);  // not fixed to the world

  const SpawnResult chair = op().spawn({.uri = "gloam://prop/chair", .X_FE = {{0, 4, 0}, {}}});
  ASSERT_TRUE(chair.ok()) << chair.error.to_string();
  const SpawnResult arm = op().spawn({.name = "second", .uri = "arm.xml", .frame = "table"});
  ASSERT_TRUE(arm.ok()) << arm.error.to_string();
  EXPECT_NEAR(op().entity_state("second").value().X_WE.p.y, -1, 1e-9);
  EXPECT_EQ(entity("second").kind, EntityKind::kRobot);
}

TEST_F(OperatorTest, NamespacesAreThoseOfTopics) {
  const SpawnResult arm = op().spawn({.name = "second", .uri = "arm.xml", .ns = "/fleet/b"});
  ASSERT_TRUE(arm.ok()) << arm.error.to_string();
  bool found = false;
  const std::vector<TopicInfo> topics = simulation_->topics().value();
  for (const TopicInfo& topic : topics) {
    EXPECT_FALSE(topic.name.starts_with("/second/")) << topic.name;
    found = found || topic.name == "/fleet/b/joint_states";
  }
  EXPECT_TRUE(found);
  expect_ok(op().remove("second"));
  EXPECT_FALSE(op().find_entity("second").ok());
  EXPECT_TRUE(simulation_->topics().ok());
}

TEST_F(OperatorTest, RefusesToSpawnByCause) {
  const auto cause = [this](SpawnRequest request) {
    const SpawnResult result = op().spawn(request);
    EXPECT_FALSE(result.ok() && result.error.message.empty());
    return result.failure;
  };
  EXPECT_EQ(cause({.name = "a b", .text = kBall}), SpawnFailure::kNameInvalid);
  EXPECT_EQ(cause({.name = "../a", .text = kBall}), SpawnFailure::kNameInvalid);
  EXPECT_EQ(cause({.name = "a"}), SpawnFailure::kNoResource);
  EXPECT_EQ(cause({.uri = "nothing.xml"}), SpawnFailure::kNoResource);
  EXPECT_EQ(cause({.uri = "gloam://prop/unicorn"}), SpawnFailure::kNoResource);
  EXPECT_EQ(cause({.uri = "http://example.com/a.xml"}), SpawnFailure::kNoResource);
  EXPECT_EQ(cause({.text = "<sdf version='1.9'/>"}), SpawnFailure::kUnsupportedFormat);
  EXPECT_EQ(cause({.text = "<mujoco/>"}), SpawnFailure::kNameInvalid);
  EXPECT_EQ(cause({.name = "x", .text = "<mujoco/>"}), SpawnFailure::kParse);
  EXPECT_EQ(cause({.name = "x", .text = "hello"}), SpawnFailure::kParse);
  EXPECT_EQ(cause({.name = "x", .text = "<mujoco><worldbody><body><geom/></worldbody></mujoco>"}),
            SpawnFailure::kParse);
  EXPECT_EQ(cause({.name = "x", .text = "<mujoco><asset><mesh file='none.stl'/></asset></mujoco>"}),
            SpawnFailure::kMissingAssets);
  write("a.fbx", "no mesh");
  write("fbx.xml",
        "<mujoco><asset><mesh name='a' file='a.fbx'/></asset>"
        "<worldbody><geom type='mesh' mesh='a'/></worldbody></mujoco>");
  EXPECT_EQ(cause({.uri = "fbx.xml"}), SpawnFailure::kUnsupportedAssets);
  EXPECT_EQ(cause({.text = kBall, .ns = "a//b"}), SpawnFailure::kNamespaceInvalid);
  EXPECT_EQ(cause({.text = kBall, .X_FE = {{}, {0, 0, 0, 0}}}), SpawnFailure::kPoseInvalid);
  EXPECT_EQ(cause({.text = kBall, .frame = "nowhere"}), SpawnFailure::kPoseInvalid);
  EXPECT_EQ(cause({.text = std::string(20u << 20, ' ')}), SpawnFailure::kUnsupportedFormat);
  EXPECT_EQ(op().entities().size(), 6u);
}

// "a-b" and "a_b" have the same topics: those of the second get names of their own.
TEST_F(OperatorTest, NamesThatShareTopicsAreNumbered) {
  ASSERT_TRUE(op().spawn({.name = "a-b", .uri = "arm.xml"}).ok());
  ASSERT_TRUE(op().spawn({.name = "a_b", .uri = "arm.xml"}).ok());
  const auto topics = simulation_->topics();
  ASSERT_TRUE(topics.ok());
  std::set<std::string> names;
  for (const TopicInfo& topic : *topics) EXPECT_TRUE(names.insert(topic.name).second) << topic.name;
  EXPECT_TRUE(std::ranges::any_of(names, [](const std::string& name) {
    return name.starts_with("/a_b") && name.find("_2") != std::string::npos;
  }));
}

TEST_F(OperatorTest, ReadsNoFilesBeyondTheScenes) {
  const std::string beyond = (fs::temp_directory_path() / "gloam_beyond.xml").string();
  std::ofstream(beyond) << kBall;
  EXPECT_EQ(op().spawn({.uri = beyond}).failure, SpawnFailure::kNoResource);
  EXPECT_EQ(op().spawn({.uri = "file://" + beyond}).failure, SpawnFailure::kNoResource);
  EXPECT_EQ(op().spawn({.uri = "../../../../../../" + beyond}).failure, SpawnFailure::kNoResource);
  const std::string text = "<mujoco><include file='" + beyond + "'/></mujoco>";
  EXPECT_FALSE(op().spawn({.text = text}).ok());
  const std::string up = "<mujoco><include file='../../../../gloam_beyond.xml'/></mujoco>";
  EXPECT_FALSE(op().spawn({.text = up}).ok());
  expect_error(op().load_world(beyond), ErrorKind::kInput, "outside");
  expect_error(op().worlds({"/etc"}), ErrorKind::kInput, "outside");
  expect_error(op().spawnables({"/etc"}), ErrorKind::kInput, "outside");
  fs::remove(beyond);
}

TEST_F(OperatorTest, RemovesWhatTheSceneHasAsItsOwn) {
  expect_ok(op().remove("seat"));
  EXPECT_FALSE(op().find_entity("seat").ok());
  expect_error(op().remove("table"), ErrorKind::kUnsupported, "part of a file");
  expect_error(op().remove("seat"), ErrorKind::kInput, "no entity");
}

TEST_F(OperatorTest, ResetsBringBackTheFirstEntities) {
  ASSERT_TRUE(spawn_ball("ball").ok());
  expect_ok(op().remove("seat"));
  expect_ok(op().step(100));
  expect_ok(op().reset({.spawned = false}));
  EXPECT_EQ(simulation_->latest().step(), 0);
  EXPECT_TRUE(op().find_entity("ball").ok());
  expect_ok(op().step(100));
  const double before = op().entity_state("crate").value().X_WE.p.z;
  expect_ok(op().reset({.state = false}));
  EXPECT_EQ(simulation_->latest().step(), 100);
  EXPECT_FALSE(op().find_entity("ball").ok());
  EXPECT_TRUE(op().find_entity("seat").ok());
  EXPECT_EQ(op().entity_state("crate").value().X_WE.p.z, before);
  expect_ok(op().reset());
  EXPECT_EQ(simulation_->latest().step(), 0);
}

TEST_F(OperatorTest, LoadsAndUnloadsWorlds) {
  EXPECT_EQ(op().current_world().value().name, "lab");
  const std::vector<WorldFile> known = op().worlds().value();
  EXPECT_TRUE(std::ranges::any_of(known, [](const WorldFile& w) { return w.name == "demo"; }));
  const auto other = std::ranges::find(known, "other", &WorldFile::name);
  ASSERT_NE(other, known.end());
  EXPECT_EQ(other->description, "Another one.");
  expect_ok(op().step(10));
  const Result<WorldFile> loaded = op().load_world(other->uri);
  ASSERT_TRUE(loaded.ok()) << loaded.error().to_string();
  EXPECT_EQ(op().state(), RunState::kStopped);
  EXPECT_TRUE(op().find_entity("ball").ok());
  EXPECT_FALSE(op().find_entity("arm").ok());
  expect_ok(op().unload_world());
  EXPECT_EQ(op().state(), RunState::kNoWorld);
  expect_error(op().current_world(), ErrorKind::kUsage, "no world");
  expect_error(op().step(1), ErrorKind::kUsage, "no world");
  expect_error(op().play(), ErrorKind::kUsage, "no world");
  expect_error(op().unload_world(), ErrorKind::kUsage, "no world");
  EXPECT_EQ(spawn_ball("a").failure, SpawnFailure::kOther);
  ASSERT_TRUE(op().load_world("lab").ok());
  EXPECT_TRUE(op().find_entity("arm").ok());
  expect_error(op().load_world("", "[environment]\nfile = \"none.xml\"\n"), ErrorKind::kInput,
               "none.xml");
  expect_error(op().load_world("labb"), ErrorKind::kInput, "lab");
  EXPECT_EQ(op().state(), RunState::kStopped);
  ASSERT_TRUE(op().load_world("", "[environment]\nfile = \"room.xml\"\n").ok());
  EXPECT_EQ(op().entities().size(), 4u);
}

TEST_F(OperatorTest, ChangesOptionsAndLiveFields) {
  expect_ok(op().set_options({{"robot.arm.position", "[0, 4, 0]"}, {"prop.seat.seed", "3"}}));
  EXPECT_NEAR(op().entity_state("arm").value().X_WE.p.y, 4, 1e-9);
  EXPECT_EQ(op().option("prop.seat.seed").value(), "3");
  expect_error(op().option("prop.seat.sed"), ErrorKind::kUsage, "seed");
  EXPECT_FALSE(op().set_options({{"prop.seat.seed", "4"}, {"robot.arm.file", "none.xml"}}).ok());
  EXPECT_FALSE(op().set_options({{"robot.arm.file", "/etc/hostname"}}).ok());
  EXPECT_EQ(op().option("prop.seat.seed").value(), "3");
  expect_error(op().set_options({{"sim.timestep", "0.001"}}), ErrorKind::kUnsupported, "timestep");
  EXPECT_GT(op().options().size(), 20u);
  // No client opens a network interface or a file, or changes what the run began with.
  for (const char* path :
       {"bridge.zmq.host", "bridge.zmq.port", "bridge.zmq.curve_secret", "bridge.foxglove.host",
        "bridge.ros2.network", "bridge.ros2.domain", "bridge", "record.outputs", "record.mcap",
        "record.topics", "sim.seed", "sim.duration", "scene.name", "randomize.a.option"})
    expect_error(op().set_options({{path, "'0.0.0.0'"}}), ErrorKind::kUnsupported, path);
  expect_ok(
      op().recompile("[environment]\nfile = \"room.xml\"\n[bridge.zmq]\nhost = \"0.0.0.0\"\n"
                     "[record]\nmcap = true\n"));
  EXPECT_FALSE(simulation_->world().scene().bridge.any());
  EXPECT_FALSE(simulation_->world().scene().record.mcap);
  expect_ok(op().reset());
}

TEST_F(OperatorTest, ChangesLiveFields) {
  for (const InputInfo& input : simulation_->world().inputs())
    if (input.kind == InputKind::kLiveField)
      expect_ok(op().set_live_field(input.name, 0,
                                    std::vector<double>(static_cast<size_t>(input.count), 0.5)));
  expect_ok(op().set_live_field("gravity", 0, {0, 0, 0}));
  expect_ok(op().step(100));
  EXPECT_NEAR(op().entity_state("crate").value().velocity.z, 0, 1e-2);
  EXPECT_EQ(op().live_field("gravity").value(), (std::vector<double>{0, 0, 0}));
  expect_error(op().set_live_field("gravit", 0, {0}), ErrorKind::kInput, "gravity");
  expect_error(op().live_field("gravit"), ErrorKind::kInput, "gravity");
  EXPECT_FALSE(op().set_live_field("gravity", 2, {0, 0, 0}).ok());
}

TEST_F(OperatorTest, RecordsTakesPicturesAndGoesBack) {
  const Result<std::string> log = op().start_recording("run");
  ASSERT_TRUE(log.ok()) << log.error().to_string();
  expect_error(op().start_recording("two"), ErrorKind::kUsage, "already being recorded");
  expect_ok(op().step(50));
  EXPECT_EQ(op().stop_recording().value(), *log);
  EXPECT_TRUE(describe_log(*log).value().has_run);
  expect_error(op().stop_recording(), ErrorKind::kUsage, "no log");
  EXPECT_FALSE(op().start_recording("../x").ok());
  EXPECT_FALSE(op().start_recording(".x").ok());

  const int64_t id = op().save_checkpoint().value();
  const uint64_t hash = simulation_->latest().hash();
  expect_ok(op().step(50));
  expect_ok(op().restore_checkpoint(id));
  EXPECT_EQ(simulation_->latest().hash(), hash);
  EXPECT_EQ(op().checkpoints().size(), 1u);
  expect_ok(op().forget_checkpoint(id));
  expect_error(op().restore_checkpoint(id), ErrorKind::kInput, "no checkpoint");

  const auto frame =
      op().picture({.width = 32,
                    .height = 24,
                    .render = {.tier = RenderTier::kDirect, .spp = 1, .denoise = false}});
  ASSERT_TRUE(frame.ok()) << frame.error().to_string();
  EXPECT_EQ((*frame)->rgb.size(), 32u * 24 * 3);
  EXPECT_EQ((*frame)->step, 50);
  EXPECT_FALSE(op().picture({.camera = "none"}).ok());
}

TEST_F(OperatorTest, NamesPosesAndSpawnables) {
  const std::vector<NamedPose> poses = op().named_poses();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].name, "arm_goal");
  EXPECT_EQ(poses[0].radius, 0.3);
  const std::vector<Spawnable> known = op().spawnables({"."}).value();
  const auto has = [&](const std::string& end) {
    return std::ranges::any_of(known, [&](const Spawnable& s) { return s.uri.ends_with(end); });
  };
  EXPECT_TRUE(has("prop/chair"));
  EXPECT_TRUE(has("quadruped.xml"));
  EXPECT_TRUE(has("quadruped/robot.toml"));
  EXPECT_TRUE(has("/d/arm.xml"));
}

// Many clients at once: each finds its own entity, and the World stays whole.
TEST_F(OperatorTest, TakesManyClientsAtOnce) {
  std::vector<std::thread> clients;
  for (int i = 0; i < 4; ++i)
    clients.emplace_back([this, i] {
      const std::string name = "ball" + std::to_string(i);
      EXPECT_TRUE(spawn_ball(name).ok());
      for (int k = 0; k < 20; ++k) {
        EXPECT_TRUE(op().entity_state(name).ok());
        (void)op().step(1);
        (void)op().entities();
      }
      EXPECT_TRUE(op().remove(name).ok());
    });
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(op().entities().size(), 6u);
}

}  // namespace
}  // namespace gloam::bridge

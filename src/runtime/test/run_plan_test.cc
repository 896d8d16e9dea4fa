// The plan of a recorded run: what it records, from the request and the scene alone.

#include "runtime/recording/run_plan.h"

#include <gtest/gtest.h>

#include "scenes.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr Rational kFlightSteps = {500, 1};  // of kFlight [Hz]

// A camera with a rate, one without outputs, and two LiDARs; the robot has two cameras.
constexpr const char* kRig = R"(
[[camera]]
name = "side"
position = [0, -2, 1]
look_at = [0, 0, 0]
width = 32
height = 24
rate = 25
[[camera]]
name = "idle"
position = [0, -2, 1]
look_at = [0, 0, 0]
outputs = []
[[lidar]]
name = "top"
preset = "VLP-16"
[[lidar]]
name = "scan"
preset = "Mid-40"
outputs = ["ply", "npy"]
)";

class RunPlans : public testing::Test {
 protected:
  World rig(const std::string& outputs) {
    return flight(folder_, std::string(kRig) + "[record]\noutputs = [" + outputs + "]\n");
  }
  RunRequest request() const { return {.out = folder_.path() / "out"}; }
  RunPlan plan(const World& world, const RunRequest& request) {
    Result<RunPlan> plan = RunPlan::make(world, request);
    EXPECT_TRUE(plan.ok()) << plan.error().to_string();
    return *plan;
  }
  static std::vector<std::string> names(const std::vector<CameraRequest>& cameras) {
    std::vector<std::string> names;
    for (const CameraRequest& camera : cameras) names.push_back(camera.camera);
    return names;
  }

  TempFolder folder_;
};

TEST_F(RunPlans, RecordTheOutputsOfTheSceneIfThereIsAFolder) {
  const World state = flight(folder_, "[record]\noutputs = [\"state\", \"sensors\"]\n");
  const RunPlan tables = plan(state, request());
  EXPECT_TRUE(tables.has_folder && tables.records_state && tables.records_sensors);
  EXPECT_FALSE(tables.records_pictures || tables.records_metrics);
  EXPECT_FALSE(tables.meters) << "nobody looks at a picture";

  const World all = rig(R"("png", "metrics", "state", "sensors")");
  const RunPlan recorded = plan(all, request());
  EXPECT_TRUE(recorded.records_pictures && recorded.records_metrics && recorded.meters);
  const RunPlan nothing = plan(all, {});
  EXPECT_FALSE(nothing.has_folder || nothing.records_pictures || nothing.records_metrics ||
               nothing.records_state || nothing.records_sensors || nothing.meters);
}

TEST_F(RunPlans, TakeDurationAndWaitingFromTheRequestOrTheScene) {
  const World world = flight(folder_, "[sim]\nduration = 0.4\n");
  EXPECT_EQ(plan(world, {}).duration, 0.4);
  EXPECT_EQ(plan(world, {.duration = 2}).duration, 2);
  EXPECT_TRUE(plan(world, {}).waits && plan(world, {}).log.required);
  const RunPlan live = plan(world, {.simulation = {.pace = Pace::kRealTime}});
  EXPECT_FALSE(live.waits || live.log.required) << "real time waits for nobody";
}

TEST_F(RunPlans, LogToTheRequestedFileOrBesideTheOtherFiles) {
  const World world =
      flight(folder_, "[record]\noutputs = [\"state\"]\nmcap = true\ntopics = [\"/clock\"]\n");
  EXPECT_EQ(plan(world, request()).log.file, request().out / kRunLogName);
  EXPECT_TRUE(plan(world, {}).log.file.empty()) << "there is no folder for it";
  RunRequest own = request();
  own.log.file = folder_.path() / "own.mcap";
  EXPECT_EQ(plan(world, own).log.file, own.log.file);
  EXPECT_EQ(plan(world, own).log.topics, std::vector<std::string>{"/clock"});
  EXPECT_FALSE(plan(world, own).meters);

  own.log.topics = {"*/image_raw"};
  EXPECT_TRUE(plan(world, own).meters) << "a log of pictures needs their exposures";
  own.log.topics = {"/no_such_topic"};
  EXPECT_FALSE(RunPlan::make(world, own).ok());
}

TEST_F(RunPlans, OpenTheCamerasThatHaveOutputs) {
  const World world = rig(R"("video", "depth_png", "thermal_png")");
  const RenderDescription description = *describe_for_rendering(*world.compiled());
  const auto cameras = plan(world, request()).cameras(description, kFlightSteps);
  ASSERT_EQ(names(cameras), (std::vector<std::string>{"a/fixed", "side", "a/rider"}));
  const CameraRequest &side = cameras[1], &rider = cameras[2];
  EXPECT_EQ(side.rate, (Rational{25, 1}));
  EXPECT_EQ(rider.rate, (Rational{20, 1})) << "the default";
  EXPECT_EQ(side.outputs, (std::vector<std::string>{"depth", "rgb"})) << "it has no thermal model";
  EXPECT_TRUE(side.required);
  EXPECT_EQ(side.width, 0) << "its own";

  RunRequest other = request();
  other.cameras = {"a/rider", "free"};
  other.rate = {10, 1};
  other.width = 8;
  other.height = 6;
  const auto few = plan(world, other).cameras(description, kFlightSteps);
  ASSERT_EQ(names(few), other.cameras);
  EXPECT_EQ(few[1].rate, other.rate);
  EXPECT_EQ(few[1].width, 8);
}

TEST_F(RunPlans, AModelWithFewStepsGivesItsRateToCamerasAndMetrics) {
  const World world = rig(R"("png", "metrics")");
  const RenderDescription description = *describe_for_rendering(*world.compiled());
  const RunPlan few = plan(world, request());
  const auto cameras = few.cameras(description, {5, 1});
  ASSERT_EQ(names(cameras), (std::vector<std::string>{"a/fixed", "side", "a/rider"}));
  EXPECT_EQ(cameras[0].rate, (Rational{5, 1}));
  EXPECT_EQ(cameras[1].rate, (Rational{25, 1})) << "as written; opening it is an error";
  EXPECT_EQ(few.metric_rate({5, 1}), (Rational{5, 1}));
  EXPECT_EQ(few.metric_rate(kFlightSteps), (Rational{100, 1}));
}

TEST_F(RunPlans, AContactSheetNeedsThreeChannelsOfEveryCamera) {
  const World world = rig(R"("contact_sheet")");
  const RenderDescription description = *describe_for_rendering(*world.compiled());
  const auto cameras = plan(world, request()).cameras(description, kFlightSteps);
  ASSERT_EQ(names(cameras), (std::vector<std::string>{"a/fixed", "side", "idle", "a/rider"}));
  for (const CameraRequest& camera : cameras)
    EXPECT_EQ(camera.outputs, (std::vector<std::string>{"depth", "rgb", "segmentation"}));
}

TEST_F(RunPlans, LidarsHaveTheirOwnFormatsOrTheUsualOne) {
  const auto all = plan(rig(R"("lidar")"), request()).lidars(kFlightSteps);
  ASSERT_TRUE(all.ok()) << all.error().to_string();
  ASSERT_EQ(all->size(), 2u);
  EXPECT_EQ((*all)[0].formats, std::vector<std::string>{"pcd"});
  EXPECT_EQ((*all)[1].formats, (std::vector<std::string>{"ply", "npy"}));

  const RunPlan others = plan(rig(R"("png")"), request());
  const auto own = others.lidars(kFlightSteps);
  ASSERT_TRUE(own.ok()) << own.error().to_string();
  ASSERT_EQ(own->size(), 1u);
  EXPECT_EQ((*own)[0].name, "scan");
  EXPECT_FALSE(others.lidars({5, 1}).ok()) << "10 scans per second at 5 steps";
}

TEST_F(RunPlans, RefuseCamerasThatTheSimulationWouldRefuseLater) {
  const World world = rig(R"("png")");
  const RenderDescription description = *describe_for_rendering(*world.compiled());
  const RunPlan made = plan(world, request());
  std::vector<CameraRequest> cameras = made.cameras(description, kFlightSteps);
  const auto recorded = recorded_cameras(made, cameras, description, kFlightSteps);
  ASSERT_TRUE(recorded.ok()) << recorded.error().to_string();
  ASSERT_EQ(recorded->size(), cameras.size());
  EXPECT_EQ((*recorded)[1].name, "side");
  EXPECT_EQ((*recorded)[1].intrinsics.width, 32);

  EXPECT_FALSE(recorded_cameras(made, cameras, description, {20, 1}).ok()) << "25 Hz";
  cameras[0].camera = "nobody";
  EXPECT_FALSE(recorded_cameras(made, cameras, description, kFlightSteps).ok());
}

TEST_F(RunPlans, RefuseMorePicturesThanThereIsMemoryFor) {
  const uint64_t one = recording_memory(std::vector<PictureMemory>{{.working = 100, .frame = 7}});
  EXPECT_EQ(one, 100 + (2u + static_cast<unsigned>(RecorderOptions().queue_frames)) * 7);
  const std::vector<PictureMemory> two(2, {.working = 100, .frame = 7});
  EXPECT_EQ(recording_memory(two), 2 * one);

  const World world = rig(R"("png")");
  const RenderDescription description = *describe_for_rendering(*world.compiled());
  RunRequest large = request();
  large.width = large.height = 4096;
  const RunPlan made = plan(world, large);
  const std::vector<CameraRequest> cameras(2000, made.cameras(description, kFlightSteps).front());
  const auto refused = recorded_cameras(made, cameras, description, kFlightSteps);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("recording 2000 camera(s) needs"), std::string::npos)
      << refused.error().to_string();
}

}  // namespace
}  // namespace gloam

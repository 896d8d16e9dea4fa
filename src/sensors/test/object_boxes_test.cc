// Boxes around objects, in the picture and in space, and how much of them is hidden.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "scene/test/temp_folder.h"
#include "sensors/camera/camera_sensor.h"
#include "sim/loop/simulator.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

// The camera looks along -Z from z = 10. A board of 4 x 2 m at z = 0 behind a post that hides its
// left half, a ball half outside of the picture, a turned body, and a thing
// that is hidden altogether.
const char* const kModel = R"(
<mujoco><compiler angle="degree"/><worldbody>
  <camera name="eye" pos="0 0 10" xyaxes="1 0 0 0 1 0" projection="orthographic" fovy="8" resolution="96 64"/>
  <body name="board" pos="0 0 0"><freejoint/><geom type="box" size="2 1 0.1" mass="1"/></body>
  <body name="post" pos="-3 0 5"><freejoint/><geom type="box" size="3 4 0.1" mass="1"/></body>
  <body name="ball" pos="6 2 0"><freejoint/><geom type="sphere" size="1" mass="1"/></body>
  <body name="arm" pos="4 -2 0" euler="0 0 30"><freejoint/>
    <geom type="capsule" size="0.2 0.5" pos="0.5 0 0" euler="0 90 0" mass="1"/>
    <body name="hand" pos="1 0 0"><joint type="hinge" axis="0 0 1"/>
      <geom type="cylinder" size="0.3 0.1" pos="0.2 0 0.4" mass="1"/></body></body>
  <body name="hidden" pos="-4 0 1"><freejoint/><geom type="box" size="0.5 0.5 0.5" mass="1"/></body>
</worldbody></mujoco>)";

std::vector<ObjectView> see(const char* model, uint32_t first_id = 0) {
  const TempFolder folder;
  ::setenv("GLOAM_CACHE", (folder.path() / "cache").c_str(), 1);
  const auto scene = load_scene(folder.write("board.xml", model));
  if (!scene.ok()) ADD_FAILURE() << scene.error().to_string();
  const World world = std::move(World::compile(*scene)).value();
  auto description = std::move(describe_for_rendering(*world.compiled())).value();
  for (InstanceDescription& in : description.instances) in.label.instance += first_id;
  auto renderer = std::move(make_cpu_renderer(description)).value();
  auto solver = std::move(PoseSolver::create(world.compiled())).value();
  auto simulator =
      std::move(Simulator::create(world.compiled(), {.pace = Pace::kLockstep})).value();
  simulator->start();
  PoseFrame poses;
  EXPECT_TRUE(solver->solve(simulator->latest(), poses).ok());
  CameraRequest request{.camera = "eye"};
  request.outputs = {"boxes"};
  auto sensor = std::move(CameraSensor::create(description, request, 1)).value();
  RenderTurns turns;
  return sensor->capture(*renderer, turns, poses, poses, 0)->objects;
}

const ObjectView& find(const std::vector<ObjectView>& objects, const std::string& name) {
  for (const ObjectView& object : objects) {
    if (object.name == name) return object;
  }
  ADD_FAILURE() << "no object " << name;
  abort();
}

// 8 px per metre, the middle at (48, 32).
TEST(ObjectBoxes, CountWhatIsSeenAndWhatIsHidden) {
  const auto objects = see(kModel);
  const ObjectView& board = find(objects, "board");
  EXPECT_EQ(board.all.pixels, 32 * 16);
  EXPECT_EQ(board.seen.pixels, 16 * 16);
  EXPECT_DOUBLE_EQ(board.visibility(), 0.5);
  EXPECT_THAT((std::array{board.seen.u0, board.seen.v0, board.seen.u1, board.seen.v1}),
              ::testing::ElementsAre(48, 24, 64, 40));
  EXPECT_THAT((std::array{board.all.u0, board.all.v0, board.all.u1, board.all.v1}),
              ::testing::ElementsAre(32, 24, 64, 40));
  EXPECT_DOUBLE_EQ(find(objects, "post").visibility(), 1);
  const ObjectView& ball = find(objects, "ball");
  EXPECT_NEAR(static_cast<double>(ball.all.pixels), M_PI * 64 / 2, 4) << "what lies in the picture";
  EXPECT_EQ(ball.all.u1, 96);
  EXPECT_DOUBLE_EQ(ball.visibility(), 1);
  const ObjectView& hidden = find(objects, "hidden");
  EXPECT_EQ(hidden.seen.pixels, 0);
  EXPECT_EQ(hidden.all.pixels, 8 * 8);
  EXPECT_DOUBLE_EQ(hidden.visibility(), 0);
  EXPECT_LT(hidden.seen.u1, hidden.seen.u0) << "no box";
}

// The arm's box is along its own axes, whatever way it is turned, and holds its hand.
TEST(ObjectBoxes, StandInTheFrameOfTheRoot) {
  const ObjectView arm = find(see(kModel), "arm");
  EXPECT_NEAR(arm.X_WO.p.x, 4, 1e-6);
  EXPECT_NEAR(arm.X_WO.q.w, std::cos(M_PI / 12), 1e-6);
  EXPECT_NEAR(arm.X_WO.q.z, std::sin(M_PI / 12), 1e-6);
  // Capsule: x from -0.2 to 1.2, y and z +-0.2; cylinder about (1.2, 0, 0.4): x to 1.5, y +-0.3, z
  // from 0.3 to 0.5.
  const double low[3] = {-0.2, -0.3, -0.2}, high[3] = {1.5, 0.3, 0.5};
  const double center[3] = {arm.center.x, arm.center.y, arm.center.z};
  const double size[3] = {arm.size.x, arm.size.y, arm.size.z};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(center[i], 0.5 * (low[i] + high[i]), 1e-5) << i;
    EXPECT_NEAR(size[i], high[i] - low[i], 1e-5) << i;
  }
}

TEST(ObjectBoxes, EndlessFloorsHaveNone) {
  const auto objects = see(R"(<mujoco><worldbody>
    <camera name="eye" pos="0 0 10" resolution="32 32"/>
    <geom name="floor" type="plane" size="0 0 1"/></worldbody></mujoco>)");
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_TRUE(objects[0].endless);
  EXPECT_EQ(objects[0].seen.pixels, 32 * 32);
}

// Most memory of this process since the last call [bytes].
int64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  int64_t kilobytes = 0;
  while (status >> word) {
    if (word == "VmHWM:") status >> kilobytes;
  }
  std::ofstream("/proc/self/clear_refs") << 5;
  return kilobytes * 1024;
}

TEST(ObjectBoxes, MemoryIsForWhatIsSeenNotForAllThatThereIs) {
  peak_memory();
  const auto few = see(kModel);
  const int64_t memory = peak_memory();
  const auto many = see(kModel, 1'000'000);
  EXPECT_LT(peak_memory() - memory, int64_t{50} << 20);
  ASSERT_EQ(many.size(), few.size());
  for (size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(many[i].instance, few[i].instance + 1'000'000);
    EXPECT_EQ(many[i].seen.pixels, few[i].seen.pixels);
  }
}

}  // namespace
}  // namespace gloam

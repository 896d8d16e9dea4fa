// Other people's robots run through the public API exactly as in stock MuJoCo, whoever watches.

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gloam/program.h"
#include "robots.h"
#include "scene/test/temp_folder.h"
#include "scenes.h"

namespace gloam {
namespace {

constexpr int64_t kSteps = 2000;
constexpr Rational kFrameRate = {25, 1};

using States = std::vector<std::vector<double>>;  // of each step, the last one included

States stock_run(const StockModel& stock, std::vector<double>* last) {
  States states;
  for (int64_t step = 0; step < kSteps; ++step) {
    RandomInputs(*stock.model, step).write(*stock.model, stock.data.get());
    states.push_back(motion_state(*stock.model, *stock.data));
    mj_step(stock.model.get(), stock.data.get());
  }
  states.push_back(motion_state(*stock.model, *stock.data));
  *last = integration_state(*stock.model, *stock.data);
  return states;
}

// "" or the first number in which two runs differ, bit for bit.
std::string first_difference(const States& a, const States& b) {
  if (a.size() != b.size()) return std::to_string(a.size()) + " and " + std::to_string(b.size());
  for (size_t step = 0; step < a.size(); ++step) {
    if (a[step].size() != b[step].size()) return "the sizes of the states differ";
    for (size_t i = 0; i < a[step].size(); ++i) {
      if (std::memcmp(&a[step][i], &b[step][i], sizeof(double)) != 0)
        return "step " + std::to_string(step) + ", number " + std::to_string(i);
    }
  }
  return "";
}

// What one camera saw, in order.
struct Pictures {
  std::mutex mutex;
  std::vector<std::shared_ptr<const CameraFrame>> frames;
  FrameCallback collect() {
    return [this](std::shared_ptr<const CameraFrame> frame) {
      const std::lock_guard lock(mutex);
      frames.push_back(std::move(frame));
    };
  }
};

struct Watching {
  bool cameras = false;
  int threads = 0;
};

struct GloamRun {
  States states;
  std::vector<double> last;
  uint64_t hash = 0;
  std::array<Pictures, 2> pictures;
};

// The same run through the public API: inputs are Commands, states are read in the step hook.
void gloam_run(const World& world, const mjModel& stock, Watching watching, GloamRun* run) {
  set_thread_count(watching.threads);
  auto simulation = Simulation::create(world, {});
  ASSERT_TRUE(simulation.ok()) << simulation.error().to_string();
  ASSERT_TRUE((*simulation)
                  ->set_step_hook([run](const mjModel* m, mjData* d) {
                    run->states.push_back(motion_state(*m, *d));
                  })
                  .ok());
  std::vector<std::unique_ptr<CameraStream>> streams;
  if (watching.cameras) {
    // One of the model's own cameras and the free one, one of each tier.
    const std::array<std::string, 2> names = {(*simulation)->camera_names().front(), "free"};
    const std::array<RenderTier, 2> tiers = {RenderTier::kDirect, RenderTier::kPath};
    for (size_t i = 0; i < names.size(); ++i) {
      CameraRequest request{.camera = names[i], .rate = kFrameRate, .width = 48, .height = 36};
      request.outputs = {"rgb", "depth", "segmentation"};
      request.render = {.tier = tiers[i], .spp = 1, .denoise = false};
      request.required = true;
      auto stream = (*simulation)->open_camera(request, run->pictures[i].collect());
      ASSERT_TRUE(stream.ok()) << stream.error().to_string();
      streams.push_back(std::move(*stream));
    }
  }
  const int64_t batch = 4000 / RandomInputs(stock, 0).count();  // what the queue of Commands holds
  for (int64_t step = 0; step < kSteps;) {
    const int64_t end = std::min(step + batch, kSteps);
    for (; step < end; ++step) {
      const Status posted = RandomInputs(stock, step).post(**simulation, step);
      ASSERT_TRUE(posted.ok()) << posted.error().to_string();
    }
    const Status status = (*simulation)->run_until(end);
    ASSERT_TRUE(status.ok()) << status.error().to_string();
  }
  const Snapshot last = (*simulation)->latest();
  run->last.assign(last.state().begin(), last.state().end());
  run->hash = last.hash();
  // The last frames may still be rendering: closing a stream waits for what it holds.
  streams.clear();
  simulation->reset();
  set_thread_count(0);
  run->states.emplace_back(run->last.begin() + 1,
                           run->last.begin() + 1 + stock.nq + stock.nv + stock.na);
}

bool sees_something(const CameraFrame& frame) {
  return std::any_of(frame.instance.begin(), frame.instance.end(),
                     [](uint16_t i) { return i != 0; });
}

class ThirdPartyRun : public ThirdPartyRobot {};

TEST_P(ThirdPartyRun, IsStockBitForBitWhileTwoCamerasRender) {
  const StockModel& stock = *stock_;
  std::vector<double> last;
  const States states = stock_run(stock, &last);
  EXPECT_NE(states.front(), states.back());

  const World world = compile_file(file_);
  GloamRun alone, watched, one_thread;
  ASSERT_NO_FATAL_FAILURE(gloam_run(world, *stock.model, {}, &alone));
  ASSERT_NO_FATAL_FAILURE(
      gloam_run(world, *stock.model, {.cameras = true, .threads = 4}, &watched));
  ASSERT_NO_FATAL_FAILURE(
      gloam_run(world, *stock.model, {.cameras = true, .threads = 1}, &one_thread));
  for (const GloamRun* run : {&alone, &watched, &one_thread}) {
    EXPECT_EQ(first_difference(states, run->states), "");
    EXPECT_EQ(first_difference({last}, {run->last}), "");
    EXPECT_EQ(run->hash, alone.hash);
  }
  const double simulated = kSteps * stock.model->opt.timestep;
  const auto expected = static_cast<size_t>(simulated * kFrameRate.value()) + 1;
  for (size_t camera = 0; camera < 2; ++camera) {
    const auto &many = watched.pictures[camera].frames, &one = one_thread.pictures[camera].frames;
    ASSERT_EQ(many.size(), expected);
    ASSERT_EQ(one.size(), expected);
    EXPECT_TRUE(sees_something(*many.front()));
    for (size_t i = 0; i < many.size(); ++i) {
      EXPECT_EQ(many[i]->index, static_cast<int64_t>(i));
      const bool equal = many[i]->step == one[i]->step && many[i]->rgb == one[i]->rgb &&
                         many[i]->depth == one[i]->depth && many[i]->part == one[i]->part;
      ASSERT_TRUE(equal) << "frame " << i << " of camera " << camera << " with 1 and 4 threads";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, ThirdPartyRun, ::testing::Values(kGo1, kG1, kYam, kPanda),
                         robot_name);

// Stock loading throws a URDF's visuals away; Gloam draws them and steps the same.
TEST(UrdfRun, IsStockBitForBitAndShowsItsVisuals) {
  const TempFolder folder;
  ::setenv("GLOAM_CACHE", (folder.path() / "cache").c_str(), 1);
  const std::filesystem::path file = folder.write("arm.urdf", R"(<robot name="arm">
    <link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <link name="rod">
      <inertial><origin xyz="0.3 0 0"/><mass value="1"/>
        <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>
      <visual><origin xyz="0.3 0 0"/><geometry><sphere radius="0.2"/></geometry></visual>
      <collision><origin xyz="0.3 0 0"/><geometry><box size="0.05 0.05 0.05"/></geometry></collision>
    </link>
    <joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint>
  </robot>)");
  const StockModel stock(file);
  ASSERT_NE(stock.model, nullptr) << stock.error;
  std::vector<double> last;
  const States states = stock_run(stock, &last);
  EXPECT_NE(states.front(), states.back());
  GloamRun run;
  const World world = compile_file(file);
  ASSERT_NO_FATAL_FAILURE(gloam_run(world, *stock.model, {.cameras = true}, &run));
  EXPECT_EQ(first_difference(states, run.states), "");
  EXPECT_EQ(first_difference({last}, {run.last}), "");
  // The free camera frames the model: the ball takes far more of its picture than the box would.
  const CameraFrame& frame = *run.pictures[1].frames.front();
  const auto seen =
      std::count_if(frame.part.begin(), frame.part.end(), [](uint32_t p) { return p != 0; });
  EXPECT_GT(seen, static_cast<int64_t>(frame.part.size()) / 40);
}

// Contacts, friction and two robots in one model: what export writes is what runs.
TEST(ThirdPartyLevel, TwoRobotsOnAFloorRunAsTheirExport) {
  const auto go1 = third_party_file(kGo1), panda = third_party_file(kPanda);
  if (!go1 || !panda) GTEST_SKIP() << "no third-party robots: run tests/fetch_data.py";
  const TempFolder folder;
  ::setenv("GLOAM_CACHE", (folder.path() / "cache").c_str(), 1);
  Scene scene;
  scene.robots.push_back({.name = "go1", .file = *go1, .X_WR = {{0, 0, 0.1}, {}}});
  scene.robots.push_back({.name = "panda", .file = *panda, .X_WR = {{1, 0, 0}, {}}});
  const Result<World> world = World::compile(scene);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const Status exported = world->export_mjcf(folder.path() / "out");
  ASSERT_TRUE(exported.ok()) << exported.error().to_string();
  const StockModel stock(folder.path() / "out" / "scene.xml");
  ASSERT_NE(stock.model, nullptr) << stock.error;
  std::vector<double> last;
  const States states = stock_run(stock, &last);
  EXPECT_GT(stock.data->ncon, 0) << "the quadruped lies on the floor";
  GloamRun run;
  ASSERT_NO_FATAL_FAILURE(gloam_run(*world, *stock.model, {.cameras = true, .threads = 2}, &run));
  EXPECT_EQ(first_difference(states, run.states), "");
  EXPECT_EQ(first_difference({last}, {run.last}), "");
}

}  // namespace
}  // namespace gloam

// Paces of a live simulation: what waits for what, and what is told of its sensors.

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "scenes.h"

namespace gloam {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr int64_t kPaceSteps = 100;  // of 2 ms

/// A camera at 100 Hz whose reader takes longer than a frame's time.
struct SlowCamera {
  explicit SlowCamera(Simulation& simulation, bool is_view = false) {
    CameraRequest request{.camera = "a/fixed", .rate = {100, 1}, .width = 8, .height = 8};
    request.outputs = {"depth"};
    request.is_view = is_view;
    stream = *simulation.open_camera(request, [this](const auto&) {
      std::this_thread::sleep_for(20ms);
      ++frames;
    });
  }
  std::atomic<int> frames{0};
  std::unique_ptr<CameraStream> stream;
};

TEST(Pace, HasNames) {
  for (const Pace pace : {Pace::kFast, Pace::kLockstep, Pace::kRealTime, Pace::kSensors})
    EXPECT_EQ(*enum_named<Pace>(to_string(pace)), pace);
  const auto wrong = enum_named<Pace>("sensor");
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().to_string(), HasSubstr("sensors"));
}

TEST(Pace, SensorsWaitsForSensorsThatNobodyRequiresAndRealTimeDoesNot) {
  const TempFolder folder;
  const World world = flight(folder);
  uint64_t hash = 0;
  for (const Pace pace : {Pace::kSensors, Pace::kRealTime}) {
    auto simulation = *Simulation::create(world, {.pace = pace});
    SlowCamera camera(*simulation);
    ASSERT_TRUE(simulation->run_until(kPaceSteps).ok());
    const SimulationStats stats = simulation->stats();
    if (pace == Pace::kSensors) {
      camera.stream->flush();
      EXPECT_EQ(camera.stream->dropped(), 0);
      EXPECT_EQ(camera.frames, kPaceSteps / 5 + 1);
      hash = stats.hash;
    } else {
      EXPECT_GT(camera.stream->dropped(), 0);
    }
    EXPECT_EQ(stats.hash, hash) << "states never depend on it";
    EXPECT_EQ(stats.pace, pace);
  }
}

TEST(Pace, SensorsWaitsForNoView) {
  const TempFolder folder;
  auto simulation = *Simulation::create(flight(folder), {.pace = Pace::kSensors, .speed = 10});
  SlowCamera view(*simulation, true);
  ASSERT_TRUE(simulation->run_until(kPaceSteps).ok());
  EXPECT_GT(view.stream->dropped(), 0);
}

TEST(Pace, ItMayChangeWhileTheSimulationWaits) {
  const TempFolder folder;
  auto simulation = *Simulation::create(flight(folder), {.pace = Pace::kRealTime});
  SlowCamera camera(*simulation);
  simulation->set_pace(Pace::kSensors, 1);
  simulation->resume();
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (camera.frames < 5 && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(1ms);
  EXPECT_GE(camera.frames, 5);
  simulation->set_pace(Pace::kFast, 1);
  const int64_t now = simulation->latest().step();
  ASSERT_TRUE(simulation->run_until(now + 1000).ok());
  EXPECT_GT(camera.stream->dropped(), 0);
}

TEST(Pace, StatsTellWhatEachSensorCosts) {
  const TempFolder folder;
  auto simulation = *Simulation::create(flight(folder), {.pace = Pace::kSensors});
  SlowCamera camera(*simulation);
  ASSERT_TRUE(simulation->run_until(kPaceSteps).ok());
  camera.stream->flush();
  const std::vector<SensorCost> sensors = simulation->stats().sensors;
  ASSERT_EQ(sensors.size(), 1u);
  EXPECT_EQ(sensors[0].name, "camera 'a/fixed'");
  EXPECT_EQ(sensors[0].rate, 100);
  EXPECT_NEAR(sensors[0].achieved, 100, 1e-6);
  EXPECT_EQ(sensors[0].messages, kPaceSteps / 5 + 1);
  EXPECT_EQ(sensors[0].dropped, 0);
  EXPECT_GE(sensors[0].wall_ms, 20) << "its reader counts";
  const double factor = simulation->stats().realtime_factor;
  EXPECT_LT(factor, 1);
}

}  // namespace
}  // namespace gloam

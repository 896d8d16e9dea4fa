// An event camera's memory is the camera's, not a stream's: who comes late sees what others see.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <chrono>
#include <map>
#include <mutex>
#include <thread>

#include "base/files.h"
#include "gloam/run.h"
#include "scenes.h"

namespace gloam {
namespace {

const char* const kCamera = R"([render]
spp = 1
denoise = false
[record]
outputs = ["events"]
[[camera]]
name = "dvs"
position = [0, -2, 0]
look_at = [0, 0, 0]
width = 32
height = 24
rate = 100
[camera.events]
threshold = 0.05
mismatch = 0.01
refractory = 0.001
noise_rate = 1
)";

using Numbers = std::vector<std::array<double, 4>>;  // as events.csv: time, x, y, brighter

/// The events of a stream, by run and frame.
class Watcher {
 public:
  Watcher(Simulation& simulation, bool required, std::chrono::milliseconds delay = {}) {
    CameraRequest request{.camera = "dvs", .rate = {100, 1}, .required = required};
    request.outputs = {"events"};
    request.render = {.spp = 1, .denoise = false};
    auto stream =
        simulation.open_camera(request, [this, delay](std::shared_ptr<const CameraFrame> frame) {
          std::this_thread::sleep_for(delay);
          const std::lock_guard lock(mutex_);
          if (frame->index <= last_) ++run_;
          last_ = frame->index;
          Numbers& numbers = frames_[{run_, frame->index}];
          for (const Event& e : frame->events)
            numbers.push_back({e.time, double(e.x), double(e.y), e.brighter ? 1.0 : 0.0});
        });
    EXPECT_TRUE(stream.ok()) << stream.error().to_string();
    stream_ = std::move(*stream);
  }
  using Frames = std::map<std::pair<int, int64_t>, Numbers>;  // by run and index
  Frames close() {
    stream_.reset();
    return frames_;
  }

 private:
  std::mutex mutex_;
  int64_t last_ = -1;
  int run_ = 0;
  Frames frames_;
  std::unique_ptr<CameraStream> stream_;
};

void expect_same(const Watcher::Frames& early, const Watcher::Frames& late, size_t least) {
  EXPECT_GE(late.size(), least);
  for (const auto& [frame, numbers] : late) {
    ASSERT_TRUE(early.contains(frame)) << frame.second;
    EXPECT_EQ(early.at(frame), numbers) << "frame " << frame.second;
  }
  size_t events = 0;
  for (const auto& [frame, numbers] : early) events += numbers.size();
  EXPECT_GT(events, 100u) << "the scene must move for this test to mean something";
}

TEST(LiveEvents, WhoComesLateSeesWhatTheOthersSee) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder, kCamera));
  Watcher early(*simulation, true);
  ASSERT_TRUE(simulation->run_until(103).ok());
  Watcher late(*simulation, true);
  ASSERT_TRUE(simulation->run_until(250).ok());
  expect_same(early.close(), late.close(), 29);
}

// It also loses frames, and must not keep the others from theirs.
TEST(LiveEvents, ASlowViewerSeesAndLeavesTheRecordingAsItIs) {
  const TempFolder folder;
  const World world = flight(folder, kCamera);
  const auto recorded = [&](bool beside) {
    auto simulation = simulate(world);
    std::unique_ptr<Watcher> viewer;
    constexpr std::chrono::milliseconds kViewing{5}, kWriting{2};
    if (beside) viewer = std::make_unique<Watcher>(*simulation, false, kViewing);
    Watcher recording(*simulation, true, kWriting);
    EXPECT_TRUE(simulation->run_until(200).ok());
    auto frames = recording.close();
    if (viewer != nullptr) expect_same(frames, viewer->close(), 3);
    return frames;
  };
  EXPECT_EQ(recorded(true), recorded(false));
}

TEST(LiveEvents, AResetBeginsAnew) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder, kCamera));
  Watcher first(*simulation, true), second(*simulation, true);
  ASSERT_TRUE(simulation->run_until(152).ok());
  ASSERT_TRUE(simulation->post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(simulation->run_until(152).ok());
  const auto frames = first.close();
  EXPECT_EQ(frames, second.close());
  ASSERT_TRUE(frames.contains({1, 10}));
  EXPECT_EQ(frames.at({1, 0}), Numbers());
  EXPECT_EQ(frames.at({1, 10}), frames.at({0, 10}));
}

TEST(LiveEvents, ARecordingIsWhatALateViewerSees) {
  const TempFolder folder;
  const World world = flight(folder, kCamera);
  RunRequest request;
  request.out = folder.path() / "out";
  request.duration = 0.4;
  request.cameras = {"dvs"};
  const auto report = run_and_record(world, request, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  ASSERT_TRUE(report->status.ok()) << report->status.error().to_string();
  const std::string csv = read_text_file(request.out / "dvs" / "events.csv").value();

  auto simulation = simulate(world);
  Watcher early(*simulation, true, std::chrono::milliseconds(5));
  ASSERT_TRUE(simulation->run_until(100).ok());
  Watcher late(*simulation, false);
  ASSERT_TRUE(simulation->run_until(200).ok());
  early.close();
  const auto frames = late.close();
  ASSERT_FALSE(frames.empty());
  for (const auto& [frame, numbers] : frames) {
    for (const auto& [time, x, y, brighter] : numbers)
      EXPECT_THAT(csv, testing::HasSubstr(fmt::format("\n{},{},{},{}\n", time, x, y, brighter)));
  }
}

TEST(LiveEvents, AStillHasNone) {
  const TempFolder folder;
  CameraRequest request{.camera = "dvs"};
  request.outputs = {"events"};
  const auto frames = render_stills(flight(folder, kCamera), 0.1, {request}, {});
  ASSERT_FALSE(frames.ok());
  EXPECT_THAT(frames.error().to_string(), testing::HasSubstr("gloam run"));
}

}  // namespace
}  // namespace gloam

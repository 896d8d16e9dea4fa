// Streams of a running simulation: when frames are taken, of which instant they are, and who waits.

#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "scenes.h"

namespace gloam {
namespace {

/// Collects frames; waits for some of them.
class SlowFrames {
 public:
  FrameCallback callback() {
    return [this](std::shared_ptr<const CameraFrame> frame) {
      std::this_thread::sleep_for(delay);
      const std::lock_guard lock(mutex_);
      frames_.push_back(std::move(frame));
      changed_.notify_all();
    };
  }
  std::vector<std::shared_ptr<const CameraFrame>> all() {
    const std::lock_guard lock(mutex_);
    return frames_;
  }
  /// The last frame once there are `count` of them.
  std::shared_ptr<const CameraFrame> wait_for(size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(30), [&] { return frames_.size() >= count; });
    EXPECT_GE(frames_.size(), count);
    return frames_.empty() ? nullptr : frames_.back();
  }
  std::chrono::milliseconds delay{0};

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::shared_ptr<const CameraFrame>> frames_;
};

CameraRequest tiny(const std::string& camera, Rational rate) {
  CameraRequest request{.camera = camera, .rate = rate, .width = 16, .height = 12};
  request.outputs = {"depth", "segmentation"};
  request.required = true;
  return request;
}

std::unique_ptr<CameraStream> open(Simulation& simulation, const CameraRequest& request,
                                   SlowFrames& frames) {
  auto stream = simulation.open_camera(request, frames.callback());
  if (!stream.ok()) {
    ADD_FAILURE() << stream.error().to_string();
    abort();
  }
  return std::move(*stream);
}

float center_depth(const CameraFrame& frame) {
  const auto w = static_cast<size_t>(frame.intrinsics.width);
  return frame.depth[static_cast<size_t>(frame.intrinsics.height / 2) * w + w / 2];
}

// t_k = k / rate falls on the first step at or after it: no drift where the rate does not divide
// the step rate.
TEST(LiveCamera, FrameKIsTakenAtTheFirstStepAtOrAfterKOverRate) {
  const TempFolder folder;
  const World world = flight(folder);
  for (const Rational rate : {Rational{30, 1}, {20, 1}, {500, 1}, {24000, 1001}}) {
    auto simulation = simulate(world);
    SlowFrames frames;
    auto stream = open(*simulation, tiny("a/fixed", rate), frames);
    ASSERT_TRUE(simulation->run_until(250).ok());
    stream.reset();
    const auto all = frames.all();
    ASSERT_EQ(all.size(), static_cast<size_t>(std::floor(0.5 * rate.value())) + 1) << rate.num;
    for (size_t k = 0; k < all.size(); ++k) {
      const auto i = static_cast<int64_t>(k);
      const int64_t step = (i * rate.den * 500 + rate.num - 1) / rate.num;  // ceil
      EXPECT_EQ(all[k]->index, i);
      EXPECT_EQ(all[k]->step, step) << "frame " << k << " at " << rate.num << " Hz";
      EXPECT_NEAR(all[k]->time, static_cast<double>(step) * 0.002, 1e-12);
    }
  }
}

// A bridge whose client has gone must not wait for a picture of many seconds.
TEST(LiveCamera, AViewThatClosesGivesItsPictureUp) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  SlowFrames frames;
  CameraRequest request = tiny("a/fixed", {50, 1});
  request.required = false;
  request.outputs = {"rgb"};
  request.render = {.tier = RenderTier::kPath, .spp = 65536};  // takes many seconds
  auto stream = open(*simulation, request, frames);
  ASSERT_TRUE(simulation->step(1).ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // it has begun
  stream.reset();
  EXPECT_TRUE(frames.all().empty());
}

// Without a tier, cameras of runs in real time have the interactive one, others the path tier.
TEST(LiveCamera, TheTierFollowsThePace) {
  const TempFolder folder;
  const World world = flight(folder);
  const auto first_image = [&](Pace pace, std::optional<RenderTier> tier) {
    auto simulation = simulate(world);
    simulation->set_pace(pace, 1);
    SlowFrames frames;
    CameraRequest request = tiny("a/fixed", {50, 1});
    request.outputs = {"rgb"};
    request.render = {.tier = tier, .spp = 1, .denoise = false};
    const auto stream = open(*simulation, request, frames);
    return frames.wait_for(1)->rgb;
  };
  const auto path = first_image(Pace::kLockstep, RenderTier::kPath);
  const auto interactive = first_image(Pace::kLockstep, RenderTier::kInteractive);
  ASSERT_NE(path, interactive);
  EXPECT_EQ(first_image(Pace::kLockstep, {}), path);
  EXPECT_EQ(first_image(Pace::kRealTime, {}), interactive);
  EXPECT_EQ(first_image(Pace::kRealTime, RenderTier::kPath), path);
}

// MuJoCo's own xpos lags one step behind the state; a frame's poses and depths must not.
TEST(LiveCamera, PoseDepthAndStampAreOfOneInstant) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  SlowFrames frames;
  auto rider = open(*simulation, tiny("a/rider", {50, 1}), frames);
  SlowFrames fixed_frames;
  auto fixed = open(*simulation, tiny("a/fixed", {50, 1}), fixed_frames);
  ASSERT_TRUE(simulation->run_until(500).ok());
  rider.reset();
  fixed.reset();
  ASSERT_EQ(frames.all().size(), 51u);
  for (const auto& frame : frames.all()) {
    EXPECT_NEAR(frame->X_WC.p.x, frame->time, 1e-5) << "1 m/s along X";
    EXPECT_NEAR(frame->X_WC.p.y, 0.5, 1e-6);
    EXPECT_NEAR(center_depth(*frame), 2.5, 1e-4) << "to the wall";
  }
  // The ball leaves the middle of the fixed camera's picture once its centre has gone by 0.2 m.
  for (const auto& frame : fixed_frames.all()) {
    const bool ball = center_depth(*frame) < 2.5f;
    if (std::abs(frame->time - 0.2) > 0.05) {
      EXPECT_EQ(ball, frame->time < 0.2) << frame->time;
    }
  }
}

TEST(LiveCamera, MotionIsFromTheFrameBefore) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  SlowFrames frames;
  CameraRequest request = tiny("a/fixed", {25, 1});
  request.outputs = {"motion", "depth"};
  auto stream = open(*simulation, request, frames);
  ASSERT_TRUE(simulation->run_until(60).ok());
  frames.wait_for(4);
  ASSERT_TRUE(simulation->post({.what = ResetSim{}}).ok());
  frames.wait_for(5);
  stream.reset();
  const auto all = frames.all();
  ASSERT_EQ(all.size(), 5u);
  for (size_t i = 0; i < all.size(); ++i) {
    const CameraFrame& frame = *all[i];
    const size_t middle = 6 * 16 + 8;
    ASSERT_LT(frame.depth[middle], 2.1f) << "the ball";
    // 1 m/s for 40 ms; nothing came before the first frame, nor before the one after a reset.
    const double moved = frame.index == 0 ? 0 : 0.04;
    EXPECT_NEAR(frame.motion[2 * middle], moved * frame.intrinsics.fx / frame.depth[middle], 1e-2)
        << "frame " << i;
  }
}

TEST(LiveCamera, TheSimulationWaitsForARequiredCamera) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  SlowFrames frames;
  frames.delay = std::chrono::milliseconds(10);
  auto stream = open(*simulation, tiny("a/fixed", {100, 1}), frames);
  ASSERT_TRUE(simulation->run_until(200).ok());
  EXPECT_GE(frames.all().size(), 30u) << "it ran ahead of the camera";
  EXPECT_EQ(stream->dropped(), 0);
  stream.reset();
  EXPECT_EQ(frames.all().size(), 41u);
}

TEST(LiveCamera, ASlowViewerLosesFramesAndSlowsNothing) {
  const TempFolder folder;
  const World world = flight(folder);
  auto alone = simulate(world);
  ASSERT_TRUE(alone->run_until(1000).ok());

  auto simulation = simulate(world);
  SlowFrames frames;
  frames.delay = std::chrono::milliseconds(50);
  CameraRequest request = tiny("a/fixed", {500, 1});
  request.required = false;
  auto stream = open(*simulation, request, frames);
  ASSERT_TRUE(simulation->run_until(1000).ok());
  EXPECT_EQ(simulation->latest().hash(), alone->latest().hash());
  const int64_t dropped = stream->dropped();
  EXPECT_GT(dropped, 0);
  EXPECT_GE(simulation->stats().dropped_snapshots, dropped);
  frames.wait_for(static_cast<size_t>(1001 - dropped));  // every frame is shown or counted
  stream.reset();
  const auto all = frames.all();
  EXPECT_EQ(all.size(), static_cast<size_t>(1001 - dropped));
  for (size_t i = 1; i < all.size(); ++i) EXPECT_GT(all[i]->index, all[i - 1]->index);
  EXPECT_EQ(all.back()->step, 1000) << "the newest is what stays";
}

TEST(LiveCamera, TheFreeCameraMovesWhilePaused) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  ASSERT_TRUE(simulation->step(10).ok());
  SlowFrames frames;
  CameraRequest request = tiny("free", {20, 1});
  request.required = false;
  auto stream = open(*simulation, request, frames);
  // Towards the wall, which is 3 m from the origin.
  const Quat towards_y = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};
  size_t count = 0;
  for (const double y : {1.0, 2.0}) {
    stream->set_pose({{2, y, 0}, towards_y});
    EXPECT_NEAR(stream->pose().p.y, y, 1e-6);
    stream->refresh();
    const auto frame = frames.wait_for(++count);
    ASSERT_NE(frame, nullptr);
    EXPECT_NEAR(frame->X_WC.p.y, y, 1e-6);
    EXPECT_NEAR(center_depth(*frame), 3 - y, 1e-4);
    EXPECT_EQ(frame->step, 10) << "time stands still";
  }
}

double noise_of(const CameraFrame& a, const CameraFrame& b) {
  double sum = 0;
  for (size_t i = 0; i < a.radiance.size(); ++i) {
    const double gap = a.radiance[i] - b.radiance[i];
    sum += gap * gap;
  }
  return sum;
}

TEST(LiveCamera, RefreshesOfAnInstantAddSamplesUntilItMoves) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  const auto request = [](int spp, bool required) {
    CameraRequest r{.camera = "free", .rate = {10, 1}, .width = 24, .height = 18};
    r.outputs = {"rgb", "radiance"};
    r.render = {.tier = RenderTier::kPath, .spp = spp, .denoise = false};
    r.X_WC = Pose{{0.5, -1, 0.5}, {0.70710678, 0.70710678, 0, 0}};
    r.required = required;
    return r;
  };
  SlowFrames many;
  auto reference = open(*simulation, request(2048, false), many);
  reference->refresh();
  const auto truth = many.wait_for(1);
  ASSERT_NE(truth, nullptr);
  reference.reset();

  SlowFrames frames;
  auto stream = open(*simulation, request(1, false), frames);
  stream->refresh();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the open's own frame, if any
  size_t count = frames.all().size();
  ASSERT_GT(count, 0u);
  for (int i = 0; i < 33; ++i) {
    stream->refresh();
    ASSERT_NE(frames.wait_for(++count), nullptr);
  }
  const double one = noise_of(*frames.all()[0], *truth);
  const double mean = noise_of(*frames.all().back(), *truth);
  ASSERT_GT(one, 0);
  EXPECT_LT(mean, one / 8) << "32 samples should have a thirty-second of the variance";
  EXPECT_EQ(frames.all().back()->step, 0);

  Pose moved = *request(1, false).X_WC;
  moved.p.x += 0.5;
  stream->set_pose(moved);
  stream->refresh();
  const auto first = frames.wait_for(++count);
  stream->set_pose(*request(1, false).X_WC);
  stream->refresh();
  const auto back = frames.wait_for(++count);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(back->radiance, frames.all()[0]->radiance) << "it begins anew, with the same draws";
}

TEST(LiveCamera, AResetStartsTheFramesAgain) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  SlowFrames frames;
  auto stream = open(*simulation, tiny("a/rider", {50, 1}), frames);
  ASSERT_TRUE(simulation->run_until(100).ok());
  frames.wait_for(11);
  ASSERT_TRUE(simulation->post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(simulation->run_until(50).ok());
  stream.reset();
  const auto all = frames.all();
  ASSERT_EQ(all.size(), 17u);
  for (size_t i = 0; i < all.size(); ++i) {
    const auto k = static_cast<int64_t>(i < 11 ? i : i - 11);
    EXPECT_EQ(all[i]->index, k);
    EXPECT_EQ(all[i]->step, 10 * k);
    EXPECT_NEAR(all[i]->X_WC.p.x, 0.02 * static_cast<double>(k), 1e-5);
  }
}

TEST(LiveCamera, WhatCannotBeOpenedSaysWhy) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  const auto refused = [&](const CameraRequest& request) {
    auto stream = simulation->open_camera(request, [](auto) {});
    EXPECT_FALSE(stream.ok());
    return stream.ok() ? std::string() : stream.error().to_string();
  };
  const auto changed = [](auto change) {
    CameraRequest request = tiny("a/fixed", {20, 1});
    change(request);
    return request;
  };
  using R = CameraRequest;
  EXPECT_NE(refused(changed([](R& r) { r.camera = "a/fixd"; })).find("a/fixed"), std::string::npos);
  EXPECT_NE(refused(changed([](R& r) { r.outputs = {"dept"}; })).find("depth"), std::string::npos);
  EXPECT_NE(refused(changed([](R& r) { r.rate = {-1, 1}; })).find("rate"), std::string::npos);
  EXPECT_NE(refused(changed([](R& r) { r.rate = {501, 1}; })).find("501"), std::string::npos);
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {-1, 12}, {16, -1}, {16, 0}, {0, 12}, {16385, 12}, {16, 1 << 30}}) {
    const std::string message = refused(changed([&](R& r) {
      r.width = width;
      r.height = height;
    }));
    EXPECT_NE(message.find("16384"), std::string::npos)
        << width << " x " << height << ": " << message;
  }
  EXPECT_NE(refused(changed([](R& r) {
              r.outputs = {"rgb"};
              r.render.spp = 0;
            })).find("spp"),
            std::string::npos);
  EXPECT_NE(refused(changed([](R& r) { r.render.max_depth = 0; })).find("max_depth"),
            std::string::npos);
  ASSERT_TRUE(simulation->run_until(10).ok()) << "and nothing was left behind that it waits for";
}

// The ball flies along +X at 1 m/s, 2 m before the camera. Row v of 48 is read 0.1 s v / 48 later.
TEST(LiveCamera, ARollingShutterSeesEachRowAtItsOwnTime) {
  const TempFolder folder;
  auto simulation = simulate(flight(
      folder, "[[camera]]\nname = \"a/fixed\"\nreadout_time = 0.1\nexposure_time = 0.004\n"));
  CameraRequest request = tiny("a/fixed", {10, 1});
  request.width = 64, request.height = 48;
  SlowFrames frames;
  auto stream = open(*simulation, request, frames);
  ASSERT_TRUE(simulation->run_until(200).ok());
  stream.reset();
  const auto all = frames.all();
  ASSERT_EQ(all.size(), 3u) << "those from 0.3 and 0.4 s on are not read out at 0.4 s";
  for (const auto& frame : all) {
    EXPECT_EQ(frame->readout_time, 0.1);
    EXPECT_EQ(frame->step, 50 * frame->index);
    const Intrinsics& k = frame->intrinsics;
    int rows = 0;
    for (int y = 0; y < k.height; ++y) {
      double sum = 0, x_sum = 0;
      for (int x = 0; x < k.width; ++x) {
        if (frame->depth[static_cast<size_t>(y * k.width + x)] > 2.5) continue;  // the wall
        ++sum;
        x_sum += x + 0.5;
      }
      if (sum < 4) continue;
      ++rows;
      const double at = frame->time + 0.1 * y / k.height;
      EXPECT_NEAR(x_sum / sum, k.cx + k.fx * at / 2, 0.51) << frame->time << ", row " << y;
    }
    EXPECT_GE(rows, 9);
  }
}

}  // namespace
}  // namespace gloam

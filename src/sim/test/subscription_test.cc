// Who gets which Snapshot, and what happens to readers that are slow.

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "test_world.h"

namespace gloam {
namespace {

const char* const kBall = R"(<mujoco><option timestep="0.002"/><worldbody>
  <body pos="0 0 1"><freejoint/><geom size=".1"/></body></worldbody></mujoco>)";

TEST(Subscription, PublishesAtTheStepsOfItsRateAndPhase) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  auto even = *sim->subscribe({.rate = {50, 1}, .required = true, .capacity = 100});
  auto odd =
      *sim->subscribe({.rate = {30, 1}, .phase = {1, 100}, .required = true, .capacity = 100});
  sim->start();
  ASSERT_TRUE(sim->step(500).ok());
  for (int k = 0; k <= 50; ++k) EXPECT_EQ(even->try_next().step(), 10 * k);
  EXPECT_FALSE(even->try_next());
  for (int k = 0; k < 30; ++k) {
    // t_k = 0.01 + k / 30, the first step at or after it.
    EXPECT_EQ(odd->try_next().step(), (3 * 5 + k * 50 + 2) / 3);
  }
  EXPECT_FALSE(odd->try_next());
}

TEST(Subscription, OneMadeLaterBeginsAtThePresentStep) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(20).ok());
  auto queue = *sim->subscribe({.rate = {50, 1}});
  EXPECT_EQ(queue->next().step(), 20);
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(queue->next().step(), 30);
}

TEST(Subscription, TheFirstSnapshotIsThereWhenTheCallReturns) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  sim->start();
  for (int n = 0; n < 300; ++n) {
    if (n % 3 == 0) {
      ASSERT_TRUE(sim->step(1).ok());
    }
    auto queue = *sim->subscribe({.rate = {500, 1}, .required = true});
    ASSERT_EQ(queue->handed_out(), 1) << "subscribed while the simulation stands still";
    ASSERT_TRUE(sim->reset().ok());
    ASSERT_EQ(queue->handed_out(), 2) << "reset";
    queue->close();
  }
}

TEST(Subscription, RequiredReadersLoseNothingHoweverSlow) {
  auto sim = make_simulator(world_from_mjcf(kBall));
  auto queue = *sim->subscribe({.rate = {500, 1}, .required = true, .capacity = 2});
  sim->start(200);
  for (int n = 0; n <= 200; ++n) {
    if (n % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_EQ(queue->next().step(), n);
    EXPECT_LE(sim->step_count(), n + 3);  // it waited
  }
  ASSERT_TRUE(sim->wait().ok());
  EXPECT_EQ(queue->dropped(), 0);
  EXPECT_EQ(sim->counters().snapshots_dropped, 0);
}

TEST(Subscription, BestEffortReadersLoseTheOldestAndItIsCounted) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  auto queue = *sim->subscribe({.rate = {500, 1}, .capacity = 4});
  sim->start();
  ASSERT_TRUE(sim->step(99).ok());
  EXPECT_EQ(queue->dropped(), 96);
  EXPECT_EQ(sim->counters().snapshots_dropped, 96);
  for (int n = 96; n < 100; ++n) EXPECT_EQ(queue->next().step(), n);
  queue->close();
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_FALSE(queue->next());
  EXPECT_EQ(sim->counters().snapshots_dropped, 96);  // still counted after it is gone
}

TEST(Subscription, SlowBestEffortReadersSeeStepsInOrder) {
  auto sim = make_simulator(world_from_mjcf(kBall));
  auto queue = *sim->subscribe({.rate = {500, 1}, .capacity = 3});
  int64_t got = 0;
  std::thread reader([&] {
    int64_t last = -1;
    while (Snapshot s = queue->next()) {
      EXPECT_GT(s.step(), last);
      last = s.step();
      ++got;
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  });
  sim->start(5000);
  ASSERT_TRUE(sim->wait().ok());
  sim->stop();
  reader.join();
  EXPECT_GT(got, 0);
  EXPECT_EQ(got + queue->dropped(), 5001);
}

// A reader of batches of 8, and how many Snapshots it has after sleeps of the sim thread.
struct BatchReader {
  std::shared_ptr<SnapshotQueue> queue;
  std::atomic<int64_t> got = 0;
  std::thread thread{[this] {
    while (queue->next()) ++got;
  }};
  explicit BatchReader(Simulator& sim)
      : queue(*sim.subscribe({.rate = {500, 1}, .required = true, .capacity = 32, .batch = 8})) {}
  ~BatchReader() {
    queue->close();
    thread.join();
  }
};

TEST(Subscription, ASleepingReaderIsWokenForAWholeBatchOrWhenTheSimulationStandsStill) {
  constexpr auto kPause = std::chrono::milliseconds(40);
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  BatchReader reader(*sim);
  std::array<int64_t, 2> seen{-1, -1};
  int64_t step = 0;
  std::chrono::steady_clock::time_point first;
  bool in_time = false;
  ASSERT_TRUE(sim->set_step_hook([&](const mjModel*, mjData*) {
                   if (step == 1) first = std::chrono::steady_clock::now();
                   if (step == 1 || step == 7 || step == 15) std::this_thread::sleep_for(kPause);
                   if (step == 7) seen[0] = reader.got;
                   if (step == 15) seen[1] = reader.got;
                   if (step == 7)
                     in_time = std::chrono::steady_clock::now() - first < kLongestBatch;
                   ++step;
                 })
                  .ok());
  sim->start();
  ASSERT_TRUE(sim->step(16).ok());
  // The first Snapshot is a batch of its own, the time since the last being endless; the reader
  // sleeps again while the hook of step 1 does.
  if (in_time) {
    EXPECT_LE(seen[0], 2);
  }
  EXPECT_GE(seen[1], 8);
  while (reader.got < 17) std::this_thread::yield();  // hangs if the rest is kept
  sim->stop();
}

TEST(Subscription, ABatchIsNotWaitedForForever) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  BatchReader reader(*sim);
  int64_t step = 0, seen = -1;
  ASSERT_TRUE(sim->set_step_hook([&](const mjModel*, mjData*) {
                   if (step == 3) std::this_thread::sleep_for(kLongestBatch);
                   if (step == 4) {
                     for (int i = 0; i < 500 && reader.got < 4; ++i)
                       std::this_thread::sleep_for(std::chrono::milliseconds(10));
                     seen = reader.got;
                   }
                   ++step;
                 })
                  .ok());
  sim->start();
  ASSERT_TRUE(sim->step(6).ok());
  EXPECT_GE(seen, 4);
  sim->stop();
}

TEST(Subscription, WaitingReadersAreReleasedByStop) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  auto queue = *sim->subscribe({.rate = {500, 1}});
  sim->start();
  EXPECT_TRUE(queue->next());
  std::thread reader([&] { EXPECT_FALSE(queue->next()); });
  sim->stop();
  reader.join();
}

TEST(Subscription, SnapshotsOutliveTheSimulator) {
  Snapshot kept;
  {
    auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
    sim->start();
    ASSERT_TRUE(sim->step(5).ok());
    kept = sim->latest();
  }
  EXPECT_EQ(kept.step(), 5);
  EXPECT_EQ(kept[Joint{0}].qpos.size(), 7u);
}

TEST(Subscription, ThePoolIsUsedAgainAndGrowsOnlyForReadersThatHoldTooMuch) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  auto queue = *sim->subscribe({.rate = {500, 1}, .required = true, .capacity = 8});
  sim->start();
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(sim->step(5).ok());
    while (queue->try_next()) {
    }
  }
  EXPECT_EQ(sim->counters().pool_grown, 0);
  std::vector<Snapshot> held;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(sim->step(5).ok());
    while (Snapshot s = queue->try_next()) held.push_back(s);
  }
  const int64_t grown = sim->counters().pool_grown;
  EXPECT_GT(grown, 50);
  for (size_t i = 1; i < held.size(); ++i) EXPECT_EQ(held[i].step(), held[i - 1].step() + 1);
  held.clear();
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(sim->step(5).ok());
    while (Snapshot s = queue->try_next()) held.push_back(s);
  }
  EXPECT_EQ(sim->counters().pool_grown, grown);
}

TEST(Subscription, RefusesBatchesThatNeverFill) {
  auto sim = make_simulator(world_from_mjcf(kBall));
  EXPECT_FALSE(sim->subscribe({.capacity = 8, .batch = 0}).ok());
  EXPECT_FALSE(sim->subscribe({.capacity = 8, .batch = 9}).ok());
}

TEST(Subscription, RefusesBadOptions) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  EXPECT_FALSE(sim->subscribe({.rate = {501, 1}}).ok());
  EXPECT_FALSE(sim->subscribe({.rate = {0, 1}}).ok());
  EXPECT_FALSE(sim->subscribe({.phase = {-1, 2}}).ok());
  EXPECT_FALSE(sim->subscribe({.capacity = 0}).ok());
  EXPECT_TRUE(sim->subscribe({.rate = {500, 1}, .capacity = 1}).ok());
}

TEST(Pace, RealTimeKeepsToTheClock) {
  auto sim = make_simulator(world_from_mjcf(kBall), {.pace = Pace::kRealTime, .speed = 2});
  const auto begin = std::chrono::steady_clock::now();
  sim->start(200);  // 0.4 s of simulation
  ASSERT_TRUE(sim->wait().ok());
  const double took =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_GT(took, 0.195);
  EXPECT_LT(took, 5);  // other programs may hold the machine up
}

TEST(Pace, PauseStopsAndResumeGoesOn) {
  auto sim = make_simulator(world_from_mjcf(kBall), {.pace = Pace::kRealTime});
  sim->start();
  sim->pause();
  ASSERT_TRUE(sim->wait().ok());
  const int64_t paused_at = sim->step_count();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(sim->step_count(), paused_at);
  ASSERT_TRUE(sim->step(3).ok());
  EXPECT_EQ(sim->step_count(), paused_at + 3);
  sim->set_pace(Pace::kRealTime, 50);
  sim->resume();
  while (sim->step_count() < paused_at + 100) std::this_thread::yield();
  sim->stop();
  EXPECT_GE(sim->latest().step(), paused_at + 100);
}

// A window of 20 ms at steps of 2 ms has 11 keys; at 30 Hz windows begin on steps 0, 17, 34, 50.
TEST(Subscription, WindowsHoldEvenStepsFromTheirEventOn) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  auto queue =
      *sim->subscribe({.rate = {30, 1}, .required = true, .capacity = 100, .window = {20, 1000}});
  sim->start();
  ASSERT_TRUE(sim->step(100).ok());
  for (const int first : {0, 17, 34, 50, 67, 84}) {
    const SnapshotWindow window = queue->try_next_window();
    ASSERT_EQ(window.count, 11) << first;
    for (int k = 0; k < 11; ++k) EXPECT_EQ(window.keys[static_cast<size_t>(k)].step(), first + k);
  }
  EXPECT_FALSE(queue->try_next_window()) << "the window from step 100 on is not complete";
}

// Whole revolutions of 0.1 s at 10 Hz: the end of one is the beginning of the next.
TEST(Subscription, WindowsMayTouchAndOverlap) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  auto whole =
      *sim->subscribe({.rate = {10, 1}, .required = true, .capacity = 9, .window = {1, 10}});
  auto twice =
      *sim->subscribe({.rate = {10, 1}, .required = true, .capacity = 9, .window = {1, 5}});
  sim->start();
  ASSERT_TRUE(sim->step(200).ok());
  for (int n = 0; n < 3; ++n) {
    const SnapshotWindow window = whole->try_next_window();
    ASSERT_EQ(window.count, 14) << "50 steps in strides of 4";
    EXPECT_EQ(window.keys[0].step(), 50 * n);
    EXPECT_EQ(window.keys[12].step() - window.keys[0].step(), 48);
    EXPECT_EQ(window.keys[13].step() - window.keys[0].step(), 52);
  }
  for (int n = 0; n < 2; ++n) {
    const SnapshotWindow window = twice->try_next_window();
    EXPECT_EQ(window.keys[0].step(), 50 * n);
    EXPECT_GE(window.keys[static_cast<size_t>(window.count) - 1].step(), 50 * n + 100);
  }
}

TEST(Subscription, AWindowIsLostAsAWhole) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  auto queue = *sim->subscribe({.rate = {50, 1}, .capacity = 2, .window = {4, 1000}});
  sim->start();
  ASSERT_TRUE(sim->step(100).ok());
  EXPECT_EQ(queue->dropped(), 8);
  for (const int first : {80, 90}) {
    const SnapshotWindow window = queue->try_next_window();
    ASSERT_EQ(window.count, 3);
    EXPECT_EQ(window.keys[0].step(), first);
    EXPECT_EQ(window.keys[2].step(), first + 2);
  }
}

TEST(Subscription, AResetBeginsItsWindowsAnew) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  auto queue = *sim->subscribe({.rate = {50, 1}, .capacity = 8, .window = {16, 1000}});
  sim->start();
  ASSERT_TRUE(sim->step(5).ok());
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->step(9).ok());
  const SnapshotWindow window = queue->try_next_window();
  ASSERT_EQ(window.count, 9);
  for (int k = 0; k < 9; ++k) EXPECT_EQ(window.keys[static_cast<size_t>(k)].step(), k);
  EXPECT_FALSE(queue->try_next_window());
}

TEST(Subscription, WindowsThatMakeNoSenseAreRefused) {
  auto sim = make_simulator(world_from_mjcf(kBall), lockstep());
  EXPECT_FALSE(sim->subscribe({.rate = {50, 1}, .window = {-1, 100}}).ok());
  EXPECT_FALSE(sim->subscribe({.rate = {50, 1}, .window = {1, 0}}).ok());
  EXPECT_FALSE(sim->subscribe({.rate = {50, 1}, .window = {1, 5}}).ok());
  EXPECT_TRUE(sim->subscribe({.rate = {500, 1}, .window = {6, 1000}}).ok());
}

}  // namespace
}  // namespace gloam

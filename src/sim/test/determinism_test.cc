// The chain of state hashes does not depend on who is watching, how fast, or from how many threads.

#include <thread>

#include "test_world.h"

namespace gloam {
namespace {

constexpr int kSteps = 600;

struct Watchers {
  int best_effort = 0, required = 0;  // consumer threads
};

uint64_t final_hash(SimulatorOptions options, Watchers watchers, uint64_t* hash_at_100 = nullptr) {
  auto sim = make_simulator(world_from_mjcf(kRichModel), std::move(options));
  EXPECT_TRUE(sim->add_controller(0, std::make_unique<RandomController>(), {250, 1}).ok());
  std::vector<std::thread> threads;
  for (int i = 0; i < watchers.best_effort + watchers.required; ++i) {
    SubscriptionOptions subscription{.rate = {100 + 13 * i, 1}, .capacity = 2};
    subscription.required = i >= watchers.best_effort;
    auto queue = *sim->subscribe(subscription);
    threads.emplace_back([queue] {
      while (Snapshot s = queue->next())
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    });
  }
  if (hash_at_100 != nullptr) {
    auto queue = *sim->subscribe({.rate = {5, 1}, .required = true, .capacity = 65536});
    sim->start(kSteps);
    EXPECT_EQ(queue->next().step(), 0);
    *hash_at_100 = queue->next().hash();
  } else {
    sim->start(kSteps);
  }
  sim->run_until(kSteps);
  EXPECT_TRUE(sim->wait().ok());
  const uint64_t hash = sim->latest().hash();
  EXPECT_EQ(sim->latest().step(), kSteps);
  sim->stop();
  for (std::thread& t : threads) t.join();
  return hash;
}

TEST(Determinism, HashDoesNotDependOnWatchersThreadsOrPace) {
  uint64_t at_100 = 0;
  const uint64_t reference = final_hash({}, {}, &at_100);
  EXPECT_NE(at_100, reference);
  EXPECT_EQ(final_hash({}, {}), reference);
  EXPECT_EQ(final_hash({}, {.best_effort = 1}), reference);
  EXPECT_EQ(final_hash({}, {.best_effort = 3, .required = 2}), reference);
  EXPECT_EQ(final_hash({.pace = Pace::kLockstep}, {.required = 1}), reference);
  EXPECT_EQ(final_hash({.pace = Pace::kRealTime, .speed = 4}, {.best_effort = 1}), reference);
  EXPECT_NE(final_hash({.seed = 2}, {}), reference);
}

TEST(Determinism, HashSeesEveryBitOfTheState) {
  auto run = [](double offset) {
    auto sim = make_simulator(world_from_mjcf(kRichModel), lockstep());
    EXPECT_TRUE(sim->set_step_hook([offset](const mjModel*, mjData* d) {
                     if (d->time == 0) d->qvel[0] += offset;
                   })
                    .ok());
    sim->start();
    EXPECT_TRUE(sim->step(1).ok());
    return sim->latest().hash();
  };
  EXPECT_EQ(run(0), run(0));
  EXPECT_NE(run(0), run(1e-15));
}

TEST(Determinism, ResetRepeatsTheRun) {
  auto sim = make_simulator(world_from_mjcf(kRichModel), lockstep());
  auto controller = std::make_unique<RandomController>();
  RandomController* counts = controller.get();
  ASSERT_TRUE(sim->add_controller(0, std::move(controller), {500, 1}).ok());
  sim->start();
  const uint64_t first = sim->latest().hash();
  ASSERT_TRUE(sim->step(300).ok());
  const uint64_t last = sim->latest().hash();
  for (int run = 0; run < 2; ++run) {
    ASSERT_TRUE(sim->post({0, SetLiveField{LiveFieldId::kGravity, 0, {0, 0, -3}}}).ok());
    ASSERT_TRUE(sim->step(17).ok());
    ASSERT_TRUE(sim->reset().ok());
    EXPECT_EQ(sim->step_count(), 0);
    EXPECT_EQ(sim->latest().step(), 0);
    EXPECT_EQ(sim->latest().hash(), first);
    ASSERT_TRUE(sim->step(300).ok());
    EXPECT_EQ(sim->latest().hash(), last);
  }
  EXPECT_EQ(counts->resets, 3);
  EXPECT_EQ(sim->counters().resets, 2);
}

// A free-running client is the one thing that is not repeatable; its log makes it so.
TEST(Determinism, ReplayOfTheCommandLogIsExact) {
  auto world = world_from_mjcf(kRichModel);
  const mjModel* m = world->model.get();
  const Body base{mj_name2id(m, mjOBJ_BODY, "base")}, hand{mj_name2id(m, mjOBJ_BODY, "hand")},
      ball{mj_name2id(m, mjOBJ_BODY, "ball")};
  std::vector<uint64_t> hashes, replayed;
  std::vector<LoggedCommand> log;
  auto watch = [](Simulator& sim) {
    return *sim.subscribe({.rate = {500, 1}, .required = true, .capacity = 65536});
  };
  auto collect = [](std::shared_ptr<SnapshotQueue> queue, std::vector<uint64_t>& out) {
    return std::thread([queue, &out] {
      while (Snapshot s = queue->next()) out.push_back(s.hash());
    });
  };
  int64_t last_step = 0;
  {
    auto sim = make_simulator(world, {.pace = Pace::kRealTime, .speed = 4});
    std::thread reader = collect(watch(*sim), hashes);
    sim->start();
    std::thread client([&] {
      for (int i = 0; i < 400; ++i) {
        const double r = random_control(i, 1000);
        switch (i % 7) {
          case 0:
            (void)sim->post({.what = SetControl{Actuator{i % 4}, r}}).ok();
            break;
          case 1:
            (void)sim->post({.what = SetMocapPose{hand, {{-1, r / 5, 1}, {}}}}).ok();
            break;
          case 2:
            (void)sim->post({.what = SetWrench{ball, {r / 10, 0, 2}, {}}}).ok();
            break;
          case 3:
            (void)sim->post({.what = AddVelocity{base, {r / 9, 0, 0}}}).ok();
            break;
          case 4:
            (void)sim->post({.what = DragBody{base, {0, 0, .05}, {r, 0, 1}, i % 2 == 0}}).ok();
            break;
          case 5:
            (void)sim
                ->post({.what = SetLiveField{LiveFieldId::kBodyMass, base.id, {double(5 + r)}}})
                .ok();
            break;
          case 6:
            (void)sim->post({sim->step_count() + 20, SetControl{Actuator{0}, -r}}).ok();
            break;
        }
        if (i == 150) (void)sim->post({.what = ResetSim{}}).ok();
        if (i == 250) {
          const Status before = sim->status();
          EXPECT_TRUE(before.ok()) << before.error().to_string();
          EXPECT_TRUE(sim->reset().ok());
        }
        std::this_thread::sleep_for(std::chrono::microseconds(50));
      }
    });
    client.join();
    sim->pause();
    const Status status = sim->wait();
    ASSERT_TRUE(status.ok()) << status.error().to_string();
    last_step = sim->step_count();
    sim->stop();
    reader.join();
    log = sim->take_command_log();
    EXPECT_GT(log.size(), 200u);
    EXPECT_EQ(log.back().run, 2);
    EXPECT_TRUE(sim->take_command_log().empty());
  }
  {
    SimulatorOptions options = lockstep();
    options.replay = log;
    auto sim = make_simulator(world, options);
    std::thread reader = collect(watch(*sim), replayed);
    sim->start();
    while (sim->counters().resets < 2) {
      if (!sim->step().ok()) FAIL() << sim->status().error().to_string();
    }
    sim->run_until(last_step);
    ASSERT_TRUE(sim->wait().ok());
    sim->stop();
    reader.join();
  }
  EXPECT_EQ(hashes.size(), replayed.size());
  EXPECT_TRUE(hashes == replayed);
}

}  // namespace
}  // namespace gloam

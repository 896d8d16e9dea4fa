#pragma once
// One hash, however a simulation is run.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <thread>

#include "base/parallel.h"
#include "test_world.h"

namespace gloam {

/// State hash after `steps`; with `look`, beside a thread that looks at Snapshots, 60 a second.
inline uint64_t hash_after_steps(std::unique_ptr<Simulator> sim, int64_t steps,
                                 const std::function<void(const Snapshot&)>& look = {}) {
  std::thread watcher;
  if (look) {
    auto queue = *sim->subscribe({.rate = {60, 1}, .capacity = 2});
    watcher = std::thread([queue, &look] {
      while (Snapshot snapshot = queue->next()) look(snapshot);
    });
  }
  sim->start(steps);
  sim->run_until(steps);
  EXPECT_TRUE(sim->wait().ok());
  const uint64_t hash = sim->latest().hash();
  sim->stop();
  if (watcher.joinable()) watcher.join();
  return hash;
}

/// `run(options, watched)`: the hash of a run. Returns that of all of them.
template <class Run>
uint64_t expect_one_hash(const Run& run) {
  const uint64_t reference = run(SimulatorOptions{}, false);
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    EXPECT_EQ(run(SimulatorOptions{}, false), reference) << threads << " threads";
  }
  set_thread_count(0);
  EXPECT_EQ(run(SimulatorOptions{.pace = Pace::kRealTime, .speed = 10}, false), reference)
      << "in ten times real time";
  EXPECT_EQ(run(SimulatorOptions{}, true), reference) << "with a watcher";
  return reference;
}

}  // namespace gloam

#pragma once
// Run: a Simulation as Python holds it, with what Python wrote into its memory.

#include <unistd.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "core.h"
#include "gloam/simulation.h"
#include "inbox.h"

namespace gloam::python {

/// Numbers of mjSTATE_INTEGRATION that Python wrote between two steps.
struct Written {
  std::vector<size_t> index;
  std::vector<double> value;
};

class Run {
 public:
  Run(std::unique_ptr<Simulation> simulation, nb::object keep);
  ~Run();

  /// Raises: closed, or this process was forked from the one that made it.
  Simulation& simulation();
  /// The present instant. The interpreter is free meanwhile: the thread that steps answers, and may
  /// be in a hook of Python's.
  Snapshot latest();
  void close();
  bool is_closed() const { return simulation_ == nullptr; }

  void step(int64_t n);
  void run_until(int64_t step);
  void resume();
  void pause();
  void reset();
  void recompile(const World& world);
  void restore(const Checkpoint& checkpoint);
  void set_hook(nb::object hook);

  /// Memory that physics steps in now; from then on what Python writes into it counts as input.
  const PhysicsMemory& memory();
  /// Number of that memory; another one after a recompile, a restore, a failure.
  int64_t generation();
  /// The next message of a stream, at the time at which it reaches a reader.
  nb::object step_until(Inbox& inbox);

  void add(const std::shared_ptr<Inbox>& inbox);
  /// Told of by whoever posts a Command, which may wait for the next step.
  void note_command() { has_commands_ = true; }
  /// For the collector of cycles.
  nb::object& hook() { return hook_; }

 private:
  std::unique_lock<std::mutex> turn();
  void give_written();
  void look_at_memory();
  void look_at_state();
  void look_anew();
  void call_hook(const mjModel_* model, mjData_* data);
  std::vector<std::shared_ptr<Inbox>> open_inboxes() const;
  void empty_inboxes();
  void restart_inboxes();
  template <class F>
  void guarded_call(F&& job);

  std::unique_ptr<Simulation> simulation_;
  nb::object keep_;  // made the memory, if it is not the simulation's own
  const pid_t process_ = getpid();
  std::mutex turn_;
  PhysicsMemory memory_;
  int64_t generation_ = 0;
  bool is_watched_ = false;   // Python holds arrays of the memory
  std::vector<double> seen_;  // state when Python last got it; empty = it runs, or was never asked
  std::vector<double> now_, in_hook_;
  Written written_;
  std::atomic<bool> has_written_{false}, has_commands_{false};
  nb::object hook_;
  std::atomic<bool> has_hook_{false};
  FirstError hook_error_;
  std::vector<std::weak_ptr<Inbox>> inboxes_;
};

}  // namespace gloam::python

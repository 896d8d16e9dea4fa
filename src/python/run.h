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
#include "model_mirror.h"

namespace gloam::python {

/// Numbers of mjSTATE_INTEGRATION that Python wrote between two steps.
struct Written {
  std::vector<size_t> index;
  std::vector<double> value;
};

class Run {
 public:
  /// Objects that a simulation is created with and shares with its Run.
  struct Shared {
    nb::object make_data;  ///< or none
    std::shared_ptr<ModelMirrors> mirrors = std::make_shared<ModelMirrors>();
    std::shared_ptr<FirstError> signal =
        std::make_shared<FirstError>();  ///< Ctrl-C while it waited
  };

  Run(std::unique_ptr<Simulation> simulation, Shared shared);
  /// Closes it at the end of its Python object, raising nothing. False: it was left behind, and
  /// must not be deleted.
  bool end();

  /// Raises: closed, or this process was forked from the one that made it.
  Simulation& simulation();
  /// The present instant. The interpreter is free meanwhile: the thread that steps answers, and may
  /// be in a hook of Python's.
  Snapshot latest();
  /// The settings of images in the scene of the present World.
  RenderOptions scene_render();
  /// Ends the simulation and its streams. Raises an Error where a callback or hook does not return
  /// within kCallbackTimeout: its thread and the simulation's memory are then left behind.
  void close();
  bool is_closed() const { return is_closed_; }

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
  /// From now on what Python writes into the model of the package `mujoco` counts as input, too.
  void watch_model();
  /// Number of that memory; another one after a recompile, a restore, a failure.
  int64_t generation();
  /// The next message of a stream, at the time at which it reaches a reader.
  nb::object step_until(Inbox& inbox);

  void add(const std::shared_ptr<Inbox>& inbox);
  /// Told of by whoever posts a Command, which may wait for the next step.
  void note_command() { has_commands_ = true; }
  /// For the collector of cycles.
  int traverse(visitproc visit, void* arg) const {
    Py_VISIT(hook_.ptr());
    return hook_error_.traverse(visit, arg);
  }
  void clear_kept() {
    hook_.reset();
    hook_error_.clear();
  }

 private:
  std::unique_lock<std::timed_mutex> turn();
  void give_written();
  void give_written_model();
  void look_at_memory();
  void look_at_state();
  void look_anew();
  void call_hook(const mjModel_* model, mjData_* data);
  void leave_behind(const std::string& what);
  std::vector<std::shared_ptr<Inbox>> open_inboxes() const;
  void empty_inboxes();
  void restart_inboxes();
  template <class F>
  void guarded_call(F&& job);

  std::unique_ptr<Simulation> simulation_;
  const Shared shared_;
  const pid_t process_ = getpid();
  std::timed_mutex turn_;
  std::atomic<bool> is_closed_{false};
  PhysicsMemory memory_;
  int64_t generation_ = 0;
  bool is_watched_ = false;              // Python holds arrays of the memory
  std::shared_ptr<ModelMirror> mirror_;  // of the memory's model; null without the package
  bool model_is_watched_ = false;        // Python holds the model
  bool model_is_given_ = false;          // it got it since the last step
  std::vector<double> seen_;  // state when Python last got it; empty = it runs, or was never asked
  std::vector<double> now_, in_hook_;
  Written written_;
  std::atomic<bool> has_written_{false}, has_commands_{false};
  nb::object hook_;
  std::atomic<bool> has_hook_{false}, is_in_hook_{false};
  FirstError hook_error_;
  std::vector<std::weak_ptr<Inbox>> inboxes_;
};

}  // namespace gloam::python

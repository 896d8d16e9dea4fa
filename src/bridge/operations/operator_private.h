#pragma once
// Operator::Private: what an Operator remembers. For the files of Operator alone.

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <set>

#include "bridge/operations/model_source.h"
#include "bridge/operations/operator.h"

namespace gloam::bridge {

struct Operator::Private {
  /// Information of a client about an entity.
  struct Info {
    std::string description;
    std::vector<std::string> tags;
    EntityKind kind;
  };
  /// A change of a state that applies at the step after `step`.
  struct Waiting {
    int64_t step = 0;
    uint64_t hash = 0;
    StateChange change;
  };
  /// An instant that is solved, and the entities of its World.
  struct Solved {
    Snapshot snapshot;
    Instant instant;
    const void* world = nullptr;  // identity of the World that `entities` are of
    std::vector<Entity> entities;
  };

  explicit Private(Simulation& of) : simulation(of), first(written_scene(of.world())) {}

  /// Solves the latest instant, if it is not. Under solved_mutex.
  Status solve();
  /// Exchanges the World. Under change_mutex. Error: the physics has failed.
  Status exchange(const Scene& scene, const ProgressCallback& progress = {});
  /// The scene with the bridges, recordings and run settings of the one that runs: a client's
  /// scene opens no network interface and no file.
  Scene without_access(Scene scene) const;
  /// Refuses what needs a World.
  Status need_world() const;
  Scene first_scene() const;
  void forget_waiting();
  size_t spawned_count() const;
  /// A scene that a client names. `known`: scenes that it may call by their names.
  Result<Scene> read_world(const std::string& uri, const std::string& text,
                           const std::vector<WorldFile>& known) const;
  /// Begins another World at its initial state, paused. Under change_mutex.
  Status enter(const Scene& scene);

  Simulation& simulation;
  std::mutex change_mutex;  ///< one change of the World, step or reset at a time
  ModelSource source;       ///< files that clients may name

  std::atomic<bool> rests{true};  ///< stopped, if it is paused at its first instant
  std::atomic<bool> stepping{false}, stop_stepping{false};
  std::atomic<bool> unloaded{false}, loading{false};
  std::atomic<double> speed{1};      ///< [simulated s per s], where it is paced
  std::atomic<bool> is_fast{false};  ///< as fast as possible
  std::atomic<bool> waits_for_sensors{false};

  mutable std::mutex names_mutex;  ///< for what follows
  Scene first;                     ///< that resets go back to
  std::map<std::string, Info, std::less<>> infos;
  std::set<std::string, std::less<>> spawned;
  std::map<std::string, Waiting, std::less<>> waiting;

  std::mutex solved_mutex;
  std::unique_ptr<Solved> solved;

  mutable std::mutex records_mutex;  ///< for what follows
  std::unique_ptr<LogStream> log;
  std::string log_file;
  std::filesystem::path recording_folder = "recordings";
  std::map<int64_t, Checkpoint> kept;
  int64_t next_checkpoint = 1;
};

}  // namespace gloam::bridge

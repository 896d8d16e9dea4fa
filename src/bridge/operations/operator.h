#pragma once
// Operator: what a client may do to a simulation, the same over every bridge. Thread-safe; calls
// that change the World come one after the other and block until it runs. Errors are told apart by
// their kind: kInput = there is no such thing, or a value is wrong; kUsage = not in this state of
// the run; kUnsupported = Gloam cannot do that; others = it was tried and failed.

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridge/operations/entity.h"
#include "bridge/operations/spawning.h"
#include "gloam/camera.h"
#include "gloam/log.h"
#include "gloam/options.h"
#include "gloam/simulation.h"

namespace gloam::bridge {

enum class RunState : uint8_t {
  kStopped,  ///< at its first instant, until somebody starts or pauses it
  kPlaying,
  kPaused,
  kFailed,   ///< physics has diverged: reset it
  kNoWorld,  ///< unloaded
  kLoading,
};
const char* to_string(RunState state);  ///< "stopped", "playing" …

/// Parts of a reset.
struct ResetScope {
  bool state = true;    ///< state and time: they begin together
  bool spawned = true;  ///< entities are those that the scene began with
};

/// Called between steps with those that are done and left; returns false to stop.
using StepProgress = std::function<bool(int64_t done, int64_t left)>;

/// Whether an option is none of a client's to change in a run: it opens network interfaces or files
/// ([bridge], [record]), or has been used when the run began.
bool is_fixed_option(std::string_view path);

/// Numbers that a client changes of an entity; what is not given stays.
struct StateChange {
  std::optional<Pose> X_WE = {};
  std::optional<Vec3> velocity = {}, angular_velocity = {};  ///< world axes [m/s], [rad/s]
};

class Operator {
 public:
  explicit Operator(Simulation& simulation);
  ~Operator();
  Operator(const Operator&) = delete;
  Operator& operator=(const Operator&) = delete;

  Simulation& simulation() { return simulation_; }
  /// Asks the program to end.
  void ask_end() { end_asked_ = true; }
  bool end_asked() const { return end_asked_; }

  // Run: operator.cc
  RunState state() const;
  Status pause();
  Status play();
  /// Pauses and resets all.
  Status stop();
  /// Takes 1 or more steps, only while paused or stopped, and blocks. Errors: kUsage while it plays
  /// or another client steps; kInterrupted when `progress` or pause() has ended it.
  Status step(int64_t count, const StepProgress& progress = {});
  /// Speed in simulated seconds per second, 0.001 … 1000; empty = as fast as possible. The pace
  /// stays kSensors where it is.
  Status set_speed(std::optional<double> speed);
  /// Pace::kFast, kRealTime or kSensors, at the present speed (docs/sensors.md). Error: no such
  /// pace.
  Status set_pace(std::string_view pace);
  Pace pace() const;
  std::optional<double> speed() const;
  Status reset(const ResetScope& scope = {});

  // Entities: entities.cc, entity.cc
  std::vector<Entity> entities() const;
  Result<Entity> find_entity(std::string_view name) const;
  /// Description, tags and kind as clients see them.
  Status set_info(std::string_view name, std::string description, std::vector<std::string> tags,
                  EntityKind kind);
  /// At the latest instant; a change that waits for the next step counts already.
  Result<EntityState> entity_state(std::string_view name) const;
  Result<std::vector<EntityState>> entity_states(const std::vector<Entity>& entities) const;
  /// Applies at the next step. Errors: kUnsupported, it neither floats nor is a mocap body.
  Status set_entity_state(std::string_view name, const StateChange& change);
  /// Boxes around geoms at the latest instant; an empty one = it has none.
  Result<Box> entity_bounds(std::string_view name, BoxFrame frame = BoxFrame::kWorld) const;
  Result<std::vector<Box>> entity_bounds(const std::vector<Entity>& entities,
                                         BoxFrame frame = BoxFrame::kWorld) const;
  std::vector<NamedPose> named_poses() const;
  /// Recompiles the World with one entity more.
  SpawnResult spawn(const SpawnRequest& request);
  /// Recompiles the World without a [[robot]], [[object]], [[prop]] or [[agent]]. Errors:
  /// kUnsupported, it is part of a file or a generated place.
  Status remove(std::string_view name);
  /// Catalogue of props, robots that come with Gloam, and models and meshes in `folders`, which lie
  /// below those that clients may read.
  Result<std::vector<Spawnable>> spawnables(const std::vector<std::string>& folders = {}) const;

  // Worlds: worlds.cc
  /// A scene by its name among worlds(), its path or file:// address, or by its text in TOML. The
  /// World is stopped then. Errors also: a scene that does not compile; the old one goes on.
  Result<WorldFile> load_world(const std::string& uri, const std::string& text = {});
  Status unload_world();
  /// Error: kUsage, none is loaded.
  Result<WorldFile> current_world() const;
  /// Scenes that come with Gloam, those beside the first scene, and those in `folders`.
  Result<std::vector<WorldFile>> worlds(const std::vector<std::string>& folders = {}) const;

  // Options: option_access.cc
  std::vector<OptionInfo> options() const;
  Result<std::string> option(std::string_view path) const;
  /// All of them or none; recompiles the World.
  /// Error: also for options that clients may not change (is_fixed_option).
  Status set_options(const std::vector<std::pair<std::string, std::string>>& values);
  /// Elements of a live field at the latest instant; names are those of World::inputs(), "gravity".
  Result<std::vector<double>> live_field(std::string_view name) const;
  /// Changes elements from `first` on, at the next step.
  Status set_live_field(std::string_view name, int first, std::vector<double> values);
  /// Goes on in the scene of a text in TOML, whose paths start at the first scene's folder.
  Status recompile(std::string_view toml);

  // Records: records.cc
  /// Starts a log, NAME.mcap in `recording_folder`; empty = named by date and time. Returns its
  /// path. Error: kUsage, one is being written.
  Result<std::string> start_recording(const std::string& name, const LogRequest& request = {});
  Result<std::string> stop_recording();
  void set_recording_folder(std::filesystem::path folder);
  /// A picture of the latest instant. `camera` and outputs as of CameraRequest.
  Result<std::shared_ptr<const CameraFrame>> picture(CameraRequest request);
  /// Keeps the present instant; at most 64 are kept. Returns its number.
  Result<int64_t> save_checkpoint();
  Status restore_checkpoint(int64_t id);
  Status forget_checkpoint(int64_t id);
  std::vector<std::pair<int64_t, Checkpoint>> checkpoints() const;

 private:
  struct Private;
  std::unique_ptr<Private> private_;
  Simulation& simulation_;
  std::atomic<bool> end_asked_{false};
};

}  // namespace gloam::bridge

#pragma once
// World: what a Scene compiles to. Immutable; shared by everything that runs it.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gloam/handle.h"
#include "gloam/result.h"
#include "gloam/scene.h"
#include "gloam/stream_info.h"

namespace gloam {

struct CompiledWorld;  // src/world/world.h

/// A name and its kind, for listings.
struct NamedElement {
  std::string name;    ///< full name, with the robot's prefix; "" when the model gives none
  std::string detail;  ///< type, size or target in words
};

/// What the model holds, for `gloam info`.
struct WorldInfo {
  /// Cameras without a name are called "camera_ID", so that they can be asked for.
  std::vector<NamedElement> bodies, joints, actuators, sensors, cameras, geoms, lights, materials;
  std::vector<NamedElement> sites, tendons, equalities, keyframes, textures;
  int nq = 0, nv = 0, nu = 0;
  double timestep = 0;             ///< [s]
  double mass = 0;                 ///< of all bodies [kg]
  int64_t model_bytes = 0;         ///< mjModel
  int64_t triangles = 0;           ///< that are drawn: of meshes, height fields, model files
  std::vector<Region> regions;     ///< floors of a generated environment
  std::vector<DrawnOption> drawn;  ///< what came of [[randomize]]
  std::vector<Error> notes;        ///< as World::notes()
  std::vector<Error> unsupported;  ///< as World::unsupported()
};

/// A robot of a World: a [[robot]], or the trees of a bare model that actuators move.
struct RobotInfo {
  Robot robot;
  std::string name;
  Body root;
  std::vector<Joint> joints;  ///< in the model's order
  std::vector<Actuator> actuators;
};

struct BodyInfo {
  Body body, parent;  ///< the world's own body is its parent's child
  std::string name;   ///< full name, "" when the model gives none
  Robot robot;        ///< id -1 = no robot's
};

/// Elements of the files that pictures do not show.
struct NotDrawn {
  std::vector<Error> hidden;   ///< groups and sites that pictures show when asked to
  std::vector<Error> lacking;  ///< cannot be drawn
};

/// How far a job is.
struct Progress {
  std::string what;    ///< "simulating", "rendering", "making 'chair' physical" …
  double done = 0;     ///< 0..1, never less than before
  double seconds = 0;  ///< wall time so far [s]
  double left = 0;     ///< about, of `what` [s]; 0 = as `done` grows, < 0 = cannot be told
};
/// Called about ten times a second, one call at a time, on a thread of the job's; returns false to
/// stop the job.
using ProgressCallback = std::function<bool(const Progress&)>;

class World {
 public:
  World() = default;
  explicit World(std::shared_ptr<const CompiledWorld> compiled) : compiled_(std::move(compiled)) {}

  /// Compiles a Scene, on any thread. On failure nothing is left behind. Without `progress` the log
  /// tells of what takes long. Stopped by it, the Error is kInterrupted: within 0.2 s, but while
  /// MuJoCo reads or compiles the model.
  static Result<World> compile(const Scene& scene, const ProgressCallback& progress = {});
  /// The same of a bare model, which starts from one of its keyframes: by its name, else by its
  /// number from 0. Errors: also, there is none of that name; the Scene is no bare model.
  static Result<World> compile_at(const Scene& scene, const std::string& keyframe,
                                  const ProgressCallback& progress = {});

  Result<Joint> find_joint(const std::string& name) const;
  Result<Body> find_body(const std::string& name) const;
  Result<Actuator> find_actuator(const std::string& name) const;
  Result<SensorHandle> find_sensor(const std::string& name) const;
  Result<Camera> find_camera(const std::string& name) const;
  Result<Geom> find_geom(const std::string& name) const;
  Result<Tendon> find_tendon(const std::string& name) const;
  Result<Robot> find_robot(const std::string& name) const;

  const Scene& scene() const;  ///< that it was compiled from, with what generators added
  std::vector<RobotInfo> robots() const;
  std::vector<BodyInfo> bodies() const;  ///< in MuJoCo's order, the world first
  /// All that a simulation of it can say and hear: what bridges and logs go by.
  std::vector<StreamInfo> streams() const;
  std::vector<InputInfo> inputs() const;
  /// Numbers of a live field (gloam/command.h) as the files give them: what a SetLiveField changes
  /// and a reset restores. Error: no such field.
  Result<std::vector<double>> live_field(const std::string& name) const;
  /// Columns of metrics.csv but the time. Error: a [[metric]] or [[goal]] of the scene that does
  /// not parse, or is of what there is not.
  Result<std::vector<MetricInfo>> metrics() const;

  WorldInfo info() const;
  /// What is odd about the scene and taken all the same, and where: open meshes, sizes that look
  /// like another unit, nodes that got another name, robots and loose things that begin inside
  /// others. The last takes one pass of MuJoCo's collision.
  std::vector<Error> notes() const;
  /// What is in the files and is not simulated or drawn, and where.
  const std::vector<Error>& unsupported() const;

  /// Reads all that pictures show to tell, which takes as long as a renderer's start.
  NotDrawn not_drawn() const;

  /// Writes the whole level as one MJCF with its assets into `folder`/scene.xml; stock MuJoCo loads
  /// it to the same model, equal in every array. With `left_out`, what is only drawn joins it as
  /// visual geoms, and what MJCF cannot hold is listed there.
  Status export_mjcf(const std::filesystem::path& folder,
                     std::vector<Error>* left_out = nullptr) const;

  const std::shared_ptr<const CompiledWorld>& compiled() const { return compiled_; }

 private:
  std::shared_ptr<const CompiledWorld> compiled_;
};

}  // namespace gloam

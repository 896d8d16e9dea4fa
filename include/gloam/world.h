#pragma once
// World: the immutable result of compiling a Scene, shared by all its simulations.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gloam/handle.h"
#include "gloam/result.h"
#include "gloam/scene.h"
#include "gloam/stream_info.h"

namespace gloam {

struct CompiledWorld;  // src/world/world.h
class Snapshot;        // gloam/snapshot.h

/// Name and kind of an element, for listings.
struct NamedElement {
  std::string name;    ///< full name, with the robot's prefix; "" if the model gives none
  std::string detail;  ///< type, size or target as text
};

/// Contents of the model, for `gloam info`.
struct WorldInfo {
  /// Cameras without a name are listed as "camera_ID", so that they can be requested.
  std::vector<NamedElement> bodies, joints, actuators, sensors, cameras, geoms, lights, materials;
  std::vector<NamedElement> sites, tendons, equalities, keyframes, textures;
  int nq = 0, nv = 0, nu = 0;
  double timestep = 0;             ///< [s]
  double mass = 0;                 ///< of all bodies [kg]
  int64_t model_bytes = 0;         ///< mjModel
  int64_t triangles = 0;           ///< rendered triangles of meshes, height fields and model files
  std::vector<Region> regions;     ///< floors of a generated environment
  std::vector<DrawnOption> drawn;  ///< values drawn by [[randomize]]
  std::vector<Error> notes;        ///< as World::notes()
  std::vector<Error> unsupported;  ///< as World::unsupported()
};

/// A robot of a World: a [[robot]], or in a bare model the kinematic trees with actuators.
struct RobotInfo {
  Robot robot;
  std::string name;
  Body root;
  std::vector<Joint> joints;  ///< in the model's order
  std::vector<Actuator> actuators;
};

struct BodyInfo {
  Body body, parent;  ///< the world body is its own parent
  std::string name;   ///< full name, "" if the model gives none
  Robot robot;        ///< id -1 = not part of a robot
};

/// Elements of the files that are not rendered.
struct NotDrawn {
  std::vector<Error> hidden;   ///< groups and sites that are rendered only on request
  std::vector<Error> lacking;  ///< cannot be rendered
};

/// Progress of a job.
struct Progress {
  std::string what;    ///< "simulating", "rendering", "building colliders for 'chair'" …
  double done = 0;     ///< 0..1, never decreases
  double seconds = 0;  ///< wall time so far [s]
  double left = 0;     ///< estimate for `what` [s]; 0 = extrapolate `done`, < 0 = unknown
};
/// Called about ten times per second, one call at a time, on a thread of the job. Returns false to
/// cancel the job.
using ProgressCallback = std::function<bool(const Progress&)>;

class World {
 public:
  World() = default;
  explicit World(std::shared_ptr<const CompiledWorld> compiled) : compiled_(std::move(compiled)) {}

  /// Compiles a Scene, on any thread. A failure leaves nothing behind. Without `progress`, slow
  /// stages are reported in the log. If `progress` cancels the compilation, the Error is
  /// kInterrupted, within 0.2 s except while MuJoCo reads or compiles the model.
  static Result<World> compile(const Scene& scene, const ProgressCallback& progress = {});
  /// Compiles a bare model that starts from one of its keyframes, given by name or else by number
  /// from 0. Errors: as for compile(); no such keyframe; the Scene is not a bare model.
  static Result<World> compile_at(const Scene& scene, const std::string& keyframe,
                                  const ProgressCallback& progress = {});

  Result<Joint> find_joint(const std::string& name) const;
  Result<Body> find_body(const std::string& name) const;
  Result<Actuator> find_actuator(const std::string& name) const;
  Result<SensorHandle> find_sensor(const std::string& name) const;
  Result<Camera> find_camera(const std::string& name) const;
  Result<Geom> find_geom(const std::string& name) const;
  Result<Tendon> find_tendon(const std::string& name) const;
  Result<Equality> find_equality(const std::string& name) const;
  Result<Robot> find_robot(const std::string& name) const;

  const Scene& scene() const;  ///< source of the World, including all elements added by generators
  std::vector<RobotInfo> robots() const;
  std::vector<BodyInfo> bodies() const;  ///< in MuJoCo's order, the world body first
  /// All outputs and inputs of a simulation of this World; bridges and logs use these lists.
  std::vector<StreamInfo> streams() const;
  std::vector<InputInfo> inputs() const;
  /// Values of a live field (gloam/command.h) in the files. SetLiveField changes them in a
  /// simulation, and a reset restores them. Error: no such field.
  Result<std::vector<double>> live_field(const std::string& name) const;
  /// Columns of metrics.csv except the time. Error: a [[metric]] or [[goal]] of the scene that does
  /// not parse or refers to unknown elements.
  Result<std::vector<MetricInfo>> metrics() const;

  /// An instant of a given configuration at rest, without a simulation: qpos (nq) [m, rad], whose
  /// quaternions are normalised; velocities are 0, all other parts of the state are initial, and
  /// effects have not begun (gases are clear, water has no ripples). `time` [s], 0 ≤ time < 1e9.
  /// `mocap`: poses X_WB of all mocap bodies in MuJoCo's order; empty = as compiled (a simulation
  /// moves agents to their places when it starts). No motion is measured between two such instants.
  /// Errors: a wrong size, a number that is not finite or out of range, reported by MuJoCo.
  Result<Snapshot> snapshot(std::span<const double> qpos, double time = 0,
                            std::span<const Pose> mocap = {}) const;

  WorldInfo info() const;
  /// Names of all elements of one of MuJoCo's types ("body", "geom", "equality" …), in MuJoCo's
  /// order; "" where the model gives none. Error: no such type.
  Result<std::vector<std::string>> names(const std::string& type) const;
  /// Number that no other World of this process has; handles remember it.
  uint64_t serial() const;
  /// Suspicious but accepted properties of the scene, with their locations: open meshes, sizes that
  /// suggest another unit, renamed nodes, robots and loose objects that start inside others. The
  /// last check takes one pass of MuJoCo's collision detection.
  std::vector<Error> notes() const;
  /// Elements of the files that are not simulated or rendered, with their locations.
  const std::vector<Error>& unsupported() const;

  /// Reads all data for rendering, so it takes as long as starting a renderer.
  NotDrawn not_drawn() const;

  /// Writes the whole scene as one MJCF with its assets into `folder`/scene.xml. Stock MuJoCo loads
  /// it as the same model, equal in every array. With `left_out`, elements that are only rendered
  /// are added as visual geoms, and elements that MJCF cannot represent are listed there.
  Status export_mjcf(const std::filesystem::path& folder,
                     std::vector<Error>* left_out = nullptr) const;

  const std::shared_ptr<const CompiledWorld>& compiled() const { return compiled_; }

 private:
  std::shared_ptr<const CompiledWorld> compiled_;
};

}  // namespace gloam

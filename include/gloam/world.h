#pragma once
// World: what a Scene compiles to. Immutable; shared by everything that runs it.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene.h"

namespace gloam {

struct CompiledWorld;  // src/world/world.h

/// Typed index of a named element. Resolve once with World::find_*, then use on every Snapshot of
/// that World. After a recompile find it again: a handle of another World is refused.
template <class Kind>
struct Handle {
  int id = -1;
  uint64_t world = 0;  ///< which World found it; 0 = an id of one's own, taken as it stands
};
using Joint = Handle<struct JointKind>;
using Body = Handle<struct BodyKind>;
using Actuator = Handle<struct ActuatorKind>;
using SensorHandle = Handle<struct SensorHandleKind>;
using Camera = Handle<struct CameraKind>;
using Geom = Handle<struct GeomKind>;
using Tendon = Handle<struct TendonKind>;

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

/// What a mesh becomes as an [[object]], and how near its colliders are to it.
struct ObjectReport {
  std::vector<std::string> colliders = {};  ///< "box", "hull" … of each
  uint64_t triangles = 0;
  bool is_closed = false;
  Vec3 size = {};     ///< of its bounding box [m]
  double volume = 0;  ///< of the mesh where it is closed, else of its hull [m³]
  double mass = 0;    ///< [kg]
  double shared = 0;  ///< of closed meshes: intersection over union with the colliders, 0 … 1
  double mean_distance = 0, max_distance = 0;  ///< between the surfaces, by sampled points [m]
  double seconds = 0;                          ///< that the colliders took
  std::vector<std::string> notes = {};         ///< what is odd about the mesh
};
/// Converts one object without a scene. Progress and Errors: as of World::compile.
Result<ObjectReport> convert_object(const ObjectOptions& object, const FileAccess& access = {},
                                    const ProgressCallback& progress = {});

/// How a model fares against stock MuJoCo, and on its way out into MJCF and back.
struct ModelCheck {
  Status status;  ///< of loading and exporting it
  int bodies = 0, joints = 0, geoms = 0;
  int compared = 0;  ///< fields of mjModel that each comparison looks at: sizes, options, arrays
  /// Why stock MuJoCo does not load the file, "" where it does. Nothing is known of scenes, nor of
  /// models in TOML.
  std::optional<std::string> stock_refusal;
  std::vector<std::string> unlike_stock;   ///< fields that are not what stock MuJoCo makes of them
  std::vector<std::string> unlike_export;  ///< fields that stock MuJoCo reads back differently
  uint64_t export_bytes = 0;               ///< of all files written

  bool passed() const { return status.ok() && unlike_stock.empty() && unlike_export.empty(); }
};
/// Loads a scene or model, exports it into `folder`, has stock MuJoCo load the model file and the
/// export, and compares all bits. A file that Gloam refuses is given to stock MuJoCo in a process
/// of its own, for `longest_stock_load` seconds at most; that one reads whatever the file names.
ModelCheck check_model(const std::filesystem::path& file, const FileAccess& access,
                       const std::filesystem::path& folder, unsigned longest_stock_load = 60);

}  // namespace gloam

#pragma once
// The compiled World behind gloam::World. Immutable after compile. ARCHITECTURE.md lists the
// modules that may see its MuJoCo types.

#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gloam/scene.h"
#include "gloam/world.h"
#include "scene/files/dependency.h"
#include "world/agents/agent_description.h"
#include "world/effects/gas_description.h"
#include "world/effects/soil_description.h"
#include "world/effects/water_description.h"
#include "world/sensors/probe_description.h"
#include "world/weather/wind_description.h"

namespace gloam {

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct SpecDeleter {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
using ModelPtr = std::unique_ptr<mjModel, ModelDeleter>;
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using DataPtr = std::unique_ptr<mjData, DataDeleter>;
using SpecPtr = std::unique_ptr<mjSpec, SpecDeleter>;

/// One robot of the scene inside the one model.
struct RobotInstance {
  std::string name;
  std::string prefix;  ///< "go1/"; "" for a bare model
  int root_body = -1;  ///< body id of its root
  RobotOptions options;
  /// Actuators that `options.controller` may use, in increasing order; empty = all of the robot's.
  std::vector<int> actuators = {};
};

/// A geom that is drawn but not simulated: the visuals of a URDF, which stock loading discards.
struct VisualOnlyGeom {
  int body = 0;   ///< body id in `model`
  int geom = -1;  ///< geom id in `visual_model`
  Pose X_BG;
  /// Row of `visual_meshes`, for which the geom only stands in; -1 = the geom itself.
  int mesh = -1;
};

/// A mesh file that a URDF draws. It is read anew, by way of the cache, where it is drawn.
struct VisualOnlyMesh {
  std::string name;   ///< "go1/base": robot and link; its materials are "NAME/MATERIAL"
  std::string label;  ///< the visual's own name; may be empty
  std::filesystem::path file;
  Vec3 scale = {1, 1, 1};  ///< scale of the file's content, in Gloam's axes and metres
  SourceLoc loc;
};

/// A number that no other World of this process has.
uint64_t next_world_serial();

/// Lines in the model files where elements stand; 0 = not known.
struct ElementLines {
  std::vector<int> geoms, sites, tendons;  ///< lines by id in `model`
};

struct CompiledWorld {
  uint64_t serial = next_world_serial();  ///< number that handles remember
  Scene scene;           ///< drawn, with the looks, lamps and cameras of its place and meshes
  Scene written;         ///< as it was given; with `keyframe` it compiles to this World again
  std::string keyframe;  ///< that was asked for, "" = none
  std::vector<Dependency> files;  ///< files of the models and what they include
  ModelPtr model;                 ///< the whole level, exactly what stock MuJoCo would load
  /// Keyframe of `model` that the simulation starts from; -1 = mj_resetData's state. A scene whose
  /// robots name keyframes gets one made of theirs, so that the start survives export.
  int initial_key = -1;
  uint64_t place_hash = 0;      ///< hash of generated parts and of meshes, 0 = nothing
  std::optional<double> ev100;  ///< exposure of a generated environment
  Vec3 render_origin;           ///< origin of the render scene [m]; world/view/render_origin.h
  std::vector<Region> regions;  ///< floors of a generated environment
  std::vector<DrawnOption> drawn;
  std::vector<RobotInstance> robots;
  GasesDescription gases;
  WindDescription wind;
  std::vector<WaterDescription> waters;
  std::vector<SoilDescription> soils;
  std::vector<AgentDescription> agents;
  std::vector<ProbeDescription> probes;
  ModelPtr visual_model;  ///< source of visual_only meshes and materials; null when there are none
  std::vector<VisualOnlyGeom> visual_only;
  std::vector<VisualOnlyMesh> visual_meshes;
  std::vector<Error> notes;        ///< oddities that are taken as they are
  std::vector<Error> place_notes;  ///< the same, of generated parts; not in the cache, as those are
  std::vector<Error> unsupported;
  ElementLines lines;
};

}  // namespace gloam

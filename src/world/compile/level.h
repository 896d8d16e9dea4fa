#pragma once
// A scene on its way to a model: parsed, put together in one mjSpec, compiled.

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "places/place.h"
#include "scene/files/model_files.h"
#include "world/compile/dropped_options.h"
#include "world/world.h"

namespace gloam {

/// One robot's own spec; the level's elements remember which one they came from.
struct LevelRobot {
  RobotOptions options;
  SpecPtr spec;
  ModelSettings settings;               ///< as its file and the scene's overrides give them
  std::set<std::string> settings_told;  ///< names that MuJoCo says it lost
};

struct MeshObjects;
class CompileProgress;

struct Level {
  SpecPtr spec;
  std::vector<LevelRobot> robots;  ///< empty for a bare model
  ModelPtr model;
  int initial_key = -1;            ///< as in CompiledWorld
  std::vector<Error> notes;        ///< as in CompiledWorld
  std::vector<Error> unsupported;  ///< settings that lost against another file's
  ElementLines lines;
};

/// Admits every model file of the scene: roots, scans. Errors as ModelFiles::add_model.
Status add_scene_files(const Scene& scene, ModelFiles* files);

/// Parses, attaches and compiles. `place` is what make_place() makes of the scene, `objects` what
/// load_mesh_objects() does. `files` must
/// hold the scene's files already and outlive the Level. After it, level.spec holds everything that
/// the model does (for export). Errors: also, it was cancelled.
Result<Level> build_level(const Scene& scene, const std::optional<Place>& place,
                          const MeshObjects& objects, ModelFiles* files,
                          CompileProgress* progress = nullptr);

/// Number of a model's objects of one type; -1 = a type that has no list of its own.
int object_count(const mjModel& model, mjtObj type);
/// Names that MuJoCo gives its objects of one type, "" where unnamed.
std::vector<std::string> object_names(const mjModel* model, mjtObj type);

}  // namespace gloam

#pragma once
// Questions about one file without a simulation: the colliders of a mesh, a model beside stock
// MuJoCo.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene.h"
#include "gloam/world.h"

namespace gloam {

/// A mesh as an [[object]]: its colliders, and how near they are to it.
struct ObjectReport {
  std::vector<std::string> colliders = {};  ///< "box", "hull" … of each
  uint64_t triangles = 0;
  bool is_closed = false;
  Vec3 size = {};     ///< size of its bounding box [m]
  double volume = 0;  ///< volume of a closed mesh, else of its hull [m³]
  double mass = 0;    ///< [kg]
  double shared = 0;  ///< intersection over union of a closed mesh and its colliders, 0 … 1
  double mean_distance = 0, max_distance = 0;  ///< between the surfaces, by sampled points [m]
  double seconds = 0;                          ///< time that the colliders took [s]
  std::vector<std::string> notes = {};         ///< oddities of the mesh
};
/// Converts one object without a scene. Progress and Errors: as of World::compile.
Result<ObjectReport> convert_object(const ObjectOptions& object, const FileAccess& access = {},
                                    const ProgressCallback& progress = {});

/// Result of checking a model against stock MuJoCo and of its export to MJCF and back.
struct ModelCheck {
  Status status;  ///< status of loading and exporting it
  int bodies = 0, joints = 0, geoms = 0;
  int compared = 0;  ///< fields of mjModel that each comparison looks at: sizes, options, arrays
  /// Reason why stock MuJoCo does not load the file, "" if it does. Empty for scenes and models in
  /// TOML.
  std::optional<std::string> stock_refusal;
  std::vector<std::string> unlike_stock;   ///< fields that are not what stock MuJoCo makes of them
  std::vector<std::string> unlike_export;  ///< fields that stock MuJoCo reads back differently
  std::string export_reason;               ///< reason why the export is not exact, "" if it is
  uint64_t export_bytes = 0;               ///< size of all files written

  bool passed() const { return status.ok() && unlike_stock.empty() && unlike_export.empty(); }
};
/// Loads a scene or model, exports it into `folder`, has stock MuJoCo load the model file and the
/// export, and compares all bits. A file that Gloam refuses is given to stock MuJoCo in a process
/// of its own, for `longest_stock_load` seconds at most; that one reads whatever the file names.
ModelCheck check_model(const std::filesystem::path& file, const FileAccess& access,
                       const std::filesystem::path& folder, unsigned longest_stock_load = 60);

}  // namespace gloam

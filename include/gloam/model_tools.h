#pragma once
// Checks of one file without a simulation: the colliders of a mesh, a model compared with stock
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

/// A mesh as an [[object]]: its colliders and their accuracy.
struct ObjectReport {
  std::vector<std::string> colliders = {};  ///< type of each: "box", "hull" …
  uint64_t triangles = 0;
  bool is_closed = false;
  Vec3 size = {};     ///< size of its bounding box [m]
  double volume = 0;  ///< volume of the mesh if it is closed, otherwise of its hull [m³]
  double mass = 0;    ///< [kg]
  double shared = 0;  ///< intersection over union of a closed mesh and its colliders, 0 … 1
  double mean_distance = 0, max_distance = 0;  ///< between the surfaces, by sampled points [m]
  double seconds = 0;                          ///< time for computing the colliders [s]
  std::vector<std::string> notes = {};         ///< oddities of the mesh
};
/// Converts one object without a scene. Progress and Errors as for World::compile.
Result<ObjectReport> convert_object(const ObjectOptions& object, const FileAccess& access = {},
                                    const ProgressCallback& progress = {});

/// Result of checking a model against stock MuJoCo and of its export to MJCF and back.
struct ModelCheck {
  Status status;  ///< status of loading and exporting it
  int bodies = 0, joints = 0, geoms = 0;
  int compared = 0;  ///< number of mjModel fields in each comparison: sizes, options, arrays
  /// Reason why stock MuJoCo does not load the file, "" if it does. Empty for scenes and models in
  /// TOML.
  std::optional<std::string> stock_refusal;
  std::vector<std::string> unlike_stock;   ///< fields that differ in stock MuJoCo
  std::vector<std::string> unlike_export;  ///< fields that stock MuJoCo reads back differently
  std::string export_reason;               ///< reason why the export is not exact, "" if it is
  uint64_t export_bytes = 0;               ///< size of all files written

  bool passed() const { return status.ok() && unlike_stock.empty() && unlike_export.empty(); }
};
/// Loads a scene or model, exports it into `folder`, loads the model file and the export with stock
/// MuJoCo, and compares all bits. Stock MuJoCo loads a file that Gloam rejects in a separate
/// process, for at most `longest_stock_load` seconds; this process reads every file that the model
/// names.
ModelCheck check_model(const std::filesystem::path& file, const FileAccess& access,
                       const std::filesystem::path& folder, unsigned longest_stock_load = 60);

}  // namespace gloam

#pragma once
// Content of a file with a 3-D model, in any format, and its reader.
// Frames: F is the file's content in Gloam's axes (right-handed, Z up, metres). glTF is Y up by its
// standard: its x, y, z become x, z, -y of F's x, z, y: p_F = (x, -z, y). COLLADA gives its axes
// and its unit, which both are undone here. OBJ, STL and PLY have no axes of their own and are
// taken as they are.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "geometry/mesh/imported_material.h"
#include "geometry/mesh/mesh.h"
#include "geometry/mesh/model_limits.h"
#include "gloam/result.h"

namespace gloam {

/// A picture as it was found: PNG, JPEG, KTX, HDR or EXR by its first bytes
/// (geometry/image/image_file.h decodes it). What a texture reads is linear or sRGB as its
/// TextureRef says.
struct ImportedImage {
  std::string name;            ///< path beside the model, or the name inside it
  std::vector<uint8_t> bytes;  ///< encoded
};

struct ImportedInstance {
  std::string name;
  int mesh = 0;
  int material = -1;  ///< -1 = none was given
  /// The mesh's frame I in F. May scale, shear and mirror; what is outside stays outside.
  Affine3f X_FI;
};

enum class ImportedLightType : uint8_t { kPoint, kSpot, kDirectional };

/// As in KHR_lights_punctual.
struct ImportedLight {
  std::string name;
  ImportedLightType type = ImportedLightType::kPoint;
  Vec3f color = {1, 1, 1};                     ///< linear Rec. 709
  float intensity = 1;                         ///< [cd]; directional: [lx]
  float range = 0;                             ///< [m] beyond which it gives nothing; 0 = no end
  float inner_cone = 0, outer_cone = kPi / 4;  ///< half angles of a spot [rad]
  Affine3f X_FL;                               ///< light's frame; it shines along its -z
};

struct ModelFile {
  std::vector<TriangleMesh> meshes;  ///< normals empty: the file has none
  std::vector<ImportedMaterial> materials;
  std::vector<ImportedImage> images;
  std::vector<ImportedInstance> instances;
  std::vector<ImportedLight> lights;
  uint64_t dropped_triangles = 0;  ///< triangles without area
  bool was_y_up = false;           ///< glTF, most COLLADA: turned into Gloam's axes
  /// Parts of the file that Gloam leaves out (skins, missing pictures …), one sentence each.
  std::vector<std::string> notes;
  /// Other files that it was made of, or that it names and that are not there; relative to its
  /// folder. Known where it was read by way of the cache.
  std::vector<std::string> parts;
};

struct ModelFileOptions {
  /// No file outside this folder is read; empty = the model file's own folder.
  std::filesystem::path root = {};
  ModelLimits limits = {};
  /// Called now and then with the fraction that is done, 0..1, never less than before; from any
  /// thread, one at a time.
  std::function<void(double share)> progress = {};
};

/// Reads glTF 2.0, GLB, COLLADA, OBJ (with MTL), STL and PLY, told apart by their content, then by
/// the name. Errors: no such file, damaged, not finite, an index out of range, over a limit, what
/// the file requires and Gloam lacks.
Result<ModelFile> read_model_file(const std::filesystem::path& path,
                                  const ModelFileOptions& options = {});

/// True if the name has an ending of a model file: .gltf .glb .dae .obj .stl .ply, in any case.
bool is_model_file(const std::filesystem::path& path);

}  // namespace gloam

#pragma once
// Objects in a scene other than robots: props of the catalogue ([[prop]]), and bodies, visuals and
// height fields made from mesh files ([[object]], [[visual]], [[hfield]]). Part of gloam/scene.h.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[prop]]: one object of the catalogue (listed by `gloam props`), in any scene.
struct PropOptions {
  std::string name = {};                 ///< unique; of its body
  std::string kind = {};                 ///< kind in the catalogue: gloam props
  uint64_t seed = 0;                     ///< seed of the variant
  Vec3 position = {};                    ///< point on the floor below its middle, in the world [m]
  std::optional<Quat> orientation = {};  ///< rotation in the world; its front is +x
  std::optional<Vec3> size = {};   ///< depth, width, height, within the limits of the kind [m]
  std::optional<Vec3> color = {};  ///< colour of its coloured parts, linear Rec. 709, 0 … 1
  std::optional<bool> loose = {};  ///< can be pushed and falls; empty = the default of its kind
  SourceLoc loc = {};
};

/// [[object]]: a body with colliders made from a glTF, GLB, OBJ, STL or PLY file, or from one of
/// its nodes.
struct ObjectOptions {
  std::string name = {};            ///< unique; of its body
  std::filesystem::path file = {};  ///< relative to the scene file
  /// Name of a node of the file (the second node of the same name is NAME_2); empty = all.
  std::string node = {};
  Pose X_WO = {};           ///< pose of the file's origin in the world
  Vec3 scale = {1, 1, 1};   ///< after `up`; not 0, < 0 mirrors; one number for all three
  std::string up = "auto";  ///< y | z: axis of the file that points up; auto = y of glTF, else z
  double unit = 1;          ///< [m] of one unit of the file
  std::string motion = "dynamic";   ///< static | dynamic | mocap
  double density = 1000;            ///< density of its volume, unless `mass` is given [kg/m³]
  std::optional<double> mass = {};  ///< [kg]
  /// box sphere capsule: the smallest enclosing one; hull: convex hull; hulls: convex parts
  /// (CoACD); none; auto: box, sphere or capsule if the mesh is one, a hull if it is convex,
  /// otherwise hulls.
  std::string colliders = "auto";
  double concavity = 0.05;            ///< hulls: maximum concavity of a part, 0.01 … 1
  int max_hulls = 32;                 ///< hulls: maximum number, 1 … 256
  std::optional<Vec3> friction = {};  ///< sliding, torsional [m], rolling [m]
  SourceLoc loc = {};
};

/// [[hfield]]: ground sampled from a mesh file, as a MuJoCo height field.
struct HeightFieldOptions {
  std::string name = {};            ///< unique; of its geom
  std::filesystem::path file = {};  ///< glTF, GLB, OBJ, STL or PLY, relative to the scene file
  Pose X_WF = {};                   ///< pose of the file's origin in the world
  Vec3 scale = {1, 1, 1};           ///< after `up`; not 0, < 0 mirrors; one number for all three
  std::string up = "auto";  ///< y | z: axis of the file that points up; auto = y of glTF, else z
  double unit = 1;          ///< [m] of one unit of the file
  /// Corners x, y of the sampled area, in the world [m]; empty = all of it.
  std::optional<std::array<double, 2>> low = {}, high = {};
  double resolution = 0.1;  ///< distance between samples [m]
  int layers =
      1;  ///< number of layers, 1: the surface seen from above; more: also floors below it, 1 … 8
  std::optional<Vec3> friction = {};  ///< sliding, torsional [m], rolling [m]
  bool drawn = true;                  ///< true: render the file; false: render the height field
  SourceLoc loc = {};
};

/// [[visual]]: a glTF, GLB, OBJ, STL or PLY file that is rendered and has no physics.
struct VisualOptions {
  std::string name = {};            ///< unique; its materials are "NAME/MATERIAL"
  std::filesystem::path file = {};  ///< relative to the scene file
  std::string node = {};            ///< name of a node of the file; empty = all of it
  std::string body = {};            ///< full name of the body it is fixed to; empty = world
  Pose X_BV = {};                   ///< pose in that body
  /// Factors along the visual's axes, after `up`; not 0, < 0 mirrors; one number for all three.
  Vec3 scale = {1, 1, 1};
  std::string up = "auto";   ///< y | z: axis of the file that points up; auto = y of glTF, else z
  double unit = 1;           ///< [m] of one unit of the file
  bool casts_shadow = true;  ///< false: light passes through it
  SourceLoc loc = {};
};

/// One kind of the catalogue, with the properties of its variant 0.
struct PropInfo {
  std::string kind = {};
  std::string text = {};  ///< description
  Vec3 size = {};         ///< size of its bounding box: depth, width, height [m]
  double mass = 0;        ///< [kg]
  bool loose = false;     ///< usually not fixed
};
/// The catalogue of [[prop]]s.
std::vector<PropInfo> prop_kinds();

}  // namespace gloam

#pragma once
// Appearance of a World, without MuJoCo types: render/ knows nothing else of a model. Moving parts
// refer to bodies by index; instant/pose_frame.h has their poses at an instant. Radiometry:
// docs/light.md. Texture coordinates: world/materials/texture_coordinates.h.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/vec.h"
#include "geometry/mesh/mesh.h"
#include "gloam/camera.h"
#include "gloam/result.h"
#include "gloam/scene/sensor.h"
#include "world/lights/ies_profile.h"
#include "world/lights/lamp_motion.h"
#include "world/lights/light_description.h"
#include "world/lights/light_schedule.h"
#include "world/materials/material_description.h"
#include "world/materials/procedural_description.h"
#include "world/media/medium_description.h"
#include "world/shapes/shape_type.h"
#include "world/weather/weather_description.h"

namespace gloam {

struct CompiledWorld;

/// One drawn thing. Its row index + 1 is its `part` in pictures.
struct InstanceDescription {
  ShapeType shape = ShapeType::kBox;
  int mesh = -1;    ///< kMesh: index into meshes; kDeformable: index into deformables
  Vec3f size;       ///< analytic shapes [m]; meshes: half extents that scale texture coordinates
  int body = 0;     ///< body it moves with, 0 = world
  int bone = 0;     ///< body of a skin's first bone, with which the skin sheds its snow
  Affine3f X_BG;    ///< rigid pose of the shape in the body
  int motion = -1;  ///< row of RenderDescription::motions, of X_BG
  int material = 0;
  bool is_static = false;  ///< never moves: its body is welded to the world
  bool casts_shadow = true;
  bool color_only = false;  ///< colour pictures alone show it: not exact channels, not LiDARs
  int group = 0;            ///< MuJoCo's
  bool shown = true;        ///< false: a collision shape that something else is drawn for
  int geom = -1;            ///< row of PoseFrame::geom_rgba, -1 = its colour never changes
  LabelRow label;
};

/// A mesh whose vertices move every instant; topology and uvs are fixed. Thin: seen from both
/// sides. Vertex i is PoseFrame::vertices[first_vertex + i], already in the world.
struct DeformableDescription {
  TriangleMesh rest;     ///< at qpos0, world; normals are recomputed from positions each update
  int first_vertex = 0;  ///< into PoseFrame::vertices
};

/// The grid behind a mesh that is a height field, to rebuild it when PoseFrame::height_field
/// changes (height_field_mesh() in world/shapes/visual_mesh.h).
struct HeightFieldDescription {
  int mesh = 0;        ///< index into meshes
  int first_data = 0;  ///< into PoseFrame::height_field
  int rows = 0, columns = 0;
  Vec3f size;      ///< half extent x, half extent y, elevation of data = 1 [m]
  float base = 0;  ///< depth of the base below z = 0 [m]
};

struct CameraDescription {
  std::string name;
  Intrinsics intrinsics;
  int camera = -1;  ///< row of PoseFrame's camera poses; -1 = free camera at X_WC
  Affine3f X_WC;
  CameraSensing sensing;  ///< sensing of the scene's [[camera]] of this name
  float aperture_radius = 0, focus_distance = 1;       ///< [m]; radius 0 = everything is sharp
  double exposure_time = 0, readout_time = 0;          ///< as in CameraOptions [s]
  float near = 0;                                      ///< nothing nearer is seen [m]
  bool culls_backs = false;                            ///< nor surfaces from behind
  std::shared_ptr<const std::vector<uint8_t>> hidden;  ///< flags by instance: not seen; null = none
};

/// How procedural materials are drawn: baked into textures on the surfaces that wear them when the
/// scene is loaded, or by their formulas at each hit, which is the reference (the CPU alone does).
struct PatternBaking {
  bool by_formula = false;
  float metres_per_texel = 0.002f;     ///< of the finest texels
  uint64_t most_bytes = 128ull << 20;  ///< of all textures: texels get coarser to fit
};

struct RenderDescription {
  std::vector<TriangleMesh> meshes;
  std::vector<DeformableDescription> deformables;
  std::vector<TextureDescription> textures;
  std::vector<MaterialDescription> materials;
  std::vector<ProceduralDescription> procedurals;
  PatternBaking pattern_baking;
  std::vector<InstanceDescription> instances;
  std::vector<HeightFieldDescription> height_fields;
  std::vector<LightDescription> lights;
  std::vector<IesProfile> ies_profiles;
  std::vector<LightSchedule> schedules;
  std::vector<LampMotion> motions;
  uint64_t schedule_seed = 1;
  std::vector<MediumDescription> media;
  std::vector<VolumeDescription> volumes;
  WeatherDescription weather;
  /// All of the model's, then one free camera that frames the model, "free".
  std::vector<CameraDescription> cameras;
  SkyDescription sky;
  float ev100 = 0;   ///< exposure by the scene's rule, used when the user gives none
  Vec3 origin;       ///< in the world [m]: all places here and in PoseFrames are counted from it
  Vec3f center;      ///< centre of the model's bounding sphere at qpos0 [m]
  float extent = 1;  ///< MuJoCo's stat.extent, about its diameter [m]
  std::vector<Error> unsupported;
};

/// Reads everything visible out of the compiled model.
Result<RenderDescription> describe_for_rendering(const CompiledWorld& world);

}  // namespace gloam

#pragma once
// What a World looks like, without MuJoCo types: the only thing render/ knows of a model. Moving
// parts refer to bodies by index; where those are at an instant is in instant/pose_frame.h.
// Radiometry: docs/light.md. Where textures land on shapes: world/materials/texture_coordinates.h.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "geometry/image/image.h"
#include "geometry/mesh/mesh.h"
#include "gloam/camera.h"
#include "gloam/result.h"
#include "gloam/scene_sensor.h"
#include "world/lights/ies_profile.h"
#include "world/lights/lamp_motion.h"
#include "world/lights/light_schedule.h"
#include "world/materials/procedural_description.h"
#include "world/media/medium_description.h"
#include "world/shapes/shape_type.h"
#include "world/sky/day_cycle.h"
#include "world/weather/weather_description.h"

namespace gloam {

struct CompiledWorld;

/// Index into RenderDescription::textures, or -1.
struct MaterialTextures {
  int base_color = -1;  ///< sRGB; 4 channels carry opacity
  int roughness = -1, metallic = -1, occlusion = -1,
      orm = -1;     ///< linear; orm = occlusion, roughness, metallic in r, g, b
  int normal = -1;  ///< tangent space, linear
  int opacity = -1, emission = -1;
  int bump = -1;  ///< linear; heights of MaterialDescription::bump_scale
  int coat_weight = -1, coat_roughness = -1, transmission = -1;  ///< linear

  std::array<int, 12> all() const {
    return {base_color, roughness, metallic,    occlusion,      orm,         normal, opacity,
            emission,   bump,      coat_weight, coat_roughness, transmission};
  }
};

/// Names after OpenPBR 1.1.
struct MaterialDescription {
  std::string name;
  Vec3f base_color{0.5f, 0.5f, 0.5f};  ///< linear, multiplies the texture
  float opacity = 1;
  float metallic = 0;
  float roughness = 0.5f;         ///< of the specular layer, 0..1 (alpha = roughness²)
  float specular_weight = 1;      ///< 0..1, scales the dielectric layer
  float ior = 1.5f;               ///< of the dielectric layer
  Vec3f emission{0, 0, 0};        ///< luminance per channel [cd/m²]
  bool emits_outwards = false;    ///< the back of a mesh's triangles is dark
  int schedule = -1;              ///< row of RenderDescription::schedules, of the emission
  float anisotropy = 0;           ///< 0..1, draws highlights out along the tangent
  float anisotropy_rotation = 0;  ///< from the tangent, counter-clockwise, in turns
  float transmission_weight = 0;  ///< 0..1: glass
  /// Of light that has gone `transmission_depth` deep, or, where that is 0, through the surface
  /// once.
  Vec3f transmission_color{1, 1, 1};
  float transmission_depth = 0;  ///< [m]
  /// Absorption inside for LiDARs of 905 and 1550 nm [1/m]; -1 = as of red light.
  std::array<float, 2> infrared_absorption{-1, -1};
  bool thin_walled = false;     ///< a sheet: nothing is inside, nothing is bent
  float subsurface_weight = 0;  ///< 0..1
  Vec3f subsurface_color{0.8f, 0.8f, 0.8f};
  float coat_weight = 0, coat_roughness = 0, coat_ior = 1.6f;
  float coat_darkening = 1;   ///< 0..1, of the base by light that the coat throws back down
  Vec3f coat_color{1, 1, 1};  ///< of light that has gone in and out through the coat
  float fuzz_weight = 0, fuzz_roughness = 0.5f;
  Vec3f fuzz_color{1, 1, 1};
  int pattern = -1, wear = -1;  ///< rows of RenderDescription::procedurals, in the geom's frame
  float wetness = 0, porosity = 0.8f, dust = 0, snow = 0;  ///< 0..1
  TextureMapping mapping = TextureMapping::kNone;
  bool texture_uniform = false;  ///< MuJoCo's texuniform: repeats per metre, not per object
  Vec2f texture_repeat{1, 1};
  MaterialTextures textures;
  float bump_scale = 0;        ///< [m] that a bump of 1 stands above one of 0
  bool glows_in_color = true;  ///< base_color's texture multiplies the emission (MuJoCo's rule)
  bool imported = false;       ///< came with a [[visual]], not with the model
  // What set_look() (world/materials/visual_rules.h) makes the values above from when they change
  // live.
  int model_material = -1;      ///< row of PoseFrame::material_rgba and its kin, -1 = none
  std::array<float, 4> rgba{};  ///< display colour and opacity as in the model
  bool own_color = false;       ///< that is the geom's: material_rgba does not apply
  float own_ior = 0;            ///< given by the scene instead of the rules'; 0 = not given
  bool can_mirror = false;      ///< reflectance counts: of planes and boxes
};

struct TextureDescription {
  std::string name;
  /// 1 (2-D), or 6 in the order right, left, up, down, front, back (MuJoCo's cube). Of one texture
  /// used both as colour and as data there are two rows: they differ in colour space.
  std::vector<Image8> faces;
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;  ///< 2-D alone
};

/// One drawn thing. Its row index + 1 is its `part` in pictures.
struct InstanceDescription {
  ShapeType shape = ShapeType::kBox;
  int mesh = -1;    ///< kMesh: index into meshes; kDeformable: index into deformables
  Vec3f size;       ///< analytic shapes [m]; meshes: half extents that scale texture coordinates
  int body = 0;     ///< body it moves with, 0 = world
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

enum class LightType : uint8_t { kPoint, kSpot, kDirectional };
struct LightDescription {
  std::string name;
  LightType type = LightType::kPoint;
  bool active = true;
  bool casts_shadow = true;
  Vec3f intensity{
      0, 0,
      0};  ///< point, spot: [cd] per channel; directional: illuminance on a facing surface [lx]
  float radius =
      0;  ///< of the luminous sphere (point, spot) [m]; directional: sine of the half angle
  float cos_cutoff = -1;   ///< spot: cosine of the half angle of the cone
  float softness = 0;      ///< spot: share of the cone over which it fades
  float legacy_scale = 0;  ///< what PoseFrame::light_diffuse is multiplied by to give `intensity`
                           ///< while the light has no intensity in cd (docs/light.md)
  Vec3f ambient{0, 0, 0};  ///< MuJoCo's; a part of SkyDescription::ambient while it is active, the
                           ///< headlight's always
  bool is_static = false;  ///< never moves: fixed to a body that is welded to the world
  int profile = -1;        ///< row of ies_profiles: `intensity` is where the profile is at its most
  int schedule = -1;       ///< row of schedules, a factor on `intensity`
  // Where it is: row of PoseFrame's light poses; or fixed to a body, shining along its own -Z; or,
  // with neither, the headlight: at the camera, along its axis.
  int light = -1;
  int body = -1;
  Affine3f X_BL;
  int motion = -1;      ///< row of motions, of X_BL
  bool of_sky = false;  ///< the sun of the scene's sky; of SkyDescription::day it is as at time 0
};

/// Light from far away, laid out as SkyLight::texels (world/sky/atmosphere.h).
struct EnvironmentDescription {
  std::string name;
  int width = 0, height = 0;  ///< [texels]; 0 = none
  std::vector<Vec3f> texels;  ///< (height x width), linear Rec. 709, finite, >= 0
  float scale = 1;            ///< [cd/m²] of a texel of one
  float turn = 0;             ///< about the world's Z, counter-clockwise from above [rad]
};

/// What rays that leave the scene see.
struct SkyDescription {
  int texture = -1;        ///< cube texture (MuJoCo's skybox), luminance = sRGB value * scale
  float scale = 0;         ///< [cd/m²] of a white texel
  Vec3f ambient{0, 0, 0};  ///< constant luminance per channel [cd/m²], added for indirect rays only
                           ///< (MuJoCo's ambient lights)
  int schedule = -1;       ///< row of RenderDescription::schedules, of `ambient`
  EnvironmentDescription environment;  ///< instead of the texture; of `day` at time 0
  std::optional<DayCycle> day;
};

struct CameraDescription {
  std::string name;
  Intrinsics intrinsics;
  int camera = -1;  ///< row of PoseFrame's camera poses; -1 = free camera at X_WC
  Affine3f X_WC;
  CameraSensing sensing;                               ///< of the scene's [[camera]] of this name
  float aperture_radius = 0, focus_distance = 1;       ///< [m]; radius 0 = everything is sharp
  double exposure_time = 0, readout_time = 0;          ///< as in CameraOptions [s]
  float near = 0;                                      ///< nothing nearer is seen [m]
  bool culls_backs = false;                            ///< nor surfaces from behind
  std::shared_ptr<const std::vector<uint8_t>> hidden;  ///< by instance: not seen; null = none
};

struct RenderDescription {
  std::vector<TriangleMesh> meshes;
  std::vector<DeformableDescription> deformables;
  std::vector<TextureDescription> textures;
  std::vector<MaterialDescription> materials;
  std::vector<ProceduralDescription> procedurals;
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
  std::vector<CameraDescription>
      cameras;  ///< all of the model's, then one free camera that frames the model, "free"
  SkyDescription sky;
  float ev100 = 0;   ///< exposure by the scene's rule, used when the user gives none
  Vec3 origin;       ///< in the world [m]: all places here and in PoseFrames are counted from it
  Vec3f center;      ///< of the model's bounding sphere at qpos0 [m]
  float extent = 1;  ///< MuJoCo's stat.extent, about its diameter [m]
  std::vector<Error> unsupported;
};

/// Reads everything visible out of the compiled model.
Result<RenderDescription> describe_for_rendering(const CompiledWorld& world);

}  // namespace gloam

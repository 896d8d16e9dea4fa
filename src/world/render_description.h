#pragma once
// What a World looks like, without MuJoCo types: the only thing render/ knows of a model. Moving
// parts refer to bodies by index; where those are at an instant is in sim/pose_frame.h. Radiometry:
// docs/light.md.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "geometry/image.h"
#include "geometry/mesh.h"
#include "gloam/camera.h"
#include "gloam/result.h"

namespace gloam {

struct CompiledWorld;

/// Closed list of shapes. Analytic ones are exact and use `size` as MuJoCo does (half extents,
/// radii [m]).
enum class ShapeType : uint8_t {
  kMesh,        ///< triangles; also height fields, SDFs (by their mesh)
  kPlane,       ///< z = 0; half extents size.x, size.y; 0 = infinite
  kBox,         ///< half extents
  kSphere,      ///< radius size.x
  kEllipsoid,   ///< semi-axes
  kCapsule,     ///< radius size.x, half length of the cylinder size.y, along z
  kCylinder,    ///< radius size.x, half length size.y, along z
  kDeformable,  ///< triangles whose vertices come with every PoseFrame (skins, flexes)
};

enum class TextureMapping : uint8_t {
  kNone,
  kUv,    ///< mesh uv, or MuJoCo's generated coordinates of primitives (2d textures)
  kCube,  ///< cube texture by object-space direction
};

/// Index into RenderDescription::textures, or -1.
struct MaterialTextures {
  int base_color = -1;  ///< sRGB; 4 channels carry opacity
  int roughness = -1, metallic = -1, occlusion = -1,
      orm = -1;     ///< linear; orm = occlusion, roughness, metallic in r, g, b
  int normal = -1;  ///< tangent space, linear
  int opacity = -1, emission = -1;
};

/// Names after OpenPBR 1.1.
struct MaterialDescription {
  std::string name;
  Vec3f base_color{0.5f, 0.5f, 0.5f};  ///< linear, multiplies the texture
  float opacity = 1;
  float metallic = 0;
  float roughness = 0.5f;     ///< of the specular layer, 0..1 (alpha = roughness²)
  float specular_weight = 1;  ///< 0..1, scales the dielectric layer
  float ior = 1.5f;           ///< of the dielectric layer
  Vec3f emission{0, 0, 0};    ///< luminance per channel [cd/m²]
  TextureMapping mapping = TextureMapping::kNone;
  bool texture_uniform = false;  ///< MuJoCo's texuniform: repeats per metre, not per object
  Vec2f texture_repeat{1, 1};
  MaterialTextures textures;
};

struct TextureDescription {
  std::string name;
  std::vector<Image8>
      faces;  ///< 1 (2-D), or 6 in the order right, left, up, down, front, back (MuJoCo's cube)
};

/// One drawn thing. Its row index + 1 is its `part` in pictures.
struct InstanceDescription {
  ShapeType shape = ShapeType::kBox;
  int mesh = -1;  ///< kMesh: index into meshes; kDeformable: index into deformables
  Vec3f size;     ///< analytic shapes [m]
  int body = 0;   ///< body it moves with, 0 = world
  Affine3f X_BG;  ///< rigid pose of the shape in the body
  int material = 0;
  bool is_static = false;  ///< never moves: its body is welded to the world
  int group = 0;           ///< MuJoCo's geom group; groups 3..5 are not drawn by default
  LabelRow label;
};

/// A mesh whose vertices move every instant; topology and uvs are fixed.
struct DeformableDescription {
  TriangleMesh rest;     ///< at qpos0; normals are recomputed from positions each update
  int first_vertex = 0;  ///< into PoseFrame::vertices
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
  float cos_cutoff = -1;  ///< spot: cosine of the half angle of the cone
  float softness = 0;     ///< spot: share of the cone over which it fades
  int light = -1;  ///< row of PoseFrame's light poses; -1 = headlight: sits at the camera, shines
                   ///< along its axis
};

/// What rays that leave the scene see.
struct SkyDescription {
  int texture = -1;        ///< cube texture (MuJoCo's skybox), luminance = sRGB value * scale
  float scale = 0;         ///< [cd/m²] of a white texel
  Vec3f ambient{0, 0, 0};  ///< constant luminance per channel [cd/m²], added for indirect rays only
                           ///< (MuJoCo's ambient lights)
};

struct CameraDescription {
  std::string name;
  Intrinsics intrinsics;
  int camera = -1;  ///< row of PoseFrame's camera poses; -1 = free camera at X_WC
  Affine3f X_WC;
};

struct RenderDescription {
  std::vector<TriangleMesh> meshes;
  std::vector<DeformableDescription> deformables;
  std::vector<TextureDescription> textures;
  std::vector<MaterialDescription> materials;
  std::vector<InstanceDescription> instances;
  std::vector<LightDescription> lights;
  std::vector<CameraDescription>
      cameras;  ///< all of the model's, then one free camera that frames the model, "free"
  SkyDescription sky;
  float ev100 = 0;   ///< exposure by the scene's rule, used when the user gives none
  Vec3f center;      ///< of the model's bounding sphere at qpos0 [m]
  float extent = 1;  ///< its radius [m]
  std::vector<Error> unsupported;
};

/// Reads everything visible out of the compiled model.
Result<RenderDescription> describe_for_rendering(const CompiledWorld& world);

}  // namespace gloam

#pragma once
// Scene as the kernel reads it: plain arrays in the memory of the side that runs it. render/scene
// fills them. Device-safe.

#include "geometry/motion_keys.h"
#include "render/kernel/light/environment_map.h"
#include "render/kernel/light/light_tree_view.h"
#include "render/kernel/math/ray.h"
#include "render/kernel/media/medium_view.h"
#include "render/kernel/surface/baked_view.h"
#include "world/materials/procedural_description.h"
#include "world/render_description.h"
#include "world/weather/shelter_map.h"

namespace gloam {

/// Texture coordinates of one triangle and how many texture lengths one metre on it spans.
struct TriangleUv {
  Vec2f corner[3];
  float density = 0;  ///< sqrt(area in uv / area [m²])
};

struct MeshView {
  DeviceSpan<const Vec3f> positions;           ///< frame G [m]; deformables: world, shutter open
  DeviceSpan<const Vec3f> positions_previous;  ///< deformables only
  /// Positions of deformables that move while the shutter is open, at key_count times, one key
  /// after the other.
  DeviceSpan<const Vec3f> position_keys;
  uint32_t key_count = 0;
  DeviceSpan<const uint32_t> indices;
  DeviceSpan<const Vec3f> corner_normals;  ///< three per triangle; empty = flat
  DeviceSpan<const TriangleUv> uvs;        ///< one per triangle; empty = none
  DeviceSpan<const float> area_cdf;  ///< running sums, 0 to 1, of triangle areas; emitters only
  float area = 0;                    ///< [m²]; emitters only
};

struct InstanceView {
  ShapeType shape = ShapeType::kBox;
  bool moving = false;      ///< while the shutter is open: `keys` holds poses that differ
  bool has_moved = false;   ///< X_WG_previous differs from X_WG
  bool color_only = false;  ///< as in InstanceDescription
  float snow_left = 1;      ///< as in PoseFrame, of its body
  uint32_t material = 0;
  uint32_t mesh = 0;
  int baked_pattern = -1, baked_wear = -1;  ///< rows of BakedView::patterns
  int light = -1;                           ///< row of lights when it emits and can be sampled
  Vec3f size;                               ///< [m]
  Vec3f half_size;                          ///< of the object that textures are fitted to [m]
  Affine3f X_WG;                            ///< at shutter open
  Affine3f X_WG_previous;
  DeviceSpan<const Affine3f>
      keys;  ///< evenly over times 0 … 1, the first is X_WG; empty unless moving
};

struct TextureLevel {
  uint32_t first = 0;  ///< texel index
  int width = 0, height = 0;
};
/// Linear RGBA, 16 bits a channel (0..65535 = 0..1), mip levels from fine to coarse.
struct TextureView {
  uint32_t first_level = 0;
  int level_count = 0;  ///< of each face
  int face_count = 1;   ///< 1 or 6
  float log2_size = 0;  ///< log2 of sqrt(width height) of the finest level
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
};
struct Texel {
  uint16_t r = 0, g = 0, b = 0, a = 0;
};

/// Layers over the base of a material, and glass; names after OpenPBR 1.1.
struct MaterialLayers {
  float coat_weight = 0, coat_roughness = 0;
  float coat_f0 = 0.04f;  ///< at normal incidence
  float coat_darkening = 1;
  Vec3f coat_color{1, 1, 1};
  float fuzz_weight = 0, fuzz_roughness = 0.5f;
  Vec3f fuzz_color{1, 1, 1};
  float transmission = 0;
  float ior = 1.5f;       ///< of glass
  Vec3f tint{1, 1, 1};    ///< of light at each passage through the surface of glass
  Vec3f absorption;       ///< inside glass [1/m]
  bool thin = false;      ///< a sheet without an inside
  bool straight = false;  ///< a smooth sheet: what goes through goes on as if it were not there
  float subsurface = 0;
  Vec3f subsurface_color{1, 1, 1};
  float anisotropy = 0;
  float cos_rotation = 1, sin_rotation = 0;  ///< of the highlights' long axis from the tangent
  int pattern = -1, wear = -1;               ///< rows of SceneView::procedurals
  float wetness = 0, porosity = 0.8f, dust = 0, snow = 0;  ///< as in surface/weathering.h
};

struct MaterialView {
  Vec3f base_color;
  Vec3f emission;
  bool emits_outwards = false;  ///< as in MaterialDescription
  float opacity = 1, metallic = 0, roughness = 0.5f;
  float f0 = 0.04f;  ///< of the dielectric layer at normal incidence, specular weight included
  float f90 = 1;     ///< of the dielectric layer at grazing incidence
  TextureMapping mapping = TextureMapping::kNone;
  bool texture_uniform = false;
  bool textured = false;       ///< any texture at all
  bool transparent = false;    ///< opacity below one somewhere, or a straight sheet
  bool glows_in_color = true;  ///< base_color's texture multiplies the emission
  int layers = -1;             ///< row of SceneView::layers
  int levels = -1;             ///< row of SceneView::light_levels
  Vec2f texture_repeat{1, 1};
  MaterialTextures textures;
  float bump_scale = 0;  ///< [m] that a bump of 1 stands above one of 0
};

enum class LightKind : uint8_t { kPoint, kSpot, kDirectional, kInstance };

struct LightView {
  LightKind kind = LightKind::kPoint;
  bool casts_shadow = true;
  bool is_delta = false;  ///< no extent: cannot be hit
  bool is_ball = false;   ///< kInstance: an even sphere at rest
  bool is_sheet = false;  ///< kInstance: an even parallelogram at rest
  Vec3f p;                ///< of the centre [m]
  Vec3f direction;        ///< along which it shines, unit
  Vec3f x;                ///< across it, unit; of lamps with a profile
  int profile = -1;       ///< row of SceneView::profiles
  Vec3f intensity;        ///< [cd]; directional: [lx]; balls and sheets: [cd/m²]
  Vec3f edges[2];         ///< of a sheet about p, which shines along their cross product [m]
  float radius = 0;       ///< [m]; directional: sine of the half angle
  float cutoff = 0, cos_cutoff = -1, cos_inner = -1;  ///< spot: half angle [rad] and cosines
  float inner = 0;                                    ///< spot: half angle of full intensity [rad]
  float strength = 0;  ///< luminous intensity [cd] (directional: illuminance [lx]), for selection
  float reach = 0;     ///< radius of a sphere about p that holds all of it [m]
  uint32_t instance = 0;  ///< kInstance
  int guide = -1;         ///< row of LightGuide::gain; -1 = it moves, or has none
  int first_key = -1;     ///< row of SceneView::light_keys of lamps and suns that move while the
                          ///< shutter is open: then p, reach and half bound the way, and spread all
  int levels = -1;        ///< row of SceneView::light_levels; -1 = it is even
  // Bounds for the tree; not of directional lights.
  Vec3f half;          ///< half the size of a box about p that holds all of it [m]
  float spread = kPi;  ///< angle from `direction` up to which it shines in full [rad]
  float falloff = 0;   ///< angle beyond that over which it fades to nothing [rad]

  friend bool operator==(const LightView&, const LightView&) = default;
};

/// State of a lamp or sun at one instant; as in LightView.
struct LightKey {
  Vec3f p, direction, x;
};

/// IesProfile's grid relative to its most.
struct ProfileView {
  uint32_t first = 0;  ///< row of SceneView::profile_values
  int rows = 0, columns = 0;
};

/// Light that static geometry lets through to the cells of a regular grid, and from where. It
/// steers sampling alone: a wrong guess costs noise, never the mean. A wall's two sides see
/// different lights, so a cell has a row for static surfaces of each facing that it holds, and one
/// for all else in it.
struct LightGuide {
  Vec3f low;            ///< corner of the grid [m]
  float per_metre = 0;  ///< 1 / edge of a cell
  static constexpr int kFacings = 6;
  int nx = 0, ny = 0, nz = 0;
  uint32_t lights = 0;  ///< that have a weight
  static constexpr uint32_t kNone = ~0u;
  DeviceSpan<const uint32_t> surface_row;  ///< cell-major, one per facing; kNone = no such surface
  /// Row-major: root mean square of what each light brings, over that of light_weight; above zero.
  DeviceSpan<const float> gain;
  DeviceSpan<const float> sky_visible;  ///< by row: fraction of the environment map's light
  /// Cells along an edge of the octahedral map of directions (light/light_directions.h).
  static constexpr uint32_t kAcross = 16;
  static constexpr uint32_t kSums = kAcross * kAcross + 1;
  /// Row-major: running sums, 0 to 1, over the map's cells, of the light that arrives from each.
  DeviceSpan<const float> arriving;
  float probability =
      0;  ///< of sampling directions by it on diffuse surfaces; the rest is the BSDF's

  /// kNone outside the grid.
  template <class F>
  GLOAM_HD UintOf<F> cell_at(Vec3Of<F> p) const {
    const Vec3Of<F> q = (p - in_all_lanes<F>(low)) * F(per_metre);
    const MaskOf<F> inside = (q.x >= 0.0f) & (q.y >= 0.0f) & (q.z >= 0.0f) &
                             (q.x < static_cast<float>(nx)) & (q.y < static_cast<float>(ny)) &
                             (q.z < static_cast<float>(nz));
    const auto along = [&](F x) { return to_uint(select(inside, x, F(0.0f))); };
    const UintOf<F> cell = (along(q.z) * UintOf<F>(static_cast<uint32_t>(ny)) + along(q.y)) *
                               UintOf<F>(static_cast<uint32_t>(nx)) +
                           along(q.x);
    return select(inside, cell, UintOf<F>(kNone));
  }
  /// Axis that a normal is nearest to: 2 k along the k-th, 2 k + 1 against it.
  template <class F>
  GLOAM_HD static UintOf<F> facing_of(Vec3Of<F> n) {
    const Vec3Of<F> a{magnitude(n.x), magnitude(n.y), magnitude(n.z)};
    const MaskOf<F> z = (a.z >= a.x) & (a.z >= a.y), y = a.y >= a.x;
    const F along = select(z, n.z, select(y, n.y, n.x));
    const UintOf<F> axis = select(z, UintOf<F>(4u), select(y, UintOf<F>(2u), UintOf<F>(0u)));
    return axis + select(along >= 0.0f, UintOf<F>(0u), UintOf<F>(1u));
  }
  /// The rows for surfaces at p with the normals n, or points in a medium (n = 0); kNone outside
  /// the grid.
  template <class F>
  GLOAM_HD UintOf<F> row_at(Vec3Of<F> p, Vec3Of<F> n) const {
    if (nx == 0) return kNone;
    const float edge = 1.0f / per_metre;
    const MaskOf<F> surface = length_squared(n) > 0.0f;
    const UintOf<F> cell = cell_at(p + n * F(1e-3f * edge));
    const MaskOf<F> inside = surface & (cell != kNone);
    const UintOf<F> at = select(inside, cell * UintOf<F>(kFacings) + facing_of(n), UintOf<F>(0u));
    const UintOf<F> row = select(inside, gather(surface_row.data, at), UintOf<F>(kNone));
    return select(row != kNone, row, cell_at(p + n * F(0.5f * edge)));
  }
};

/// Luminance of even surroundings that would light surfaces as strongly as the scene does [cd/m²],
/// by facing.
struct AmbientCube {
  Vec3f light[LightGuide::kFacings];

  GLOAM_HD Vec3f on(Vec3f n) const {
    return light[n.x >= 0 ? 0 : 1] * (n.x * n.x) + light[n.y >= 0 ? 2 : 3] * (n.y * n.y) +
           light[n.z >= 0 ? 4 : 5] * (n.z * n.z);
  }
};

/// Directional albedo of the GGX layer without Fresnel, split for Schlick's:
/// albedo(F0, F90) = F0 a + F90 b.
struct AlbedoTable {
  static constexpr int kSize = 32;
  float a[kSize * kSize], b[kSize * kSize];  ///< rows of roughness 0..1, columns of cosine 0..1
  float fuzz[kSize * kSize];                 ///< of sheen::lobe, the same rows and columns
};

/// Directional albedo of single scattering on rough glass, reflected and let through.
struct GlassTable {
  static constexpr int kSize = 16;
  float albedo[kSize * kSize * kSize];  ///< by axis_of(eta) -1..1, roughness 0..1, cosine 0..1
  /// Index of refraction beyond / here, 1/3 to 3, as -1..1.
  GLOAM_HD static float axis_of(float eta) {
    return clamp(2.0f * (eta - 1.0f) / (eta + 1.0f), -1.0f, 1.0f);
  }
  GLOAM_HD static float eta_at(float axis) { return (2.0f + axis) / (2.0f - axis); }
};

/// Kernels on a card may be made for scenes without anything special alone, in which nothing moves
/// while the shutter is open: what they leave out is then known when they are compiled, and they
/// are several times shorter.
#if defined(__CUDA_ARCH__) && defined(GLOAM_PLAIN_KERNELS)
inline constexpr bool kPlainScenes = true;
#else
inline constexpr bool kPlainScenes = false;
#endif

/// Kernels for scenes without media, in which all else may be.
#if defined(__CUDA_ARCH__) && defined(GLOAM_KERNELS_WITHOUT_MEDIA)
inline constexpr bool kNoMedia = true;
#else
inline constexpr bool kNoMedia = kPlainScenes;
#endif

#ifdef __CUDA_ARCH__
inline constexpr bool kOnCard = true;
#else
inline constexpr bool kOnCard = false;
#endif

/// Water and snow that the weather has left on surfaces under the open sky, as of
/// kernel/surface/weathering.h.
struct FallenView {
  float wetness = 0, snow = 0;
  float time = 0;     ///< [s]
  float impacts = 0;  ///< of drops that make rings on puddles [1/(m² s)]
  ShelterView shelter;
};

/// Scenes with more lights have a tree over them, by which the direct and the interactive tier
/// select.
inline constexpr uint32_t kMaxLightsWithoutTree = 16;
/// Scenes with more lights select by it in the path tier, too: up to here lights are weighed one by
/// one, with what the guide knows of each. A furnished house has some thirty.
inline constexpr uint32_t kMaxWeighedLights = 48;

struct SceneView {
  DeviceSpan<const InstanceView> instances;
  DeviceSpan<const MeshView> meshes;
  DeviceSpan<const MaterialView> materials;
  DeviceSpan<const TextureView> textures;
  DeviceSpan<const TextureLevel> texture_levels;
  DeviceSpan<const Texel> texels;
  DeviceSpan<const LightView> lights;
  DeviceSpan<const LightKey> light_keys;  ///< light_key_count of every light that moves
  uint32_t light_key_count = 0;
  /// Levels of lights that flicker while the shutter is open: their light in light_level_count
  /// equal spans of time, as fractions of its mean.
  DeviceSpan<const float> light_levels;
  uint32_t light_level_count = 0;
  DeviceSpan<const ProfileView> profiles;
  DeviceSpan<const float> profile_values;
  LightTreeView light_tree;      ///< of scenes with more than kMaxLightsWithoutTree
  bool selects_by_tree = false;  ///< lights are selected by it
  DeviceSpan<const MaterialLayers> layers;
  DeviceSpan<const ProceduralDescription> procedurals;
  BakedView baked;
  const AlbedoTable* albedo = nullptr;
  const GlassTable* glass = nullptr;  ///< where some material is glass
  LightGuide guide;
  MediaView media;
  FallenView fallen;
  EnvironmentView environment;  ///< instead of sky_texture
  int sky_texture = -1;
  float sky_scale = 0;
  Vec3f sky_ambient;                     ///< for indirect rays
  const AmbientCube* ambient = nullptr;  ///< for the direct stage
  bool has_transparent = false;          ///< some material lets light straight through
  bool has_color_only = false;  ///< some instance is color_only; then has_transparent holds, too
  bool has_emitters = false;    ///< something that a ray can hit gives light: sky, sphere, instance
  bool has_visible_lights = false;  ///< some sphere or sun can be hit

  GLOAM_HD bool has_textures() const { return !kPlainScenes && textures.size > 0; }
  GLOAM_HD bool has_layers() const { return !kPlainScenes && layers.size > 0; }
  GLOAM_HD bool has_fallen() const { return !kPlainScenes && fallen.wetness + fallen.snow > 0; }
  GLOAM_HD bool has_media() const { return !kNoMedia && media.volumes.size > 0; }
  /// Whether a medium's light is sampled. Not on a card, where rays find it by chance alone:
  /// kernels for all scenes are too long as they are.
  GLOAM_HD bool has_glow() const { return !kOnCard && media.glows.size > 0; }
  GLOAM_HD bool has_environment() const { return !kPlainScenes && !environment.levels.empty(); }
  GLOAM_HD bool has_flicker() const { return !kPlainScenes && light_levels.size > 0; }
  GLOAM_HD bool has_sky_texture() const { return !kPlainScenes && sky_texture >= 0; }
  GLOAM_HD bool lets_light_through() const { return !kPlainScenes && has_transparent; }
  GLOAM_HD bool has_many_lights() const { return !kPlainScenes && selects_by_tree; }
  GLOAM_HD bool guides_directions() const { return guide.probability > 0; }
  /// On the host alone: it reads the lights.
  bool is_plain() const {
    bool lamps = lights.size <= kMaxLightsWithoutTree;
    for (uint32_t i = 0; lamps && i < lights.size; ++i) {
      const LightView& light = lights[i];
      lamps = light.kind != LightKind::kInstance && light.profile < 0;
    }
    return lamps && textures.empty() && layers.empty() && media.volumes.empty() &&
           environment.levels.empty() && sky_texture < 0 && light_levels.empty() && !has_fallen() &&
           !has_transparent;
  }
};

/// The `active` lanes whose instance colour pictures alone show.
template <class F>
GLOAM_HD MaskOf<F> color_only_lanes(const SceneView& scene, UintOf<F> instance, MaskOf<F> active) {
  MaskOf<F> out = false;
  if (!scene.has_color_only) return out;
  each_lane(active, [&](int i) {
    if (scene.instances[lane(instance, i)].color_only) set_lane(&out, i, true);
  });
  return out;
}

/// Light of a row of SceneView::light_levels at a time in the shutter, as a fraction of its mean.
GLOAM_HD float level_at(const SceneView& scene, int row, float time) {
  const uint32_t count = scene.light_level_count;
  const float at = clamp(time, 0.0f, 1.0f) * static_cast<float>(count);
  const uint32_t bin = static_cast<uint32_t>(min(at, static_cast<float>(count - 1)));
  return scene.light_levels[static_cast<uint32_t>(row) * count + bin];
}

/// Pose of an instance at a time in the shutter (linear between the keys, as Embree does);
/// `between` is scratch for it.
GLOAM_HD const Affine3f& pose_at(const InstanceView& instance, float time, Affine3f* between) {
  if (kPlainScenes || !instance.moving || time == 0) return instance.X_WG;
  float fraction;
  const uint32_t key = key_before(instance.keys.size, time, &fraction);
  *between = lerp(instance.keys[key], instance.keys[key + 1], fraction);
  return *between;
}
GLOAM_HD Affine3f pose_at(const InstanceView& instance, float time) {
  Affine3f between;
  return pose_at(instance, time, &between);
}

GLOAM_HD bool deforms_in_shutter(const MeshView& mesh) {
  return !kPlainScenes && !mesh.position_keys.empty();
}
GLOAM_HD Vec3f mesh_vertex(const MeshView& mesh, uint32_t i, float time) {
  if (!deforms_in_shutter(mesh) || time == 0) return mesh.positions[i];
  float fraction;
  const uint32_t row = key_before(mesh.key_count, time, &fraction) * mesh.positions.size + i;
  return lerp(mesh.position_keys[row], mesh.position_keys[row + mesh.positions.size], fraction);
}

/// Corners i of a mesh.
template <class F>
GLOAM_HD Vec3Of<F> mesh_vertices(const MeshView& mesh, UintOf<F> i, F time) {
  if (deforms_in_shutter(mesh)) {
    Vec3Of<F> p;
    each_lane(MaskOf<F>(true),
              [&](int at) { set_lane(&p, at, mesh_vertex(mesh, lane(i, at), lane(time, at))); });
    return p;
  }
  const float* coordinates = &mesh.positions.data->x;
  return {gather(coordinates, i * 3u), gather(coordinates + 1, i * 3u),
          gather(coordinates + 2, i * 3u)};
}

}  // namespace gloam

#include "world/view/studio.h"

#include <algorithm>
#include <cmath>

#include "world/materials/visual_rules.h"
#include "world/sky/environment.h"

namespace gloam {
namespace {

constexpr float kKeyIlluminance = 900;    // [lx], on a surface that faces the key light
constexpr float kZenithLuminance = 520;   // [cd/m²]
constexpr float kKeyRadius = 0.1f;        // sine of the half angle: soft shadows
constexpr float kKeyElevation = 0.9f;     // [rad]
constexpr float kKeyLeftOfCamera = 0.8f;  // [rad]
// Display value of the subject's median, linear, 1 = white
constexpr float kSubjectOnDisplay = 0.31f;
constexpr float kDarkest = 0.01f, kBrightest = 0.7f;  // reflectances that an exposure is fitted to
constexpr float kFloorOnDisplay = 0.46f;
constexpr float kFloorReach = 7;  // half width in diagonals of the subject

bool is_headlight(const LightDescription& light) { return light.light < 0 && light.body < 0; }

/// Mean luminance of a material's colour, its texture included, and what its gloss adds: of black
/// plastic that is all there is.
float reflectance_of(const MaterialDescription& material, const RenderDescription& scene) {
  float albedo = luminance(material.base_color);
  if (material.textures.base_color >= 0)
    albedo *= mean_luminance(scene.textures[static_cast<size_t>(material.textures.base_color)]);
  constexpr float kGloss = 0.01f;  // Fresnel's 0.04, of a sky that is darker than what is lit
  return albedo + kGloss * material.specular_weight;
}

/// The reflectance that is shown as white, by what a camera at X_WC sees of the points (a small
/// depth buffer): the median lands at kSubjectOnDisplay.
float white_reflectance(std::span<const DrawnPart> subject, const Affine3f& X_WC,
                        const RenderDescription& scene) {
  constexpr int kSide = 48;
  struct Cell {
    float depth = INFINITY, reflectance = 0;
  };
  std::vector<Cell> cells(kSide * kSide);
  for (const DrawnPart& part : subject) {
    const InstanceDescription& in = scene.instances[part.instance];
    const float albedo = reflectance_of(scene.materials[static_cast<size_t>(in.material)], scene);
    for (const Vec3f& p : part.points) {
      const Vec3f v = p - X_WC.p;
      const float depth = -dot(v, X_WC.z);
      if (!(depth > 0)) continue;
      const auto at = [&](float x) {
        return static_cast<int>(std::floor((0.5f + x / depth) * kSide));
      };
      const int column = at(dot(v, X_WC.x)), row = at(dot(v, X_WC.y));
      if (column < 0 || row < 0 || column >= kSide || row >= kSide) continue;
      Cell& cell = cells[static_cast<size_t>(row * kSide + column)];
      if (depth < cell.depth) cell = {depth, albedo};
    }
  }
  std::vector<float> seen;
  for (const Cell& cell : cells)
    if (std::isfinite(cell.depth)) seen.push_back(cell.reflectance);
  if (seen.empty()) return 1;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  return clamp(*middle, kDarkest, kBrightest) / kSubjectOnDisplay;
}

/// As bright as the floor up to where level views end, so that they have an even backdrop; brighter
/// towards the zenith.
EnvironmentDescription soft_sky(float floor_luminance) {
  EnvironmentDescription sky;
  sky.name = "studio";
  sky.width = 64;
  sky.height = 32;
  for (int y = 0; y < sky.height; ++y) {
    const float elevation =
        0.5f * kPi - (static_cast<float>(y) + 0.5f) * kPi / static_cast<float>(sky.height);
    const float up = clamp((elevation - 0.5f) / (0.25f * kPi), 0, 1);
    const float share = up * up * (3 - 2 * up);
    const Vec3f color = Vec3f{1, 1, 1} * (floor_luminance * (1 - share)) +
                        Vec3f{0.97f, 0.99f, 1.05f} * (kZenithLuminance * share);
    sky.texels.insert(sky.texels.end(), static_cast<size_t>(sky.width), color);
  }
  return sky;
}

/// A square whose opacity falls from one in the middle to nothing at its edge.
Image8 faded_disc() {
  Image8 image;
  image.width = image.height = 256;
  image.channels = 1;
  image.color_space = ColorSpace::kLinear;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / 128 - 1;
      const float v = (static_cast<float>(y) + 0.5f) / 128 - 1;
      const float t = clamp((std::sqrt(u * u + v * v) - 0.25f) / 0.7f, 0, 1);
      const float opacity = 1 - t * t * (3 - 2 * t);
      image.texels.push_back(static_cast<uint8_t>(std::lround(255 * opacity)));
    }
  }
  return image;
}

void add_floor(Vec3f center, float half_width, float albedo, RenderDescription* out) {
  MaterialDescription material;
  material.name = "studio floor";
  material.base_color = {albedo, albedo, albedo};
  material.specular_weight = 0;
  material.roughness = 1;
  material.mapping = TextureMapping::kUv;
  material.textures.opacity = static_cast<int>(out->textures.size());
  out->textures.push_back(
      {"studio floor", {faded_disc()}, TextureWrap::kClamp, TextureWrap::kClamp});
  TriangleMesh mesh;
  const float h = half_width;
  mesh.positions = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  InstanceDescription floor;
  floor.shape = ShapeType::kMesh;
  floor.mesh = static_cast<int>(out->meshes.size());
  floor.size = {h, h, 0};
  floor.X_BG.p = center;
  floor.material = static_cast<int>(out->materials.size());
  floor.is_static = true;
  floor.color_only = true;
  floor.casts_shadow = false;
  floor.label.body = floor.label.geom = floor.label.material = material.name;
  floor.label.part = static_cast<uint32_t>(out->instances.size()) + 1;
  out->meshes.push_back(std::move(mesh));
  out->materials.push_back(std::move(material));
  out->instances.push_back(std::move(floor));
}

void add_key_light(const Affine3f& X_WC, RenderDescription* out) {
  const float camera = std::atan2(X_WC.z.y, X_WC.z.x);  // from the subject to the camera
  const float azimuth = camera - kKeyLeftOfCamera;
  LightDescription key;
  key.name = "studio key";
  key.type = PunctualLightType::kDirectional;
  key.intensity = Vec3f{1, 0.98f, 0.95f} * kKeyIlluminance;
  key.radius = kKeyRadius;
  key.is_static = true;
  key.body = 0;
  const Frame frame =
      Frame::from_z({std::cos(kKeyElevation) * std::cos(azimuth),
                     std::cos(kKeyElevation) * std::sin(azimuth), std::sin(kKeyElevation)});
  key.X_BL = {frame.x, frame.y, frame.z, {}};
  out->lights.push_back(std::move(key));
}

/// True if the model stands on a floor of its own: a plane that faces up, or something flat and
/// wide.
bool has_floor(std::span<const DrawnPart> all, float diagonal, const RenderDescription& scene) {
  for (const InstanceDescription& in : scene.instances) {
    if (in.shown && in.shape == ShapeType::kPlane && in.X_BG.z.z > 0.5f && in.body == 0)
      return true;
  }
  return std::any_of(all.begin(), all.end(), [&](const DrawnPart& part) {
    const Vec3f size = part.high - part.low;
    return scene.instances[part.instance].is_static && min(size.x, size.y) > diagonal &&
           size.z < 0.2f * diagonal;
  });
}

}  // namespace

bool needs_studio(const Scene& scene, const RenderDescription& description) {
  if (scene.render.look != RenderLook::kAuto) return scene.render.look == RenderLook::kStudio;
  if (!scene.lights.empty() || scene.sky || !scene.environment.file.empty()) return false;
  if (description.sky.texture >= 0 || description.sky.environment.width > 0) return false;
  const bool lit = std::any_of(
      description.lights.begin(), description.lights.end(),
      [](const LightDescription& light) { return light.active && !is_headlight(light); });
  return !lit;
}

void add_studio(std::span<const DrawnPart> subject, std::span<const DrawnPart> all,
                const Affine3f& X_WC, RenderDescription* out) {
  if (subject.empty()) return;
  Vec3f low = subject.front().low, high = subject.front().high;
  for (const DrawnPart& part : subject) {
    low = {min(low.x, part.low.x), min(low.y, part.low.y), min(low.z, part.low.z)};
    high = {max(high.x, part.high.x), max(high.y, part.high.y), max(high.z, part.high.z)};
  }
  const float diagonal = max(length(high - low), 1e-3f);
  for (LightDescription& light : out->lights) {
    if (!is_headlight(light)) continue;
    light.active = false;
    light.ambient = {};
  }
  out->sky = {};

  constexpr float kFacing = 0.6f * kKeyIlluminance + 0.3f * kPi * kZenithLuminance;  // [lx]
  const float white = white_reflectance(subject, X_WC, *out) * kFacing * kInvPi;     // [cd/m²]
  out->ev100 = ev100_for(white, 1);
  const float floor_luminance = kFloorOnDisplay * white;
  out->sky.environment = soft_sky(floor_luminance);
  const float level =
      illuminance(out->sky.environment, {0, 0, 1}) + kKeyIlluminance * std::sin(kKeyElevation);
  add_key_light(X_WC, out);
  if (has_floor(all, diagonal, *out)) return;
  const Vec3f middle = (low + high) * 0.5f;
  // Below feet that are flat, by less than can be seen.
  const Vec3f center{middle.x, middle.y, low.z - 1e-4f * diagonal};
  add_floor(center, kFloorReach * diagonal, min(floor_luminance * kPi / level, 0.9f), out);
}

void open_exposure(std::span<const DrawnPart> subject, const Affine3f& X_WC,
                   RenderDescription* out) {
  constexpr float kTurned = 0.6f;  // light on a surface that does not face its lamp
  const float opened = kTurned * kWhiteExposed * white_reflectance(subject, X_WC, *out);
  out->ev100 += std::log2(min(opened, 1));
}

}  // namespace gloam

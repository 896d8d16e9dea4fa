// Bump maps tilt the normal by the slope of their heights; textures repeat, mirror or clamp.

#include <gtest/gtest.h>

#include "render/kernel/surface/surface.h"
#include "render/test/probe.h"

namespace gloam {
namespace {

constexpr float kRise = 256.0f / 255;  // of ramp() over one texture length

/// Heights that rise from 0 to 1 with u, texel by texel.
Image8 ramp() {
  Image8 image{256, 4, 1, ColorSpace::kLinear, {}};
  for (int row = 0; row < image.height; ++row)
    for (int i = 0; i < 256; ++i) image.texels.push_back(static_cast<uint8_t>(i));
  return image;
}

MaterialDescription bumped(int texture, float scale) {
  MaterialDescription m;
  m.mapping = TextureMapping::kUv;
  m.textures.bump = texture;
  m.bump_scale = scale;
  return m;
}

/// A square of side 2 about the origin, facing +z; u runs along `u_axis`.
TriangleMesh quad(Vec3f u_axis, Vec2f repeats = {1, 1}) {
  TriangleMesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const Vec3f v_axis = cross(Vec3f{0, 0, 1}, u_axis);
  for (const Vec3f& p : mesh.positions)
    mesh.uvs.push_back(
        {(0.5f + 0.5f * dot(p, u_axis)) * repeats.x, (0.5f + 0.5f * dot(p, v_axis)) * repeats.y});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

/// Normals of a few pixels, as lanes shade them.
std::vector<Vec3f> normals_seen(const SceneBuilder& b, const Affine3f& X_WC) {
  RenderSettings settings;
  settings.spp = 1;
  const CameraView view = SceneBuilder::camera(X_WC, 4, 4, 5);
  return b.render(view, settings).center_normal;
}

/// The same at the middle, as one float at a time shades it.
Vec3f normal_of_one_ray(const SceneBuilder& b, Vec3f from, Vec3f towards) {
  const Probe probe(b);
  const Ray ray = make_ray(from, towards);
  RayHit hit;
  const bool found = probe.tracer.closest(ray, true, false, &hit);
  EXPECT_TRUE(found);
  return make_surface(probe.view, ray, hit, RayCone{}, found).normal;
}

void expect_all(const std::vector<Vec3f>& normals, Vec3f expected) {
  for (const Vec3f& n : normals) EXPECT_LT(length(n - expected), 2e-3f);
}

TEST(Bump, RampTiltsThePlaneByItsSlope) {
  SceneBuilder b;
  const float scale = 0.5f, slope = scale * kRise / 2;  // one texture length spans 2 m
  b.add(ShapeType::kPlane, {1, 1, 0}, {}, b.add_material(bumped(b.add_texture(ramp()), scale)));
  const Vec3f expected = normalize(Vec3f{-slope, 0, 1});
  expect_all(normals_seen(b, translation({0.2f, 0.1f, 2})), expected);
  EXPECT_LT(length(normal_of_one_ray(b, {0.2f, 0.1f, 2}, {0, 0, -1}) - expected), 2e-3f);
}

TEST(Bump, FollowsTheUvsOfMeshesHoweverTheyLie) {
  for (const Vec3f& u_axis : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, normalize(Vec3f{1, 1, 0})}) {
    SceneBuilder b;
    MaterialDescription m = bumped(b.add_texture(ramp()), 0.3f);
    m.texture_repeat = {2, 1};
    const float slope = 0.3f * kRise * 1.5f * 2 / 2;  // 1.5 repeats of the mesh, 2 of the material
    const Affine3f X = rigid({1, 0, 0}, 0.4f, {});
    b.add(ShapeType::kMesh, {}, X, b.add_material(m), 0, b.add_mesh(quad(u_axis, {1.5f, 1})));
    const Vec3f expected = transform_vector(X, normalize(Vec3f{0, 0, 1} - u_axis * slope));
    // Within a ramp, off its jump back: u = 0.25 of 3 lengths over the square.
    const Vec3f at = transform_point(X, u_axis * -0.15f);
    EXPECT_LT(length(normal_of_one_ray(b, at + X.z * 2.0f, -X.z) - expected), 2e-3f);
    // From behind, bumps are dents.
    EXPECT_LT(length(normal_of_one_ray(b, at - X.z * 2.0f, X.z) + expected), 2e-3f);
  }
}

TEST(Bump, WorksOnSolidsWithoutUvs) {
  SceneBuilder b;
  const float scale = 0.2f;
  b.add(ShapeType::kBox, {1, 1, 1}, {}, b.add_material(bumped(b.add_texture(ramp()), scale)));
  // On the face across x, s runs along y: over 2 m as on a plane.
  const Vec3f n = normal_of_one_ray(b, {3, 0.2f, 0.1f}, {-1, 0, 0});
  EXPECT_LT(length(n - normalize(Vec3f{1, -scale * kRise / 2, 0})), 2e-3f);
}

TEST(Bump, ZeroHeightChangesNoBit) {
  const auto picture = [](int kind) {
    SceneBuilder b;
    MaterialDescription m;
    if (kind == 1) m = bumped(b.add_texture(ramp()), 0);
    if (kind == 2) m = bumped(b.add_texture({2, 2, 1, ColorSpace::kLinear, {0, 0, 0, 0}}), 1);
    b.add(ShapeType::kMesh, {}, {}, b.add_material(m), 0, b.add_mesh(make_ball(12, 0.1f)));
    LightDescription light;
    light.intensity = {100, 100, 100};
    b.add_light(light, {2, 2, 3});
    RenderSettings settings;
    settings.spp = 2;
    return b.render(SceneBuilder::camera(look_at({3, 0, 1}, {}), 24, 24, 45), settings);
  };
  const Film plain = picture(0);
  EXPECT_TRUE(plain.radiance == picture(1).radiance);
  EXPECT_TRUE(plain.radiance == picture(2).radiance);
  EXPECT_GT(luminance(plain.radiance[12 * 24 + 12]), 0);
}

TEST(Texture, WrapsAsItsPictureIsSaidTo) {
  // Left black, right white, over u from 0 to 3 on the square.
  struct Case {
    TextureWrap wrap;
    float seen[3][2];  // at 1/4 and 3/4 of each length
  };
  const Case cases[] = {{TextureWrap::kRepeat, {{0, 1}, {0, 1}, {0, 1}}},
                        {TextureWrap::kMirror, {{0, 1}, {1, 0}, {0, 1}}},
                        {TextureWrap::kClamp, {{0, 1}, {1, 1}, {1, 1}}}};
  for (const Case& c : cases) {
    SceneBuilder b;
    MaterialDescription m;
    m.mapping = TextureMapping::kUv;
    m.base_color = {1, 1, 1};
    m.textures.base_color = b.add_texture({2, 1, 1, ColorSpace::kLinear, {0, 255}});
    b.description.textures[0].wrap_u = c.wrap;
    b.add(ShapeType::kMesh, {}, {}, b.add_material(m), 0, b.add_mesh(quad({1, 0, 0}, {3, 1})));
    RenderSettings settings;
    settings.spp = 1;
    for (int i = 0; i < 6; ++i) {
      const float x = -1 + (static_cast<float>(i / 2) + (i % 2 == 0 ? 0.25f : 0.75f)) * 2 / 3;
      const CameraView view = SceneBuilder::camera(translation({x, 0.1f, 0.2f}), 1, 1, 0.1);
      EXPECT_NEAR(b.render(view, settings).center_albedo[0].x, c.seen[i / 2][i % 2], 0.02)
          << "wrap " << static_cast<int>(c.wrap) << " at " << i;
    }
  }
}

TEST(Mesh, TrianglesWithoutAreaShineAndCastNothing) {
  // A square lamp with triangles that are points and lines, whichever comes first or last.
  const auto picture = [](bool with_flat) {
    SceneBuilder b;
    TriangleMesh lamp = quad({1, 0, 0});
    if (with_flat) {
      lamp.indices.insert(lamp.indices.begin(), {0, 0, 0});
      lamp.indices.insert(lamp.indices.end(), {0, 1, 1, 2, 2, 2});
    }
    b.add(ShapeType::kMesh, {}, translation({0, 0, 2}), b.add_emitter({10, 10, 10}), 0,
          b.add_mesh(lamp));
    b.add(ShapeType::kPlane, {}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
    RenderSettings settings;
    settings.spp = 64;
    settings.variance = true;
    return picture_mean(
        b.render(SceneBuilder::camera(look_at({2, 0, 1}, {}), 16, 16, 30), settings));
  };
  const Mean whole = picture(false), flat = picture(true);
  EXPECT_NEAR(flat.mean, whole.mean, 4 * std::hypot(whole.standard_error(), flat.standard_error()));
  EXPECT_GT(whole.mean, 0.1);
  EXPECT_LT(whole.standard_error(), 0.02 * whole.mean);
}

}  // namespace
}  // namespace gloam

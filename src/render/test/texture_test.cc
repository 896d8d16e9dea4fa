// Texture coordinates after MuJoCo's rules, and their filtering.

#include <gtest/gtest.h>

#include "render/test/probe.h"

namespace gloam {
namespace {

MaterialDescription textured(int texture, bool uniform, Vec2f repeat) {
  MaterialDescription m;
  m.base_color = {1, 1, 1};
  m.specular_weight = 0;
  m.mapping = TextureMapping::kUv;
  m.texture_uniform = uniform;
  m.texture_repeat = repeat;
  m.textures.base_color = texture;
  return m;
}

/// Four texels: top left black, top right dark, bottom left grey, bottom right white; linear.
Image8 corners() { return {2, 2, 1, ColorSpace::kLinear, {0, 85, 170, 255}}; }

/// Albedo seen straight from above the point (x, y), from near by.
float albedo_above(const SceneBuilder& b, float x, float y, float z = 0.2f) {
  RenderSettings settings;
  settings.spp = 1;
  CameraView view = SceneBuilder::camera(translation({x, y, z}), 1, 1, 0.1);
  return b.render(view, settings).center_albedo[0].x;
}

TEST(Texture, PlanesRepeatPerObjectOrPerLength) {
  // Not uniform: the picture spans the object; its top is at +y, as MuJoCo's generated coordinates
  // put it.
  SceneBuilder object;
  object.add(ShapeType::kPlane, {2, 1, 0}, {},
             object.add_material(textured(object.add_texture(corners()), false, {1, 1})));
  EXPECT_NEAR(albedo_above(object, -1, 0.5f), 0, 0.02);
  EXPECT_NEAR(albedo_above(object, 1, 0.5f), 85 / 255.0, 0.02);
  EXPECT_NEAR(albedo_above(object, -1, -0.5f), 170 / 255.0, 0.02);
  EXPECT_NEAR(albedo_above(object, 1, -0.5f), 1, 0.02);
  // Uniform: half a repeat per metre and unit of texrepeat; the origin of the texture is the middle
  // of an infinite plane, the corner of a finite one.
  for (const float size : {0.0f, 5.0f}) {
    SceneBuilder uniform;
    uniform.add(ShapeType::kPlane, {size, size, 0}, {},
                uniform.add_material(textured(uniform.add_texture(corners()), true, {4, 4})));
    const float origin = size > 0 ? -0.25f : 0.0f;
    for (const float shift : {0.0f, 0.5f, 1.5f}) {
      const float x = origin + shift, y = origin;
      EXPECT_NEAR(albedo_above(uniform, x - 0.125f, y + 0.125f + shift), 0, 0.02);
      EXPECT_NEAR(albedo_above(uniform, x + 0.125f, y + 0.125f - shift), 85 / 255.0, 0.02);
      EXPECT_NEAR(albedo_above(uniform, x + 0.125f, y - 0.125f - shift), 1, 0.02);
    }
  }
}

TEST(Texture, MeshUvsGrowUpwards) {
  SceneBuilder b;
  TriangleMesh quad;
  quad.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  quad.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  quad.indices = {0, 1, 2, 0, 2, 3};
  b.add(ShapeType::kMesh, {}, {}, b.add_material(textured(b.add_texture(corners()), false, {1, 1})),
        0, b.add_mesh(quad));
  EXPECT_NEAR(albedo_above(b, -0.5f, 0.5f), 0, 0.02);
  EXPECT_NEAR(albedo_above(b, 0.5f, 0.5f), 85 / 255.0, 0.02);
  EXPECT_NEAR(albedo_above(b, -0.5f, -0.5f), 170 / 255.0, 0.02);
}

TEST(Texture, CubeFacesFollowTheAxes) {
  SceneBuilder b;
  std::vector<Image8> faces;
  for (uint8_t i = 0; i < 6; ++i) {
    faces.push_back({2, 2, 1, ColorSpace::kLinear, std::vector<uint8_t>(4, uint8_t(40 * i + 20))});
  }
  b.description.textures.push_back({"cube", faces});
  MaterialDescription m = textured(0, false, {1, 1});
  m.mapping = TextureMapping::kCube;
  b.add(ShapeType::kBox, {0.5f, 0.2f, 0.1f}, {}, b.add_material(m));
  RenderSettings settings;
  settings.spp = 1;
  const Vec3f from[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int i = 0; i < 6; ++i) {
    const Film film =
        b.render(SceneBuilder::camera(look_at(from[i] * 2.0f, {}), 1, 1, 0.1), settings);
    EXPECT_NEAR(film.center_albedo[0].x, (40 * i + 20) / 255.0, 0.01) << "face " << i;
  }
}

TEST(Texture, SrgbIsDecodedAndColourMultiplies) {
  SceneBuilder b;
  MaterialDescription m =
      textured(b.add_texture({1, 1, 3, ColorSpace::kSrgb, {188, 188, 188}}), true, {1, 1});
  m.base_color = {0.5f, 0.5f, 0.5f};
  b.add(ShapeType::kPlane, {}, {}, b.add_material(m));
  EXPECT_NEAR(albedo_above(b, 0, 0), 0.5 * 0.5029, 1e-3);  // sRGB 188 = 0.5029 linear
}

TEST(Texture, DistantCheckerFadesToItsMeanWithoutAliasing) {
  SceneBuilder b;
  b.add(ShapeType::kPlane, {}, {},
        b.add_material(textured(b.add_texture(make_checker(256, 2, 0, 255)), true, {8, 8})));
  RenderSettings settings;
  settings.spp = 1;
  // Squares of 0.125 m seen at 60 m and a slope: far below a pixel.
  const CameraView far = SceneBuilder::camera(look_at({0, -40, 45}, {0, 0, 0}), 64, 64, 40);
  Mean mean;
  const Film film = b.render(far, settings);
  for (const Vec3f& albedo : film.center_albedo) {
    mean.add(albedo.x);
    EXPECT_NEAR(albedo.x, 0.5, 0.06);
  }
  EXPECT_NEAR(mean.mean, 0.5, 0.01);
  // Near by it stays black and white.
  EXPECT_NEAR(albedo_above(b, 0.06f, 0.06f, 1), albedo_above(b, -0.06f, -0.06f, 1), 0.02);
  EXPECT_NEAR(std::fabs(albedo_above(b, 0.06f, 0.06f, 1) - albedo_above(b, 0.06f, -0.06f, 1)), 1,
              0.02);
}

TEST(Texture, OpacityTextureCutsHoles) {
  SceneBuilder b;
  Image8 holes{2, 1, 4, ColorSpace::kSrgb, {255, 255, 255, 0, 255, 255, 255, 255}};
  MaterialDescription m = textured(b.add_texture(holes), false, {1, 1});
  b.add(ShapeType::kPlane, {1, 1, 0}, translation({0, 0, 1}), b.add_material(m));
  b.add(ShapeType::kPlane, {}, {}, b.add_diffuse({0.3f, 0.3f, 0.3f}));
  RenderSettings settings;
  settings.spp = 8;
  for (const RenderTier tier : {RenderTier::kPath, RenderTier::kDirect}) {
    settings.tier = tier;
    settings.spp = tier == RenderTier::kPath ? 8 : 1;
    const auto look = [&](float x) {
      return b.render(SceneBuilder::camera(translation({x, 0, 2}), 1, 1, 0.1), settings);
    };
    EXPECT_EQ(look(-0.5f).part[0], 2u);
    EXPECT_NEAR(look(-0.5f).depth[0], 2, 1e-5);
    EXPECT_EQ(look(0.5f).part[0], 1u);
    EXPECT_NEAR(look(0.5f).depth[0], 1, 1e-5);
  }
}

TEST(Texture, NormalMapTiltsTowardsItsTexel) {
  SceneBuilder b;
  // A normal of (0.6, 0, 0.8) everywhere.
  const int map = b.add_texture({1, 1, 3, ColorSpace::kLinear, {204, 128, 230}});
  MaterialDescription m;
  m.mapping = TextureMapping::kUv;
  m.textures.normal = map;
  b.add(ShapeType::kPlane, {1, 1, 0}, rigid({0, 0, 1}, kPi / 2, {}), b.add_material(m));
  RenderSettings settings;
  settings.spp = 1;
  const Film film = b.render(SceneBuilder::camera(translation({0, 0, 2}), 1, 1, 0.1), settings);
  EXPECT_LT(length(film.center_normal[0] - Vec3f{0, 0.6f, 0.8f}), 0.01);  // u runs along +y here
}

TEST(Texture, NormalMapsFollowTheTextureRoundEveryShape) {
  struct Case {
    const char* what;
    ShapeType shape;
    Vec3f from;    ///< looks at the origin [m]
    Vec3f normal;  ///< of the surface seen
    Vec3f u;       ///< along which the texture's u grows there
  };
  const Case cases[] = {
      {"top of a box", ShapeType::kBox, {0, 0, 3}, {0, 0, 1}, {1, 0, 0}},
      {"box across x", ShapeType::kBox, {3, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      {"box against x", ShapeType::kBox, {-3, 0, 0}, {-1, 0, 0}, {0, 1, 0}},
      {"box across y", ShapeType::kBox, {0, 3, 0}, {0, 1, 0}, {1, 0, 0}},
      {"ball", ShapeType::kSphere, {3, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      {"ball from behind", ShapeType::kSphere, {-3, 0, 0}, {-1, 0, 0}, {0, -1, 0}},
      {"wall of a cylinder", ShapeType::kCylinder, {0, 3, 0}, {0, 1, 0}, {-1, 0, 0}},
  };
  for (const Case& c : cases) {
    SceneBuilder b;
    MaterialDescription m;
    m.mapping = TextureMapping::kUv;
    m.textures.normal = b.add_texture({1, 1, 3, ColorSpace::kLinear, {204, 128, 230}});
    b.add(c.shape, {1, 1, 1}, {}, b.add_material(m));
    RenderSettings settings;
    settings.spp = 1;
    const Film film = b.render(SceneBuilder::camera(look_at(c.from, {}), 1, 1, 0.1), settings);
    const Vec3f expected = c.u * 0.6f + c.normal * 0.8f;
    EXPECT_LT(length(film.center_normal[0] - expected), 0.01) << c.what;
  }
}

TEST(Texture, LayersHaveMapsOfTheirOwn) {
  SceneBuilder b;
  MaterialDescription m;
  m.mapping = TextureMapping::kUv;
  m.coat_weight = 0.5f;
  m.coat_roughness = 1;
  m.transmission_weight = 1;
  const auto grey = [&](uint8_t texel) {
    return b.add_texture({1, 1, 1, ColorSpace::kLinear, {texel}});
  };
  m.textures.coat_weight = grey(51);
  m.textures.coat_roughness = grey(102);
  m.textures.transmission = grey(153);
  b.add(ShapeType::kBox, {1, 1, 1}, {}, b.add_material(m));
  const Probe probe(b);
  const Ray ray = make_ray({0, 0, 3}, {0, 0, -1});
  RayHit hit;
  ASSERT_TRUE(probe.tracer.trace(ray, false, &hit));
  const Surface s = make_surface(probe.view, ray, hit, RayCone{});
  EXPECT_NEAR(s.coat_weight, 0.5f * 0.2f, 1e-5f);
  EXPECT_NEAR(s.coat_roughness, 0.4f, 1e-5f);
  EXPECT_NEAR(s.transmission, 0.6f, 1e-5f);
}

TEST(Texture, RoughnessAndMetallicComeFromTheirMaps) {
  SceneBuilder b;
  // orm: occlusion 1, roughness 0.2, metallic 1.
  const int orm = b.add_texture({1, 1, 3, ColorSpace::kLinear, {255, 51, 255}});
  MaterialDescription mapped, plain;
  mapped.mapping = TextureMapping::kUv;
  mapped.roughness = mapped.metallic = 1;
  mapped.textures.orm = orm;
  mapped.base_color = plain.base_color = {0.8f, 0.5f, 0.3f};
  plain.roughness = 0.2f;
  plain.metallic = 1;
  const int a = b.add_material(mapped), c = b.add_material(plain);
  LightDescription light;
  light.intensity = {100, 100, 100};
  light.radius = 0.3f;
  b.add_light(light, {1, 1, 2});
  SceneBuilder other = b;
  b.add(ShapeType::kPlane, {1, 1, 0}, {}, a);
  other.add(ShapeType::kPlane, {1, 1, 0}, {}, c);
  RenderSettings settings;
  const CameraView view = SceneBuilder::camera(look_at({-1, -1, 2}, {0, 0, 0}), 16, 16, 30);
  const Film first = b.render(view, settings), second = other.render(view, settings);
  for (size_t i = 0; i < first.radiance.size(); ++i) {
    EXPECT_NEAR(first.radiance[i].x, second.radiance[i].x, 2e-3 * second.radiance[i].x + 1e-4);
  }
  EXPECT_GT(luminance(first.radiance[100]), 0);
}

TEST(Texture, WhiteIsNeverWhiterThanWhite) {
  // A hair more of opacity, and what is opaque would let light below zero through.
  const std::vector<Texel> white(9, Texel{65535, 65535, 65535, 65535});
  const TextureLevel level{0, 3, 3};
  TextureView texture;
  texture.level_count = 1;
  SceneView scene;
  scene.texels = {white.data(), static_cast<uint32_t>(white.size())};
  scene.texture_levels = {&level, 1};
  scene.textures = {&texture, 1};
  Sampler sampler = Sampler::make(0, 0, 0, 0, 0, 0);
  for (int i = 0; i < 10000; ++i) {
    const Rgba texel = lookup_2d(scene, 0, sampler.next_2d(), 0.0f);
    ASSERT_LE(max_component(texel.rgb), 1);
    ASSERT_LE(texel.a, 1);
    ASSERT_GT(texel.a, 0.99999f);
  }
}

}  // namespace
}  // namespace gloam

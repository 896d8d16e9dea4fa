// [[visual]] tables: model files as drawn things.

#include "world/shapes/visual_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/cache_writer.h"
#include "base/files.h"
#include "geometry/test/gltf_builder.h"
#include "geometry/test/image_writer.h"
#include "geometry/test/read_helper.h"
#include "world/test/visual_test_model.h"

namespace gloam {
namespace {

using testing::HasSubstr;
using visual_test::describe;
using visual_test::expect_near;
using Json = nlohmann::json;

class VisualFile : public testing::Test {
 protected:
  void SetUp() override { setenv("GLOAM_CACHE", (folder.path / "cache").c_str(), 1); }
  void TearDown() override { unsetenv("GLOAM_CACHE"); }

  /// A robot's link of 1 kg, moved by a joint, beside a static table.
  CompiledWorld world(std::vector<VisualOptions> visuals) const {
    CompiledWorld made = visual_test::compile(R"(<mujoco><worldbody>
      <body name="table" pos="5 0 0"><geom size=".1"/></body>
      <body name="arm" pos="0 0 1"><joint/><geom size=".1" group="3"/></body>
      </worldbody></mujoco>)");
    made.scene.visuals = std::move(visuals);
    return made;
  }
  VisualOptions visual(const std::filesystem::path& file) const {
    VisualOptions v;
    v.name = "lamp";
    v.file = file;
    v.loc = {"scene.toml", 3, 1};
    return v;
  }
  RenderDescription described(const VisualOptions& v) const { return describe(world({v})); }
  std::string error(const VisualOptions& v) const { return visual_test::refusal(world({v})); }

  TestFolder folder;
};

/// Instances that visuals brought.
std::vector<InstanceDescription> parts(const RenderDescription& d) {
  std::vector<InstanceDescription> out;
  for (const InstanceDescription& i : d.instances)
    if (i.shape == ShapeType::kMesh) out.push_back(i);
  return out;
}
Vec3f vertex(const RenderDescription& d, const InstanceDescription& i, size_t v) {
  return transform_point(i.X_BG, d.meshes[static_cast<size_t>(i.mesh)].positions[v]);
}
Vec3f face_normal(const RenderDescription& d, const InstanceDescription& i) {
  const TriangleMesh& m = d.meshes[static_cast<size_t>(i.mesh)];
  const Vec3f a = vertex(d, i, m.indices[0]);
  return normalize(cross(vertex(d, i, m.indices[1]) - a, vertex(d, i, m.indices[2]) - a));
}
const MaterialDescription& material_named(const RenderDescription& d, const std::string& name) {
  for (const MaterialDescription& m : d.materials)
    if (m.name == name) return m;
  ADD_FAILURE() << "no material " << name;
  return d.materials.front();
}
std::string notes(const RenderDescription& d) {
  std::string out;
  for (const Error& e : d.unsupported) out += e.to_string() + "\n";
  return out;
}

const std::vector<Vec3f> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// One triangle with normals along its +z and uvs; its nodes are the test's.
GltfBuilder triangle_file() {
  GltfBuilder file;
  const int p = file.add_positions(kTriangle);
  const int n = file.add_positions({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
  const int uv = file.add_accessor(std::vector<Vec2f>{{0, 0}, {1, 0}, {0, 1}}, "VEC2", 5126, 3);
  file.add_mesh({{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", uv}}}});
  return file;
}
GltfBuilder material_file(Json material) {
  GltfBuilder file = triangle_file();
  material["name"] = "paint";
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.push("materials", std::move(material));
  file.push("nodes", {{"mesh", 0}});
  return file;
}
/// Adds a picture and returns its texture.
int add_picture(GltfBuilder* file, const std::string& png, const Json& sampler = {}) {
  const int view = file->add_view(std::vector<uint8_t>(png.begin(), png.end()));
  const int image = file->push("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  Json texture = {{"source", image}};
  if (!sampler.is_null()) texture["sampler"] = file->push("samplers", sampler);
  return file->push("textures", texture);
}

TEST_F(VisualFile, NodesThatDifferByAMoveShareTheirMesh) {
  GltfBuilder file = triangle_file();
  const float h = std::sqrt(0.5f);
  file.push("nodes", {{"mesh", 0}, {"name", "plain"}});
  file.push("nodes", {{"mesh", 0}, {"rotation", {0, 0, h, h}}, {"translation", {2, 0, 0}}});
  file.push("nodes", {{"mesh", 0}, {"scale", {2, 3, 1}}, {"rotation", {h, 0, 0, h}}});
  file.push("nodes", {{"mesh", 0}, {"scale", {-1, 1, 1}}});
  VisualOptions v = visual(folder.write("a.glb", file.glb()));
  v.body = "arm";
  v.X_BV.p = {0, 0, 10};
  v.X_BV.q = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // a quarter turn about Z
  v.scale = {1, 1, 4};
  v.unit = 0.5;
  const RenderDescription d = described(v);
  const auto p = parts(d);
  ASSERT_EQ(p.size(), 4u);
  // glTF's (x, y, z) is (x, -z, y) here; then sizes, then the turn (x, y) -> (-y, x).
  const auto place = [](Vec3f g) {
    const Vec3f f{0.5f * g.x, -0.5f * g.z, 2 * g.y};
    return Vec3f{-f.y, f.x, f.z + 10};
  };
  const auto turned = [](Vec3f v) { return Vec3f{2 - v.y, v.x, v.z}; };
  const auto raised = [](Vec3f v) { return Vec3f{2 * v.x, -v.z, 3 * v.y}; };
  const auto mirrored = [](Vec3f v) { return Vec3f{-v.x, v.y, v.z}; };
  for (size_t i = 0; i < 3; ++i) {
    expect_near(vertex(d, p[0], i), place(kTriangle[i]), 1e-5f);
    expect_near(vertex(d, p[1], i), place(turned(kTriangle[i])), 1e-5f);
    expect_near(vertex(d, p[2], i), place(raised(kTriangle[i])), 1e-5f);
    expect_near(vertex(d, p[3], i), place(mirrored(kTriangle[i])), 1e-5f);
  }
  for (const InstanceDescription& i : p) {
    expect_near(cross(i.X_BG.x, i.X_BG.y), i.X_BG.z, 1e-6f);
    EXPECT_NEAR(length(i.X_BG.x), 1, 1e-6f);
    const TriangleMesh& m = d.meshes[static_cast<size_t>(i.mesh)];
    expect_near(transform_vector(i.X_BG, m.normals[0]), face_normal(d, i), 1e-5f);
    EXPECT_FALSE(i.is_static);
    EXPECT_EQ(i.label.body, "arm");
  }
  EXPECT_EQ(p[0].label.geom, "lamp/plain");
  EXPECT_EQ(p[1].label.geom, "lamp/part_1");
}

TEST_F(VisualFile, OneMeshServesEveryRigidNodeOfEveryVisualOfTheFile) {
  GltfBuilder file = triangle_file();
  for (int i = 0; i < 20; ++i) {
    const float a = 0.3f * static_cast<float>(i);
    file.push("nodes", {{"mesh", 0},
                        {"rotation", {std::sin(a) * 0.6f, std::sin(a) * 0.8f, 0, std::cos(a)}},
                        {"translation", {a, 0, 0}}});
  }
  const VisualOptions a = visual(folder.write("a.glb", file.glb()));
  VisualOptions b = a;
  b.name = "other";
  b.X_BV.p = {0, 3, 0};
  VisualOptions big = a;
  big.name = "big";
  big.scale = {2, 2, 2};
  const RenderDescription d = describe(world({a, b, big}));
  EXPECT_EQ(parts(d).size(), 60u);
  EXPECT_EQ(d.meshes.size(), 2u);
  // Objects: table, arm, and each visual; its nodes are its parts.
  const auto p = parts(d);
  EXPECT_EQ(p[0].label.instance, p[19].label.instance);
  EXPECT_NE(p[0].label.instance, p[20].label.instance);
  EXPECT_NE(p[0].label.part, p[1].label.part);
  EXPECT_EQ(p[20].label.instance_name, "other");
}

TEST_F(VisualFile, OtherFormatsStandAsTheyAreUnlessToldOtherwise) {
  const auto path = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 0 2\nf 1 2 3\n");
  VisualOptions v = visual(path);
  RenderDescription d = described(v);
  expect_near(vertex(d, parts(d)[0], 2), {0, 0, 2}, 1e-6f);
  v.up = "y";
  d = described(v);
  expect_near(vertex(d, parts(d)[0], 2), {0, -2, 0}, 1e-6f);
  v.file = folder.write("a.glb", [] {
    GltfBuilder file = triangle_file();
    file.push("nodes", {{"mesh", 0}});
    return file.glb();
  }());
  v.up = "z";
  d = described(v);
  expect_near(vertex(d, parts(d)[0], 2), {0, 1, 0}, 1e-6f);
}

TEST_F(VisualFile, MaterialsKeepTheirLayers) {
  const GltfBuilder file = material_file(
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.2, 0.4, 0.6, 0.5}},
         {"metallicFactor", 0.25},
         {"roughnessFactor", 0.75}}},
       {"emissiveFactor", {1, 0.5, 0}},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 400}}},
         {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.8}, {"clearcoatRoughnessFactor", 0.1}}},
         {"KHR_materials_ior", {{"ior", 1.33}}},
         {"KHR_materials_sheen",
          {{"sheenColorFactor", {0.1, 0.2, 0.3}}, {"sheenRoughnessFactor", 0.4}}},
         {"KHR_materials_anisotropy",
          {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 1.5707963}}}}}});
  const RenderDescription d = described(visual(folder.write("a.glb", file.glb())));
  const MaterialDescription& m = material_named(d, "lamp/paint");
  expect_near(m.base_color, {0.2f, 0.4f, 0.6f}, 1e-6f);
  EXPECT_EQ(m.opacity, 1) << "alpha does not count unless the mode says so";
  EXPECT_EQ(m.metallic, 0.25f);
  EXPECT_EQ(m.roughness, 0.75f);
  expect_near(m.emission, {400, 200, 0}, 1e-3f);
  EXPECT_FALSE(m.emits_outwards);
  EXPECT_EQ(m.coat_weight, 0.8f);
  EXPECT_EQ(m.coat_roughness, 0.1f);
  EXPECT_EQ(m.coat_ior, 1.5f);
  EXPECT_EQ(m.coat_darkening, 0) << "glTF's coat leaves the base its colour";
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.fuzz_weight, 1);
  expect_near(m.fuzz_color, {0.1f, 0.2f, 0.3f}, 1e-6f);
  EXPECT_EQ(m.fuzz_roughness, 0.4f);
  EXPECT_EQ(m.anisotropy, 0.6f);
  EXPECT_NEAR(m.anisotropy_rotation, 0.25f, 1e-6f);
}

TEST_F(VisualFile, GlassIsThinWithoutThicknessAndAbsorbsWithIt) {
  Json transmission = {{"transmissionFactor", 0.9}};
  const auto describe_glass = [&](const Json& extensions) {
    const GltfBuilder file = material_file(
        {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.6, 0.7, 1}}, {"metallicFactor", 0}}},
         {"extensions", extensions}});
    VisualOptions v = visual(folder.write("a.glb", file.glb()));
    v.unit = 0.01;
    return material_named(described(v), "lamp/paint");
  };
  MaterialDescription m = describe_glass({{"KHR_materials_transmission", transmission}});
  EXPECT_EQ(m.transmission_weight, 0.9f);
  EXPECT_TRUE(m.thin_walled);
  expect_near(m.transmission_color, {0.5f, 0.6f, 0.7f}, 1e-6f);
  m = describe_glass({{"KHR_materials_transmission", transmission},
                      {"KHR_materials_volume",
                       {{"thicknessFactor", 1},
                        {"attenuationColor", {0.1, 0.2, 0.3}},
                        {"attenuationDistance", 5}}}});
  EXPECT_FALSE(m.thin_walled);
  expect_near(m.transmission_color, {0.1f, 0.2f, 0.3f}, 1e-6f);
  EXPECT_NEAR(m.transmission_depth, 0.05f, 1e-6f) << "in metres, by the visual's unit";
}

TEST_F(VisualFile, TexturesAreTakenChannelByChannel) {
  GltfBuilder file = material_file({{"alphaMode", "MASK"}, {"alphaCutoff", 0.4}});
  // Two texels: alpha 0.2 and 0.6; the packed map has roughness 51, 102 and metalness 153, 204.
  const int color =
      add_picture(&file, png_file(2, 1, 4, {10, 20, 30, 51, 40, 50, 60, 153}), {{"wrapS", 33071}});
  const int packed = add_picture(&file, png_file(2, 1, 3, {1, 51, 153, 2, 102, 204}));
  Json& m = file.json["materials"][0];
  m["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", color}}},
                               {"metallicRoughnessTexture", {{"index", packed}}}};
  m["emissiveTexture"] = {{"index", color}};
  m["emissiveFactor"] = {1, 1, 1};
  const RenderDescription d = described(visual(folder.write("a.glb", file.glb())));
  const MaterialDescription& paint = material_named(d, "lamp/paint");
  EXPECT_EQ(paint.mapping, TextureMapping::kUv);
  EXPECT_FALSE(paint.glows_in_color);
  EXPECT_EQ(paint.textures.occlusion, -1);
  ASSERT_GE(paint.textures.base_color, 0);
  const TextureDescription& base = d.textures[static_cast<size_t>(paint.textures.base_color)];
  EXPECT_THAT(base.faces[0].texels, testing::ElementsAre(10, 20, 30, 0, 40, 50, 60, 255));
  EXPECT_EQ(base.faces[0].color_space, ColorSpace::kSrgb);
  EXPECT_EQ(base.wrap_u, TextureWrap::kClamp);
  EXPECT_EQ(base.wrap_v, TextureWrap::kRepeat);
  EXPECT_EQ(paint.textures.opacity, -1) << "the colour's own alpha says it";
  const auto& orm = d.textures[static_cast<size_t>(paint.textures.orm)].faces[0];
  EXPECT_THAT(orm.texels, testing::ElementsAre(1, 51, 153, 2, 102, 204));
  EXPECT_EQ(orm.color_space, ColorSpace::kLinear);
  const auto& glow = d.textures[static_cast<size_t>(paint.textures.emission)].faces[0];
  EXPECT_EQ(glow.channels, 3);

  // The same without alphaMode is opaque.
  m.erase("alphaMode");
  const RenderDescription opaque = described(visual(folder.write("b.glb", file.glb())));
  const MaterialDescription& p = material_named(opaque, "lamp/paint");
  EXPECT_EQ(opaque.textures[static_cast<size_t>(p.textures.base_color)].faces[0].channels, 3);
}

TEST_F(VisualFile, LayersHaveTexturesOfTheirOwn) {
  GltfBuilder file = material_file(Json::object());
  const int picture = add_picture(&file, png_file(2, 1, 3, {1, 51, 153, 2, 102, 204}));
  file.json["materials"][0]["extensions"] = {
      {"KHR_materials_clearcoat",
       {{"clearcoatFactor", 0.8},
        {"clearcoatTexture", {{"index", picture}}},
        {"clearcoatRoughnessFactor", 0.5},
        {"clearcoatRoughnessTexture", {{"index", picture}}}}},
      {"KHR_materials_transmission",
       {{"transmissionFactor", 0.9}, {"transmissionTexture", {{"index", picture}}}}}};
  const RenderDescription d = described(visual(folder.write("a.glb", file.glb())));
  const MaterialDescription& m = material_named(d, "lamp/paint");
  EXPECT_EQ(m.mapping, TextureMapping::kUv);
  EXPECT_EQ(m.coat_weight, 0.8f);
  EXPECT_EQ(m.coat_roughness, 0.5f);
  EXPECT_EQ(m.transmission_weight, 0.9f);
  const auto texels = [&](int row) {
    EXPECT_GE(row, 0);
    return row < 0 ? std::vector<uint8_t>{} : d.textures[static_cast<size_t>(row)].faces[0].texels;
  };
  EXPECT_THAT(texels(m.textures.coat_weight), testing::ElementsAre(1, 2)) << "red";
  EXPECT_THAT(texels(m.textures.coat_roughness), testing::ElementsAre(51, 102)) << "green";
  EXPECT_THAT(texels(m.textures.transmission), testing::ElementsAre(1, 2)) << "red";
  EXPECT_EQ(notes(d), "");
}

TEST_F(VisualFile, UvTransformsGoIntoTheMeshOrTheRepeats) {
  GltfBuilder file = material_file({});
  const int texture = add_picture(&file, png_file(1, 1, 3, {1, 2, 3}));
  const auto with = [&](const Json& transform) {
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", texture}, {"extensions", {{"KHR_texture_transform", transform}}}};
    return described(visual(folder.write("a.glb", file.glb())));
  };
  RenderDescription d = with({{"scale", {2, 3}}});
  EXPECT_EQ(material_named(d, "lamp/paint").texture_repeat.y, 3);
  EXPECT_EQ(d.meshes[0].uvs[1].x, 1);
  d = with({{"offset", {0.25, 0.5}}, {"rotation", 0.5}, {"scale", {2, 3}}});
  EXPECT_EQ(material_named(d, "lamp/paint").texture_repeat.y, 1);
  // By the extension: offset * rotation * scale of (u, v), v downwards; (1, 0) and (0, 1).
  const float c = std::cos(0.5f), s = std::sin(0.5f);
  const Vec2f u = d.meshes[0].uvs[1], v = d.meshes[0].uvs[2];
  EXPECT_NEAR(u.x, 2 * c + 0.25f, 1e-6f);
  EXPECT_NEAR(1 - u.y, -2 * s + 0.5f, 1e-6f);
  EXPECT_NEAR(v.x, 3 * s + 0.25f, 1e-6f);
  EXPECT_NEAR(1 - v.y, 3 * c + 0.5f, 1e-6f);
}

TEST_F(VisualFile, UnlitShinesByItsColourAndReflectsNothing) {
  const GltfBuilder file =
      material_file({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}},
                     {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  const MaterialDescription m =
      material_named(described(visual(folder.write("a.glb", file.glb()))), "lamp/paint");
  expect_near(m.emission, {50, 25, 100}, 1e-4f);
  expect_near(m.base_color, {0, 0, 0}, 0);
  EXPECT_EQ(m.specular_weight, 0);
  EXPECT_EQ(m.metallic, 0);
}

TEST_F(VisualFile, LampsShineWhereTheirNodesAre) {
  GltfBuilder file = triangle_file();
  file.push("nodes", {{"mesh", 0}});
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"intensity", 50},
       {"color", {1, 0.5, 0.25}},
       {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.6}}}},
      {{"type", "directional"}, {"intensity", 1000}}};
  const auto lamp = [](int light) { return Json{{"KHR_lights_punctual", {{"light", light}}}}; };
  file.push("nodes", {{"name", "bulb"}, {"translation", {1, 2, 3}}, {"extensions", lamp(0)}});
  file.push("nodes", {{"extensions", lamp(1)}, {"scale", {2, 2, 2}}});
  VisualOptions v = visual(folder.write("a.glb", file.glb()));
  v.body = "arm";
  const RenderDescription d = described(v);
  ASSERT_EQ(d.lights.size(), 3u);  // and the headlight
  const LightDescription &spot = d.lights[0], &sun = d.lights[1];
  EXPECT_EQ(spot.name, "lamp/bulb");
  EXPECT_EQ(spot.type, PunctualLightType::kSpot);
  expect_near(spot.intensity, {50, 25, 12.5f}, 1e-5f);
  EXPECT_NEAR(spot.cos_cutoff, std::cos(0.6f), 1e-6f);
  EXPECT_NEAR(spot.softness, 0.5f, 1e-6f);
  EXPECT_EQ(spot.light, -1);
  EXPECT_GT(spot.body, 0);
  expect_near(spot.X_BL.p, {1, -3, 2}, 1e-6f);
  expect_near(-spot.X_BL.z, {0, 1, 0}, 1e-6f);  // glTF's -z
  EXPECT_EQ(sun.type, PunctualLightType::kDirectional);
  EXPECT_EQ(sun.intensity.x, 1000);
  EXPECT_NEAR(length(sun.X_BL.z), 1, 1e-6f);
  EXPECT_FALSE(d.lights[2].active) << "the automatic headlight yields to lamps of known strength";
}

TEST_F(VisualFile, ObjBringsItsLibraryAndHeights) {
  folder.write("h.png", png_file(2, 1, 1, {0, 255}));
  folder.write("n.png", png_file(2, 1, 3, {128, 128, 255, 120, 130, 250}));
  folder.write("a.mtl",
               "newmtl rough\nKd 0.1 0.2 0.3\nPr 0.3\nPm 0.5\nmap_Bump -bm 2 h.png\n"
               "newmtl tilted\nmap_Bump n.png\n");
  const auto path = folder.write("a.obj",
                                 "mtllib a.mtl\nv 0 0 0\nv 4 0 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                 "usemtl rough\nf 1/1 2/2 3/3\nusemtl tilted\nf 3/3 2/2 1/1\n");
  const RenderDescription d = described(visual(path));
  const MaterialDescription& m = material_named(d, "lamp/rough");
  expect_near(m.base_color, {0.1f, 0.2f, 0.3f}, 1e-6f);
  EXPECT_EQ(m.roughness, 0.3f);
  EXPECT_EQ(m.metallic, 0.5f);
  ASSERT_GE(m.textures.bump, 0);
  EXPECT_NEAR(m.bump_scale, 0.08f, 1e-6f) << "2 x 1 % of the 4 m that the texture spans";
  EXPECT_EQ(material_named(d, "lamp/tilted").textures.bump, -1);
  EXPECT_GE(material_named(d, "lamp/tilted").textures.normal, 0);
  EXPECT_THAT(notes(d), HasSubstr("looks like a normal map"));
}

TEST_F(VisualFile, MaterialTablesReachItsMaterials) {
  const GltfBuilder file =
      material_file({{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.8}}}}}});
  CompiledWorld w = world({visual(folder.write("a.glb", file.glb()))});
  MaterialOptions o;
  o.name = "lamp/*";
  o.base_color = Vec3{0.5, 0.25, 0.125};
  o.dust = 0.5;
  o.bump = folder.write("h.png", png_file(2, 1, 1, {0, 255}));
  o.coat_weight_map = folder.write("c.png", png_file(2, 1, 1, {10, 20}));
  w.scene.materials = {o};
  const RenderDescription d = describe(w);
  const MaterialDescription& m = material_named(d, "lamp/paint");
  EXPECT_EQ(m.base_color.x, 0.5f);
  EXPECT_EQ(m.dust, 0.5f);
  EXPECT_EQ(m.coat_weight, 0.8f) << "what the table does not say stays the file's";
  EXPECT_EQ(m.bump_scale, 0.001f);
  ASSERT_GE(m.textures.coat_weight, 0);
  EXPECT_THAT(d.textures[static_cast<size_t>(m.textures.coat_weight)].faces[0].texels,
              testing::ElementsAre(10, 20));
  EXPECT_EQ(d.textures[static_cast<size_t>(m.textures.bump)].faces[0].color_space,
            ColorSpace::kLinear);
}

TEST_F(VisualFile, IsAnObjectInTheWorldAndAPartOfItsBodyElsewhere) {
  GltfBuilder file = triangle_file();
  file.push("nodes", {{"mesh", 0}});
  VisualOptions fixed = visual(folder.write("a.glb", file.glb())), carried = fixed;
  carried.name = "sleeve";
  carried.body = "arm";
  const RenderDescription d = describe(world({fixed, carried}));
  const auto p = parts(d);
  EXPECT_EQ(p[0].label.instance_name, "lamp");
  EXPECT_TRUE(p[0].is_static);
  EXPECT_EQ(p[1].label.instance_name, "arm");
  // The arm has something to show now, so its collision shape stays hidden.
  for (const InstanceDescription& i : d.instances) EXPECT_EQ(i.shown, i.group != 3);
}

TEST_F(VisualFile, BadInputIsNamed) {
  GltfBuilder file = triangle_file();
  file.push("nodes", {{"mesh", 0}});
  const std::string glb = file.glb();
  VisualOptions v = visual(folder.write("a.glb", glb));
  v.body = "amr";
  EXPECT_THAT(error(v), testing::AllOf(HasSubstr("scene.toml:3"), HasSubstr("no body 'amr'"),
                                       HasSubstr("did you mean 'arm'")));
  v = visual(folder.write("cut.glb", glb.substr(0, glb.size() / 2)));
  EXPECT_THAT(error(v), testing::AllOf(HasSubstr("scene.toml:3"), HasSubstr("cut.glb"),
                                       HasSubstr("visual 'lamp'")));
  EXPECT_THAT(error(visual(folder.write("a.fbx", "Kaydara FBX Binary"))),
              testing::AllOf(HasSubstr("not a glTF"), HasSubstr("GLB")));
  EXPECT_THAT(error(visual(folder.path / "none.glb")), HasSubstr("none.glb"));
  EXPECT_THAT(error(visual(folder.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"))),
              HasSubstr("finite"));
  v = visual(folder.write("far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n"));
  EXPECT_THAT(error(v), HasSubstr("unit"));
  // A picture outside the scene's root.
  folder.write("secret.png", png_file(1, 1, 3, {1, 2, 3}));
  folder.write("in/a.mtl", "newmtl m\nmap_Kd ../secret.png\n");
  CompiledWorld w = world({visual(
      folder.write("in/a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))});
  w.scene.access.strict = true;
  w.scene.file = folder.path / "in/scene.toml";
  EXPECT_THAT(visual_test::refusal(w), HasSubstr("leads outside of the folder"));
}

TEST_F(VisualFile, TrianglesWithoutAreaAreLeftOutAndSaid) {
  const auto path = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");
  const RenderDescription d = described(visual(path));
  EXPECT_EQ(d.meshes.at(0).triangle_count(), 1u);
  EXPECT_THAT(notes(d), HasSubstr("1 triangles without area"));
}

TEST_F(VisualFile, PicturesThatCannotBeReadAreSaid) {
  GltfBuilder file = material_file({});
  const int texture = add_picture(&file, "no picture");
  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
  const RenderDescription d = described(visual(folder.write("a.glb", file.glb())));
  EXPECT_EQ(material_named(d, "lamp/paint").textures.base_color, -1);
  EXPECT_THAT(notes(d), HasSubstr("an image is ignored"));
}

TEST_F(VisualFile, ASecondStartReadsTheCache) {
  GltfBuilder file = triangle_file();
  file.push("nodes", {{"mesh", 0}});
  const VisualOptions v = visual(folder.write("a.glb", file.glb()));
  const RenderDescription first = described(v);
  finish_cache_writes();
  const auto entries = [&] {
    return std::distance(std::filesystem::directory_iterator(folder.path / "cache/visuals"), {});
  };
  EXPECT_EQ(entries(), 1);
  const RenderDescription second = described(v);
  EXPECT_EQ(entries(), 1);
  EXPECT_TRUE(first.meshes[0].positions == second.meshes[0].positions);
}

}  // namespace
}  // namespace gloam

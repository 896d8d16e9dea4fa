// Accessors, primitives and nodes of glTF, value by value.

#include <gmock/gmock.h>

#include "geometry/test/gltf_builder.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<Vec3f> kSquare = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};

ModelFile read_ok(const GltfBuilder& file) {
  Result<ModelFile> text = read_text(file.gltf(), "test.gltf");
  EXPECT_TRUE(text.ok()) << error_of(text);
  Result<ModelFile> binary = read_text(file.glb(), "test.glb");
  EXPECT_TRUE(binary.ok()) << error_of(binary);
  if (!text.ok() || !binary.ok()) return {};
  EXPECT_EQ(text->meshes.size(), binary->meshes.size());
  for (size_t i = 0; i < text->meshes.size(); ++i) {
    EXPECT_EQ(text->meshes[i].positions, binary->meshes[i].positions);
    EXPECT_EQ(text->meshes[i].indices, binary->meshes[i].indices);
  }
  return std::move(*text);
}

std::string error_for(const GltfBuilder& file) {
  return error_of(read_text(file.gltf(), "test.gltf"));
}

TEST(GltfMesh, IndicesOfEveryTypeNameTheSameTriangles) {
  for (const int type : {5121, 5123, 5125}) {
    GltfBuilder file;
    const int positions = file.add_positions(kSquare);
    const std::vector<uint32_t> corners = {0, 1, 2, 2, 1, 3};
    int indices = 0;
    if (type == 5121)
      indices = file.add_accessor(std::vector<uint8_t>(corners.begin(), corners.end()), "SCALAR",
                                  type, 6);
    if (type == 5123)
      indices = file.add_accessor(std::vector<uint16_t>(corners.begin(), corners.end()), "SCALAR",
                                  type, 6);
    if (type == 5125) indices = file.add_accessor(corners, "SCALAR", type, 6);
    file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    const ModelFile model = read_ok(file);
    ASSERT_EQ(model.meshes.size(), 1u);
    EXPECT_EQ(model.meshes[0].positions, kSquare);
    EXPECT_EQ(model.meshes[0].indices, corners);
    EXPECT_TRUE(model.meshes[0].normals.empty());
  }
}

TEST(GltfMesh, StripsAndFansKeepTheWinding) {
  const std::vector<Vec3f> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 1}};
  GltfBuilder file;
  const int positions = file.add_positions(points);
  file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 5}});
  file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 6}});
  file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 1}});
  const ModelFile model = read_ok(file);
  ASSERT_EQ(model.meshes.size(), 2u);
  EXPECT_THAT(model.meshes[0].indices, ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4));
  EXPECT_THAT(model.meshes[1].indices, ElementsAre(1, 2, 0, 2, 3, 0, 3, 4, 0));
  EXPECT_THAT(model.notes, ElementsAre("points and lines are ignored"));
}

TEST(GltfMesh, ComponentsOfEveryTypeAreReadAndNormalised) {
  struct Case {
    int type;
    bool normalized;
    std::vector<uint8_t> bytes;  // of (lowest, highest)
    Vec2f uv;                    // v as in the file
  };
  const std::vector<Case> cases = {
      {5120, false, {0x80, 0x7f, 0, 0}, {-128, 127}},
      {5120, true, {0x80, 0x7f, 0, 0}, {-1, 1}},
      {5121, false, {0, 0xff, 0, 0}, {0, 255}},
      {5121, true, {0x33, 0xff, 0, 0}, {0.2f, 1}},
      {5122, false, {0x00, 0x80, 0xff, 0x7f}, {-32768, 32767}},
      {5122, true, {0x00, 0x80, 0xff, 0x7f}, {-1, 1}},
      {5123, false, {1, 0, 0xff, 0xff}, {1, 65535}},
      {5123, true, {0x33, 0x33, 0xff, 0xff}, {0.2f, 1}},
      {5125, false, {1, 0, 0, 0, 0, 0, 1, 0}, {1, 65536}},
      {5125, true, {0, 0, 0, 0, 0xff, 0xff, 0xff, 0xff}, {0, 1}},
      {5126, false, {0, 0, 0x80, 0x3f, 0, 0, 0, 0x40}, {1, 2}},
  };
  for (const Case& c : cases) {
    GltfBuilder file;
    const int positions = file.add_positions({kSquare[0], kSquare[1], kSquare[2]});
    std::vector<uint8_t> three;
    for (int i = 0; i < 3; ++i) three.insert(three.end(), c.bytes.begin(), c.bytes.end());
    const int uvs =
        file.add_accessor(three, "VEC2", c.type, 3, c.normalized, static_cast<int>(c.bytes.size()));
    file.add_mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}});
    const ModelFile model = read_ok(file);
    ASSERT_EQ(model.meshes.size(), 1u);
    for (const Vec2f uv : model.meshes[0].uvs)
      EXPECT_EQ(uv, (Vec2f{c.uv.x, 1 - c.uv.y})) << c.type << " " << c.normalized;
  }
}

TEST(GltfMesh, InterleavedVerticesAreTakenApart) {
  // position, normal, uv, second uv: 40 bytes a vertex.
  std::vector<float> rows;
  for (int i = 0; i < 3; ++i) {
    const Vec3f p = kSquare[static_cast<size_t>(i)];
    const float f = static_cast<float>(i);
    rows.insert(rows.end(), {p.x, p.y, p.z, 0, 0, 1, f, 0.25f, 0.5f, f});
  }
  GltfBuilder file;
  const int view = file.add_view(rows, 40);
  const auto add = [&](int offset, const char* type) {
    return file.push("accessors", {{"bufferView", view},
                                   {"byteOffset", offset},
                                   {"componentType", 5126},
                                   {"type", type},
                                   {"count", 3}});
  };
  file.add_mesh({{"attributes",
                  {{"POSITION", add(0, "VEC3")},
                   {"NORMAL", add(12, "VEC3")},
                   {"TEXCOORD_0", add(24, "VEC2")},
                   {"TEXCOORD_1", add(32, "VEC2")}}}});
  const ModelFile model = read_ok(file);
  ASSERT_EQ(model.meshes.size(), 1u);
  const TriangleMesh& mesh = model.meshes[0];
  EXPECT_THAT(mesh.positions, ElementsAre(kSquare[0], kSquare[1], kSquare[2]));
  EXPECT_THAT(mesh.normals, ElementsAre(Vec3f{0, 0, 1}, Vec3f{0, 0, 1}, Vec3f{0, 0, 1}));
  EXPECT_THAT(mesh.uvs, ElementsAre(Vec2f{0, 0.75f}, Vec2f{1, 0.75f}, Vec2f{2, 0.75f}));
  EXPECT_THAT(mesh.uvs1, ElementsAre(Vec2f{0.5f, 1}, Vec2f{0.5f, 0}, Vec2f{0.5f, -1}));
}

TEST(GltfMesh, SparseAccessorsReplaceElements) {
  for (const bool on_zeros : {false, true}) {
    GltfBuilder file;
    json accessor = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}};
    if (!on_zeros) accessor["bufferView"] = file.add_view(kSquare);
    const int at = file.add_view(std::vector<uint8_t>{1, 2, 3});
    const int values = file.add_view(std::vector<Vec3f>{{5, 6, 7}, {8, 9, 10}, {1, 2, 4}});
    accessor["sparse"] = {{"count", 3},
                          {"indices", {{"bufferView", at}, {"componentType", 5121}}},
                          {"values", {{"bufferView", values}}}};
    const int positions = file.push("accessors", accessor);
    file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 5}});
    const ModelFile model = read_ok(file);
    ASSERT_EQ(model.meshes.size(), 1u);
    EXPECT_THAT(model.meshes[0].positions,
                ElementsAre(Vec3f{0, 0, 0}, Vec3f{5, 6, 7}, Vec3f{8, 9, 10}, Vec3f{1, 2, 4}));
  }
}

TEST(GltfMesh, TrianglesWithoutAreaAreDroppedAndCounted) {
  GltfBuilder file;
  const int positions = file.add_positions({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}});
  const int indices =
      file.add_accessor(std::vector<uint8_t>{0, 1, 2, 0, 1, 3, 3, 3, 1}, "SCALAR", 5121, 9);
  file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  const ModelFile model = read_ok(file);
  EXPECT_EQ(model.dropped_triangles, 2u);
  EXPECT_THAT(model.meshes[0].indices, ElementsAre(0, 1, 3));
}

TEST(GltfMesh, NodesStackUpAndTurnFromYUpToZUp) {
  GltfBuilder file;
  file.add_triangle();  // node 0
  file.json["nodes"][0]["name"] = "leaf";
  file.json["nodes"][0]["matrix"] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 0, 0, 1};
  file.push("nodes", {{"children", {0}},
                      {"translation", {0, 3, 0}},
                      {"rotation", {0, 0, 0.70710678, 0.70710678}},  // 90 degrees about z
                      {"scale", {1, 1, -1}}});
  const ModelFile model = read_ok(file);
  ASSERT_EQ(model.instances.size(), 1u);
  const ImportedInstance& leaf = model.instances[0];
  EXPECT_EQ(leaf.name, "leaf");
  EXPECT_EQ(leaf.material, -1);
  // (1, 2, 3) -> leaf (3, 4, 6) -> scaled (3, 4, -6) -> turned (-4, 3, -6) -> moved (-4, 6, -6)
  // -> Z up (-4, 6, 6).
  const Vec3f p = transform_point(leaf.X_FI, {1, 2, 3});
  EXPECT_NEAR(p.x, -4, 1e-5);
  EXPECT_NEAR(p.y, 6, 1e-5);
  EXPECT_NEAR(p.z, 6, 1e-5);
}

TEST(GltfMesh, TheSceneChoosesItsNodes) {
  GltfBuilder file;
  file.add_triangle();
  file.push("nodes", {{"mesh", 0}, {"name", "other"}});
  file.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  file.json["scene"] = 1;
  const ModelFile model = read_ok(file);
  ASSERT_EQ(model.instances.size(), 1u);
  EXPECT_EQ(model.instances[0].name, "other");
}

TEST(GltfMesh, LightsKeepTheirUnits) {
  GltfBuilder file;
  file.add_triangle();
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"intensity", 800},
       {"color", {1, 0.5, 0.25}},
       {"range", 7},
       {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
      {{"type", "directional"}, {"intensity", 100000}, {"name", "sun"}},
      {{"type", "point"}}};
  for (const int i : {0, 1, 2})
    file.push("nodes", {{"translation", {0, 5, i}},
                        {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const ModelFile model = read_ok(file);
  ASSERT_EQ(model.lights.size(), 3u);
  const ImportedLight& spot = model.lights[0];
  EXPECT_EQ(spot.type, ImportedLightType::kSpot);
  EXPECT_EQ(spot.intensity, 800);
  EXPECT_EQ(spot.color, (Vec3f{1, 0.5f, 0.25f}));
  EXPECT_EQ(spot.range, 7);
  EXPECT_EQ(spot.inner_cone, 0.25f);
  EXPECT_EQ(spot.outer_cone, 0.5f);
  EXPECT_EQ(spot.X_FL.p, (Vec3f{0, 0, 5}));
  EXPECT_EQ(-spot.X_FL.z, (Vec3f{0, 1, 0}));  // glTF's -z points along F's +y
  EXPECT_EQ(model.lights[1].type, ImportedLightType::kDirectional);
  EXPECT_EQ(model.lights[1].name, "sun");
  EXPECT_EQ(model.lights[1].X_FL.p, (Vec3f{0, -1, 5}));
  EXPECT_EQ(model.lights[2].type, ImportedLightType::kPoint);
  EXPECT_EQ(model.lights[2].intensity, 1);
}

// --- what is wrong with a file is said with its place ---

TEST(GltfErrors, CyclesAndTwoParentsAreRefused) {
  GltfBuilder file;
  file.add_triangle();
  file.json["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}};
  EXPECT_THAT(error_for(file), HasSubstr("is its own ancestor"));
  file.json["nodes"] = {{{"children", {0}}}};
  EXPECT_THAT(error_for(file), HasSubstr("/nodes/0: is its own ancestor"));
  file.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  EXPECT_THAT(error_for(file), HasSubstr("/nodes/1/children/0: node 2 has two parents"));
}

TEST(GltfErrors, DeepHierarchiesAreFine) {
  GltfBuilder file;
  file.add_triangle();
  for (int i = 0; i < 20000; ++i) file.push("nodes", {{"children", {i}}});
  EXPECT_EQ(read_ok(file).instances.size(), 1u);
}

TEST(GltfErrors, UnknownRequiredExtensionsAreNamed) {
  GltfBuilder file;
  file.add_triangle();
  file.json["extensionsRequired"] = {"KHR_texture_transform", "KHR_draco_mesh_compression"};
  EXPECT_THAT(error_for(file), HasSubstr("'KHR_draco_mesh_compression'"));
  EXPECT_THAT(error_for(file), HasSubstr("/extensionsRequired/1"));
  EXPECT_THAT(error_for(file), HasSubstr("test.gltf"));
  file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_TRUE(read_text(file.gltf(), "test.gltf").ok());
}

TEST(GltfErrors, NumbersOutsideTheirRangesAreRefused) {
  const auto with = [](const char* pointer, const json& value) {
    GltfBuilder file;
    file.add_triangle();
    file.json[json::json_pointer(pointer)] = value;
    return error_for(file);
  };
  EXPECT_THAT(with("/nodes/0/mesh", 7),
              HasSubstr("/nodes/0/mesh: refers to mesh 7, but there are 1"));
  EXPECT_THAT(with("/nodes/0/mesh", -1), HasSubstr("/nodes/0/mesh: is -1"));
  EXPECT_THAT(with("/nodes/0/mesh", 0.5), HasSubstr("an integer"));
  EXPECT_THAT(with("/nodes/0/mesh", "0"), HasSubstr("must be a number, not string"));
  EXPECT_THAT(with("/nodes/0/scale", {1, 2}), HasSubstr("/nodes/0/scale: must contain 3 numbers"));
  EXPECT_THAT(with("/nodes/0/scale", {1, 2, 1e300}), HasSubstr("/nodes/0/scale/2"));
  EXPECT_THAT(with("/nodes/0/rotation", {0, 0, 0, 0}), HasSubstr("not a rotation"));
  EXPECT_THAT(with("/accessors/0/count", 4), HasSubstr("do not fit into buffer view 0"));
  EXPECT_THAT(with("/accessors/0/count", 1e12), HasSubstr("the limit is"));
  EXPECT_THAT(with("/accessors/0/componentType", 5124), HasSubstr("not a component type"));
  EXPECT_THAT(with("/accessors/0/byteOffset", 9e15), HasSubstr("do not fit"));
  EXPECT_THAT(with("/bufferViews/0/byteOffset", 9e15), HasSubstr("outside of buffer 0"));
  EXPECT_THAT(with("/bufferViews/0/byteStride", 4), HasSubstr("but an element has"));
  EXPECT_THAT(with("/asset/version", "1.0"), HasSubstr("only glTF 2"));
  EXPECT_THAT(with("/materials", {{{"pbrMetallicRoughness", {{"roughnessFactor", 2}}}}}),
              HasSubstr("/materials/0/pbrMetallicRoughness/roughnessFactor: is 2"));
  EXPECT_EQ(with("/nodes/0/scale", {1, 2, 3}), "no error");
}

TEST(GltfErrors, AnIndexOutOfRangeAndANanAreNamed) {
  GltfBuilder file;
  int positions = file.add_positions(kSquare);
  const int indices = file.add_accessor(std::vector<uint8_t>{0, 1, 2, 2, 1, 4}, "SCALAR", 5121, 6);
  file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  EXPECT_THAT(error_for(file),
              HasSubstr("/meshes/0/primitives/0: triangle 1 uses vertex 4, but there are 4"));
  GltfBuilder nan;
  positions = nan.add_positions({{0, 0, 0}, {1, 0, std::numeric_limits<float>::quiet_NaN()}, {}});
  nan.add_mesh({{"attributes", {{"POSITION", positions}}}});
  EXPECT_THAT(error_for(nan), HasSubstr("the position of vertex 1 is not finite"));
}

TEST(GltfErrors, DeepAndCrowdedJsonIsRefusedBeforeItIsParsed) {
  const std::string deep = "{\"asset\":" + std::string(1000000, '[');
  EXPECT_THAT(error_of(read_text(deep, "a.gltf")), HasSubstr("nested more than 64 levels deep"));
  const std::string crowded = "{\"asset\":[" + std::string(kMaxJsonValues, ',') + "]}";
  EXPECT_THAT(error_of(read_text(crowded, "a.gltf")), HasSubstr("values; the limit is"));
  EXPECT_THAT(error_of(read_text("{\"asset\": {\"version\": ", "a.gltf")),
              HasSubstr("not JSON: syntax error at byte"));
}

TEST(GltfErrors, OneAccessorUsedByManyPrimitivesMeetsTheMemoryLimit) {
  GltfBuilder file;
  const int positions = file.add_positions(std::vector<Vec3f>(999));
  json primitives = json::array();
  for (int i = 0; i < 1000; ++i) primitives.push_back({{"attributes", {{"POSITION", positions}}}});
  file.push("meshes", {{"primitives", primitives}});
  ModelFileOptions options;
  options.limits.decoded_bytes = 1 << 20;
  EXPECT_THAT(error_of(read_text(file.gltf(), "a.gltf", options)),
              HasSubstr("exceed the size limit when decoded"));
}

TEST(GltfErrors, ACutGlbIsRefusedAtEveryLength) {
  GltfBuilder file;
  file.add_triangle();
  const std::string whole = file.glb();
  ASSERT_TRUE(read_text(whole, "a.glb").ok());
  for (size_t n = 4; n < whole.size(); ++n)
    EXPECT_FALSE(read_text(whole.substr(0, n), "a.glb").ok()) << n;
}

TEST(GltfFiles, BuffersAndImagesAreReadFromBesideTheModelOnly) {
  GltfBuilder file;
  file.add_triangle();
  file.json["images"] = {{{"uri", "wood%20grain.png"}}};
  const TestFolder folder;
  folder.write("model/data.bin", std::string(file.bin.begin(), file.bin.end()));
  folder.write("model/wood grain.png", "picture");
  folder.write("secret.bin", std::string(100, 'x'));
  const auto path = folder.write("model/m.gltf", file.gltf_with_file("data.bin"));
  Result<ModelFile> model = read_model_file(path);
  ASSERT_TRUE(model.ok()) << error_of(model);
  EXPECT_EQ(model->meshes[0].positions[1], (Vec3f{1, 0, 0}));
  EXPECT_EQ(model->images[0].name, "wood grain.png");
  EXPECT_EQ(std::string(model->images[0].bytes.begin(), model->images[0].bytes.end()), "picture");

  std::filesystem::create_symlink("../secret.bin", folder.path / "model/link.bin");
  for (const std::string uri :
       {"../secret.bin", "%2e%2e/secret.bin", "link.bin", "/etc/passwd", "file:///etc/passwd",
        "http://example.org/a.bin", "a/../../secret.bin"}) {
    folder.write("model/m.gltf", file.gltf_with_file(uri));
    const std::string error = error_of(read_model_file(path));
    EXPECT_THAT(error,
                testing::AnyOf(HasSubstr("leads outside of the folder"),
                               HasSubstr("is an absolute path"), HasSubstr("network address")))
        << uri;
    EXPECT_THAT(error, HasSubstr("/buffers/0"));
  }
  ModelFileOptions wide;
  wide.root = folder.path;
  folder.write("model/m.gltf", file.gltf_with_file("../secret.bin"));
  EXPECT_TRUE(read_model_file(path, wide).ok());
  wide.root = folder.path / "elsewhere";
  EXPECT_THAT(error_of(read_model_file(path, wide)), HasSubstr("is outside of the root folder"));
  folder.write("model/m.gltf", file.gltf_with_file("missing.bin"));
  EXPECT_THAT(error_of(read_model_file(path)), HasSubstr("'missing.bin' is missing"));
  folder.write("model/data.bin", "short");
  folder.write("model/m.gltf", file.gltf_with_file("data.bin"));
  EXPECT_THAT(error_of(read_model_file(path)), HasSubstr("must have 36 bytes, but has 5"));
}

}  // namespace
}  // namespace gloam

// COLLADA, colours at vertices, and text as other programs write it.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/plain_text.h"
#include "geometry/image/image_file.h"
#include "geometry/test/gltf_builder.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// `asset`, `primitive` of the geometry g, `nodes` of the scene, `more` libraries.
std::string dae(const std::string& asset, const std::string& primitive, const std::string& nodes,
                const std::string& more = "") {
  return "<?xml version='1.0'?>\n<COLLADA version='1.4.1'><asset>" + asset +
         "</asset>\n<library_geometries><geometry id='g'><mesh>"
         "<source id='p'><float_array id='pa' count='12'>0 0 0 1 0 0\n1 1 0 0 1 0</float_array>"
         "<technique_common><accessor source='#pa' count='4' stride='3'/></technique_common>"
         "</source><source id='n'><float_array id='na' count='3'>0 0 2</float_array>"
         "<technique_common><accessor source='#na' count='1' stride='3'/></technique_common>"
         "</source><source id='t'><float_array id='ta' count='4'>0 0 1 0.5</float_array>"
         "<technique_common><accessor source='#ta' count='2' stride='2'/></technique_common>"
         "</source><vertices id='v'><input semantic='POSITION' source='#p'/></vertices>" +
         primitive + "</mesh></geometry></library_geometries>\n" + more +
         "<library_visual_scenes><visual_scene id='s'>" + nodes +
         "</visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url='#s'/></scene></COLLADA>";
}

const char* const kSquareDae =
    "<polylist count='1' material='m'><input semantic='VERTEX' source='#v' offset='0'/>"
    "<input semantic='NORMAL' source='#n' offset='1'/>"
    "<input semantic='TEXCOORD' source='#t' offset='2' set='0'/>"
    "<vcount>4</vcount><p>0 0 0 1 0 1 2 0 1 3 0 0</p></polylist>";
const char* const kTriangle =
    "<triangles count='1'><input semantic='VERTEX' source='#v' offset='0'/><p>0 1 "
    "2</p></triangles>";
const char* const kNode = "<node id='a'><instance_geometry url='#g'/></node>";

ModelFile read_ok(const std::string& text, const std::string& name = "a.dae") {
  Result<ModelFile> model = read_text(text, name);
  EXPECT_TRUE(model.ok()) << error_of(model);
  return model.ok() ? std::move(*model) : ModelFile{};
}
std::string error_for(const std::string& text, const std::string& name = "a.dae") {
  return error_of(read_text(text, name));
}

Vec3f place(const ModelFile& model, Vec3f p, size_t instance = 0) {
  return transform_point(model.instances.at(instance).X_FI, p);
}
void expect_near(Vec3f a, Vec3f b) { EXPECT_LT(length(a - b), 1e-5f) << testing::PrintToString(a); }

TEST(Collada, PolygonsOfSeveralInputsBecomeTriangles) {
  const ModelFile model = read_ok(dae("<up_axis>Z_UP</up_axis>", kSquareDae, kNode));
  ASSERT_EQ(model.meshes.size(), 1u);
  const TriangleMesh& mesh = model.meshes[0];
  EXPECT_EQ(mesh.triangle_count(), 2u);
  EXPECT_THAT(mesh.positions,
              ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}));
  EXPECT_EQ(mesh.normals, std::vector<Vec3f>(4, Vec3f{0, 0, 1}));
  EXPECT_THAT(mesh.uvs, ElementsAre(Vec2f{0, 0}, Vec2f{1, 0.5f}, Vec2f{1, 0.5f}, Vec2f{0, 0}));
  EXPECT_EQ(model.instances.at(0).name, "a");
}

TEST(Collada, UnitAndUpAxisAreUndone) {
  const std::string unit = "<unit meter='0.5'/>";
  expect_near(place(read_ok(dae(unit + "<up_axis>Z_UP</up_axis>", kTriangle, kNode)), {1, 2, 4}),
              {0.5f, 1, 2});
  for (const char* up : {"", "<up_axis> Y_UP\n</up_axis>"})
    expect_near(place(read_ok(dae(unit + up, kTriangle, kNode)), {1, 2, 4}), {0.5f, -2, 1});
  expect_near(place(read_ok(dae(unit + "<up_axis>X_UP</up_axis>", kTriangle, kNode)), {1, 2, 4}),
              {-1, -2, 0.5f});
  EXPECT_THAT(error_for(dae("<unit meter='0'/>", kTriangle, kNode)), HasSubstr("a.dae:2: <unit>"));
}

TEST(Collada, NodesAreFlattened) {
  const ModelFile model = read_ok(
      dae("<up_axis>Z_UP</up_axis>", kTriangle,
          "<node id='top'><translate>1 0 0</translate><rotate>0 0 1 90</rotate><scale>2 2 2</scale>"
          "<node name='inner'><matrix>1 0 0 0 0 1 0 0 0 0 -1 3 0 0 0 1</matrix>"
          "<instance_geometry url='#g'/></node><instance_node url='#shared'/></node>",
          "<library_nodes><node id='shared'><instance_geometry url='#g'/></node></library_nodes>"));
  ASSERT_EQ(model.instances.size(), 2u);
  EXPECT_EQ(model.meshes.size(), 1u);
  expect_near(place(model, {1, 0, 1}, 1), {1, 2, 6 - 2});
  const Affine3f& X = model.instances[1].X_FI;
  EXPECT_LT(dot(X.x, cross(X.y, X.z)), 0) << "mirrored";
  expect_near(place(model, {1, 0, 1}, 0), {1, 2, 2});
}

TEST(Collada, EffectsBecomeMaterials) {
  const auto file = [&](const std::string& phong) {
    return read_ok(dae(
        "", kSquareDae,
        "<node><instance_geometry url='#g'><bind_material><technique_common>"
        "<instance_material symbol='m' target='#red'/></technique_common></bind_material>"
        "</instance_geometry></node>",
        "<library_materials><material id='red' name='paint'><instance_effect url='#e'/></material>"
        "</library_materials><library_effects><effect id='e'><profile_COMMON>"
        "<newparam sid='half'><float>0.5</float></newparam>"
        "<technique sid='t'><phong>" +
            phong + "</phong></technique></profile_COMMON></effect></library_effects>"));
  };
  const ModelFile red = file("<diffuse><color>1 0 0.5 1</color></diffuse>");
  ASSERT_EQ(red.materials.size(), 1u);
  EXPECT_EQ(red.instances.at(0).material, 0);
  EXPECT_EQ(red.materials[0].name, "paint");
  expect_near(red.materials[0].base_color, {1, 0, 0.21404f});
  EXPECT_EQ(red.materials[0].alpha_mode, AlphaMode::kOpaque);
  const ModelFile glass = file(
      "<diffuse><color>1 1 1 1</color></diffuse>"
      "<transparency><param ref='half'/></transparency>");
  EXPECT_FLOAT_EQ(glass.materials.at(0).opacity, 0.5f);
  EXPECT_EQ(glass.materials[0].alpha_mode, AlphaMode::kBlend);
  const ModelFile clear = file(
      "<transparent opaque='RGB_ZERO'><color>0.25 0.25 0.25 1</color>"
      "</transparent>");
  EXPECT_NEAR(clear.materials.at(0).opacity, 0.75f, 1e-5f);
}

TEST(Collada, PicturesAreFoundBesideTheFileAndNowhereElse) {
  TestFolder folder;
  folder.write("red.png", "png");
  const auto read = [&](const std::string& name) {
    const auto file = folder.write(
        "m/a.dae",
        dae("", kSquareDae,
            "<node><instance_geometry url='#g'><bind_material><technique_common>"
            "<instance_material symbol='m' target='#red'/></technique_common></bind_material>"
            "</instance_geometry></node>",
            "<library_images><image id='i'><init_from>" + name +
                "</init_from></image></library_images><library_materials><material id='red'>"
                "<instance_effect url='#e'/></material></library_materials><library_effects>"
                "<effect id='e'><profile_COMMON><newparam sid='sf'><surface><init_from>i"
                "</init_from></surface></newparam><newparam sid='sm'><sampler2D><source>sf</source>"
                "</sampler2D></newparam><technique><lambert><diffuse><texture texture='sm' "
                "texcoord='UV'/></diffuse></lambert></technique></profile_COMMON></effect>"
                "</library_effects>"));
    folder.write("m/red.png", "png");
    return read_model_file(file);
  };
  for (const char* name : {"red.png", "./red.png", ".\\red.png", "C:\\art\\red.png", "red%2Epng"}) {
    const Result<ModelFile> model = read(name);
    ASSERT_TRUE(model.ok()) << error_of(model);
    EXPECT_EQ(model->images.size(), 1u) << name;
    EXPECT_EQ(model->materials.at(0).base_color_texture.image, 0);
  }
  EXPECT_THAT(error_of(read("../red.png")), HasSubstr("leads outside of the folder"));
  EXPECT_TRUE(read("none.png")->images.empty());
}

TEST(Collada, DamageIsToldWithItsLine) {
  const std::string whole = dae("", kSquareDae, kNode);
  for (size_t n = 0; n < whole.size(); n += 7)
    EXPECT_FALSE(read_text(whole.substr(0, n), "a.dae").ok());
  EXPECT_THAT(error_for(dae("", kTriangle, "<node><instance_geometry url='#h'/></node>")),
              HasSubstr("refers to geometry '#h', which is not in the file"));
  EXPECT_THAT(error_for(dae("",
                            "<triangles><input semantic='VERTEX' source='#v' offset='0'/>"
                            "<p>0 1 9</p></triangles>",
                            kNode)),
              HasSubstr("a.dae:4: <triangles> refers to element 9 of a source with 4 elements"));
  EXPECT_THAT(error_for(dae("",
                            "<triangles><input semantic='VERTEX' source='#v' offset='0'/>"
                            "<p>0 1 x</p></triangles>",
                            kNode)),
              HasSubstr("'x', which is not a valid index"));
  // A node that holds itself, and nodes whose copies double at every level.
  EXPECT_THAT(error_for(dae("", kTriangle, "<node id='a'><instance_node url='#a'/></node>")),
              HasSubstr("its own ancestor"));
  std::string nodes;
  for (int i = 0; i < 60; ++i)
    nodes +=
        fmt::format("<node id='b{}'><instance_node url='#b{}'/><instance_node url='#b{}'/></node>",
                    i, i + 1, i + 1);
  EXPECT_THAT(error_for(dae("", kTriangle, nodes + "<node id='b60'/>")),
              HasSubstr("exceeds the limit on nodes"));
  EXPECT_FALSE(read_text("<COLLADA>" + std::string(10, '<') + "</COLLADA>", "a.dae").ok());
}

// --- colours at vertices ---

// The picture's value at the uv of a corner, as it is shown.
std::array<int, 3> shown(const ModelFile& model, size_t corner) {
  const ImportedInstance& in = model.instances.at(0);
  const TriangleMesh& mesh = model.meshes[static_cast<size_t>(in.mesh)];
  const TextureRef& texture = model.materials[static_cast<size_t>(in.material)].base_color_texture;
  const auto& bytes = model.images[static_cast<size_t>(texture.image)].bytes;
  const Result<Image8> image = decode_png(bytes, "x.png");
  EXPECT_TRUE(image.ok());
  const Vec2f uv = mesh.uvs[mesh.indices[corner]];
  const auto x = static_cast<size_t>(uv.x * static_cast<float>(image->width));
  const auto y = static_cast<size_t>((1 - uv.y) * static_cast<float>(image->height));
  const size_t at =
      (y * static_cast<size_t>(image->width) + x) * static_cast<size_t>(image->channels);
  return {image->texels[at], image->texels[at + 1], image->texels[at + 2]};
}

TEST(VertexColors, OfPlyObjAndGltfAreDrawn) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 255 0 0\n1 0 0 0 200 0\n0 1 0 0 0 100\n3 0 1 2\n";
  GltfBuilder gltf;
  const int p = gltf.add_positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const int c = gltf.add_accessor(std::vector<float>{1, 0, 0, 0, 0.577580f, 0, 0, 0, 0.127438f},
                                  "VEC3", 5126, 3);
  const int mesh = gltf.add_mesh({{"attributes", {{"POSITION", p}, {"COLOR_0", c}}}});
  gltf.push("nodes", {{"mesh", mesh}});
  const std::pair<std::string, std::string> files[] = {
      {"a.ply", ply},
      {"a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 0.784314 0\nv 0 1 0 0 0 0.392157\nf 1 2 3\n"},
      {"b.obj", "v 0 0 0 255 0 0\nv 1 0 0 0 200 0\nv 0 1 0 0 0 100\nf 1 2 3\n"},
      {"a.gltf", gltf.gltf()}};
  for (const auto& [name, text] : files) {
    const ModelFile model = read_ok(text, name);
    ASSERT_GE(model.instances.at(0).material, 0) << name;
    EXPECT_THAT(shown(model, 0), ElementsAre(255, 0, 0)) << name;
    EXPECT_THAT(shown(model, 1), ElementsAre(0, 200, 0)) << name;
    EXPECT_THAT(shown(model, 2), ElementsAre(0, 0, 100)) << name;
    EXPECT_THAT(model.notes, IsEmpty()) << name;
  }
}

TEST(VertexColors, OfOneColourNeedNoPicture) {
  const ModelFile model =
      read_ok("v 0 0 0 0 1 0\nv 1 0 0 0 1 0\nv 0 1 0 0 1 0\nf 1 2 3\n", "a.obj");
  EXPECT_TRUE(model.images.empty());
  expect_near(model.materials.at(0).base_color, {0, 1, 0});
}

TEST(GltfExtensions, InstancesArePlacedAndUnknownOnesAreTold) {
  GltfBuilder gltf;
  gltf.add_triangle();
  const int t = gltf.add_accessor(std::vector<Vec3f>{{1, 0, 0}, {0, 2, 0}}, "VEC3", 5126, 2);
  const int s = gltf.add_accessor(std::vector<Vec3f>{{1, 1, 1}, {-2, 2, 2}}, "VEC3", 5126, 2);
  gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", t}, {"SCALE", s}};
  gltf.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "VENDOR_glitter"};
  const ModelFile model = read_ok(gltf.gltf(), "a.gltf");
  ASSERT_EQ(model.instances.size(), 2u);
  expect_near(place(model, {1, 0, 0}, 0), {2, 0, 0});
  expect_near(place(model, {1, 0, 0}, 1), {-2, 0, 2});
  EXPECT_THAT(model.notes, ElementsAre(HasSubstr("'VENDOR_glitter'")));
  gltf.json["extensionsRequired"] = {"VENDOR_glitter"};
  EXPECT_THAT(error_for(gltf.gltf(), "a.gltf"),
              HasSubstr("requires the extension 'VENDOR_glitter'"));
}

// --- text as it comes ---

std::string utf16(const std::string& text, bool big) {
  std::string out = big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) big ? (out += '\0', out += c) : (out += c, out += '\0');
  return out;
}

TEST(PlainText, EveryReaderOfModelsTakesMarksLineEndsAndUtf16) {
  GltfBuilder gltf;
  gltf.add_triangle();
  const std::pair<std::string, std::string> files[] = {
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"a.dae", dae("", kTriangle, kNode)},
      {"a.gltf", gltf.gltf()},
      {"a.stl",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
       "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
       "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}};
  for (const auto& [name, text] : files) {
    std::string crlf, cr;
    for (const char c : text) {
      crlf += c == '\n' ? "\r\n" : std::string(1, c);
      cr += c == '\n' ? '\r' : c;
    }
    for (const std::string& written : {"\xEF\xBB\xBF" + text, crlf, cr, utf16(text, false),
                                       utf16(text, true), "\xEF\xBB\xBF" + cr, text + '\0'}) {
      const ModelFile model = read_ok(written, name);
      ASSERT_EQ(model.meshes.size(), 1u) << name;
      EXPECT_EQ(model.meshes[0].triangle_count(), 1u) << name;
    }
    EXPECT_THAT(error_for(utf16(text, false) + "x", name), HasSubstr("half a character")) << name;
  }
}

TEST(PlainText, PointersOfGitLfsAreNamed) {
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:01\nsize 9\n";
  for (const char* name : {"a.obj", "a.glb", "a.stl", "a.dae", "a.ply"})
    EXPECT_THAT(error_for(pointer, name), HasSubstr("is a Git LFS pointer, not the file itself"));
}

}  // namespace
}  // namespace gloam

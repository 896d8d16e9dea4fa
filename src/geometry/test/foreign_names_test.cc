// Names as other systems and programs write them: folders divided by '\', percent-encoded
// characters, paths of other machines, keywords of OBJ and MTL in capitals.

#include <gmock/gmock.h>

#include "base/path_readings.h"
#include "geometry/test/gltf_builder.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

const char* const kObj =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\n"
    "f 1/1 2/2 3/3\n";
const std::vector<std::string> kWaysToWrite = {"my tex/a b.png", "my tex\\a b.png",
                                               "my%20tex/a%20b.png", "my%20tex\\a%20b.png",
                                               "my%20tex%5Ca%20b.png"};

TEST(PathReadings, AreTheNameItselfFirst) {
  EXPECT_THAT(path_readings("a.obj"), ElementsAre("a.obj"));
  EXPECT_THAT(path_readings("a%20b\\c"), ElementsAre("a%20b\\c", "a%20b/c", "a b\\c", "a b/c"));
  EXPECT_EQ(decode_percent("100%"), "100%");
  EXPECT_EQ(decode_percent("%zz%2"), "%zz%2");
  EXPECT_EQ(without_foreign_folder("C:\\art\\a.png"), "a.png");
  EXPECT_EQ(without_foreign_folder("/home/me/a.png"), "a.png");
  EXPECT_EQ(without_foreign_folder("tex\\a.png"), "tex/a.png");
}

TEST(ForeignNames, OfPicturesInMtlAreFound) {
  const TestFolder folder;
  folder.write("my tex/a b.png", "png");
  folder.write("a b.png", "png");
  const auto path = folder.write("m.obj", kObj);
  std::vector<std::string> ways = kWaysToWrite;
  ways.emplace_back("C:\\art\\a b.png");
  for (const std::string& way : ways) {
    folder.write("m.mtl", "newmtl a\nmap_Kd " + way + "\n");
    const Result<ModelFile> model = read_model_file(path);
    ASSERT_TRUE(model.ok()) << way << error_of(model);
    EXPECT_EQ(model->images.size(), 1u) << way;
    EXPECT_TRUE(model->notes.empty()) << way;
  }
  // A name that is literally so comes first.
  folder.write("my%20tex/a%20b.png", "literal");
  folder.write("m.mtl", "newmtl a\nmap_Kd my%20tex/a%20b.png\n");
  EXPECT_EQ(read_model_file(path)->images.at(0).bytes.size(), 7u);
}

TEST(ForeignNames, OfFilesInGltfAreFound) {
  const TestFolder folder;
  GltfBuilder file;
  file.add_triangle();
  folder.write("my tex/a b.png", std::string(file.bin.begin(), file.bin.end()));
  for (const std::string& way : kWaysToWrite) {
    const auto path = folder.write("m.gltf", file.gltf_with_file(way));
    const Result<ModelFile> model = read_model_file(path);
    EXPECT_TRUE(model.ok()) << way << error_of(model);
  }
  const auto path = folder.write("m.gltf", file.gltf_with_file("..%5Coutside.bin"));
  folder.write("../outside.bin", "x");
  EXPECT_THAT(error_of(read_model_file(path)), HasSubstr("leads outside of the folder"));
  std::filesystem::remove(folder.path / "../outside.bin");
}

TEST(ForeignNames, OfPicturesInColladaAreFound) {
  const TestFolder folder;
  folder.write("my tex/a b.png", "png");
  for (const std::string& way : kWaysToWrite) {
    const auto path = folder.write(
        "m.dae",
        "<COLLADA version='1.4.1'><library_images><image id='i'><init_from>" + way +
            "</init_from></image></library_images><library_effects><effect id='e'><profile_COMMON>"
            "<newparam sid='sf'><surface><init_from>i</init_from></surface></newparam>"
            "<newparam sid='sm'><sampler2D><source>sf</source></sampler2D></newparam><technique>"
            "<lambert><diffuse><texture texture='sm' texcoord='UV'/></diffuse></lambert>"
            "</technique></profile_COMMON></effect></library_effects><library_materials>"
            "<material id='m'><instance_effect url='#e'/></material></library_materials>"
            "<library_geometries><geometry id='g'><mesh><source id='p'><float_array id='a'>"
            "0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source='#a' count='3' "
            "stride='3'/></technique_common></source><vertices id='v'><input semantic='POSITION' "
            "source='#p'/></vertices><triangles material='x'><input semantic='VERTEX' source='#v' "
            "offset='0'/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>"
            "<library_visual_scenes><visual_scene id='s'><node><instance_geometry url='#g'>"
            "<bind_material><technique_common><instance_material symbol='x' target='#m'/>"
            "</technique_common></bind_material></instance_geometry></node></visual_scene>"
            "</library_visual_scenes><scene><instance_visual_scene url='#s'/></scene></COLLADA>");
    const Result<ModelFile> model = read_model_file(path);
    ASSERT_TRUE(model.ok()) << error_of(model);
    EXPECT_EQ(model->images.size(), 1u) << way;
  }
}

TEST(MtlKeywords, AreReadInAnyCaseWithTheirOptions) {
  const TestFolder folder;
  folder.write("two.png", "png");
  folder.write("m.mtl",
               "NEWMTL a\nKA 1 1 1\nKD 0.5 0.25 0.125\nKS 0 0 0\nILLUM 1\nD -HALO 0.75\n"
               "MAP_KD -S 2 3 1 -O 0.5 0.25 -CLAMP ON two.png\n"
               "Map_Pr -ImfChan g two.png\nBUMP -BM 0.5 two.png\nNorm two.png\npM 0.5\n"
               "Ke 1 0 0\nKE 2 0 0\n");
  const auto path =
      folder.write("m.obj",
                   "MTLLIB m.mtl\nV 0 0 0\nV 1 0 0\nV 0 1 0\nVT 0 0\nVT 1 0\nVT 0 1\nUSEMTL a\n"
                   "F 1/1 2/2 3/3\n");
  const Result<ModelFile> model = read_model_file(path);
  ASSERT_TRUE(model.ok()) << error_of(model);
  ASSERT_EQ(model->materials.size(), 1u);
  const ImportedMaterial& m = model->materials[0];
  EXPECT_EQ(m.base_color, (Vec3f{0.5f, 0.25f, 0.125f}));
  EXPECT_EQ(m.opacity, 0.75f);
  EXPECT_EQ(m.specular_weight, 0);
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.base_color_texture.image, 0);
  EXPECT_EQ(m.base_color_texture.wrap_u, TextureWrap::kClamp);
  const Vec2f uv = transform_uv(m.base_color_texture.transform, {0.25f, 0.5f});
  EXPECT_FLOAT_EQ(uv.x, 2 * 0.25f + 0.5f);
  EXPECT_EQ(m.roughness_texture.image, 0);
  EXPECT_EQ(m.roughness_texture.channel, TextureChannel::kGreen);
  EXPECT_EQ(m.bump_scale, 0.5f);
  EXPECT_TRUE(m.normal_texture.ok());
  EXPECT_EQ(m.emission.x, 200);
  EXPECT_TRUE(model->notes.empty());
  EXPECT_EQ(model->instances.at(0).material, 0);
  EXPECT_EQ(model->meshes.at(0).uvs.size(), 3u);
}

TEST(MtlKeywords, ThatAreUnknownAreNoted) {
  const TestFolder folder;
  folder.write("m.mtl",
               "newmtl a\nKa 1 1 1\nmap_Kdd two.png\nrefl two.png\nmap_Kd -wrap x t.png\n");
  const Result<ModelFile> model = read_model_file(folder.write("m.obj", kObj));
  ASSERT_TRUE(model.ok()) << error_of(model);
  EXPECT_THAT(model->notes, Contains("'map_kdd' in the material library is ignored"));
  EXPECT_THAT(model->notes, Contains("'refl' in the material library is ignored"));
  EXPECT_THAT(model->notes, Contains("image option '-wrap' is ignored"));
  EXPECT_THAT(model->notes, testing::Not(Contains(HasSubstr("'ka'"))));
}

}  // namespace
}  // namespace gloam

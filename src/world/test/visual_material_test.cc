#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "geometry/test/image_writer.h"
#include "visual_test_model.h"
#include "world/lights/ktx_light.h"
#include "world/materials/visual_rules.h"

namespace gloam {
namespace {

using visual_test::compile;
using visual_test::describe;
using visual_test::expect_near;

class VisualTextureFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("gloam_visual_" + std::to_string(reinterpret_cast<uintptr_t>(this)));
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "t.png", std::ios::binary) << png_file(2, 3, 3, kTexels);
    std::ofstream(folder_ / "s.png", std::ios::binary) << png_file(2, 3, 3, kTexels, true);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  CompiledWorld compile_here(const std::string& compiler, const std::string& assets) {
    return compile("<mujoco><compiler texturedir='" + folder_.string() + "' " + compiler +
                   "/><asset>" + assets +
                   "</asset><worldbody><geom size='1' material='m'/></worldbody></mujoco>");
  }

  const std::vector<uint8_t> kTexels{255, 0,  0,  0, 255, 0, 0,   0,   255,
                                     90,  90, 90, 0, 0,   0, 255, 255, 255};
  std::filesystem::path folder_;
};

const Image8& color_image(const RenderDescription& out) {
  const int texture = out.materials.at(0).textures.base_color;
  return out.textures.at(static_cast<size_t>(texture)).faces.at(0);
}

TEST_F(VisualTextureFiles, RowsAreFromTheTop) {
  const RenderDescription out = describe(compile_here(
      "", "<texture name='t' type='2d' file='t.png'/><material name='m' texture='t'/>"));
  const Image8& image = color_image(out);
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 3);
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(image.texels, kTexels);
  EXPECT_EQ(out.materials[0].mapping, TextureMapping::kUv);
}

TEST_F(VisualTextureFiles, ByReferenceIsTheSameAsEmbedded) {
  const std::string assets =
      "<texture name='t' type='2d' file='t.png'/><material name='m' texture='t'/>";
  const CompiledWorld world = compile_here("passthrough='textures'", assets);
  ASSERT_EQ(world.model->tex_adr[0], -1) << "the texels are not in the model";
  EXPECT_EQ(color_image(describe(world)).texels, kTexels);

  std::filesystem::remove(folder_ / "t.png");
  const RenderDescription out = describe(world);
  ASSERT_EQ(out.unsupported.size(), 1u) << "a file that has gone is said, not fatal";
  EXPECT_NE(out.unsupported[0].message.find("texture 't' cannot be read"), std::string::npos);
  EXPECT_EQ(color_image(out).texels, (std::vector<uint8_t>{255, 255, 255}));
}

TEST_F(VisualTextureFiles, KtxIsReadThoughMuJoCoKeepsItsBytes) {
  const auto assets = [](const std::string& file) {  // MuJoCo remembers files by their names
    return "<texture name='t' type='2d' file='" + file + "'/><material name='m' texture='t'/>";
  };
  // RGBA of 2 x 1 texels, rows from the bottom as OpenGL has them.
  const auto ktx = [](const std::vector<std::string>& faces) {
    return ktx_file(0x1401, 0x1908, 0x8058, 2, 1, faces);
  };
  std::ofstream(folder_ / "t.ktx", std::ios::binary) << ktx({"abcdefgh"});
  const RenderDescription out = describe(compile_here("", assets("t.ktx")));
  EXPECT_TRUE(out.unsupported.empty());
  const Image8& image = color_image(out);
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.channels, 4);
  EXPECT_EQ(std::string(image.texels.begin(), image.texels.end()), "abcdefgh");
  EXPECT_EQ(image.color_space, ColorSpace::kSrgb);

  std::ofstream(folder_ / "cut.ktx", std::ios::binary) << ktx({"abcdefgh"}).substr(0, 50);
  const RenderDescription cut = describe(compile_here("", assets("cut.ktx")));
  ASSERT_EQ(cut.unsupported.size(), 1u);
  EXPECT_NE(cut.unsupported[0].message.find("texture 't' cannot be read"), std::string::npos);
}

TEST_F(VisualTextureFiles, KtxCubesLightTheSceneAsMuJoCoTurnsItsSky) {
  std::vector<std::string> faces;  // +x -x +y -y +z -z, each of one texel with its own red
  for (int i = 0; i < 6; ++i)
    faces.push_back(raw(1.0f + static_cast<float>(i)) + raw(0.0f) + raw(0.0f));
  std::ofstream(folder_ / "cube.ktx", std::ios::binary)
      << ktx_file(0x1406, 0x1907, 0x8815, 1, 1, faces);
  const RenderDescription out = describe(
      compile("<mujoco><compiler texturedir='" + folder_.string() +
              "'/><asset><texture name='t' type='2d' file='cube.ktx'/></asset><worldbody><light "
              "type='image' texture='t' intensity='200'/><geom size='1'/></worldbody></mujoco>"));
  const EnvironmentDescription& e = out.sky.environment;
  ASSERT_EQ(e.width, 4);
  ASSERT_EQ(e.height, 2);
  EXPECT_EQ(e.scale, 200);
  for (const Vec3f& texel : e.texels) EXPECT_GE(texel.x, 1);
  const EnvironmentDescription fine = environment_of(
      [&] {
        KtxImage cube;
        for (int i = 0; i < 6; ++i)
          cube.float_faces.push_back({8, 8, 1, std::vector<float>(64, static_cast<float>(i + 1))});
        return cube;
      }(),
      "fine");
  const auto at = [&](int row, int column) {
    return fine.texels[static_cast<size_t>(fine.width * row + column)].x;
  };
  EXPECT_EQ(at(8, 16), 1);  // +X
  EXPECT_EQ(at(8, 0), 2);   // -X
  EXPECT_EQ(at(0, 5), 3);   // up is the cube's +Y
  EXPECT_EQ(at(15, 5), 4);
  EXPECT_EQ(at(8, 24), 5);  // -Y is the cube's +Z
  EXPECT_EQ(at(8, 8), 6);   // +Y
}

TEST_F(VisualTextureFiles, ColoursAreSrgbWhateverTheFileSays) {
  for (const char* attributes :
       {"file='t.png'", "file='s.png'", "builtin='flat' width='4' height='4'"})
    EXPECT_EQ(color_image(
                  describe(compile_here("", std::string("<texture name='t' type='2d' ") +
                                                attributes + "/><material name='m' texture='t'/>")))
                  .color_space,
              ColorSpace::kSrgb)
        << attributes;
}

TEST(VisualMaterial, CubeFacesAreInMuJoCosOrder) {
  // builtin flat: five faces rgb1, the down face rgb2; a cross marks no face apart.
  const RenderDescription out = describe(R"(<mujoco><asset>
      <texture name="c" type="cube" builtin="flat" width="8" rgb1="1 0 0" rgb2="0 0 1"/>
      <material name="m" texture="c" texuniform="true" texrepeat="2 3"/></asset>
    <worldbody><geom size="1" material="m"/></worldbody></mujoco>)");
  EXPECT_EQ(out.materials[0].mapping, TextureMapping::kCube);
  EXPECT_TRUE(out.materials[0].texture_uniform);
  EXPECT_EQ(out.materials[0].texture_repeat.y, 3);
  const auto& faces = out.textures[0].faces;
  ASSERT_EQ(faces.size(), 6u);
  for (size_t f = 0; f < 6; ++f) {
    EXPECT_EQ(faces[f].texels.size(), 8u * 8 * 3);
    EXPECT_EQ(faces[f].texels[0], f == 3 ? 0 : 255) << f;
    EXPECT_EQ(faces[f].texels[2], f == 3 ? 255 : 0) << f;
  }
}

TEST(VisualMaterial, ColourOfGeomWinsWhenItIsGiven) {
  const RenderDescription out = describe(R"(<mujoco><asset>
      <material name="m" rgba="1 .5 0 1" emission=".5"/></asset><worldbody>
      <geom size="1" material="m"/><geom size="1" material="m" rgba="0 1 0 .25"/>
      <geom size="1" rgba="0 0 1 1"/><geom size="1"/><geom size="2" material="m"/>
      <geom name="unseen" size="1" rgba="1 1 1 0"/></worldbody></mujoco>)");
  ASSERT_EQ(out.instances.size(), 6u);
  EXPECT_EQ(out.materials[static_cast<size_t>(out.instances[5].material)].opacity, 0)
      << "what is fully transparent may be shown by a Command";
  const auto material = [&](size_t i) {
    return out.materials[static_cast<size_t>(out.instances[i].material)];
  };
  const float half = linear_color({.5f, 0, 0}).x;
  expect_near(material(0).base_color, {1, half, 0}, 1e-6f);
  EXPECT_EQ(material(0).model_material, 0);
  EXPECT_FALSE(material(0).own_color);
  expect_near(material(0).emission, {50, 50 * half, 0}, 1e-4f);
  expect_near(material(1).base_color, {0, 1, 0}, 1e-6f);
  EXPECT_FLOAT_EQ(material(1).opacity, .25f);
  EXPECT_TRUE(material(1).own_color);
  expect_near(material(1).emission, {0, 50, 0}, 1e-4f);
  expect_near(material(2).base_color, {0, 0, 1}, 1e-6f);
  EXPECT_EQ(material(2).model_material, -1);
  expect_near(material(3).base_color, Vec3f{half, half, half}, 1e-6f);
  EXPECT_EQ(out.instances[0].material, out.instances[4].material) << "rows are shared";
  EXPECT_EQ(out.instances[0].label.material, "m");
}

TEST(VisualMaterial, SurfaceFromOldAndNewAttributes) {
  const RenderDescription out = describe(R"(<mujoco><asset>
      <material name="old" specular=".2" shininess="1"/>
      <material name="mirror" reflectance=".25" shininess="0"/>
      <material name="new" roughness=".3" metallic=".9" shininess="1"/></asset><worldbody>
      <geom size="1" material="old"/><geom type="plane" size="1 1 1" material="mirror"/>
      <geom size="1" material="mirror"/><geom size="1" material="new"/></worldbody></mujoco>)");
  const auto material = [&](size_t i) {
    return out.materials[static_cast<size_t>(out.instances[i].material)];
  };
  EXPECT_NEAR(std::pow(material(0).roughness, 4), 2. / 130, 1e-6);
  EXPECT_FLOAT_EQ(material(0).specular_weight, .4f);
  EXPECT_EQ(material(0).metallic, 0);
  // Reflectance is that at normal incidence: ((n - 1) / (n + 1))², on planes and boxes only.
  const float n = material(1).ior;
  EXPECT_NEAR(((n - 1) / (n + 1)) * ((n - 1) / (n + 1)), .25, 1e-5);
  EXPECT_LE(material(1).roughness, .1f);
  EXPECT_FLOAT_EQ(material(2).ior, 1.5f);
  EXPECT_FLOAT_EQ(material(2).roughness, 1);
  EXPECT_FLOAT_EQ(material(3).roughness, .3f);
  EXPECT_FLOAT_EQ(material(3).metallic, .9f);
}

TEST(VisualMaterial, LayersByRole) {
  const RenderDescription out = describe(R"(<mujoco><asset>
      <texture name="a" type="2d" builtin="flat" width="2" height="2"/>
      <texture name="b" type="2d" builtin="checker" width="2" height="2"/>
      <texture name="c" type="cube" builtin="flat" width="2"/>
      <material name="m" roughness=".5"><layer role="rgb" texture="a"/>
        <layer role="orm" texture="b"/><layer role="normal" texture="a"/>
        <layer role="emissive" texture="b"/><layer role="opacity" texture="c"/></material></asset>
    <worldbody><geom size="1" material="m"/></worldbody></mujoco>)");
  const MaterialDescription& m = out.materials[0];
  const auto texture = [&](int row) { return out.textures.at(static_cast<size_t>(row)); };
  EXPECT_EQ(texture(m.textures.base_color).name, "a");
  EXPECT_EQ(texture(m.textures.base_color).faces[0].color_space, ColorSpace::kSrgb);
  EXPECT_EQ(texture(m.textures.normal).name, "a");
  EXPECT_EQ(texture(m.textures.normal).faces[0].color_space, ColorSpace::kLinear);
  EXPECT_EQ(texture(m.textures.orm).faces[0].color_space, ColorSpace::kLinear);
  EXPECT_EQ(texture(m.textures.emission).faces[0].color_space, ColorSpace::kSrgb);
  EXPECT_EQ(m.textures.opacity, -1) << "a cube among 2d layers cannot be drawn";
  ASSERT_EQ(out.unsupported.size(), 1u);
  EXPECT_NE(out.unsupported[0].message.find("'c'"), std::string::npos);
  EXPECT_FLOAT_EQ(m.roughness, .5f) << "multiplies the layer";
  EXPECT_FLOAT_EQ(m.metallic, 1) << "not given: the layer stands alone";
  expect_near(m.emission, {100, 100, 100}, 1e-4f);
}

}  // namespace
}  // namespace gloam

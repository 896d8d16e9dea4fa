// Models in TOML are models like any other: bare, as robots, with includes, and with what only
// mjSpec has.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "gloam/mjcf.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "world/compile/level.h"
#include "world/export/model_compare.h"

namespace gloam {
namespace {

constexpr const char* kPendulum = R"([mujoco]
model = "pendulum"

[[mujoco.worldbody.body]]
name = "arm"

[[mujoco.worldbody.body.joint]]
name = "hinge"
axis = [0, 1, 0]

[[mujoco.worldbody.body.geom]]
name = "rod"
type = "capsule"
fromto = [0, 0, 0, 0.5, 0, 0]
size = 0.02

[[mujoco.actuator.motor]]
name = "drive"
joint = "hinge"
)";

class TomlModel : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }
  std::filesystem::path write(const std::string& name, const std::string& text) {
    EXPECT_TRUE(write_text_file_atomic(folder_.path() / name, text).ok());
    return folder_.path() / name;
  }
  Result<World> compile(const std::filesystem::path& file) {
    GLOAM_TRY(const Scene scene, load_scene(file));
    return World::compile(scene);
  }
  std::string complaint(const std::filesystem::path& file) {
    const Result<World> world = compile(file);
    if (world.ok()) return "fine";
    Error error = world.error();
    error.loc.file = std::filesystem::path(error.loc.file).filename();
    return error.to_string();
  }
  TempFolder folder_;
};

TEST_F(TomlModel, IsTheModelOfItsXml) {
  const auto toml = compile(write("pendulum.toml", kPendulum));
  ASSERT_TRUE(toml.ok()) << toml.error().to_string();
  const auto document = mjcf::Document::from_toml(kPendulum);
  const auto xml = compile(write("pendulum.xml", document->to_xml()));
  ASSERT_TRUE(xml.ok()) << xml.error().to_string();
  const auto differing =
      compare_models(toml->compiled()->model.get(), xml->compiled()->model.get());
  EXPECT_TRUE(differing.empty()) << differing[0];
  EXPECT_TRUE(toml->export_mjcf(folder_.path() / "out").ok());
}

TEST_F(TomlModel, JoinsASceneAndIncludesOthers) {
  write("arm.toml", kPendulum);
  write("arms.toml",
        "[mujoco]\n[[mujoco.include]]\nfile = 'arm.toml'\n[[mujoco.worldbody.geom]]\nsize = 1\n");
  const auto world = compile(write("scene.toml", "[[robot]]\nname = 'a'\nfile = 'arms.toml'\n"));
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_TRUE(world->find_actuator("a/drive").ok());
}

TEST_F(TomlModel, ErrorsNameTheLineOfTheToml) {
  const std::string text = kPendulum;
  EXPECT_EQ(complaint(write("m.toml", text + "gaer = 1\n")),
            "m.toml:20:8: <motor> has no attribute 'gaer' (did you mean 'gear'?)");
  EXPECT_EQ(complaint(write("m.toml", text + "[[mujoco.actuator.motor]]\njoint = 'hinges'\n")),
            "m.toml:20: unknown transmission target 'hinges' for actuator id = 1");
  EXPECT_EQ(complaint(write("m.toml", text + "[[mujoco.include]]\nfile = 'gone.toml'\n")),
            "m.toml:20: 'gone.toml' does not exist (check the path)");
  EXPECT_EQ(complaint(write("m.toml", text + "[[mujoco.sensor.touch]]\n")),
            "m.toml:20:1: <touch> is missing 'site': text");
  EXPECT_EQ(
      complaint(write("m.toml", text + "[[mujoco.worldbody.replicate]]\ncount = 999999999\n")),
      "m.toml:20: replicate count=\"999999999\" exceeds the limit of 100000");
  write("inner.toml", "[mujoco]\n\n[[mujoco.worldbody.gem]]\n");
  EXPECT_EQ(complaint(write("m.toml", text + "[[mujoco.include]]\nfile = 'inner.toml'\n")),
            "inner.toml:3:1: <gem> is not allowed in <body> (did you mean <geom>?)");
}

TEST_F(TomlModel, AScenesFileIsNoModel) {
  write("other.toml", "[[robot]]\nname = 'a'\nfile = 'x.xml'\n");
  EXPECT_EQ(complaint(write("scene.toml", "[[robot]]\nname = 'a'\nfile = 'other.toml'\n")),
            "scene.toml:1:1: 'other.toml' is a scene, but a model is expected here (use an MJCF "
            "(.xml) or URDF file, or a TOML model (docs/models.md))");
  write("broken.toml", "[mujoco]\nmodel = \n");
  EXPECT_THAT(complaint(write("scene.toml", "[[robot]]\nname = 'a'\nfile = 'broken.toml'\n")),
              ::testing::StartsWith("broken.toml:2:"));
}

TEST_F(TomlModel, WhatOnlyMjSpecHasIsSet) {
  const std::string text =
      std::string(kPendulum) +
      "[[mujoco.asset.mesh]]\nname = 'm'\nvertex = [0,0,0, 1,0,0, 0,1,0, 0,0,1]\n"
      "face = [0,2,1, 0,1,3, 1,2,3, 0,3,2]\nneedsdf = true\noctree_maxdepth = 3\n"
      "[[mujoco.worldbody.geom]]\ntype = 'mesh'\nmesh = 'm'\n";
  const auto world = compile(write("m.toml", text));
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_GT(world->compiled()->model->noct, 0) << "the octree that needsdf asks for";
  Result<mjcf::Document> document = mjcf::Document::from_toml(text);
  EXPECT_EQ(document->save(folder_.path() / "m.xml").error().message,
            "MJCF has no attribute 'needsdf' of <mesh>");
}

}  // namespace
}  // namespace gloam

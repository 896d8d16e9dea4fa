// [planner] in scene files: its files, and keys that belong to one type of planner.

#include <gtest/gtest.h>

#include "gloam/scene.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

class PlannerToml : public ::testing::Test {
 protected:
  void SetUp() override { folder_.write("robot.xml", "<mujoco/>"); }

  Result<Scene> load(const std::string& planner) const {
    return load_scene(folder_.write(
        "scene.toml", "[[robot]]\nname = \"go\"\nfile = \"robot.xml\"\n[planner]\n" + planner));
  }
  std::string message(const std::string& planner) const {
    const Result<Scene> scene = load(planner);
    return scene.ok() ? std::string() : scene.error().to_string();
  }

  TempFolder folder_;
};

TEST_F(PlannerToml, FindsALibraryBesideTheScene) {
  folder_.write("build/planner.so", "");
  const Result<Scene> scene = load("type = \"library\"\nlibrary = \"build/planner.so\"\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  EXPECT_EQ(scene->planner->library, folder_.path() / "build/planner.so");
}

TEST_F(PlannerToml, FindsTheFoldersOfAMapAndOfANetwork) {
  folder_.write("map/map.json", "{}");
  folder_.write("nomad/distance.onnx", "");
  const Result<Scene> scene = load("type = \"nomad\"\nmap = \"map\"\nweights = \"nomad\"\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  EXPECT_EQ(scene->planner->map, folder_.path() / "map");
  EXPECT_EQ(scene->planner->weights, folder_.path() / "nomad");
}

TEST_F(PlannerToml, RejectsFilesThatAreMissingOrElsewhere) {
  EXPECT_NE(message("type = \"library\"\nlibrary = \"no.so\"\n").find("there is no file 'no.so'"),
            std::string::npos);
  EXPECT_NE(message("type = \"replay\"\nmap = \"no_map\"\n").find("there is no file 'no_map'"),
            std::string::npos);
  folder_.write("build/planner.so", "");
  EXPECT_NE(message("type = \"library\"\nlibrary = \"build\"\n").find("'build' is not a file"),
            std::string::npos);
  EXPECT_FALSE(load("type = \"library\"\nlibrary = \"/bin/sh\"\n").ok());
  EXPECT_FALSE(load("type = \"replay\"\nmap = \"/etc\"\n").ok());
}

TEST_F(PlannerToml, RejectsKeysOfOtherTypes) {
  folder_.write("planner.so", "");
  EXPECT_NE(message("type = \"route\"\nlibrary = \"planner.so\"\n").find("has a 'library'"),
            std::string::npos);
  EXPECT_NE(message("type = \"library\"\n").find("needs a 'library'"), std::string::npos);
  EXPECT_NE(message("type = \"external\"\n").find("needs an 'address'"), std::string::npos);
  EXPECT_NE(message("type = \"route\"\ncommand = \"x\"\n").find("has a 'command'"),
            std::string::npos);
}

}  // namespace
}  // namespace gloam

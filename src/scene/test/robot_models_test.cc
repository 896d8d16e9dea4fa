// [[robot]] model: settings and sensors that come from a robot.toml.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/test/source_dir.h"
#include "gloam/options.h"
#include "gloam/program.h"
#include "scene/robots/robot_models.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kEntry = R"(description = "a toy"
file = "parts/toy.xml"
keyframe = "home"
base = "free"
[controller]
type = "joint_position"
rate = 250
kp = 7
target = [1, 2]
[joints]
FL = ["a", "b", "c"]
[[sensor]]
name = "lidar"
kind = "lidar"
mount = "mast"
preset = "OS1-64"
hide = ["*"]
[[sensor]]
name = "eyes"
kind = "stereo"
mount = "head"
baseline = 0.07
[[sensor]]
name = "gyro"
kind = "sensor"
mount = "imu_gyro"
noise = 0.1
)";

class RobotModels : public testing::Test {
 protected:
  RobotModels() {
    folder_.write("toy/parts/toy.xml", "<mujoco/>");
    folder_.write("toy/robot.toml", kEntry);
  }
  Result<Scene> read(const std::string& text) { return parse_scene(text, folder_.path()); }
  RobotOptions robot(const std::string& text) {
    const Result<Scene> scene = read(text);
    EXPECT_TRUE(scene.ok()) << scene.error().to_string();
    return scene.ok() ? scene->robots.at(0) : RobotOptions();
  }
  std::string error(const std::string& text) {
    const Result<Scene> scene = read(text);
    EXPECT_FALSE(scene.ok()) << text;
    return scene.ok() ? "" : scene.error().to_string();
  }

  TempFolder folder_;
};

TEST_F(RobotModels, GiveTheirSettings) {
  for (const char* path : {"toy/robot.toml", "./toy", "toy/"}) {
    const RobotOptions toy = robot(fmt::format("[[robot]]\nmodel = \"{}\"\n", path));
    EXPECT_EQ(toy.name, "toy");
    EXPECT_EQ(toy.file, folder_.path() / "toy/parts/toy.xml");
    EXPECT_EQ(toy.keyframe, "home");
    EXPECT_EQ(toy.base, "free");
    EXPECT_EQ(toy.controller.type, "joint_position");
    EXPECT_EQ(toy.controller.kp, 7);
    EXPECT_THAT(toy.controller.target, ElementsAre(1, 2));
    EXPECT_THAT(toy.joints.front_left, ElementsAre("a", "b", "c"));
    EXPECT_TRUE(toy.model.empty()) << "the Scene holds what it stands for";
    EXPECT_EQ(toy.loc.line, 1);
  }
}

TEST_F(RobotModels, SettingsOfTheSceneReplaceThemKeyByKey) {
  const RobotOptions toy = robot(
      "[[robot]]\nmodel = './toy'\nname = 'a'\nbase = 'model'\nposition = [1, 2, 3]\n"
      "[robot.controller]\nkp = 9\ntarget = [3]\n");
  EXPECT_EQ(toy.name, "a");
  EXPECT_EQ(toy.base, "model") << "although it is the default";
  EXPECT_EQ(toy.X_WR.p, (Vec3{1, 2, 3}));
  EXPECT_EQ(toy.controller.type, "joint_position");
  EXPECT_EQ(toy.controller.rate, (Rational{250, 1}));
  EXPECT_EQ(toy.controller.kp, 9);
  EXPECT_THAT(toy.controller.target, ElementsAre(3));
}

TEST_F(RobotModels, AnotherControllerInheritsOnlyTheRate) {
  const RobotOptions toy = robot("[[robot]]\nmodel = './toy'\ncontroller.type = 'trot'\n");
  EXPECT_EQ(toy.controller.type, "trot");
  EXPECT_EQ(toy.controller.rate, (Rational{250, 1}));
  EXPECT_EQ(toy.controller.kp, ControllerOptions().kp);
  const RobotOptions same = robot("[[robot]]\nmodel = './toy'\ncontroller.type = 'joint_position'");
  EXPECT_EQ(same.controller.kp, 7);
}

TEST_F(RobotModels, SensorsAreMountedUnderTheRobotsName) {
  const Result<Scene> scene = read(
      "[[lidar]]\nname = 'own'\n"
      "[[robot]]\nname = 'a'\nmodel = './toy'\nsensors = ['lidar', 'gyro', 'eyes']\n"
      "[[robot]]\nname = 'b'\nmodel = './toy'\nsensors = ['lidar']\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  ASSERT_EQ(scene->lidars.size(), 3u);
  EXPECT_EQ(scene->lidars[1].name, "a/lidar");
  EXPECT_EQ(scene->lidars[1].body, "a/mast");
  EXPECT_EQ(scene->lidars[1].preset, "OS1-64");
  EXPECT_THAT(scene->lidars[1].hide, ElementsAre("a/*"));
  EXPECT_EQ(scene->lidars[1].loc.file, (folder_.path() / "toy/robot.toml").string());
  EXPECT_EQ(scene->lidars[2].body, "b/mast");
  ASSERT_EQ(scene->stereo.size(), 1u);
  EXPECT_EQ(scene->stereo[0].name, "a/eyes");
  EXPECT_EQ(scene->stereo[0].body, "a/head");
  ASSERT_EQ(scene->sensors.size(), 1u);
  EXPECT_EQ(scene->sensors[0].match, "a/imu_gyro");
  EXPECT_THAT(error("[[lidar]]\nname = 'toy/lidar'\n[[robot]]\nmodel = './toy'\n"
                    "sensors = ['lidar']\n"),
              HasSubstr("two lidars named 'toy/lidar'"));
}

TEST_F(RobotModels, TheCatalogueIsTheFoldersWithAnEntry) {
  const fs::path robots = source_dir() / "assets/robots";
  const RobotOptions dog = robot("[[robot]]\nmodel = 'quadruped'\ncontroller.goals = []\n");
  EXPECT_EQ(dog.name, "quadruped");
  EXPECT_EQ(dog.file, robots / "quadruped/quadruped.xml");
  EXPECT_EQ(dog.controller.type, "trot");
  EXPECT_THAT(error("[[robot]]\nmodel = 'quadrupde'\n"),
              AllOf(HasSubstr("no robot model 'quadrupde'"), HasSubstr(":2:9"),
                    HasSubstr("did you mean 'quadruped'?")));
}

TEST_F(RobotModels, AnySceneMayReadTheCatalogue) {
  FileAccess access;
  access.root = folder_.path();
  const char* const text = "[[robot]]\nmodel = 'cart'\n";
  const Result<Scene> scene = parse_scene(text, folder_.path(), access);
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  // Also a Scene that is written and read again, as logs do.
  const Result<Scene> again = parse_scene(to_toml(*scene), folder_.path(), access);
  ASSERT_TRUE(again.ok()) << again.error().to_string();
  EXPECT_EQ(again->robots[0].file, scene->robots[0].file);
}

TEST_F(RobotModels, OfScenesMadeInCodeAreTheSame) {
  Scene scene;
  scene.robots.push_back({.model = (folder_.path() / "toy").string(), .sensors = {"lidar"}});
  scene.robots[0].controller.kp = 9;
  const Result<Scene> made = with_robot_models(scene);
  ASSERT_TRUE(made.ok()) << made.error().to_string();
  const Result<Scene> written = read(
      "[[robot]]\nmodel = './toy'\nsensors = ['lidar']\ncontroller.kp = 9\n[scene]\nname = "
      "'scene'\n");
  ASSERT_TRUE(written.ok());
  EXPECT_EQ(to_toml(*made), [&] {
    Scene in_code = *written;
    in_code.file.clear();
    return to_toml(in_code);
  }());
  EXPECT_EQ(made->file, "");

  scene.robots[0].loc = {"made.cc", 3, 0};
  scene.robots[0].sensors = {"lidr"};
  const Result<Scene> wrong = with_robot_models(scene);
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().to_string(), AllOf(HasSubstr("made.cc:3"), HasSubstr("'lidar'")));
  folder_.write("toy/robot.toml", "description = 'd'\nfile = 'tyo.xml'\n");
  EXPECT_THAT(with_robot_models(scene).error().to_string(), HasSubstr("toy/robot.toml:2:8"));
}

TEST_F(RobotModels, OverlaysReplaceTheModelWithItsSettings) {
  const Result<Scene> scene =
      read("[[robot]]\nname = 'a'\nmodel = './toy'\nposition = [0, 0, 1]\n");
  ASSERT_TRUE(scene.ok());
  const auto over = overlay_scene(*scene, "[[robot]]\nname = 'a'\nmodel = 'cart'\n", "over.toml");
  ASSERT_TRUE(over.ok()) << over.error().to_string();
  EXPECT_EQ(over->robots[0].file.filename(), "cart.xml");
  EXPECT_EQ(over->robots[0].controller.type, "none");
  EXPECT_EQ(over->robots[0].base, "model");
  EXPECT_EQ(over->robots[0].X_WR.p.z, 1);
}

TEST_F(RobotModels, MistakesOfTheSceneAreToldThere) {
  const auto scene = [](const std::string& more) { return "[[robot]]\nmodel = './toy'\n" + more; };
  EXPECT_THAT(error(scene("file = 'a.xml'")),
              AllOf(HasSubstr("scene.toml:3:8"), HasSubstr("both 'model' and 'file'")));
  EXPECT_THAT(error(scene("sensors = ['eys']")),
              AllOf(HasSubstr(":3:12"), HasSubstr("no sensor 'eys'"), HasSubstr("'eyes'")));
  EXPECT_THAT(error(scene("sensors = ['eyes', 'eyes']")), HasSubstr("'eyes' twice"));
  EXPECT_THAT(error(scene("sensors = 'eyes'")), HasSubstr("array of names"));
  EXPECT_THAT(error(scene("[[robot]]\nmodel = './toy'\n")),
              AllOf(HasSubstr(":3:"), HasSubstr("two robots named 'toy'")));
  EXPECT_THAT(error("[[robot]]\nmodel = 3\n"), HasSubstr("'model' must be a string"));
  EXPECT_THAT(error("[[robot]]\nmodel = './tyo'\n"), HasSubstr("no file './tyo/robot.toml'"));
  EXPECT_THAT(error("[[robot]]\nname = 'a'\nfile = 'toy/parts/toy.xml'\nsensors = ['eyes']\n"),
              AllOf(HasSubstr(":4:"), HasSubstr("no 'model'")));
  EXPECT_THAT(error("[[robot]]\nname = 'a'\n"), HasSubstr("'file' is missing"));
}

TEST_F(RobotModels, MistakesOfTheRobotsFileAreToldThere) {
  const auto with = [&](const std::string& entry) {
    folder_.write("bad/toy.xml", "<mujoco/>");
    folder_.write("bad/robot.toml", entry);
    return error("[[robot]]\nmodel = './bad'\nsensors = ['s']\n");
  };
  const std::string head = "description = 'd'\nfile = 'toy.xml'\n";
  const auto told = [](const char* place, const char* what) {
    return AllOf(HasSubstr(std::string("bad/robot.toml") + place), HasSubstr(what));
  };
  EXPECT_THAT(with("file = 'toy.xml'\n"), told("", "'description' is missing"));
  EXPECT_THAT(with("description = 'd'\n"), told("", "'file' is missing"));
  EXPECT_THAT(with("description = 'd'\nfile = 'tyo.xml'\n"), told(":2:8", "'toy.xml'"));
  EXPECT_THAT(with("description = 'd'\nfile = '/etc/passwd'\n"), told(":2:8", "lies outside"));
  EXPECT_THAT(with("description = 'd'\nfile = 3\n"), told(":2:8", "must be a string"));
  EXPECT_THAT(with(head + "name = 'x'\n"), told(":3:1", "set by the scene"));
  const std::string sensor = "[[sensor]]\nname = 's'\nkind = 'lidar'\n";
  EXPECT_THAT(with(head + "keyfram = 'x'\n" + sensor), told(":3:1", "'keyframe'"));
  EXPECT_THAT(with(head + "[controller]\ntype = 'joint_position'\nkp = 'x'\n" + sensor),
              told(":5:6", "'kp'"));
  EXPECT_THAT(with(head + "[[sensor]]\nname = 's'\n"), told(":3:1", "'kind' is missing"));
  EXPECT_THAT(with(head + "[[sensor]]\nname = 's'\nkind = 'lidr'\n"), told(":5:8", "'lidar'"));
  EXPECT_THAT(with(head + sensor + "body = 'b'\n"), told(":6:8", "use 'mount'"));
  EXPECT_THAT(with(head + sensor + "rows = 'b'\n"), told(":6:8", "'rows'"));
  EXPECT_THAT(with(head + sensor + sensor), told(":7:8", "two sensors named 's'"));
  EXPECT_THAT(with(head + "sensor = 3\n"), told(":3:10", "array of tables"));
}

TEST_F(RobotModels, ManyRobotsOfALongEntryAreRefused) {
  folder_.write("toy/robot.toml", kEntry + std::string(200000, '#'));
  std::string scene;
  for (int i = 0; i < 400; ++i)
    scene += fmt::format("[[robot]]\nname = 'r{}'\nmodel = './toy'\n", i);
  EXPECT_THAT(error(scene), HasSubstr("larger than 64 MiB"));
}

}  // namespace
}  // namespace gloam

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gloam/options.h"
#include "gloam/scene.h"
#include "scene/test/temp_folder.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kModel = "<mujoco><worldbody><body name='b'/></worldbody></mujoco>";

class SceneToml : public ::testing::Test {
 protected:
  SceneToml() { folder_.write("robot.xml", kModel); }

  Result<Scene> load(const std::string& text) {
    return load_scene(folder_.write("scene.toml", text));
  }
  /// The error of a scene, "" if it loads.
  std::string error_of(const std::string& text) {
    const Result<Scene> scene = load(text);
    return scene.ok() ? "" : scene.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(SceneToml, ReadsEveryTable) {
  const Result<Scene> scene = load(R"(
[scene]
name = "yard"
[sim]
timestep = 0.002
duration = 5
seed = 7
[[robot]]
name = "go1"
file = "robot.xml"
position = [1, 2, 0.5]
orientation = [0, 0, 0, 2]
keyframe = "home"
[robot.controller]
type = "trot"
rate = 62.5
[[robot.controller.goals]]
time = 1
vx = 0.5
[[robot.controller.goals]]
time = 2.5
yaw_rate = -0.3
[[camera]]
name = "front"
body = "go1/b"
look_at = [1, 0, 0]
rate = "30000/1001"
outputs = ["video", "depth_png"]
[[push]]
body = "go1/b"
time = 3
velocity = [0, 0.2, 0]
[render]
tier = "direct"
ev100 = -2
[record]
outputs = ["video"]
)");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  EXPECT_EQ(scene->name, "yard");
  EXPECT_EQ(scene->sim.timestep, 0.002);
  EXPECT_EQ(scene->sim.duration, 5);
  EXPECT_EQ(scene->sim.seed, 7u);
  ASSERT_EQ(scene->robots.size(), 1u);
  const RobotOptions& robot = scene->robots[0];
  EXPECT_EQ(robot.file, folder_.path() / "robot.xml");
  EXPECT_EQ(robot.X_WR.p, (Vec3{1, 2, 0.5}));
  EXPECT_EQ(robot.X_WR.q, (Quat{0, 0, 0, 1}));  // normalised
  EXPECT_EQ(robot.controller.rate, (Rational{125, 2}));
  ASSERT_EQ(robot.controller.goals.size(), 2u);
  EXPECT_EQ(robot.controller.goals[0].vx, 0.5);
  EXPECT_EQ(robot.controller.goals[1].yaw_rate, -0.3);
  EXPECT_EQ(robot.loc.line, 8);
  ASSERT_EQ(scene->cameras.size(), 1u);
  EXPECT_EQ(scene->cameras[0].rate, (Rational{30000, 1001}));
  EXPECT_EQ(scene->cameras[0].outputs, (std::vector<std::string>{"video", "depth_png"}));
  EXPECT_EQ(scene->pushes.at(0).velocity, (Vec3{0, 0.2, 0}));
  EXPECT_EQ(scene->render.tier, RenderTier::kDirect);
  EXPECT_EQ(scene->render.ev100, -2);
  EXPECT_EQ(scene->record.outputs, (std::vector<std::string>{"video"}));
}

struct BadScene {
  const char* what;
  const char* text;
  std::vector<const char*> expected;  // all of these stand in the message
};

class BadScenes : public SceneToml, public ::testing::WithParamInterface<BadScene> {};

TEST_P(BadScenes, IsOneClearLineWithItsPlace) {
  const std::string message = error_of(GetParam().text);
  for (const char* part : GetParam().expected) EXPECT_THAT(message, HasSubstr(part));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadScenes,
    ::testing::Values(
        BadScene{"empty", "", {"scene.toml: the file is empty"}},
        BadScene{"comment_only", "# nothing\n", {"the file is empty"}},
        BadScene{"syntax", "[sim]\nduration = \n", {"scene.toml:2", "not valid TOML"}},
        BadScene{"unclosed", "[sim\n", {"scene.toml:1"}},
        BadScene{"unknown_key",
                 "[sim]\ndurration = 5\n",
                 {"scene.toml:2:1", "unknown key 'durration'", "did you mean 'duration'?"}},
        BadScene{"unknown_table", "[simm]\n", {"scene.toml:1", "'simm'", "did you mean 'sim'?"}},
        BadScene{"wrong_type",
                 "[sim]\nduration = \"5\"\n",
                 {"scene.toml:2:12", "'duration' must be a number, not a string"}},
        BadScene{"float_for_integer", "[sim]\nseed = 1.5\n", {"scene.toml:2", "an integer"}},
        BadScene{"negative_seed", "[sim]\nseed = -1\n", {"must not be negative"}},
        BadScene{"not_a_number", "[sim]\nduration = nan\n", {"scene.toml:2", "'duration' is nan"}},
        BadScene{"infinite", "[sim]\nduration = inf\n", {"scene.toml:2", "'duration' is inf"}},
        BadScene{"zero_duration", "[sim]\nduration = 0\n", {"'duration' is 0", "exclusive"}},
        BadScene{"huge_number", "[sim]\nduration = 1e300\n", {"scene.toml:2"}},
        BadScene{"bad_word",
                 "[render]\ntier = \"pth\"\n",
                 {"'tier' cannot be 'pth'", "did you mean 'path'?"}},
        BadScene{"too_many_samples", "[render]\nspp = 100000\n", {"from 1 to 65536"}},
        BadScene{"error_of_zero", "[render]\nerror = 0\n", {"scene.toml:2", "error"}},
        BadScene{"error_above_one", "[render]\nerror = 2\n", {"scene.toml:2", "error"}},
        BadScene{"error_of_the_direct_tier",
                 "[render]\ntier = \"direct\"\nerror = 0.1\n",
                 {"scene.toml:1", "path tier", "spp"}},
        BadScene{"error_of_few_samples",
                 "[render]\nspp = 8\nerror = 0.1\n",
                 {"scene.toml:1", "too few", "16"}},
        BadScene{"too_large_integer", "[render]\nspp = 99999999999\n", {"from 1 to 65536"}},
        BadScene{"absurd_resolution",
                 "[[camera]]\nname = \"c\"\nwidth = 20000\n",
                 {"scene.toml:3", "from 1 to 16384 px"}},
        BadScene{"robot_not_array",
                 "[robot]\nname = \"a\"\n",
                 {"'robot' must be an array of tables", "write [[robot]]"}},
        BadScene{"no_file", "[[robot]]\nname = \"a\"\n", {"scene.toml:1", "'file' is missing"}},
        BadScene{"missing_file",
                 "[[robot]]\nname = \"a\"\nfile = \"robott.xml\"\n",
                 {"there is no file 'robott.xml'", "did you mean 'robot.xml'?"}},
        BadScene{
            "file_is_folder", "[[robot]]\nname = \"a\"\nfile = \".\"\n", {"'.' is not a file"}},
        BadScene{"file_is_scene",
                 "[[robot]]\nname = \"a\"\nfile = \"scene.toml\"\n",
                 {"'scene.toml' is a scene, but a model is expected here"}},
        BadScene{"network",
                 "[environment]\nfile = \"http://example.org/x.xml\"\n",
                 {"only local files are supported"}},
        BadScene{"file_scheme",
                 "[environment]\nfile = \"file:///etc/passwd\"\n",
                 {"only local files are supported"}},
        BadScene{"outside",
                 "[environment]\nfile = \"../../../../../../../etc/passwd\"\n",
                 {"lies outside", "--root"}},
        BadScene{"absolute", "[environment]\nfile = \"/etc/passwd\"\n", {"lies outside"}},
        BadScene{"nul", "[environment]\nfile = \"a\\u0000b\"\n", {"control character"}},
        BadScene{"duplicate_robots",
                 "[[robot]]\nname = \"a\"\nfile = \"robot.xml\"\n"
                 "[[robot]]\nname = \"a\"\nfile = \"robot.xml\"\n",
                 {"scene.toml:4", "two robots named 'a'", "line 1"}},
        BadScene{"duplicate_cameras",
                 "[[camera]]\nname = \"c\"\n[[camera]]\nname = \"c\"\n",
                 {"two cameras named 'c'"}},
        BadScene{
            "slash_in_name", "[[robot]]\nname = \"a/b\"\nfile = \"robot.xml\"\n", {"without '/'"}},
        BadScene{
            "empty_name", "[[robot]]\nname = \"\"\nfile = \"robot.xml\"\n", {"'name'", "empty"}},
        BadScene{"short_vector",
                 "[[camera]]\nname = \"c\"\nposition = [1, 2]\n",
                 {"'position' must have 3 numbers, not 2"}},
        BadScene{"vector_of_text",
                 "[[camera]]\nname = \"c\"\nposition = [1, \"2\", 3]\n",
                 {"'position[1]' must be a number"}},
        BadScene{"zero_quaternion",
                 "[[camera]]\nname = \"c\"\norientation = [0, 0, 0, 0]\n",
                 {"not a rotation"}},
        BadScene{"look_twice",
                 "[[camera]]\nname = \"c\"\norientation = [1, 0, 0, 0]\nlook_at = [1, 0, 0]\n",
                 {"both 'look_at' and 'orientation'"}},
        BadScene{"look_at_itself",
                 "[[camera]]\nname = \"c\"\nlook_at = [0, 0, 0]\n",
                 {"looks at its own position"}},
        BadScene{"body_and_track",
                 "[[camera]]\nname = \"c\"\nbody = \"x\"\ntrack = \"x\"\n",
                 {"both 'body' and 'track'"}},
        BadScene{
            "bad_rate_text", "[[camera]]\nname = \"c\"\nrate = \"30/0\"\n", {"not a fraction"}},
        BadScene{"bad_rate_number",
                 "[[camera]]\nname = \"c\"\nrate = 0.31415926535\n",
                 {"not an exact fraction"}},
        BadScene{"zero_rate", "[[camera]]\nname = \"c\"\nrate = 0\n", {"'rate' is 0"}},
        BadScene{"bad_output",
                 "[[camera]]\nname = \"c\"\noutputs = [\"png\", \"deph_png\"]\n",
                 {"'outputs[1]' cannot be 'deph_png'", "did you mean 'depth_png'?"}},
        BadScene{
            "goals_out_of_order",
            "[[robot]]\nname = \"a\"\nfile = \"robot.xml\"\n[robot.controller]\ntype = \"trot\"\n"
            "[[robot.controller.goals]]\ntime = 2\n[[robot.controller.goals]]\ntime = 1\n",
            {"scene.toml:8", "sort the goals by time"}},
        BadScene{"option_of_another_controller",
                 "[[robot]]\nname = \"a\"\nfile = \"robot.xml\"\n[robot.controller]\nkp = 40\n"
                 "type = \"trot\"\n",
                 {"scene.toml:5", "'trot' has no 'kp'", "one of: type, rate, goals"}},
        BadScene{
            "option_of_another_controller_that_is_near",
            "[[robot]]\nname = \"a\"\nfile = \"robot.xml\"\n[robot.controller]\ntype = \"none\"\n"
            "rat = 3\n",
            {"scene.toml:6", "unknown key 'rat'", "did you mean 'rate'?"}},
        BadScene{"nothing_in_it", "[sim]\nduration = 1\n", {"the scene is empty"}}),
    [](const auto& info) { return info.param.what; });

TEST_F(SceneToml, SurvivesDeepNesting) {
  const std::string deep = "[sim]\nx = " + std::string(100000, '[') + "\n";
  EXPECT_THAT(error_of(deep), HasSubstr("scene.toml:2"));
}

TEST_F(SceneToml, MissingSceneSuggestsItsNeighbour) {
  ASSERT_FALSE(load("[sim]\n").ok());
  const Result<Scene> scene = load_scene(folder_.path() / "scen.toml");
  ASSERT_FALSE(scene.ok());
  EXPECT_THAT(scene.error().to_string(), HasSubstr("did you mean 'scene.toml'?"));
}

TEST_F(SceneToml, ABareModelIsWrappedAsItIs) {
  const Result<Scene> scene = load_scene(folder_.path() / "robot.xml");
  ASSERT_TRUE(scene.ok());
  EXPECT_EQ(scene->bare_model, folder_.path() / "robot.xml");
  EXPECT_TRUE(scene->robots.empty());
}

TEST_F(SceneToml, ArchivesAreRefused) {
  folder_.write("robot.mjz", "PK");
  const Result<Scene> scene = load_scene(folder_.path() / "robot.mjz");
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().kind, ErrorKind::kUnsupported);
}

TEST_F(SceneToml, StrictKeepsToTheOwnFolderAndRootWidens) {
  folder_.write("../shared/robot.xml", kModel);
  const auto scene =
      folder_.write("scene.toml", "[[robot]]\nname = \"a\"\nfile = \"../shared/robot.xml\"\n");
  EXPECT_TRUE(load_scene(scene).ok());
  FileAccess strict;
  strict.strict = true;
  EXPECT_FALSE(load_scene(scene, strict).ok());
  FileAccess root;
  root.root = folder_.path().parent_path();
  EXPECT_TRUE(load_scene(scene, root).ok());
  root.root = folder_.path() / "elsewhere";
  EXPECT_FALSE(load_scene(scene, root).ok());
}

TEST(ExactRational, FindsTheFractionThatWasMeant) {
  const auto fraction = [](double x) {
    Rational r;
    return exact_rational(x, &r) ? r : Rational{0, 0};
  };
  EXPECT_EQ(fraction(60), (Rational{60, 1}));
  EXPECT_EQ(fraction(62.5), (Rational{125, 2}));
  EXPECT_EQ(fraction(29.97), (Rational{2997, 100}));
  EXPECT_EQ(fraction(1.0 / 3), (Rational{1, 3}));
  EXPECT_EQ(fraction(-0.25), (Rational{-1, 4}));
  EXPECT_EQ(fraction(3.14159265358979), (Rational{0, 0}));
}

class SetOption : public SceneToml {
 protected:
  SetOption() {
    scene_ = load("[[robot]]\nname = \"go1\"\nfile = \"robot.xml\"\n[[camera]]\nname = \"top\"\n")
                 .value();
  }
  std::string set(std::string_view path, std::string_view value) {
    const Status status = set_option(scene_, path, value);
    return status.ok() ? "" : status.error().to_string();
  }
  Scene scene_;
};

TEST_F(SetOption, ChangesOneOption) {
  EXPECT_EQ(set("sim.duration", "5"), "");
  EXPECT_EQ(scene_.sim.duration, 5);
  EXPECT_EQ(set("render.tier", "direct"), "");  // quotes may be left out
  EXPECT_EQ(scene_.render.tier, RenderTier::kDirect);
  EXPECT_EQ(set("scene.name", "\"yard\""), "");
  EXPECT_EQ(scene_.name, "yard");
  EXPECT_EQ(set("robot.go1.controller.type", "joint_position"), "");
  EXPECT_EQ(set("robot.go1.controller.kp", "7"), "");
  EXPECT_EQ(scene_.robots[0].controller.kp, 7);
  EXPECT_EQ(set("camera.0.position", "[1, 2, 3]"), "");
  EXPECT_EQ(scene_.cameras[0].position, (Vec3{1, 2, 3}));
  EXPECT_EQ(set("camera.top.rate", "\"30000/1001\""), "");
  EXPECT_EQ(scene_.cameras[0].rate, (Rational{30000, 1001}));
  EXPECT_EQ(set("robot.go1.controller.type", "trot"), "");
  EXPECT_EQ(set("robot.go1.controller.goals", "[{time = 0, vx = 0.5}]"), "");
  EXPECT_EQ(scene_.robots[0].controller.goals.at(0).vx, 0.5);
}

TEST_F(SetOption, KnowsWhichOptionsAControllerHas) {
  const auto options = [&] {
    std::string keys;
    for (const OptionInfo& option : list_options(scene_))
      if (const size_t at = option.path.find("controller."); at != std::string::npos)
        keys += option.path.substr(at + 11) + " ";
    return keys;
  };
  EXPECT_EQ(options(), "type rate ");
  EXPECT_THAT(set("robot.go1.controller.kp", "7"), HasSubstr("'none' has no 'kp'"));
  EXPECT_EQ(set("robot.go1.controller.type", "joint_position"), "");
  EXPECT_EQ(options(), "type rate kp kd target ");
  EXPECT_THAT(set("robot.go1.controller.goals", "[]"),
              HasSubstr("'joint_position' has no 'goals'"));
  EXPECT_THAT(set("robot.go1.controller.tarket", "[1]"), HasSubstr("did you mean 'target'?"));
  EXPECT_EQ(set("robot.go1.controller.kp", "7"), "");
  EXPECT_EQ(*get_option(scene_, "robot.go1.controller.kp"), "7.0");
  EXPECT_THAT(to_toml(scene_), HasSubstr("kp = 7"));
  // The stiffness of another type is not written: it could not be read again.
  EXPECT_EQ(set("robot.go1.controller.type", "trot"), "");
  EXPECT_FALSE(get_option(scene_, "robot.go1.controller.kp").ok());
  EXPECT_THAT(to_toml(scene_), Not(HasSubstr("kp = 7")));
}

TEST_F(SetOption, RefusesWhatTheFileWouldRefuse) {
  EXPECT_THAT(set("sim.durration", "5"), HasSubstr("did you mean 'duration'?"));
  EXPECT_THAT(set("simm.duration", "5"), HasSubstr("did you mean 'sim'?"));
  EXPECT_THAT(set("sim.duration", "-5"), HasSubstr("'duration' is -5"));
  EXPECT_THAT(set("sim.duration", "5s"), HasSubstr("not a string"));
  EXPECT_THAT(set("robot.go2.keyframe", "x"), HasSubstr("did you mean 'go1'?"));
  EXPECT_THAT(set("robot.go1", "x"), HasSubstr("needs a name or number and an option"));
  EXPECT_THAT(set("camera.top.width.x", "1"), HasSubstr("has no option 'x'"));
  EXPECT_NE(set("", "1"), "");
  EXPECT_NE(set("sim.duration", "5\nseed = 3"), "");
  const Status status = set_option(scene_, "sim.duration", "nan");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().exit_code(), 2);
  EXPECT_EQ(scene_.sim.duration, 10);  // unchanged
}

// Parsers and whoever walks the tables recurse.
TEST_F(SceneToml, RefusesWhatNestsTooDeep) {
  std::string parts;
  for (int i = 0; i < 40'000; ++i) parts += "a.";
  EXPECT_THAT(error_of("\n" + parts + "b = 1"), HasSubstr("scene.toml:2: keys and tables are"));
  EXPECT_THAT(error_of("[" + parts + "b]"), HasSubstr("nested more than 256 deep"));
  EXPECT_THAT(error_of("[mujoco]\n[mujoco." + parts + "b]"), HasSubstr("scene.toml:2"));
  Scene scene;
  EXPECT_FALSE(set_option(scene, parts + "b", "1").ok());
  EXPECT_FALSE(set_option(scene, "sim.duration", std::string(40'000, '[')).ok());
}

}  // namespace
}  // namespace gloam

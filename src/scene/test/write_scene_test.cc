// Scenes written as TOML and read again are the same scenes.

#include <gmock/gmock.h>

#include "base/test/source_dir.h"
#include "gloam/options.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

class WrittenExample : public testing::TestWithParam<fs::path> {};

std::vector<fs::path> examples() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(source_dir() / "examples"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  return files;
}

// Every option, by its path, has the same value.
TEST_P(WrittenExample, IsTheSameSceneAgain) {
  const Scene scene = *load_scene(GetParam());
  const std::string text = to_toml(scene);
  const Result<Scene> again = parse_scene(text, GetParam().parent_path());
  ASSERT_TRUE(again.ok()) << again.error().to_string() << "\n" << text;
  const std::vector<OptionInfo> a = list_options(scene), b = list_options(*again);
  ASSERT_EQ(a.size(), b.size()) << text;
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].path, b[i].path);
    EXPECT_EQ(a[i].value, b[i].value) << a[i].path;
  }
  ASSERT_EQ(scene.overrides.size(), again->overrides.size());
  for (size_t i = 0; i < scene.overrides.size(); ++i)
    EXPECT_EQ(scene.overrides[i].value, again->overrides[i].value);
  EXPECT_EQ(to_toml(*again), text);
}

INSTANTIATE_TEST_SUITE_P(All, WrittenExample, testing::ValuesIn(examples()),
                         [](const auto& info) { return info.param.stem().string(); });

class WrittenScene : public testing::Test {
 protected:
  WrittenScene() {
    folder_.write("r.xml",
                  "<mujoco><worldbody><body name='b'><joint name='j.x'/><geom size='.1'/></body>"
                  "</worldbody></mujoco>");
  }
  Scene read(const std::string& text) { return *parse_scene(text, folder_.path()); }

  TempFolder folder_;
};

constexpr const char* kRobot = "[[robot]]\nname = 'r'\nfile = 'r.xml'\n";

TEST_F(WrittenScene, KeepsOrderQuotesAndNestingOfOverrides) {
  const Scene scene = read(std::string(kRobot) + R"(
[override.r.joint."j.*"]
damping = 0.1
[override.r.joint."j.x"]
damping = 0.25
[override.r.geom.".*"]
rgba = [1, 0, 0, 1]
)");
  const Scene again = read(to_toml(scene));
  ASSERT_EQ(again.overrides.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.overrides[i].pattern, scene.overrides[i].pattern);
    EXPECT_EQ(again.overrides[i].tag, scene.overrides[i].tag);
    EXPECT_EQ(again.overrides[i].value, scene.overrides[i].value);
  }
}

TEST_F(WrittenScene, NamesFilesFromItsFolderAndLeavesOutDefaults) {
  const std::string text = to_toml(read(kRobot));
  EXPECT_THAT(text, HasSubstr("r.xml"));
  EXPECT_THAT(text, Not(HasSubstr(folder_.path().string())));
  EXPECT_THAT(text, Not(HasSubstr("timestep")));
}

TEST_F(WrittenScene, KeepsTheLastBitOfNumbers) {
  Scene scene = read(kRobot);
  scene.robots[0].X_WR.p = {0.1 + 0.2, 1e-300, -0.0};
  const Scene again = read(to_toml(scene));
  EXPECT_EQ(again.robots[0].X_WR.p.x, 0.1 + 0.2);
  EXPECT_EQ(again.robots[0].X_WR.p.y, 1e-300);
  EXPECT_TRUE(std::signbit(again.robots[0].X_WR.p.z));
}

TEST_F(WrittenScene, SingleOptionsAreReadByTheirPaths) {
  Scene scene = read(std::string(kRobot) + "[weather]\nvisibility = 80\n");
  EXPECT_EQ(*get_option(scene, "weather.visibility"), "80.0");
  EXPECT_EQ(*get_option(scene, "robot.r.base"), "'model'");
  ASSERT_TRUE(set_option(scene, "robot.r.position", "[1, 2, 3]").ok());
  EXPECT_EQ(*get_option(scene, "robot.r.position"), "[ 1.0, 2.0, 3.0 ]");
  EXPECT_THAT(get_option(scene, "weather.visibilty").error().to_string(), HasSubstr("visibility"));
  EXPECT_FALSE(get_option(scene, "robot.q.base").ok());
  EXPECT_FALSE(get_option(scene, "").ok());
}

TEST_F(WrittenScene, ListedOptionsCanBeSetToWhatTheyAre) {
  Scene scene = read(std::string(kRobot) + "[weather]\nvisibility = 80\n[[camera]]\nname='c'\n");
  const std::string before = to_toml(scene);
  int set = 0;
  for (const OptionInfo& option : list_options(scene)) {
    if (option.value.empty()) continue;
    EXPECT_EQ(*get_option(scene, option.path), option.value);
    const Status status = set_option(scene, option.path, option.value);
    set += status.ok();
  }
  EXPECT_GT(set, 40);
  EXPECT_EQ(to_toml(scene), before);
}

}  // namespace
}  // namespace gloam

// Other people's robots, unedited. tests/fetch_data.py gets them; GLOAM_TEST_DATA says where.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "gloam/world.h"
#include "scene/mujoco_guard.h"
#include "scene/mujoco_plugins.h"
#include "scene/test/temp_folder.h"
#include "world/model_cache.h"
#include "world/model_compare.h"
#include "world/world.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;

const char* const kMjlab[] = {"unitree_go1/xmls/go1.xml", "unitree_g1/xmls/g1.xml",
                              "i2rt_yam/xmls/yam.xml"};

class ThirdParty : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("GLOAM_TEST_DATA");
    if (data == nullptr || !fs::is_directory(fs::path(data) / "mjlab"))
      GTEST_SKIP() << "no third-party robots: run tests/fetch_data.py and set GLOAM_TEST_DATA";
    mjlab_ = fs::path(data) / "mjlab/mjlab/asset_zoo/robots";
    robosuite_ = fs::path(data) / "robosuite/robosuite/models/assets";
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    load_mujoco_plugins();  // as the stock programs that these files were written for
  }

  // "" or what is wrong. Compares with stock, with the cache and after export.
  std::string check(const fs::path& file, bool* stock_loads = nullptr) {
    char error[2000] = "";
    ModelPtr stock;
    {
      const MujocoWarningCapture warnings;
      stock.reset(mj_loadXML(file.c_str(), nullptr, error, sizeof(error)));
    }
    if (stock_loads != nullptr) *stock_loads = stock != nullptr;
    const Result<Scene> scene = load_scene(file);
    if (!scene.ok()) return scene.error().to_string();
    const Result<World> world = World::compile(*scene);
    if (!world.ok()) return world.error().to_string();
    if (stock != nullptr) {
      const auto differing = compare_models(stock.get(), world->compiled()->model.get());
      if (!differing.empty()) return "differs from stock in " + differing[0];
    }
    finish_cache_writes();
    if (const auto cached = load_cached_world(*scene)) {
      const auto differing = compare_models(cached->model.get(), world->compiled()->model.get());
      if (!differing.empty()) return "differs from the cache in " + differing[0];
    }
    const Status exported = world->export_mjcf(folder_.path() / "out");  // compares by itself
    fs::remove_all(folder_.path() / "out");
    return exported.ok() ? "" : exported.error().to_string();
  }

  TempFolder folder_;
  fs::path mjlab_, robosuite_;
};

TEST_F(ThirdParty, UnitreeAndYamAreStockAndRoundTrip) {
  for (const char* name : kMjlab) EXPECT_EQ(check(mjlab_ / name), "") << name;
}

TEST_F(ThirdParty, SlowEveryRobosuiteFileThatStockLoadsRoundTrips) {
  if (!fs::is_directory(robosuite_)) GTEST_SKIP() << "robosuite was not fetched";
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(robosuite_)) {
    const fs::path extension = entry.path().extension();
    if (extension == ".xml" || extension == ".urdf") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  int loaded = 0, round_trips = 0;
  for (const fs::path& file : files) {
    bool stock_loads = false;
    const std::string wrong = check(file, &stock_loads);
    loaded += stock_loads;
    round_trips += stock_loads && wrong.empty();
    if (stock_loads) {
      EXPECT_EQ(wrong, "") << file;
    }
  }
  RecordProperty("loaded", loaded);
  RecordProperty("round_trips", round_trips);
  EXPECT_GE(loaded, 50) << "of " << files.size();
}

TEST_F(ThirdParty, TwoRobotsInOneLevelRoundTrip) {
  Scene scene;
  for (const char* name : {"go1", "g1"}) {
    RobotOptions robot;
    robot.name = name;
    robot.file = mjlab_ / ("unitree_" + std::string(name)) / "xmls" / (std::string(name) + ".xml");
    robot.X_WR.p.x = static_cast<double>(scene.robots.size());
    scene.robots.push_back(robot);
  }
  folder_.write(
      "room.xml",
      "<mujoco><worldbody><geom name='floor' type='plane' size='9 9 1'/></worldbody></mujoco>");
  scene.environment.file = folder_.path() / "room.xml";
  const Result<World> world = World::compile(scene);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_TRUE(world->find_body("go1/trunk").ok());
  const Status exported = world->export_mjcf(folder_.path() / "out");
  EXPECT_TRUE(exported.ok()) << exported.error().to_string();
}

}  // namespace
}  // namespace gloam

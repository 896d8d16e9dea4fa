// Other people's robots, unedited. tests/fetch_data.py gets them; GLOAM_TEST_DATA says where.

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "base/cache_writer.h"
#include "gloam/model_tools.h"
#include "gloam/world.h"
#include "scene/files/mujoco_plugins.h"
#include "scene/test/temp_folder.h"
#include "world/cache/model_cache.h"
#include "world/export/export_mjcf.h"
#include "world/export/model_compare.h"
#include "world/world.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

const char* const kMjlab[] = {"unitree_go1/xmls/go1.xml", "unitree_g1/xmls/g1.xml",
                              "i2rt_yam/xmls/yam.xml"};

class ThirdParty : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("GLOAM_TEST_DATA");
    if (data == nullptr || !fs::is_directory(fs::path(data) / "mjlab"))
      GTEST_SKIP() << "no third-party robots: run tests/fetch_data.py and set GLOAM_TEST_DATA";
    data_ = data;
    mjlab_ = data_ / "mjlab/mjlab/asset_zoo/robots";
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    load_mujoco_plugins();  // as the stock programs that these files were written for
  }

  // "" or what is wrong: `gloam check`, and what the cache keeps of it.
  std::string check(const fs::path& file, bool* stock_loads = nullptr) {
    const ModelCheck model = check_model(file, {}, folder_.path() / "out");
    fs::remove_all(folder_.path() / "out");
    if (stock_loads != nullptr) *stock_loads = model.stock_refusal == "";
    if (!model.status.ok()) return model.status.error().to_string();
    if (!model.passed()) {
      return fmt::format("differs from stock in [{}], from its export in [{}]",
                         fmt::join(model.unlike_stock, ", "), fmt::join(model.unlike_export, ", "));
    }
    finish_cache_writes();
    const Scene scene = load_scene(file).value();
    const auto cached = load_cached_world(scene);
    if (cached == nullptr || model.stock_refusal != "") return "";
    const ModelPtr stock = load_stock_model(file).value();
    const auto differing = compare_models(cached->model.get(), stock.get());
    return differing.empty() ? "" : "differs from the cache in " + differing[0];
  }

  TempFolder folder_;
  fs::path data_, mjlab_;
};

TEST_F(ThirdParty, UnitreeAndYamAreStockAndRoundTrip) {
  for (const char* name : kMjlab) EXPECT_EQ(check(mjlab_ / name), "") << name;
}

TEST_F(ThirdParty, EveryFileThatStockLoadsRoundTrips) {
  if (!fs::is_directory(data_ / "robosuite")) GTEST_SKIP() << "robosuite was not fetched";
  std::vector<fs::path> files;
  for (const char* wheel : {"mjlab", "robosuite"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(data_ / wheel)) {
      const fs::path extension = entry.path().extension();
      if (extension == ".xml" || extension == ".urdf") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  int loaded = 0;
  for (const fs::path& file : files) {
    bool stock_loads = false;
    const std::string wrong = check(file, &stock_loads);
    loaded += stock_loads;
    if (stock_loads) {
      EXPECT_EQ(wrong, "") << file;
    }
  }
  EXPECT_EQ(loaded, 59) << "of " << files.size();
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

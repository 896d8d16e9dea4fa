// Scenes side by side: what each row counts, and the files.
#include <cmath>

#include "base/files.h"
#include "geometry/image/image_file.h"
#include "gloam/run.h"
#include "scenes.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr const char* kSensors = R"(
[sim]
duration = 1
[[camera]]
name = "eye"
position = [0, -2, 0]
look_at = [0, 3, 0]
width = 64
height = 48
[camera.stereo_depth]
preset = "d435"
[camera.thermal]
netd = 0.05
[[lidar]]
name = "top"
position = [0, -1, 0]
preset = "VLP-16"
columns = 64
truth = true
)";
constexpr const char* kFog = R"(
[[volume]]
name = "fog"
medium = "fog"
position = [0, 0, 0]
size = [20, 20, 20]
visibility = 8
)";

Scene scene_of(const TempFolder& folder, const std::string& text) {
  Scene scene = flight(folder, text).compiled()->scene;
  scene.render.spp = 2;
  return scene;
}

TEST(CompareScenes, FogCostsSensorsWhatTheRowsSay) {
  const TempFolder folder;
  ComparisonRequest request;
  request.rows.push_back({"clear", scene_of(folder, kSensors)});
  request.rows.push_back({"fog", scene_of(folder, std::string(kSensors) + kFog)});
  request.camera = "eye";
  request.lidar = "top";
  request.rate = {2, 1};
  request.out = folder.path();
  request.name = "pair";
  const auto rows = compare_scenes(request, {});
  ASSERT_TRUE(rows.ok()) << rows.error().to_string();
  ASSERT_EQ(rows->size(), 2u);
  const ComparisonResult &clear = (*rows)[0], &fog = (*rows)[1];
  EXPECT_EQ(clear.visibility, 1e5);
  EXPECT_NEAR(fog.visibility, 8, 0.01);
  EXPECT_EQ(clear.media_returns, 0);
  EXPECT_GT(fog.media_returns, 0.02) << "the LiDAR sees no fog";
  EXPECT_LT(fog.lidar_returns, clear.lidar_returns) << "fog takes no return of surfaces away";
  EXPECT_LT(fog.contrast, 0.8 * clear.contrast) << "fog leaves the contrast as it was";
  EXPECT_GT(clear.illuminance, 0);

  const auto png = read_file(folder.path() / "pair.png");
  ASSERT_TRUE(png.ok()) << png.error().to_string();
  const auto picture = decode_png(*png, "pair.png");
  ASSERT_TRUE(picture.ok()) << picture.error().to_string();
  EXPECT_EQ(picture->width, 4 * (64 + 4) + 4) << "four sensors side by side";
  EXPECT_GT(std::filesystem::file_size(folder.path() / "pair.mp4"), 1000u);
}

TEST(CompareScenes, WhatCannotBeComparedIsRefused) {
  const TempFolder folder;
  ComparisonRequest request;
  EXPECT_FALSE(compare_scenes(request, {}).ok()) << "no scenes at all";
  request.rows.push_back({"one", scene_of(folder, kSensors)});
  request.camera = "eye";
  request.lidar = "tip";
  request.out = folder.path();
  request.name = "one";
  const auto no_lidar = compare_scenes(request, {});
  ASSERT_FALSE(no_lidar.ok());
  EXPECT_NE(no_lidar.error().message.find("tip"), std::string::npos) << no_lidar.error().message;
  request.lidar = "top";
  request.camera = "eys";
  EXPECT_FALSE(compare_scenes(request, {}).ok()) << "no such camera";
  request.camera = "eye";
  const auto stopped = compare_scenes(request, [](const Progress&) { return false; });
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(stopped.error().kind, ErrorKind::kInterrupted);
}

}  // namespace
}  // namespace gloam

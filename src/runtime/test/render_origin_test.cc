// Worlds far from the origin, as those in map coordinates, look as they do at the origin.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "gloam/run.h"
#include "runtime/live/live_simulation.h"
#include "scenes.h"

namespace gloam {
namespace {

/// A room, a robot that falls, lamps, a camera and a LiDAR at a place of the map: UTM easting and
/// northing, and a height. A multiple of the grid of origins, so that nothing is rounded.
struct MapPlace {
  double x = 0, y = 0, z = 0;
};
constexpr MapPlace kMap{512000, 5400576, 1024};

std::string map_point(const MapPlace& o, double x, double y, double z) {
  return fmt::format("{} {} {}", o.x + x, o.y + y, o.z + z);
}

World map_world(const TempFolder& folder, const MapPlace& o) {
  folder.write("place.xml", fmt::format(R"(<mujoco>
<visual><headlight ambient="0 0 0" diffuse="0 0 0"/></visual>
<worldbody>
  <light pos="{}" dir="0 0 -1" diffuse=".7 .7 .7" castshadow="true"/>
  <geom name="floor" type="box" size="3 3 .1" pos="{}" rgba=".6 .5 .4 1"/>
  <geom name="wall" type="box" size=".1 3 1" pos="{}" rgba=".3 .5 .6 1"/>
  <site name="mark" pos="{}" size=".1"/>
  <camera name="eye" pos="{}" xyaxes="0 -1 0 0.3 0 1"/>
  <body name="ball" pos="{}"><freejoint/><geom name="ball" size=".3" rgba=".9 .2 .2 1"/></body>
  <body name="post" pos="{}"><joint axis="0 0 1"/><geom name="post" type="capsule" size=".1 .4"/>
    <camera name="arm" pos="0 -1 0.3" xyaxes="1 0 0 0 0.2 1"/></body>
  <body name="hand" mocap="true" pos="{}"><geom name="hand" size=".1" contype="0" conaffinity="0"/></body>
</worldbody></mujoco>)",
                                        map_point(o, 0, 0, 4), map_point(o, 0, 0, -0.1),
                                        map_point(o, 2.9, 0, 1), map_point(o, 1, 1, 1),
                                        map_point(o, -2.5, 0, 1), map_point(o, 0.5, 0.5, 1),
                                        map_point(o, 1, -0.8, 0.5), map_point(o, 0, -0.5, 1.4)));
  const auto file =
      folder.write("scene.toml", fmt::format(R"(
[environment]
file = "place.xml"
[[light]]
name = "lamp"
type = "sphere"
radius = 0.1
flux = 800
position = [{}, {}, {}]
[[lidar]]
name = "roof"
position = [{}, {}, {}]
pattern = "raster"
rows = 12
columns = 24
field_of_view = [90, 40]
rate = 10
)",
                                             o.x - 1, o.y + 1, o.z + 2, o.x - 2, o.y, o.z + 0.8));
  auto scene = load_scene(file);
  EXPECT_TRUE(scene.ok()) << scene.error().to_string();
  auto world = World::compile(*scene);
  EXPECT_TRUE(world.ok()) << world.error().to_string();
  return std::move(*world);
}

CameraFrame far_picture(const World& world, const std::string& camera) {
  CameraRequest request{
      .camera = camera,
      .width = 64,
      .height = 48,
      .outputs = {"radiance", "depth", "distance", "segmentation", "normal", "motion", "boxes"}};
  request.render = {.tier = RenderTier::kPath, .spp = 4, .denoise = false};
  auto frames = render_stills(world, 0.2, {request}, {});
  EXPECT_TRUE(frames.ok()) << frames.error().to_string();
  return frames->front();
}

template <class T>
double widest_gap(const std::vector<T>& a, const std::vector<T>& b) {
  EXPECT_EQ(a.size(), b.size());
  double gap = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i] == b[i]) continue;
    gap = std::max(gap, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  }
  return gap;
}

TEST(RenderOrigin, PicturesAreAsAtTheOrigin) {
  const TempFolder folder;
  const World near = map_world(folder, {}), far = map_world(folder, kMap);
  for (const char* camera : {"eye", "arm"}) {
    const CameraFrame a = far_picture(near, camera), b = far_picture(far, camera);
    ASSERT_FALSE(a.depth.empty());
    // The bodies' own doubles step by 1e-9 m there; contacts and sums differ by that.
    EXPECT_LT(widest_gap(a.depth, b.depth), 1e-5) << camera;
    EXPECT_LT(widest_gap(a.distance, b.distance), 1e-5) << camera;
    EXPECT_EQ(widest_gap(a.part, b.part), 0) << camera;
    EXPECT_LT(widest_gap(a.normal, b.normal), 1e-5) << camera;
    EXPECT_LT(widest_gap(a.motion, b.motion), 1e-3) << camera;
    double sum = 0, gap = 0;
    for (size_t i = 0; i < a.radiance.size(); ++i) {
      sum += a.radiance[i];
      gap += std::abs(a.radiance[i] - b.radiance[i]);
    }
    EXPECT_LT(gap, 1e-3 * sum) << camera;
    EXPECT_NEAR(b.X_WC.p.x - a.X_WC.p.x, kMap.x, 1e-5) << "poses are the world's";
    EXPECT_NEAR(b.X_WC.p.y - a.X_WC.p.y, kMap.y, 1e-5);
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (size_t i = 0; i < a.objects.size(); ++i) {
      if (a.objects[i].endless) continue;
      EXPECT_NEAR(b.objects[i].X_WO.p.x - a.objects[i].X_WO.p.x, kMap.x, 1e-5);
    }
  }
}

std::shared_ptr<const LidarScan> map_scan(const World& world) {
  auto simulation = Simulation::create(world, {.pace = Pace::kFast});
  EXPECT_TRUE(simulation.ok());
  std::shared_ptr<const LidarScan> first;
  auto stream = (*simulation)
                    ->open_lidar({.lidar = "roof", .required = true},
                                 [&](std::shared_ptr<const LidarScan> scan) {
                                   if (first == nullptr) first = std::move(scan);
                                 });
  EXPECT_TRUE(stream.ok()) << stream.error().to_string();
  EXPECT_TRUE((*simulation)->run_until(150).ok());
  stream->reset();
  return first;
}

TEST(RenderOrigin, ScansAreAsAtTheOrigin) {
  const TempFolder folder;
  const auto a = map_scan(map_world(folder, {})), b = map_scan(map_world(folder, kMap));
  ASSERT_NE(a, nullptr);
  ASSERT_NE(b, nullptr);
  ASSERT_GT(a->size(), 100u);
  EXPECT_LT(widest_gap(a->range, b->range), 1e-4);
  EXPECT_LT(widest_gap(a->x, b->x), 1e-4);
  EXPECT_NEAR(b->X_WL_start.p.y - a->X_WL_start.p.y, kMap.y, 1e-5);
}

TEST(RenderOrigin, TheFreeCameraIsInTheWorld) {
  const TempFolder folder;
  const World near = map_world(folder, {}), far = map_world(folder, kMap);
  const CameraFrame a = far_picture(near, "free"), b = far_picture(far, "free");
  EXPECT_NEAR(b.X_WC.p.x - a.X_WC.p.x, kMap.x, 1e-3);
  EXPECT_NEAR(b.X_WC.p.z - a.X_WC.p.z, kMap.z, 1e-3);
  CameraRequest request{.camera = "free", .width = 64, .height = 48, .outputs = {"depth"}};
  request.X_WC = b.X_WC;
  auto again = render_stills(far, 0.2, {request}, {});
  ASSERT_TRUE(again.ok());
  EXPECT_LT(widest_gap(again->front().depth, b.depth), 1e-4);
  EXPECT_NEAR(again->front().X_WC.p.x, b.X_WC.p.x, 1e-6);
}

}  // namespace
}  // namespace gloam

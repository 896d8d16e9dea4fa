// Lenses from the scene file to the picture: known points against what the published CameraInfo
// says of them, and depth against known walls.
#include <gmock/gmock.h>

#include <cmath>

#include "geometry/lens.h"
#include "gloam/program.h"
#include "scene/test/temp_folder.h"
#include "sensors/camera/camera_sensor.h"
#include "sim/loop/simulator.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;

struct Point {
  double x, y, z;
};

// A luminous box of 3 x 2.5 x 4 m (half sizes) around the camera.
const char* const kWalls = R"(
  <geom type="box" size="10 10 1" pos="0 0 -5" material="lamp"/>
  <geom type="box" size="10 10 1" pos="0 0 5" material="lamp"/>
  <geom type="box" size="1 10 10" pos="-4 0 0" material="lamp"/>
  <geom type="box" size="1 10 10" pos="4 0 0" material="lamp"/>
  <geom type="box" size="10 1 10" pos="0 -3.5 0" material="lamp"/>
  <geom type="box" size="10 1 10" pos="0 3.5 0" material="lamp"/>)";

// What OpenCV and ROS say, written down anew: (u, v) with pixel centres at integers, of a point in
// the optical frame.
std::array<double, 2> published_pixel(const CameraInfo& info, Point p) {
  const std::vector<double>& d = info.d;
  double a = 0, b = 0;
  if (info.distortion_model == "equirectangular") {
    a = std::atan2(p.x, p.z);
    b = std::asin(p.y / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
  } else if (info.distortion_model == "equidistant") {
    const double r = std::hypot(p.x, p.y), t = std::atan2(r, p.z);
    const double td = t * (1 + d[0] * std::pow(t, 2) + d[1] * std::pow(t, 4) +
                           d[2] * std::pow(t, 6) + d[3] * std::pow(t, 8));
    a = r > 0 ? td * p.x / r : 0;
    b = r > 0 ? td * p.y / r : 0;
  } else {
    const double x = p.x / p.z, y = p.y / p.z, r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
    double radial = 1 + d[0] * r2 + d[1] * r4 + d[4] * r6;
    if (info.distortion_model == "rational_polynomial")
      radial /= 1 + d[5] * r2 + d[6] * r4 + d[7] * r6;
    a = x * radial + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x);
    b = y * radial + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y;
  }
  return {info.k[0] * a + info.k[2], info.k[4] * b + info.k[5]};
}

struct LensCase {
  const char* name;
  const char* lens;  // the scene file's table
  double widest;     // angle off the axis at which a point is tried [deg]
};
const LensCase kCases[] = {
    {"pinhole", R"({ model = "pinhole", fx = 180, fy = 190, cx = 150, cy = 125 })", 35},
    {"plumb_bob",
     R"({ model = "plumb_bob", d = [-0.25, 0.07, 0.002, -0.0015, -0.008], fx = 170, cx = 165 })",
     38},
    {"rational",
     R"({ model = "rational_polynomial", d = [5.2, 3.1, 0.0002, -0.0001, 0.12, 5.5, 4.9, 0.75], )"
     R"(focal_length = 0.004, sensor_size = [0.0064, 0.0048] })",
     32},
    {"fisheye", R"({ model = "equidistant", d = [-0.012, 0.0041, -0.0021, 0.0003], fx = 75 })", 92},
    {"panorama", R"({ model = "equirectangular" })", 150}};

class CameraLensTest : public ::testing::TestWithParam<LensCase> {
 protected:
  /// A camera at the origin that looks along -Z with +Y up.
  std::string load(const std::string& bodies, const std::string& camera_lines) {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    folder_.write("room.xml", R"(<mujoco><visual><headlight active="0"/></visual>
      <asset><material name="lamp" emission="1" rgba="1 1 1 1"/></asset>
      <worldbody>)" + bodies + "</worldbody></mujoco>");
    const auto scene = load_scene(folder_.write("room.toml", R"(
[environment]
file = "room.xml"
[render]
denoise = false
[[camera]]
name = "eye"
position = [0, 0, 0.0]
orientation = [1, 0, 0, 0]
width = 320
height = 240
)" + camera_lines));
    if (!scene.ok()) return scene.error().to_string();
    auto world = World::compile(*scene);
    if (!world.ok()) return world.error().to_string();
    world_ = std::move(*world);
    auto description = describe_for_rendering(*world_.compiled());
    if (!description.ok()) return description.error().to_string();
    description_ = std::move(*description);
    return "";
  }
  std::shared_ptr<const CameraFrame> capture(std::vector<std::string> outputs, int spp = 1) {
    CameraRequest request{.camera = "eye"};
    request.outputs = std::move(outputs);
    request.render = {.spp = spp, .max_depth = 1, .denoise = false};
    auto sensor = CameraSensor::create(description_, request, 1);
    EXPECT_TRUE(sensor.ok()) << sensor.error().to_string();
    auto renderer = std::move(make_cpu_renderer(description_)).value();
    auto solver = std::move(PoseSolver::create(world_.compiled())).value();
    auto simulator =
        std::move(Simulator::create(world_.compiled(), {.pace = Pace::kLockstep})).value();
    simulator->start();
    PoseFrame poses;
    EXPECT_TRUE(solver->solve(simulator->latest(), poses).ok());
    RenderTurns turns;
    return (*sensor)->capture(*renderer, turns, poses, poses, 0);
  }

  TempFolder folder_;
  World world_;
  RenderDescription description_;
};

TEST_P(CameraLensTest, KnownPointsAppearWhereTheCameraInfoSays) {
  std::vector<Point> points;  // optical frame, 2 m away
  const double widest = GetParam().widest * M_PI / 180;
  for (const double theta : {0.02, 0.5 * widest, widest}) {
    for (const double phi : {0.3, 2.7, 4.4}) {
      points.push_back({2 * std::sin(theta) * std::cos(phi), 2 * std::sin(theta) * std::sin(phi),
                        2 * std::cos(theta)});
      if (theta == 0.02) break;
    }
  }
  std::string bodies;
  for (const Point& p : points) {
    bodies += "<geom type='sphere' size='0.02' material='lamp' pos='" + std::to_string(p.x) + " " +
              std::to_string(-p.y) + " " + std::to_string(-p.z) + "'/>";
  }
  ASSERT_EQ(load(bodies, std::string("lens = ") + GetParam().lens), "");
  const auto frame = capture({"radiance"}, 256);
  const CameraInfo info = camera_info(frame->camera, frame->intrinsics);
  EXPECT_EQ(info.frame_id, "eye_optical_frame");
  int tried = 0;
  for (const Point& p : points) {
    const auto [u, v] = published_pixel(info, p);
    if (!(u > 8 && v > 8 && u < info.width - 9 && v < info.height - 9)) continue;
    ++tried;
    double sum = 0, at_u = 0, at_v = 0;
    const int u0 = static_cast<int>(std::lround(u)), v0 = static_cast<int>(std::lround(v));
    for (int y = v0 - 6; y <= v0 + 6; ++y) {
      for (int x = u0 - 6; x <= u0 + 6; ++x) {
        const double light = frame->radiance[3 * static_cast<size_t>(y * info.width + x)];
        sum += light;
        at_u += light * x;
        at_v += light * y;
      }
    }
    ASSERT_GT(sum, 0) << "nothing near " << u << ", " << v;
    EXPECT_NEAR(at_u / sum, u, 0.1);
    EXPECT_NEAR(at_v / sum, v, 0.1);
  }
  EXPECT_GE(tried, 5);
}

// The point at each pixel's depth lies on a wall.
TEST_P(CameraLensTest, DepthIsThatOfTheWalls) {
  ASSERT_EQ(load(kWalls, std::string("lens = ") + GetParam().lens), "");
  const auto frame = capture({"depth", "distance", "segmentation"});
  const Intrinsics& k = frame->intrinsics;
  const PixelRays rays(k);
  const auto off_the_walls = [](Vec3 p) {
    return std::abs(std::max({std::abs(p.x) / 3, std::abs(p.y) / 2.5, std::abs(p.z) / 4}) - 1);
  };
  double worst = 0;
  int seen = 0, dark = 0;
  for (int y = 0; y < k.height; ++y) {
    for (int x = 0; x < k.width; ++x) {
      const size_t i = static_cast<size_t>(y * k.width + x);
      const auto ray = rays.at(x + 0.5, y + 0.5);
      if (!ray) {
        ++dark;
        EXPECT_EQ(frame->part[i], 0u);
        EXPECT_TRUE(std::isinf(frame->depth[i]) && std::isinf(frame->distance[i]));
        continue;
      }
      ++seen;
      worst = std::max({worst, off_the_walls(ray->at(double{frame->distance[i]})),
                        off_the_walls(ray->at_depth(double{frame->depth[i]}))});
    }
  }
  EXPECT_LT(worst, 1e-4);
  EXPECT_GT(seen, 50000);
  if (k.lens == LensModel::kEquidistant) {
    EXPECT_EQ(dark, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, CameraLensTest, ::testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_F(CameraLensTest, FisheyesOfSmallCirclesLeaveTheRestBlack) {
  ASSERT_EQ(load(kWalls, R"(lens = { model = "equidistant", fx = 30 })"), "");  // pi: 94 px
  const auto frame = capture({"radiance", "depth", "segmentation"}, 4);
  const auto at = [&](int x, int y) { return static_cast<size_t>(y * 320 + x); };
  EXPECT_GT(frame->radiance[3 * at(160, 120)], 0);
  EXPECT_NEAR(frame->depth[at(70, 120)], 4 / std::cos(M_PI - std::hypot(89.5, 0.5) / 30), 1e-3)
      << "on the wall behind";
  EXPECT_EQ(frame->radiance[3 * at(60, 120)], 0);
  EXPECT_EQ(frame->part[at(60, 120)], 0u);
  EXPECT_TRUE(std::isinf(frame->depth[at(60, 120)]));
}

TEST_F(CameraLensTest, MistakesAreToldWithTheirLine) {
  const auto told = [&](const std::string& lens) {
    return load("<geom size='1'/>", "lens = " + lens);
  };
  EXPECT_THAT(told(R"({ model = "plumb_bob", d = [-0.9, 0, 0, 0], fx = 150 })"),
              AllOf(HasSubstr("room.toml:12"), HasSubstr("folds within the image")));
  EXPECT_THAT(told(R"({ model = "plumbbob" })"), HasSubstr("plumb_bob"));
  EXPECT_THAT(told(R"({ model = "equidistant", d = [0.1, 0, 0, 0, 0] })"),
              AllOf(HasSubstr("room.toml:12"), HasSubstr("takes 4")));
  EXPECT_THAT(told(R"({ model = "pinhole", fx = -3 })"), HasSubstr("fx"));
  EXPECT_THAT(told(R"({ model = "pinhole", fx = 100, sensor_size = [0.01, 0.01] })"),
              HasSubstr("sensor_size"));
  EXPECT_THAT(told(R"({ model = "pinhole", fx = 100, f_number = 2 })"), HasSubstr("needs both"));
  EXPECT_THAT(told(R"({ model = "equirectangular", fx = 3, wide = 1 })"), HasSubstr("wide"));
}

TEST(CameraInfo, HasTheValuesOfRos) {
  Intrinsics k{.width = 640, .height = 480, .fx = 500, .fy = 510, .cx = 320, .cy = 240};
  k.lens = LensModel::kPlumbBob;
  k.distortion = {0.1, 0.2, 0.3, 0.4, 0.5};
  const CameraInfo info = camera_info("go/head", k);
  EXPECT_EQ(info.frame_id, "go/head_optical_frame");
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  EXPECT_THAT(info.d, ::testing::ElementsAre(0.1, 0.2, 0.3, 0.4, 0.5));
  EXPECT_THAT(info.k, ::testing::ElementsAre(500, 0, 319.5, 0, 510, 239.5, 0, 0, 1));
  EXPECT_THAT(info.p, ::testing::ElementsAre(500, 0, 319.5, 0, 0, 510, 239.5, 0, 0, 0, 1, 0));
  // A camera that looks along -Z of the world, +Y up: Z of the optical frame is -Z of the world.
  const Pose X_WO = optical_pose({{1, 2, 3}, {1, 0, 0, 0}});
  EXPECT_EQ(X_WO.p, (Vec3{1, 2, 3}));
  const Affine3f X = to_affine(X_WO);
  EXPECT_NEAR(X.z.z, -1, 1e-6);
  EXPECT_NEAR(X.y.y, -1, 1e-6);
  EXPECT_NEAR(X.x.x, 1, 1e-6);
}

}  // namespace
}  // namespace gloam

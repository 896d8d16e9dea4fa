#include "studio/free_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gloam::studio {
namespace {

constexpr double kTolerance = 1e-12;
const double kHalf = std::sqrt(0.5);
const Pose kAlongY = {{0, -5, 1}, {kHalf, kHalf, 0, 0}};  // MuJoCo's axes: looks along -Z, up is +Y

void expect_near(const Vec3& a, const Vec3& b, double tolerance = kTolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(FreeCamera, TakesOverAnUprightPoseUnchanged) {
  OrbitCamera camera(kAlongY, 3);
  const Pose pose = camera.pose();
  expect_near(pose.p, kAlongY.p);
  expect_near(rotate(pose.q, {0, 0, -1}), {0, 1, 0});
  expect_near(rotate(pose.q, {0, 1, 0}), {0, 0, 1});
  expect_near(rotate(pose.q, {1, 0, 0}), {1, 0, 0});
}

TEST(FreeCamera, OrbitKeepsThePivotInTheMiddle) {
  OrbitCamera camera(kAlongY, 5);  // pivot (0, 0, 1)
  camera.orbit(0.37, 0.11);
  camera.orbit(-0.9, -0.3);
  const Pose pose = camera.pose();
  expect_near(pose.p + 5 * rotate(pose.q, {0, 0, -1}), {0, 0, 1});
  EXPECT_NEAR(rotate(pose.q, {1, 0, 0}).z, 0, kTolerance);  // stays upright
}

TEST(FreeCamera, TheSceneFollowsTheMouse) {
  OrbitCamera camera(kAlongY, 5);
  camera.orbit(0.5, 0);  // a quarter turn to the right: the camera goes to the left side, -X
  expect_near(camera.pose().p, {-5, 0, 1});
  OrbitCamera above(kAlongY, 5);
  above.orbit(0, 0.25);  // down: it rises and looks down
  EXPECT_NEAR(above.pose().p.z, 1 + 5 * kHalf, kTolerance);
  OrbitCamera panned(kAlongY, 5);
  panned.pan(0.1, 0.2, 4);  // the picture goes right and down: the camera left and up
  expect_near(panned.pose().p, {-0.4, -5, 1.8});
  OrbitCamera closer(kAlongY, 5);
  closer.zoom(std::log(2));
  expect_near(closer.pose().p, {0, -2.5, 1});
}

TEST(FreeCamera, NeverTipsOverOrLeavesTheNumbers) {
  OrbitCamera camera(kAlongY, 5);
  for (int i = 0; i < 100; ++i) {
    camera.orbit(100, 100);
    camera.zoom(10);
  }
  const Pose pose = camera.pose();
  EXPECT_GT(rotate(pose.q, {0, 1, 0}).z, 0);
  EXPECT_NEAR(camera.distance(), 0.01, 1e-9);
  for (int i = 0; i < 100; ++i) camera.zoom(-10);
  EXPECT_NEAR(camera.distance(), 1e4, 1e-6);
  EXPECT_TRUE(std::isfinite(camera.pose().p.x));
}

TEST(FreeCamera, StraightDownKeepsTheTopOfThePicture) {
  OrbitCamera camera({{0, 0, 4}, {1, 0, 0, 0}}, 4);  // looks down, up is +Y
  const Pose pose = camera.pose();
  const Vec3 up = rotate(pose.q, {0, 1, 0});
  EXPECT_NEAR(up.y, 1, 1e-3);
  expect_near(pose.p, {0, 0, 4}, 0.05);
}

TEST(DragPlane, PixelAndDepthGiveThePointBack) {
  const Intrinsics k = {640, 480, 500, 510, 310, 245};
  const Pose pose = OrbitCamera({{1, 2, 3}, {0.9, 0.3, 0.1, std::sqrt(1 - 0.91)}}, 2).pose();
  const Vec3 point = *point_at(pose, k, 100, 400, 2.5);
  EXPECT_NEAR(depth_of(pose, point), 2.5, 1e-9);
  // Middle of the picture: straight ahead.
  expect_near(*point_at(pose, k, 310, 245, 2), pose.p + 2 * rotate(pose.q, {0, 0, -1}), 1e-9);
  // v grows downwards.
  EXPECT_LT(point_at(kAlongY, k, 310, 400, 2)->z, 1);
  const Intrinsics parallel = {640, 480, 100, 100, 320, 240, true};
  expect_near(*point_at(kAlongY, parallel, 420, 240, 2), {1, -3, 1}, 1e-9);
}

// What is dragged stays under the mouse, whatever the lens.
TEST(DragPlane, OfAFisheyeIsASphereAboutTheCamera) {
  Intrinsics k{.width = 400, .height = 400, .fx = 100, .fy = 100, .cx = 200, .cy = 200};
  k.lens = LensModel::kEquidistant;
  const double right_angle = 200 + 100 * std::numbers::pi / 2;
  const Vec3 beside = *point_at(kAlongY, k, right_angle, 200, 2);
  expect_near(beside, kAlongY.p + Vec3{2, 0, 0}, 1e-6);
  EXPECT_NEAR(depth_of(kAlongY, k, beside), 2, 1e-6);
  k.lens = LensModel::kPlumbBob;
  k.distortion = {-0.1};  // a tangent of 0.5 shrinks by 2.5 %
  expect_near(*point_at(kAlongY, k, 200 + 100 * 0.5 * 0.975, 200, 2), kAlongY.p + Vec3{1, 2, 0},
              1e-6);
}

}  // namespace
}  // namespace gloam::studio

#include "studio/free_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gloam::studio {
namespace {

constexpr double kPi = std::numbers::pi;
// Straight up or down has no azimuth.
constexpr double kMaxElevation = 0.499 * kPi;
constexpr double kMinDistance = 0.01, kMaxDistance = 1e4;  // [m]

Quat multiply(const Quat& a, const Quat& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// Upright camera that looks along azimuth and elevation: about Z, then pitched about its own X.
/// With both angles zero it looks along +X.
Quat upright(double azimuth, double elevation) {
  const double yaw = (azimuth - kPi / 2) / 2;
  const double pitch = (elevation + kPi / 2) / 2;
  return multiply({std::cos(yaw), 0, 0, std::sin(yaw)}, {std::cos(pitch), std::sin(pitch), 0, 0});
}

}  // namespace

Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }

Vec3 rotate(const Quat& q, const Vec3& v) {
  const Quat turned = multiply(multiply(q, {0, v.x, v.y, v.z}), {q.w, -q.x, -q.y, -q.z});
  return {turned.x, turned.y, turned.z};
}

double depth_of(const Pose& X_WC, const Vec3& p_W) {
  return dot(rotate(X_WC.q, {0, 0, -1}), p_W - X_WC.p);
}

double depth_of(const Pose& X_WC, const Intrinsics& intrinsics, const Vec3& p_W) {
  const bool along_the_ray =
      intrinsics.lens == LensModel::kEquidistant || intrinsics.lens == LensModel::kEquirectangular;
  return along_the_ray ? norm(p_W - X_WC.p) : depth_of(X_WC, p_W);
}

std::optional<Vec3> point_at(const Pose& X_WC, const Intrinsics& intrinsics, double u, double v,
                             double depth) {
  const std::optional<PixelRay> ray = pixel_ray(intrinsics, u, v);
  if (!ray) return std::nullopt;
  return X_WC.p + rotate(X_WC.q, ray->at_depth(depth));
}

OrbitCamera::OrbitCamera(const Pose& X_WC, double distance)
    : distance_(std::clamp(distance, kMinDistance, kMaxDistance)) {
  const Vec3 direction = rotate(X_WC.q, {0, 0, -1});
  elevation_ =
      std::clamp(std::asin(std::clamp(direction.z, -1.0, 1.0)), -kMaxElevation, kMaxElevation);
  // Looking straight down the top of the picture is ahead, straight up it is behind.
  const Vec3 up = rotate(X_WC.q, {0, 1, 0});
  const bool steep = std::hypot(direction.x, direction.y) < 1e-6;
  const double sign = direction.z < 0 ? 1 : -1;
  azimuth_ = steep ? std::atan2(sign * up.y, sign * up.x) : std::atan2(direction.y, direction.x);
  pivot_ = X_WC.p + distance_ * forward();
}

void OrbitCamera::orbit(double dx, double dy) {
  azimuth_ = std::remainder(azimuth_ - kPi * dx, 2 * kPi);
  elevation_ = std::clamp(elevation_ - kPi * dy, -kMaxElevation, kMaxElevation);
}

void OrbitCamera::pan(double dx, double dy, double view_height) {
  const Quat q = upright(azimuth_, elevation_);
  pivot_ = pivot_ + (-dx * view_height) * rotate(q, {1, 0, 0}) +
           (dy * view_height) * rotate(q, {0, 1, 0});
}

void OrbitCamera::zoom(double amount) {
  distance_ = std::clamp(distance_ * std::exp(-amount), kMinDistance, kMaxDistance);
}

Pose OrbitCamera::pose() const {
  return {pivot_ - distance_ * forward(), upright(azimuth_, elevation_)};
}

Vec3 OrbitCamera::forward() const {
  return {std::cos(elevation_) * std::cos(azimuth_), std::cos(elevation_) * std::sin(azimuth_),
          std::sin(elevation_)};
}

}  // namespace gloam::studio

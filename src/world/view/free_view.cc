#include "world/view/free_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gloam {
namespace {

constexpr float kFill = 0.94f;  // fraction of the picture's half width or height that is filled
constexpr float kLeastCover = 0.17f, kMostCover = 0.42f;  // fraction of the picture's area

struct Spread {
  float low = INFINITY, high = -INFINITY;
  void add(float x) {
    low = min(low, x);
    high = max(high, x);
  }
  float middle() const { return 0.5f * (low + high); }
  float half() const { return 0.5f * (high - low); }
};

template <class Visit>
void each_point(std::span<const DrawnPart> subject, const Visit& visit) {
  for (const DrawnPart& part : subject)
    for (const Vec3f& p : part.points) visit(p);
}

void place_camera(std::span<const DrawnPart> subject, ViewDirection direction, float fill,
                  CameraDescription* camera) {
  const float ca = std::cos(direction.azimuth), sa = std::sin(direction.azimuth);
  const float ce = std::cos(direction.elevation), se = std::sin(direction.elevation);
  Affine3f& X_WC = camera->X_WC;
  X_WC.x = {sa, -ca, 0};
  X_WC.y = {-se * ca, -se * sa, ce};
  X_WC.z = {-ce * ca, -ce * sa, -se};
  Spread x, y, z;  // in C's axes
  each_point(subject, [&](Vec3f p) {
    x.add(dot(p, X_WC.x));
    y.add(dot(p, X_WC.y));
    z.add(dot(p, X_WC.z));
  });
  Intrinsics& k = camera->intrinsics;
  const float least = 1e-3f;  // [m] a point is looked at from here
  if (k.orthographic) {
    const double height =
        2 *
        max(max(y.half(), x.half() * static_cast<float>(k.height) / static_cast<float>(k.width)) /
                kFill,
            least);
    k.fx = k.fy = k.height / height;
    const float away = z.high + max(z.half(), least) + 1;
    X_WC.p = X_WC.x * x.middle() + X_WC.y * y.middle() + X_WC.z * away;
    return;
  }
  const float tan_x = fill * 0.5f * static_cast<float>(k.width / k.fx);
  const float tan_y = fill * 0.5f * static_cast<float>(k.height / k.fy);
  // The smallest cone of the picture's shape about all points, in closed form: its four sides are
  // planes of fixed direction, so each is pushed until it touches; the apex is where they meet.
  Spread right, up;  // spreads of x ± z tan, y ± z tan: places of the sides at z = 0
  each_point(subject, [&](Vec3f p) {
    const float px = dot(p, X_WC.x), py = dot(p, X_WC.y), pz = dot(p, X_WC.z);
    right.high = max(right.high, px + pz * tan_x);
    right.low = min(right.low, px - pz * tan_x);
    up.high = max(up.high, py + pz * tan_y);
    up.low = min(up.low, py - pz * tan_y);
  });
  const float away = max(max(right.half() / tan_x, up.half() / tan_y), z.high + least);
  X_WC.p = X_WC.x * right.middle() + X_WC.y * up.middle() + X_WC.z * away;
}

/// About the fraction of the picture that the points cover, in cells of 1/48 of its width.
float cover_of(std::span<const DrawnPart> subject, const CameraDescription& camera) {
  constexpr int kColumns = 48;
  const Intrinsics& k = camera.intrinsics;
  const int rows = std::max(kColumns * k.height / std::max(k.width, 1), 1);
  std::vector<bool> met(static_cast<size_t>(kColumns) * static_cast<size_t>(rows));
  each_point(subject, [&](Vec3f p) {
    const Vec3f v = p - camera.X_WC.p;
    const float depth = k.orthographic ? 1 : -dot(v, camera.X_WC.z);
    const auto at = [depth](float x, double focal, int side, int cells) {
      return static_cast<int>(
          std::floor((0.5 + x * focal / depth / side) * static_cast<double>(cells)));
    };
    const int column = at(dot(v, camera.X_WC.x), k.fx, k.width, kColumns);
    const int row = at(dot(v, camera.X_WC.y), k.fy, k.height, rows);
    if (column >= 0 && row >= 0 && column < kColumns && row < rows)
      met[static_cast<size_t>(row * kColumns + column)] = true;
  });
  const auto count = std::count(met.begin(), met.end(), true);
  return static_cast<float>(count) / static_cast<float>(met.size());
}

}  // namespace

void frame_subject(std::span<const DrawnPart> subject, ViewDirection direction, float steepest,
                   CameraDescription* camera) {
  if (subject.empty()) return;
  place_camera(subject, direction, kFill, camera);
  constexpr float kStep = 0.1f;  // [rad]
  while (cover_of(subject, *camera) < kLeastCover && direction.elevation > steepest) {
    direction.elevation = max(direction.elevation - kStep, steepest);
    place_camera(subject, direction, kFill, camera);
  }
  if (const float cover = cover_of(subject, *camera); cover > kMostCover)
    place_camera(subject, direction, kFill * std::sqrt(kMostCover / cover), camera);
}

}  // namespace gloam

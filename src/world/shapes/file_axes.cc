#include "world/shapes/file_axes.h"

namespace gloam {
namespace {

/// glTF's axes to Gloam's: (x, y, z) -> (x, -z, y).
constexpr Affine3f kYUpToZUp{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, 0}};
constexpr Affine3f kZUpToYUp{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 0, 0}};

}  // namespace

Affine3f file_axes(const Vec3& scale, double unit, const std::string& up, bool was_y_up) {
  const auto f = [&](double s) { return static_cast<float>(s * unit); };
  const Affine3f size{{f(scale.x), 0, 0}, {0, f(scale.y), 0}, {0, 0, f(scale.z)}, {}};
  const bool is_y_up = up == "y" || (up == "auto" && was_y_up);
  if (is_y_up == was_y_up) return size;
  return size * (is_y_up ? kYUpToZUp : kZUpToYUp);
}

}  // namespace gloam

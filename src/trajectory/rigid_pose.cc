#include "trajectory/rigid_pose.h"

#include <algorithm>

namespace gloam {
namespace {

double determinant(const RotationRows& R) {
  return R[0] * (R[4] * R[8] - R[5] * R[7]) - R[1] * (R[3] * R[8] - R[5] * R[6]) +
         R[2] * (R[3] * R[7] - R[4] * R[6]);
}

// R⁻ᵀ: cofactors over the determinant.
RotationRows inverse_transpose(const RotationRows& R) {
  const double d = determinant(R);
  return {(R[4] * R[8] - R[5] * R[7]) / d, (R[5] * R[6] - R[3] * R[8]) / d,
          (R[3] * R[7] - R[4] * R[6]) / d, (R[2] * R[7] - R[1] * R[8]) / d,
          (R[0] * R[8] - R[2] * R[6]) / d, (R[1] * R[6] - R[0] * R[7]) / d,
          (R[1] * R[5] - R[2] * R[4]) / d, (R[2] * R[3] - R[0] * R[5]) / d,
          (R[0] * R[4] - R[1] * R[3]) / d};
}

}  // namespace

RotationRows rotation_of(const Quat& quaternion) {
  const Quat& q = quaternion;
  const double s = 2 / (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const double xx = s * q.x * q.x, yy = s * q.y * q.y, zz = s * q.z * q.z;
  const double xy = s * q.x * q.y, xz = s * q.x * q.z, yz = s * q.y * q.z;
  const double wx = s * q.w * q.x, wy = s * q.w * q.y, wz = s * q.w * q.z;
  return {1 - yy - zz, xy - wz, xz + wy, xy + wz,    1 - xx - zz,
          yz - wx,     xz - wy, yz + wx, 1 - xx - yy};
}

double distance_from_rotation(const RotationRows& R) {
  const RotationRows G = product(R, transpose(R));
  double largest = 0;
  for (size_t i = 0; i < 9; ++i)
    largest = std::max(largest, std::fabs(G[i] - (i % 4 == 0 ? 1.0 : 0.0)));
  return determinant(R) > 0 ? largest : 2;
}

Quat nearest_quaternion(const RotationRows& given) {
  RotationRows R = given;
  for (int i = 0; i < 4 && distance_from_rotation(R) > 1e-15; ++i) {
    const RotationRows other = inverse_transpose(R);
    for (size_t k = 0; k < 9; ++k) R[k] = 0.5 * (R[k] + other[k]);
  }
  // Markley 2008: the largest of the four squares is the one to divide by.
  const double trace = R[0] + R[4] + R[8];
  const double squares[4] = {trace, R[0], R[4], R[8]};
  const auto k = std::max_element(squares, squares + 4) - squares;
  Quat q;
  if (k == 0)
    q = {1 + trace, R[7] - R[5], R[2] - R[6], R[3] - R[1]};
  else if (k == 1)
    q = {R[7] - R[5], 1 + 2 * R[0] - trace, R[1] + R[3], R[2] + R[6]};
  else if (k == 2)
    q = {R[2] - R[6], R[1] + R[3], 1 + 2 * R[4] - trace, R[5] + R[7]};
  else
    q = {R[3] - R[1], R[2] + R[6], R[5] + R[7], 1 + 2 * R[8] - trace};
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

}  // namespace gloam

#pragma once
// Poses as matrices: products and inverses as evo computes them, whose rotations need not be
// orthonormal to the last digit.

#include <cmath>

#include "gloam/trajectory.h"

namespace gloam {

struct RigidPose {
  RotationRows R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vec3 p;
};

inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double norm(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

inline Vec3 rotate(const RotationRows& R, const Vec3& v) {
  return {R[0] * v.x + R[1] * v.y + R[2] * v.z, R[3] * v.x + R[4] * v.y + R[5] * v.z,
          R[6] * v.x + R[7] * v.y + R[8] * v.z};
}
inline RotationRows transpose(const RotationRows& R) {
  return {R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]};
}
inline RotationRows product(const RotationRows& A, const RotationRows& B) {
  RotationRows C;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j)
      C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
  return C;
}
/// X_AC = X_AB X_BC.
inline RigidPose product(const RigidPose& X_AB, const RigidPose& X_BC) {
  return {product(X_AB.R, X_BC.R), rotate(X_AB.R, X_BC.p) + X_AB.p};
}
inline RigidPose inverse(const RigidPose& X) {
  const RotationRows R = transpose(X.R);
  return {R, -1.0 * rotate(R, X.p)};
}
/// X_BC of X_AB and X_AC.
inline RigidPose relative(const RigidPose& X_AB, const RigidPose& X_AC) {
  return product(inverse(X_AB), X_AC);
}
inline RigidPose pose_of(const Trajectory& trajectory, size_t i) {
  return {trajectory.rotations[i], trajectory.positions[i]};
}

/// Rows of the matrix of a quaternion of any length but 0.
RotationRows rotation_of(const Quat& q);
/// Unit quaternion of the rotation nearest to R (Higham 1986, polar decomposition by Newton's
/// iteration).
Quat nearest_quaternion(const RotationRows& R);
/// Largest element of |R Rᵀ - 1|; of a mirrored matrix 2.
double distance_from_rotation(const RotationRows& R);
/// Angle of q [rad], 0 … pi.
inline double angle_of(const Quat& q) {
  return 2 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), std::fabs(q.w));
}
inline Quat relative(const Quat& a, const Quat& b) {  // a⁻¹ b
  return {
      a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, a.w * b.x - a.x * b.w - a.y * b.z + a.z * b.y,
      a.w * b.y + a.x * b.z - a.y * b.w - a.z * b.x, a.w * b.z - a.x * b.y + a.y * b.x - a.z * b.w};
}

}  // namespace gloam

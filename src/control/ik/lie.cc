#include "control/ik/lie.h"

#include <cmath>

namespace gloam::ik {
namespace {

constexpr double kSmallSquare = 1e-10;  // squared angle [rad²] below which series apply

Matrix3d skew(const Vector3d& v) {
  Matrix3d S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

Vector3d rotation_vector(const Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double norm = q.vec().norm();
  if (norm < 1e-10) return Vector3d::Zero();
  return 2 * std::atan2(norm, q.w()) / norm * q.vec();
}

// Coefficient of [ω]² in the inverse of SO(3)'s left Jacobian; equation 146.
double inverse_coefficient(double square) {
  if (square < kSmallSquare) return 1.0 / 12;
  const double angle = std::sqrt(square);
  return (1 - 0.5 * angle * std::cos(0.5 * angle) / std::sin(0.5 * angle)) / square;
}

Matrix3d inverse_left_jacobian(const Vector3d& w) {
  const Matrix3d W = skew(w);
  return Matrix3d::Identity() - 0.5 * W + inverse_coefficient(w.squaredNorm()) * W * W;
}

// Equation 180.
Matrix3d coupling(const Vector3d& v, const Vector3d& w) {
  const double t2 = w.squaredNorm(), t = std::sqrt(t2), t4 = t2 * t2;
  const double sin = std::sin(t), cos = std::cos(t);
  const Matrix3d V = skew(v), W = skew(w);
  const Matrix3d VW = V * W, WV = W * V, WVW = WV * W;
  const double b = (t - sin) / (t2 * t);
  const double c = (1 - 0.5 * t2 - cos) / t4;
  const double d = (2 * t - 3 * sin + t * cos) / (2 * t4 * t);
  return 0.5 * V + b * (WV + VW + WVW) - c * (W * WV + VW * W - 3 * WVW) + d * (WVW * W + W * WVW);
}

}  // namespace

Vector6d log(const Transform& X) {
  const Vector3d w = rotation_vector(X.R);
  Vector6d twist;
  twist << inverse_left_jacobian(w) * X.p, w;
  return twist;
}

Matrix6d log_derivative(const Transform& X) {
  const Vector6d twist = -log(X);  // the right Jacobian is the left one of the negative twist
  const Vector3d w = twist.tail<3>();
  Matrix6d J = Matrix6d::Identity();
  if (w.squaredNorm() < kSmallSquare) return J;
  const Matrix3d inverse = inverse_left_jacobian(w);
  J.topLeftCorner<3, 3>() = J.bottomRightCorner<3, 3>() = inverse;
  J.topRightCorner<3, 3>() = -inverse * coupling(twist.head<3>(), w) * inverse;
  return J;
}

Matrix6d adjoint(const Transform& X) {
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = X.R;
  A.topRightCorner<3, 3>() = skew(X.p) * X.R;
  return A;
}

}  // namespace gloam::ik

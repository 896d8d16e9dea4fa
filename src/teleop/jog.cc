#include "teleop/jog.h"

#include <Eigen/Geometry>
#include <cmath>

namespace gloam::teleop {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d position(const Pose& X) { return {X.p.x, X.p.y, X.p.z}; }
Quaterniond rotation(const Pose& X) { return Quaterniond(X.q.w, X.q.x, X.q.y, X.q.z).normalized(); }

}  // namespace

JogStep key_step(int speed) { return {0.002 * speed, 0.01 * speed}; }

JogStep stick_step(int speed, double seconds) {
  return {0.02 * speed * seconds, 0.1 * speed * seconds};
}

Pose jogged(const Pose& X_WG, const Pose& X_WF, double yaw, const Deflection& move,
            const JogStep& step) {
  const Vector3d p_WF = position(X_WF);
  const Quaterniond R_WF = rotation(X_WF);
  Vector3d p_WG = position(X_WG);
  Quaterniond R_WG = rotation(X_WG);
  if ((p_WG - p_WF).norm() > kForeign * kJogReach ||
      R_WG.angularDistance(R_WF) > kForeign * kJogTurn) {
    p_WG = p_WF;
    R_WG = R_WF;
  }
  const Quaterniond R_WH(AngleAxisd(yaw, Vector3d::UnitZ()));
  p_WG += step.distance * (R_WH * Vector3d(move.forward, move.left, move.up));
  const Vector3d turn_W = step.angle * (R_WH * Vector3d(move.roll, move.pitch, move.turn));
  if (turn_W.norm() > 0) R_WG = AngleAxisd(turn_W.norm(), turn_W.normalized()) * R_WG;
  const Vector3d lead = p_WG - p_WF;
  if (lead.norm() > kJogReach) p_WG = p_WF + lead * (kJogReach / lead.norm());
  const double angle = R_WG.angularDistance(R_WF);
  if (angle > kJogTurn) R_WG = R_WF.slerp(kJogTurn / angle, R_WG);
  R_WG.normalize();
  return {{p_WG.x(), p_WG.y(), p_WG.z()}, {R_WG.w(), R_WG.x(), R_WG.y(), R_WG.z()}};
}

double heading(const Pose& X_WB) {
  const Vector3d x_W = rotation(X_WB) * Vector3d::UnitX();
  return std::atan2(x_W.y(), x_W.x());
}

}  // namespace gloam::teleop

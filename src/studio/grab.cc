#include "studio/grab.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace gloam::studio {
namespace {

Error refuse(const char* text) { return {ErrorKind::kUsage, text}; }

Quat product(const Quat& a, const Quat& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Quat rotation(const Vec3& axis, double angle) {
  const double s = std::sin(angle / 2);
  return {std::cos(angle / 2), s * axis.x, s * axis.y, s * axis.z};
}

bool is_near(const Pose& a, const Pose& b) {
  const double turned = std::abs(a.q.w - b.q.w) + std::abs(a.q.x - b.q.x) +
                        std::abs(a.q.y - b.q.y) + std::abs(a.q.z - b.q.z);
  return norm(a.p - b.p) < 1e-9 && turned < 1e-9;
}

}  // namespace

std::optional<Grab::Placing> Grab::placing_of(const Snapshot& now, int body) {
  Instant instant;
  if (!now || !instant.solve(now).ok()) return {};
  Placing placing;
  const auto mocap = instant.value("body_mocapid");
  placing.is_mocap = mocap.ok() && mocap->at(static_cast<size_t>(body)) >= 0;
  const auto types = instant.value("jnt_type"), bodies = instant.value("jnt_bodyid");
  for (size_t i = 0; types.ok() && bodies.ok() && i < types->size(); ++i)
    if ((*bodies)[i] == body && (*types)[i] == 0)  // mjJNT_FREE
      placing.free_joint = static_cast<int>(i);
  return placing;
}

Result<Grab> Grab::take(int64_t client, Simulation& simulation, const CameraFrame& frame,
                        const DragStartMessage& message) {
  Result<PickResult> hit = simulation.pick(frame, message.u, message.v);
  if (!hit.ok()) return refuse("There is nothing to grab here.");
  if (hit->body.id <= 0) return refuse("This is part of the world and cannot move.");
  Grab grab(client, std::move(*hit), message.turn);
  GLOAM_TRY(grab.X_WB_, simulation.body_pose(grab.body()));
  grab.placing_ = placing_of(simulation.latest(), grab.body().id);
  grab.depth_ = depth_of(frame.X_WC, frame.intrinsics, grab.hit_.point_W);
  grab.move_to(frame, message.u, message.v);
  grab.u0_ = grab.u_, grab.v0_ = grab.v_;
  return grab;
}

void Grab::move_to(const CameraFrame& frame, double u, double v) {
  u_ = u / frame.intrinsics.width, v_ = v / frame.intrinsics.height;
}

// A pulled body's pose as it would be without inertia; a turned one's orientation at its place.
std::optional<Pose> Grab::goal(const CameraFrame& frame) const {
  const Intrinsics& k = frame.intrinsics;
  if (turn_) {
    const double aspect = static_cast<double>(k.width) / k.height;
    const Vec3 right = rotate(frame.X_WC.q, {1, 0, 0}), up = rotate(frame.X_WC.q, {0, 1, 0});
    const Quat turned = product(rotation(up, std::numbers::pi * (u_ - u0_) * aspect),
                                rotation(right, std::numbers::pi * (v_ - v0_)));
    return Pose{X_WB_.p, product(turned, X_WB_.q)};
  }
  const auto target = point_at(frame.X_WC, k, u_ * k.width, v_ * k.height, depth_);
  if (!target) return {};
  return Pose{X_WB_.p + (*target - hit_.point_W), X_WB_.q};
}

std::vector<Command> Grab::place(const Pose& X_WB) const {
  if (placing_->is_mocap) return {{.what = SetMocapPose{body(), X_WB}}};
  if (placing_->free_joint < 0) return {};
  const Vec3& p = X_WB.p;
  const Quat& q = X_WB.q;
  return {
      {.what = SetJointState{{placing_->free_joint, 0}, {p.x, p.y, p.z, q.w, q.x, q.y, q.z}, {}}}};
}

std::vector<Command> Grab::follow(const CameraFrame& frame, bool paused) {
  const std::optional<Pose> X_WB = goal(frame);
  if (!X_WB || (last_ && is_near(*last_, *X_WB) && paused == was_paused_)) return {};
  last_ = X_WB;
  was_paused_ = paused;
  if (placing_ && (paused || placing_->is_mocap)) return place(*X_WB);
  if (turn_) return {{.what = TurnBody{body(), X_WB->q, true}}};
  const Vec3 target_W = hit_.point_W + (X_WB->p - X_WB_.p);
  return {{.what = DragBody{body(), hit_.point_B, target_W, true}}};
}

std::vector<Command> Grab::let_go() const {
  if (turn_) return {{.what = TurnBody{body(), {1, 0, 0, 0}, false}}};
  return {{.what = DragBody{body(), hit_.point_B, hit_.point_W, false}}};
}

}  // namespace gloam::studio

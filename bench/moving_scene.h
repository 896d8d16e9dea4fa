#pragma once
// A scene that steps between the images of a camera, which may move through it.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gloam/program.h"
#include "gloam/scene.h"
#include "runtime/live/live_simulation.h"
#include "sensors/camera/camera_sensor.h"

namespace gloam {

/// A simulation that stands still while an image is made.
class MovingScene {
 public:
  static Result<std::unique_ptr<MovingScene>> compile(const Scene& scene) {
    auto out = std::make_unique<MovingScene>();
    GLOAM_TRY(const World world, World::compile(scene));
    GLOAM_TRY(out->simulation, LiveSimulation::create(world, {.pace = Pace::kLockstep},
                                                      {.metering = Metering::kNever}));
    GLOAM_TRY(out->solver_, PoseSolver::create(world.compiled()));
    return out;
  }
  Status open_renderer() {
    GLOAM_TRY(shared, simulation->renderer());
    return {};
  }
  /// Steps to image `index` of `rate` images per second.
  Status step_to(int index, int rate) {
    const Rational step_rate = simulation->step_rate();
    const int64_t due = int64_t{index} * step_rate.num / (step_rate.den * rate);
    const int64_t ahead = due - simulation->latest().step();
    return ahead > 0 ? simulation->step(ahead) : Status{};
  }
  /// Solves the poses of this instant; the last ones become `previous`.
  Status solve() {
    std::swap(now, previous);
    GLOAM_TRY_STATUS(solver_->solve(simulation->latest(), now));
    if (!std::exchange(has_previous_, true)) previous = now;
    return {};
  }

  std::unique_ptr<LiveSimulation> simulation;
  std::shared_ptr<SharedRenderer> shared;  ///< null before open_renderer()
  PoseFrame now, previous;

 private:
  std::unique_ptr<PoseSolver> solver_;
  bool has_previous_ = false;
};

/// Shortest way from one rotation to another, `part` of it.
inline Quat slerp(const Quat& a, Quat b, double part) {
  double cosine = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
  if (cosine < 0) {
    b = {-b.w, -b.x, -b.y, -b.z};
    cosine = -cosine;
  }
  const double angle = std::acos(std::min(cosine, 1.0));
  const bool near = angle < 1e-6;
  const double s = near ? 1 - part : std::sin((1 - part) * angle) / std::sin(angle);
  const double t = near ? part : std::sin(part * angle) / std::sin(angle);
  return {s * a.w + t * b.w, s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

/// A camera of the scene, or the free camera on its way from one of them to another and back.
class BenchCamera {
 public:
  static constexpr double kSpeed = 0.7;  // a slow walk [m/s]

  /// `name`: of a camera, or FROM..TO. The two are where they are at `scene.now`.
  static Result<BenchCamera> find(const MovingScene& scene, const std::string& name) {
    BenchCamera out;
    const size_t dots = name.find("..");
    out.name_ = dots == std::string::npos ? name : "free";
    if (dots == std::string::npos) return out;
    GLOAM_TRY(out.from_, pose_of(scene, name.substr(0, dots)));
    GLOAM_TRY(out.to_, pose_of(scene, name.substr(dots + 2)));
    const Vec3 &a = out.from_.p, &b = out.to_.p;
    out.length_ = std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
    if (out.length_ > 1e-3) return out;
    return Error{ErrorKind::kInput, "the cameras " + name + " are at the same place", {}, ""};
  }
  const std::string& name() const { return name_; }
  /// Pose in the world; empty = as the scene moves it.
  std::optional<Pose> pose_at(double time) const {
    if (length_ == 0) return {};
    const double ways = std::fmod(kSpeed * time / length_, 2);
    const double part = ways < 1 ? ways : 2 - ways;
    const Vec3 &a = from_.p, &b = to_.p;
    const Vec3 p{a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.z + part * (b.z - a.z)};
    return Pose{p, slerp(from_.q, to_.q, part)};
  }

 private:
  static Result<Pose> pose_of(const MovingScene& scene, const std::string& name) {
    const RenderDescription& description = scene.shared->description;
    std::vector<std::string> names;
    for (size_t i = 0; i < description.cameras.size(); ++i) {
      const PoseFrame* const now = &scene.now;
      if (description.cameras[i].name == name) {
        const CameraView view = view_at(description, static_cast<int>(i), {&now, 1}, *now);
        return in_world(view.X_WC_open, description.origin);
      }
      names.push_back(description.cameras[i].name);
    }
    return Error{
        ErrorKind::kInput, "there is no camera '" + name + "'", {}, suggest_name(name, names)};
  }

  std::string name_;
  Pose from_, to_;
  double length_ = 0;  // [m]; 0: one camera of the scene
};

}  // namespace gloam

#include "sim/effects/wind/wind.h"

#include <algorithm>
#include <cmath>

#include "world/shapes/visual_pose.h"

namespace gloam {
namespace {

constexpr double kRoughness = 0.03;  // length [m]
constexpr double kLowest = 0.1;      // [m]; nearer to the ground the law says nothing
constexpr double kReference = 10;    // reference height of winds [m]
constexpr Rational kGustRate{100, 1};

}  // namespace

Wind::Wind(const WindDescription& wind) : wind_(wind) {
  if (blows()) gusts_.emplace(wind);
}

double Wind::mean_speed(double height) const {
  return wind_.speed * std::log(std::max(height, kLowest) / kRoughness) /
         std::log(kReference / kRoughness);
}

Vec3 Wind::gust(double time) const { return blows() ? gusts_->at(time) : Vec3{}; }

Vec3 Wind::with_mean(Vec3 gust, double height) const {
  const double mean = mean_speed(height);
  return {mean * wind_.along_x + gust.x, mean * wind_.along_y + gust.y, gust.z};
}

void give_air(mjOption* option) {
  if (option->density > 0 || option->viscosity > 0) return;
  option->density = kAir.density;
  option->viscosity = kAir.viscosity;
}

WindOnBodies::WindOnBodies(const CompiledWorld& world, Rational timestep)
    : wind_(world.wind),
      schedule_(StepSchedule::at_most(kGustRate, timestep)),
      timestep_(timestep.value()) {
  const mjModel& m = *world.model;
  const std::vector<Affine3f> X_WB = body_poses_at_qpos0(m);
  double mass = 0;
  const auto add = [&](int body) {
    const int joint = m.body_jntadr[body];
    const bool floats = joint >= 0 && m.jnt_type[joint] == mjJNT_FREE;
    roots_.push_back({floats ? m.jnt_qposadr[joint] + 2 : -1,
                      double{X_WB[static_cast<size_t>(body)].p.z}, m.body_subtreemass[body]});
    mass += m.body_subtreemass[body];
  };
  for (const RobotInstance& robot : world.robots) {
    if (robot.root_body > 0) add(robot.root_body);
  }
  for (int body = 1; roots_.empty() && body < m.nbody; ++body) {
    if (m.body_parentid[body] == 0 && m.body_dofnum[body] > 0) add(body);
  }
  for (Root& root : roots_) root.weight = mass > 0 ? root.weight / mass : 0;
}

void WindOnBodies::blow(int64_t step, const double* qpos, mjOption* option) {
  double height = 0;
  for (const Root& root : roots_)
    height += root.weight * (root.qpos >= 0 ? qpos[root.qpos] : root.z);
  const int64_t next = schedule_.first_at_or_after(step + 1);
  const int64_t since = schedule_.step_of(next - 1);
  if (since != gust_step_) gust_ = wind_.gust(static_cast<double>(since) * timestep_);
  gust_step_ = since;
  const Vec3 v = wind_.with_mean(gust_, height);
  option->wind[0] = v.x, option->wind[1] = v.y, option->wind[2] = v.z;
}

}  // namespace gloam

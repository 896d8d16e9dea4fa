// A planner in C++: drives towards the goal and turns away from what its LiDAR sees, like a charge
// in a potential field (Khatib, "Real-Time Obstacle Avoidance for Manipulators and Mobile Robots",
// 1986).
//
//   g++ -std=c++17 -O2 -shared -fPIC -Iinclude examples/planner_library/steer.cc -o
//   examples/planner_library/steer.so
//   ./gloam navigate examples/planner_library/arena.toml --allow-programs

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gloam/planner/plugin.h"

namespace {

constexpr double kReach = 1.2;   // of obstacles [m]
constexpr double kBody = 0.35;   // nearer points are the robot's own [m]
constexpr double kTurn = 1.5;    // yaw rate per angle to the wanted direction [1/s]
constexpr double kMostTurn = 1;  // [rad/s]

class Steer final : public gloam::PlannerPlugin {
 public:
  static constexpr GloamPlannerInfo kInfo = {10, 0.05, GLOAM_PLANNER_SCAN, 0, 0};

  void reset(const GloamPlannerTask& task) override {
    if (!task.has_goal) throw std::invalid_argument("this planner needs the position of the goal");
    goal_x_ = task.goal[0], goal_y_ = task.goal[1];
    radius_ = task.goal_radius, top_speed_ = task.top_speed;
  }

  void plan(const GloamPlannerObservation& in, GloamPlannerAnswer* answer) override {
    const double dx = goal_x_ - in.pose[0], dy = goal_y_ - in.pose[1];
    const double distance = std::hypot(dx, dy);
    if (distance < 0.8 * radius_) {
      answer->kind = GLOAM_PLANNER_ARRIVED;
      return;
    }
    const double bearing = std::atan2(dy, dx) - in.pose[2];
    double x = std::cos(bearing), y = std::sin(bearing);  // wanted direction in the robot's frame
    add_obstacles(in, &x, &y);
    const double angle = std::atan2(y, x);
    answer->kind = GLOAM_PLANNER_VELOCITY;
    answer->velocity[0] = top_speed_ * std::max(0.0, std::cos(angle));
    answer->velocity[2] = std::clamp(kTurn * angle, -kMostTurn, kMostTurn);
  }

 private:
  /// Adds the force of the nearest point in each of 36 sectors around the robot.
  static void add_obstacles(const GloamPlannerObservation& in, double* x, double* y) {
    double nearest[36];
    std::fill(std::begin(nearest), std::end(nearest), kReach);
    for (int64_t i = 0; i < in.scan_size; ++i) {
      const float* p = in.scan + 3 * i;
      const double distance = std::hypot(p[0], p[1]);
      if (p[2] < -0.22f || p[2] > 0.3f || distance < kBody || distance > kReach) continue;
      const int sector = static_cast<int>((std::atan2(p[1], p[0]) / M_PI + 1) * 18) % 36;
      nearest[sector] = std::min(nearest[sector], distance);
    }
    for (int k = 0; k < 36; ++k) {
      const double angle = (k + 0.5) * M_PI / 18 - M_PI;
      const double force = 0.15 * (1 / nearest[k] - 1 / kReach);
      *x -= force * std::cos(angle);
      *y -= force * std::sin(angle);
    }
  }

  double goal_x_ = 0, goal_y_ = 0, radius_ = 0, top_speed_ = 0;
};

}  // namespace

GLOAM_PLANNER(Steer)

// Goals of navigation, reached one after the other.
//
// SPL, success weighted by path length: S · l / max(p, l) with the shortest way l and the way taken
// p (Anderson et al. 2018, On Evaluation of Embodied Navigation Agents, arXiv:1807.06757, eq. 1).
// SCT, success weighted by completion time: S · T / max(C, T) with the time T that the shortest way
// takes at the robot's speed and the time C that it took (Yokoyama, Ha and Batra 2021, arXiv:
// 2103.08022). The shortest way is `shortest_path` of the goals; where it is empty, on the
// navigation mesh of the scene's agents, without agents a straight line.

#include <algorithm>
#include <cmath>

#include "metrics/builtin/robot_metric.h"
#include "metrics/builtin/shortest_way.h"

namespace gloam {
namespace {

class GoalMetric final : public RobotMetric {
 public:
  explicit GoalMetric(const MetricRobot& robot)
      : world_(robot.world), root_(robot.root()), goals_(robot.goals) {}
  std::vector<MetricColumn> columns() const override {
    return {{"goal_distance", "m"}, {"goals_reached", ""}, {"success", ""}};
  }
  void begin_episode() override {
    has_start_ = failed_ = false;
    reached_ = 0;
    way_ = shortest_ = fastest_ = 0;
  }

  /// The distance is to the goal that comes next; of the last one for good.
  void sample(const MetricInstant& instant, std::span<double> out) override {
    const mjtNum* p = instant.data->xpos + 3 * root_;
    if (!has_start_) begin(instant);
    if (!is_done()) way_ += std::hypot(p[0] - last_[0], p[1] - last_[1]);
    std::copy_n(p, 2, last_);
    while (!is_done()) {
      const GoalOptions& goal = goals_[reached_];
      if (goal.time_limit > 0 && instant.time() > goal.time_limit) failed_ = true;
      if (failed_ || distance_to(goal, p) > goal.radius) break;
      ++reached_;
      time_ = instant.time();
    }
    distance_ = distance_to(goals_[std::min(reached_, goals_.size() - 1)], p);
    out[0] = distance_;
    out[1] = static_cast<double>(reached_);
    out[2] = is_success() ? 1 : 0;
  }

  void summarize(std::vector<MetricNumber>* numbers) const override {
    const double success = is_success() ? 1 : 0;
    numbers->emplace_back("success", success);
    numbers->emplace_back("goals_reached", static_cast<double>(reached_));
    numbers->emplace_back("goal_distance_m", distance_);
    if (is_success()) numbers->emplace_back("time_to_goal_s", time_);
    const auto weight = [&](double best, double taken) {
      return taken > best ? best / taken : 1.0;  // also where both are 0
    };
    numbers->emplace_back("spl", success * weight(shortest_, way_));
    if (fastest_ > 0) numbers->emplace_back("sct", success * weight(fastest_, time_));
  }

 private:
  static double distance_to(const GoalOptions& goal, const mjtNum* p) {
    return std::hypot(p[0] - goal.position.x, p[1] - goal.position.y);
  }
  bool is_success() const { return reached_ == goals_.size(); }
  bool is_done() const { return failed_ || is_success(); }
  void begin(const MetricInstant& instant) {
    has_start_ = true;
    const mjtNum* p = instant.data->xpos + 3 * root_;
    std::copy_n(p, 2, last_);
    Vec3 from{p[0], p[1], p[2]};
    bool has_speeds = true;
    for (const GoalOptions& goal : goals_) {
      if (!goal.shortest_path && ways_ == nullptr)
        ways_ = std::make_unique<ShortestWays>(*world_, instant);
      const double leg =
          goal.shortest_path ? *goal.shortest_path : ways_->length(from, goal.position);
      shortest_ += leg;
      has_speeds = has_speeds && goal.top_speed > 0;
      if (has_speeds) fastest_ += leg / goal.top_speed;
      from = goal.position;
    }
    if (!has_speeds) fastest_ = 0;
  }

  const CompiledWorld* world_;
  int root_;
  std::vector<GoalOptions> goals_;
  std::unique_ptr<ShortestWays> ways_;  // of the first episode's start
  bool has_start_ = false, failed_ = false;
  size_t reached_ = 0;
  double last_[2] = {}, distance_ = 0;           // [m]
  double way_ = 0, shortest_ = 0, fastest_ = 0;  // [m], [m], [s]
  double time_ = 0;                              // at which the last goal was reached [s]
};

}  // namespace

std::unique_ptr<RobotMetric> make_goal_metric(const MetricRobot& robot) {
  if (robot.goals.empty() || robot.root() <= 0) return nullptr;
  return std::make_unique<GoalMetric>(robot);
}

}  // namespace gloam

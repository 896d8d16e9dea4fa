// Collisions as episodes: a body of the robot touches a thing, and has touched none of its geoms
// for half a second before. Standing is no collision: contacts with what never moves (the ground,
// a terrain, a floor) whose normal is within 45 degrees of the vertical, and contacts of the robot
// with itself.

#include <algorithm>
#include <limits>
#include <map>

#include "metrics/builtin/robot_contact.h"
#include "world/model_names.h"

namespace gloam {
namespace {

constexpr double kMergeInterval = 0.5;      // [s]
constexpr double kMinGroundNormal = 0.707;  // |z| of the normal of what is stood on: 45 degrees

class CollisionMetric final : public RobotMetric {
 public:
  explicit CollisionMetric(const MetricRobot& robot)
      : robot_(robot), things_(static_cast<size_t>(robot.world->model->nbody)) {}

  std::vector<MetricColumn> columns() const override {
    return {{"collisions", ""}, {"collision_force", "N"}};
  }
  void begin_episode() override {
    std::ranges::fill(things_, Thing());
    count_ = 0;
    peak_ = 0;
  }
  void sample(const MetricInstant& instant, std::span<double> out) override {
    double force = 0;
    for (const ContactState& contact : instant.contacts) {
      const auto touch = contact_of(robot_, *instant.model, contact);
      if (!touch || is_support(*instant.model, *touch)) continue;
      Thing& thing = things_[static_cast<size_t>(touch->other_body)];
      if (instant.time() - thing.last_touch >= kMergeInterval) {
        ++thing.count;
        ++count_;
      }
      thing.last_touch = instant.time();
      force += touch->force;
    }
    peak_ = std::max(peak_, force);
    out[0] = static_cast<double>(count_);
    out[1] = force;
  }
  void summarize(std::vector<MetricNumber>* numbers) const override {
    numbers->emplace_back("collisions", static_cast<double>(count_));
    if (count_ == 0) return;
    numbers->emplace_back("collision_force_max_N", peak_);
    std::map<std::string, double> by_name;
    for (size_t body = 0; body < things_.size(); ++body)
      if (things_[body].count > 0)
        by_name[name_of_thing(static_cast<int>(body))] += static_cast<double>(things_[body].count);
    for (const auto& [name, count] : by_name) numbers->emplace_back("collisions." + name, count);
  }

 private:
  struct Thing {
    double last_touch = -std::numeric_limits<double>::infinity();  // [s]
    int64_t count = 0;
  };

  static bool is_support(const mjModel& m, const RobotContact& touch) {
    const bool moves = m.body_weldid[touch.other_body] != 0;
    return !moves && touch.steepness > kMinGroundNormal;
  }
  std::string name_of_thing(int body) const {
    if (body == 0) return "world";
    const std::string name = name_of(*robot_.world->model, mjOBJ_BODY, body);
    return name.empty() ? "body " + std::to_string(body) : name;
  }

  MetricRobot robot_;
  std::vector<Thing> things_;  // by body
  int64_t count_ = 0;
  double peak_ = 0;  // [N]
};

}  // namespace

std::unique_ptr<RobotMetric> make_collision_metric(const MetricRobot& robot) {
  if (robot.base < 0 && robot.actuators.empty()) return nullptr;
  return std::make_unique<CollisionMetric>(robot);
}

}  // namespace gloam

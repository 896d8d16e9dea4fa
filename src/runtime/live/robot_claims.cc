#include "runtime/live/robot_claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "world/world_robots.h"

namespace gloam {
namespace {

// The robot of which `elements` holds the element, -1 = none.
template <class Elements>
int owner_of(const CompiledWorld& world, int element, Elements elements) {
  for (size_t robot = 0; robot < world.robots.size(); ++robot) {
    const std::vector<int> own = elements(*world.model, world.robots[robot]);
    if (std::find(own.begin(), own.end(), element) != own.end()) return static_cast<int>(robot);
  }
  return -1;
}

// The robot that a Command drives, -1 = none.
int driven_robot(const CompiledWorld& world, const Command& command) {
  return std::visit(
      [&world](const auto& what) {
        using T = std::decay_t<decltype(what)>;
        if constexpr (std::is_same_v<T, StopTrajectory>) {
          return -1;  // a claim protects no motion from being stopped
        } else if constexpr (requires { what.robot; }) {
          return what.robot.id;
        } else if constexpr (std::is_same_v<T, SetControl>) {
          return owner_of(world, what.actuator.id, robot_actuators);
        } else if constexpr (std::is_same_v<T, SetJointGoal>) {
          return owner_of(world, what.joint.id, robot_joints);
        } else {
          return -1;
        }
      },
      command.what);
}

}  // namespace

class RobotClaims::Lease final : public ControlLease {
 public:
  Lease(std::shared_ptr<Table> table, std::string robot, Post post)
      : table_(std::move(table)), robot_(std::move(robot)), post_(std::move(post)) {}
  ~Lease() override {
    const std::lock_guard lock(table_->mutex);
    table_->by_robot.erase(robot_);
  }
  std::string robot() const override { return robot_; }
  Status post(std::span<const Command> commands) override { return post_(commands, robot_); }

 private:
  std::shared_ptr<Table> table_;
  std::string robot_;
  Post post_;
};

Result<std::unique_ptr<ControlLease>> RobotClaims::claim(
    const std::shared_ptr<const CompiledWorld>& world, Robot robot, Post post) {
  const bool is_other = robot.world != 0 && robot.world != world->serial;
  if (is_other || robot.id < 0 || static_cast<size_t>(robot.id) >= world->robots.size()) {
    return Error{ErrorKind::kUsage,
                 fmt::format("there is no robot number {} in the running World", robot.id),
                 {},
                 "look it up in Simulation::world()"};
  }
  const std::string& name = world->robots[static_cast<size_t>(robot.id)].name;
  const std::lock_guard lock(table_->mutex);
  if (table_->by_robot.contains(name)) {
    return Error{ErrorKind::kUsage,
                 fmt::format("robot '{}' is already claimed", name),
                 {},
                 "wait until its ControlLease is released"};
  }
  auto lease = std::make_unique<Lease>(table_, name, std::move(post));
  table_->by_robot.emplace(name, lease.get());
  return std::unique_ptr<ControlLease>(std::move(lease));
}

Status RobotClaims::check(const CompiledWorld& world, std::span<const Command> commands,
                          const std::string& holder) const {
  const std::lock_guard lock(table_->mutex);
  if (table_->by_robot.empty()) return {};
  for (const Command& command : commands) {
    const int robot = driven_robot(world, command);
    if (robot < 0 || static_cast<size_t>(robot) >= world.robots.size()) continue;
    const std::string& name = world.robots[static_cast<size_t>(robot)].name;
    if (name != holder && table_->by_robot.contains(name)) {
      return Error{ErrorKind::kUsage,
                   fmt::format("robot '{}' is claimed by another client", name),
                   {},
                   "claim it after its ControlLease has been released"};
    }
  }
  return {};
}

}  // namespace gloam

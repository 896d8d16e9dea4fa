#include "control/parted_controller.h"

#include <fmt/format.h>
#include <re2/re2.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "base/text.h"
#include "control/controllers.h"
#include "control/robot_joints.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

/// An actuator on a joint of a robot.
struct JointActuator {
  int actuator = -1;
  std::string joint;  // without the robot's prefix
  const RobotPart* part = nullptr;
};

// One row for each joint that an actuator moves, by itself or by a tendon.
std::vector<JointActuator> joint_actuators(const mjModel& model, const RobotInstance& robot) {
  std::vector<JointActuator> rows;
  for (int actuator = 0; actuator < model.nactuator; ++actuator) {
    const int target = model.actuator_trnid[2 * actuator];
    const int transmission = model.actuator_trntype[actuator];
    std::vector<int> joints;
    if (transmission == mjTRN_JOINT) joints = {target};
    if (transmission == mjTRN_TENDON) joints = joints_of_tendon(model, target);
    for (const int joint : joints) {
      if (!is_part_of(model, model.jnt_bodyid[joint], robot.root_body)) continue;
      rows.push_back({actuator, joint_name(model, joint, robot)});
    }
  }
  return rows;
}

// The actuators of a part, or those that no part claims.
std::vector<int> actuators_of(const std::vector<JointActuator>& rows, const RobotPart* part) {
  std::set<int> claimed, own;
  for (const JointActuator& row : rows) {
    if (row.part != nullptr) claimed.insert(row.actuator);
    if (row.part == part) own.insert(row.actuator);
  }
  if (part == nullptr) std::erase_if(own, [&](int actuator) { return claimed.contains(actuator); });
  // An empty list would mean all actuators.
  return own.empty() ? std::vector<int>{-1} : std::vector<int>(own.begin(), own.end());
}

// Marks the actuators of a part's joints; returns how many match `pattern`.
Result<int> claim(const RobotInstance& robot, const RobotPart& part, const std::string& pattern,
                  std::vector<JointActuator>* rows) {
  const RE2 expression(pattern, RE2::Quiet);
  int count = 0;
  for (JointActuator& row : *rows) {
    if (row.joint != pattern && !(expression.ok() && RE2::FullMatch(row.joint, expression)))
      continue;
    if (row.part != nullptr && row.part != &part) {
      return Error{ErrorKind::kInput,
                   fmt::format("joint '{}' of robot '{}' belongs to the parts '{}' and '{}'",
                               row.joint, robot.name, row.part->name, part.name),
                   part.loc, "give every joint to one part only"};
    }
    row.part = &part;
    ++count;
  }
  return count;
}

Status claim_all(const RobotInstance& robot, std::vector<JointActuator>* rows) {
  for (const RobotPart& part : robot.options.parts) {
    for (const std::string& pattern : part.joints) {
      GLOAM_TRY(const int count, claim(robot, part, pattern, rows));
      if (count > 0) continue;
      std::vector<std::string> names;
      for (const JointActuator& row : *rows) names.push_back(row.joint);
      return Error{ErrorKind::kInput,
                   fmt::format("part '{}': robot '{}' has no driven joint '{}'", part.name,
                               robot.name, pattern),
                   part.loc, suggest_name(pattern, names)};
    }
  }
  return {};
}

class PartedController final : public Controller {
 public:
  struct Child {
    std::string part;  // "" = the robot's own controller
    std::unique_ptr<Controller> controller;
    ControllerOptions options;
    int64_t every = 1;  // calls of the whole per call
  };
  explicit PartedController(std::vector<Child> children) : children_(std::move(children)) {}

  ControllerTraits traits() const override {
    ControllerTraits all;
    for (const Child& child : children_) {
      const ControllerTraits own = child.controller->traits();
      all.every_step = all.every_step || own.every_step;
      all.is_logged = all.is_logged || own.is_logged;
    }
    return all;
  }

  Status set_period(double period) override {
    for (Child& child : children_) {
      const double rate = child.options.rate.value();
      const double ratio = child.controller->traits().every_step ? 1 : 1 / (rate * period);
      child.every = std::llround(ratio);
      if (child.every < 1 || std::abs(ratio - static_cast<double>(child.every)) > 1e-6) {
        return Error{ErrorKind::kInput,
                     fmt::format("the rate of part '{}', {:g} Hz, does not divide the rate of its "
                                 "robot, {:g} Hz",
                                 child.part, rate, 1 / period),
                     child.options.loc, "choose a rate that divides it"};
      }
      GLOAM_TRY_STATUS(child.controller->set_period(period * static_cast<double>(child.every)));
    }
    return {};
  }

  void reset(const mjModel* model, const mjData* data) override {
    calls_ = 0;
    for (Child& child : children_) child.controller->reset(model, data);
  }

  void take_over(const mjModel* model, const mjData* data, const Controller& before) override {
    const auto* old = dynamic_cast<const PartedController*>(&before);
    calls_ = old != nullptr ? old->calls_ : 0;
    for (Child& child : children_) {
      const Controller* same =
          old != nullptr ? old->find(child.part) : (child.part.empty() ? &before : nullptr);
      if (same != nullptr) {
        child.controller->take_over(model, data, *same);
      } else {
        child.controller->reset(model, data);
      }
    }
  }

  void control(const ControlInputs& in) override {
    for (Child& child : children_) {
      if (calls_ % child.every != 0) continue;
      ControlInputs own = in;
      own.period = in.period * static_cast<double>(child.every);
      child.controller->control(own);
    }
    ++calls_;
  }

  std::unique_ptr<Controller> clone() const override {
    std::vector<Child> copies;
    for (const Child& child : children_) {
      copies.push_back({child.part, child.controller->clone(), child.options, child.every});
      if (copies.back().controller == nullptr) return nullptr;
    }
    auto copy = std::make_unique<PartedController>(std::move(copies));
    copy->calls_ = calls_;
    return copy;
  }

  const Controller* own() const override {
    const Controller* const found = find("");
    return found != nullptr ? found->own() : nullptr;
  }

 private:
  const Controller* find(const std::string& part) const {
    const auto row = std::ranges::find(children_, part, &Child::part);
    return row == children_.end() ? nullptr : row->controller.get();
  }

  std::vector<Child> children_;
  int64_t calls_ = 0;
};

}  // namespace

Result<std::vector<ControlledPart>> robot_parts(const mjModel& model, const RobotInstance& robot) {
  std::vector<ControlledPart> parts;
  if (robot.options.parts.empty()) return std::vector<ControlledPart>{{"", robot}};
  std::vector<JointActuator> rows = joint_actuators(model, robot);
  GLOAM_TRY_STATUS(claim_all(robot, &rows));
  const auto add = [&](std::string name, const ControllerOptions& options, const RobotPart* part) {
    RobotInstance instance = robot;
    instance.options.controller = options;
    instance.options.parts.clear();
    instance.actuators = actuators_of(rows, part);
    parts.push_back({std::move(name), std::move(instance)});
  };
  add("", robot.options.controller, nullptr);
  for (const RobotPart& part : robot.options.parts) add(part.name, part.controller, &part);
  return parts;
}

Result<std::unique_ptr<Controller>> make_parted_controller(
    const std::shared_ptr<const CompiledWorld>& world, const RobotInstance& robot) {
  GLOAM_TRY(std::vector<ControlledPart> parts, robot_parts(*world->model, robot));
  std::vector<PartedController::Child> children;
  for (ControlledPart& part : parts) {
    GLOAM_TRY(auto controller, make_controller(world, part.robot));
    if (controller == nullptr) continue;
    children.push_back(
        {std::move(part.name), std::move(controller), part.robot.options.controller});
  }
  return std::unique_ptr<Controller>(std::make_unique<PartedController>(std::move(children)));
}

}  // namespace gloam

// Topics of actuator models ([[robot.actuator]]): battery and motors.

#include <cmath>
#include <limits>

#include "ros/messages/gloam_msgs.h"
#include "ros/messages/sensor_msgs.h"
#include "topics/model_frames.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/model_names.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr Rational kBatteryRate = {1, 1};  // [Hz]

InstantEncoder battery_state(int robot, std::string name) {
  return
      [robot, name = std::move(name)](const TopicInfo& topic, TopicInstant& at, MessageBytes* out) {
        using sensor_msgs::BatteryState;
        constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
        BatteryState message;
        message.header = ros_header(at.snapshot().time(), topic.frame_id);
        message.voltage = message.current = message.charge = message.capacity = kUnknown;
        message.percentage = message.temperature = kUnknown;
        message.location = name;
        if (const ActuatorOutputs* o = at.snapshot().actuators(Robot{robot}); o != nullptr) {
          message.voltage = static_cast<float>(o->voltage);
          message.current = static_cast<float>(-o->current);
          message.percentage = static_cast<float>(o->charge);
          message.charge = static_cast<float>(o->charge * o->capacity);
          message.capacity = static_cast<float>(o->capacity);
          message.present = true;
          message.power_supply_status =
              o->current > 0   ? BatteryState::POWER_SUPPLY_STATUS_DISCHARGING
              : o->current < 0 ? BatteryState::POWER_SUPPLY_STATUS_CHARGING
                               : BatteryState::POWER_SUPPLY_STATUS_NOT_CHARGING;
          message.power_supply_health = o->charge > 0 ? BatteryState::POWER_SUPPLY_HEALTH_GOOD
                                                      : BatteryState::POWER_SUPPLY_HEALTH_DEAD;
        }
        message.design_capacity = message.capacity;
        encode(message, out);
        return Status();
      };
}

InstantEncoder actuator_states(int robot, std::string prefix) {
  return [robot, prefix = std::move(prefix)](const TopicInfo& topic, TopicInstant& at,
                                             MessageBytes* out) {
    const mjModel& m = at.model();
    gloam_msgs::ActuatorStates message;
    message.header = ros_header(at.snapshot().time(), topic.frame_id);
    if (const ActuatorOutputs* o = at.snapshot().actuators(Robot{robot}); o != nullptr) {
      for (const DriveOutput& drive : o->drives) {
        const mjtNum* gear = m.actuator_gear + 6 * m.actuator_outadr[drive.actuator];
        const bool is_propeller = m.actuator_trntype[drive.actuator] == mjTRN_SITE;
        message.name.push_back(is_propeller
                                   ? local_name(name_of(m, mjOBJ_ACTUATOR, drive.actuator), prefix)
                                   : joint_label(m, m.actuator_trnid[2 * drive.actuator], prefix));
        const double per_force = is_propeller ? mju_norm3(gear) : gear[0];
        message.torque.push_back(std::isfinite(drive.force) ? per_force * drive.force : 0);
        message.speed.push_back(drive.speed);
        message.current.push_back(drive.current);
        message.temperature.push_back(drive.temperature);
      }
      message.power = o->power;
      message.energy = o->energy;
    }
    encode(message, out);
    return Status();
  };
}

}  // namespace

void add_actuator_topics(const TopicWorld& world, TopicTable* table) {
  for (size_t i = 0; i < world->robots.size(); ++i) {
    const RobotInstance& robot = world->robots[i];
    if (robot.options.actuator.empty()) continue;
    const std::string root =
        robot.root_body > 0 ? body_frame(*world->model, robot.root_body) : kWorldFrameId;
    const auto add = [&](const char* name, std::string type, Rational rate, InstantEncoder encode) {
      table->push_back({{.name = "/" + topic_token(robot.name) + name,
                         .type = std::move(type),
                         .frame_id = root,
                         .rate = rate,
                         .source = {TopicSource::Kind::kRobot, robot.name}},
                        {},
                        {},
                        std::move(encode)});
    };
    const int number = static_cast<int>(i);
    add("/actuators", type_name<gloam_msgs::ActuatorStates>(), kStateRate,
        actuator_states(number, robot.prefix));
    if (robot.options.actuators && robot.options.actuators->battery)
      add("/battery", type_name<sensor_msgs::BatteryState>(), kBatteryRate,
          battery_state(number, robot.name));
  }
}

}  // namespace gloam

#include "scene/validate/validate_actuator.h"

#include <fmt/format.h>
#include <re2/re2.h>

#include <string>

namespace gloam {
namespace {

using Table = std::vector<std::array<double, 2>>;

// The complaint about the rows of a table of two columns; "" = none.
std::string fault_of(const Table& curve) {
  if (curve.size() < 2) return "needs at least two rows";
  if (curve[0][0] != 0) return fmt::format("begins at {:g}, not at 0", curve[0][0]);
  for (size_t i = 1; i < curve.size(); ++i)
    if (!(curve[i][0] > curve[i - 1][0]))
      return fmt::format("has {:g} after {:g}", curve[i][0], curve[i - 1][0]);
  return "";
}

Error error_at(const SourceLoc& loc, std::string message, std::string hint) {
  return {ErrorKind::kInput, std::move(message), loc, std::move(hint)};
}

Status validate_torque_speed(const ActuatorOptions& o, const std::string& where) {
  if ((o.stall_torque > 0) != (o.no_load_speed > 0))
    return error_at(o.loc,
                    fmt::format("{} has '{}' alone", where,
                                o.stall_torque > 0 ? "stall_torque" : "no_load_speed"),
                    "a DC motor needs both 'stall_torque' and 'no_load_speed'");
  if (o.curve.empty()) return {};
  if (o.stall_torque > 0)
    return error_at(o.loc, fmt::format("{} has both 'stall_torque' and 'curve'", where),
                    "specify only one of them");
  if (const std::string fault = fault_of(o.curve); !fault.empty())
    return error_at(o.loc, fmt::format("'curve' of {} {}", where, fault),
                    "write [speed, torque] rows with speeds that increase from 0");
  return {};
}

Status validate_thermal(const ActuatorOptions& o, const std::string& where) {
  if (!o.thermal) return {};
  if (!(o.torque_constant > 0 && o.winding_resistance > 0))
    return error_at(o.loc, fmt::format("{} has 'thermal', but its current is not known", where),
                    "specify 'torque_constant' and 'winding_resistance'");
  if (!(o.thermal->cutoff > o.thermal->derate_start))
    return error_at(o.loc,
                    fmt::format("'cutoff' of {} is {:g} °C, not above 'derate_start' ({:g} °C)",
                                where, o.thermal->cutoff, o.thermal->derate_start),
                    "raise 'cutoff'");
  if (!(o.torque_limit > 0 || o.stall_torque > 0 || !o.curve.empty()))
    return error_at(o.loc, fmt::format("{} has no torque limit that 'thermal' could lower", where),
                    "specify 'torque_limit', 'stall_torque' and 'no_load_speed', or 'curve'");
  return {};
}

// A propeller has neither the joint nor the torques that these keys describe.
const char* key_of_joints(const ActuatorOptions& o) {
  const ActuatorOptions none;
  if (o.joints != none.joints) return "joints";
  if (o.gear_ratio != none.gear_ratio) return "gear_ratio";
  if (o.stall_torque > 0 || o.no_load_speed > 0) return "stall_torque";
  if (!o.curve.empty()) return "curve";
  if (o.torque_limit > 0) return "torque_limit";
  if (o.backlash > 0) return "backlash";
  if (o.friction) return "friction";
  if (o.thermal) return "thermal";
  return o.network ? "network" : nullptr;
}

Status validate_motor(const ActuatorOptions& o, bool has_battery, const std::string& where) {
  const PropellerOptions& p = *o.propeller;
  if (has_battery && p.voltage > 0)
    return error_at(o.loc, fmt::format("the propeller of {} has 'voltage' beside a battery", where),
                    "remove 'voltage': the battery supplies the motor");
  if (o.torque_constant == 0) {
    if (p.no_load_current > 0 || p.current_limit > 0 || p.voltage > 0)
      return error_at(o.loc, fmt::format("the motor of {} has no 'torque_constant'", where),
                      "it is 9.549 / Kv, with Kv in rpm/V");
    return {};
  }
  const char* const missing = o.winding_resistance == 0        ? "winding_resistance"
                              : p.inertia == 0                 ? "propeller.inertia"
                              : !has_battery && p.voltage == 0 ? "propeller.voltage"
                                                               : nullptr;
  if (missing == nullptr) return {};
  return error_at(o.loc, fmt::format("the motor of {} has no '{}'", where, missing),
                  "a motor with 'torque_constant' needs 'winding_resistance', 'inertia', and a "
                  "battery or 'voltage'");
}

Status validate_propeller(const ActuatorOptions& o, bool has_battery, const std::string& where) {
  if (o.actuators.empty() != !o.propeller)
    return error_at(
        o.loc, fmt::format("{} has '{}' alone", where, o.propeller ? "propeller" : "actuators"),
        "a propeller needs 'actuators', names of actuators at sites, and 'propeller'");
  if (!o.propeller) return {};
  if (const char* key = key_of_joints(o); key != nullptr)
    return error_at(o.loc, fmt::format("{} has '{}', which is for joints", where, key),
                    "propellers have 'actuators', 'torque_constant', 'winding_resistance', 'delay' "
                    "and 'propeller'");
  const PropellerOptions& p = *o.propeller;
  if (p.zero_torque_advance &&
      !(p.zero_thrust_advance && *p.zero_torque_advance > *p.zero_thrust_advance))
    return error_at(
        o.loc, fmt::format("'zero_torque_advance' of {} is not above 'zero_thrust_advance'", where),
        "a propeller needs torque as long as it gives thrust");
  return validate_motor(o, has_battery, where);
}

Status validate_one(const ActuatorOptions& o, const RobotOptions& robot) {
  const std::string& names = o.actuators.empty() ? o.joints : o.actuators;
  const std::string where = fmt::format("actuator '{}' of robot '{}'", names, robot.name);
  const RE2 pattern(names, RE2::Quiet);
  if (!pattern.ok())
    return error_at(
        o.loc, fmt::format("'{}' is not a regular expression: {}", names, pattern.error()), "");
  GLOAM_TRY_STATUS(validate_propeller(o, robot.actuators && robot.actuators->battery, where));
  GLOAM_TRY_STATUS(validate_torque_speed(o, where));
  GLOAM_TRY_STATUS(validate_thermal(o, where));
  const ActuatorFriction friction = o.friction.value_or(ActuatorFriction{});
  if (friction.breakaway && *friction.breakaway < friction.coulomb)
    return error_at(o.loc,
                    fmt::format("'breakaway' of {} is {:g} N m, below 'coulomb' ({:g} N m)", where,
                                *friction.breakaway, friction.coulomb),
                    "friction at rest is at least the sliding friction");
  return {};
}

Status validate_battery(const BatteryOptions& o, const SourceLoc& loc, const std::string& where) {
  if ((o.voltage > 0) == !o.curve.empty())
    return error_at(loc,
                    fmt::format("{} has {}", where,
                                o.curve.empty() ? "no voltage" : "both 'voltage' and 'curve'"),
                    "specify 'voltage', or 'curve' over the charge");
  if (o.curve.empty()) return {};
  if (const std::string fault = fault_of(o.curve); !fault.empty())
    return error_at(loc, fmt::format("'curve' of {} {}", where, fault),
                    "write [charge, voltage] rows with charges that increase from 0 to 1");
  if (o.curve.back()[0] != 1)
    return error_at(loc,
                    fmt::format("'curve' of {} ends at {:g}, not at 1", where, o.curve.back()[0]),
                    "the last row is for the full battery, charge 1");
  if (!(o.curve[0][1] > 0))
    return error_at(loc, fmt::format("'curve' of {} begins with {:g} V", where, o.curve[0][1]),
                    "voltages must be positive; at charge 0 the battery switches off by itself");
  return {};
}

}  // namespace

Status validate_actuators(const RobotOptions& robot) {
  for (const ActuatorOptions& actuator : robot.actuator)
    GLOAM_TRY_STATUS(validate_one(actuator, robot));
  if (!robot.actuators) return {};
  const SharedActuatorOptions& shared = *robot.actuators;
  if (robot.actuator.empty())
    return error_at(shared.loc,
                    fmt::format("robot '{}' has [robot.actuators], but no actuators", robot.name),
                    "add [[robot.actuator]] with the joints that the settings are for");
  if (!shared.battery) return {};
  return validate_battery(*shared.battery, shared.loc,
                          fmt::format("the battery of robot '{}'", robot.name));
}

}  // namespace gloam

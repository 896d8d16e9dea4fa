// Propellers with fixed pitch on motors whose speed a controller (ESC) sets by the voltage.
//
// Propeller (McCormick 1995, "Aerodynamics, Aeronautics, and Flight Mechanics", chapter 6), linear
// in the advance ratio J = v / (n D): thrust = k_T w² (1 − J / J_T), torque = k_Q w² (1 − J / J_Q)
// with k_T = C_T ρ D⁴ / 4π² and k_Q = C_P ρ D⁵ / 8π³. Shaft: I dw/dt = k (i − i_0) − torque;
// winding: i = (U − k w) / R with 0 <= U <= the supply's voltage and |i| <= the current limit.
// Within these limits the speed approaches the speed of the commanded thrust exponentially.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/hash.h"
#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
// The motors of a robot and its battery limit each other at once, but the battery is solved after
// them, from their power. Where their windings have less resistance than the battery, a voltage of
// the step before would swing: it follows within this time instead [s].
constexpr double kVoltageTime = 0.01;
constexpr double kCreep = 1;  // speed below which the friction of the motor falls to zero [rad/s]

// Change over dt of a speed whose derivative is `rate` and falls by `decay` per speed [1/s]: exact
// for a linear law, and without a change at its equilibrium.
double change_over(double dt, double rate, double decay) {
  const double x = decay * dt;
  return rate * dt * (x > 1e-9 ? -std::expm1(-x) / x : 1);
}

struct Shaft {
  size_t row;
  double thrust_factor, torque_factor;          // k_T [N s²/rad²], k_Q [N m s²/rad²]
  double zero_thrust_speed, zero_torque_speed;  // v per shaft speed at which they are zero [m]
  double nominal_voltage;                       // [V]
  double highest;                               // commanded thrust at the start [N]
  double speed = 0;                             // of the shaft [rad/s]
  double supply = 1;                            // voltage over nominal voltage, smoothed

  // At the shaft speed w and the inflow v, for J from −J_T to 2 J_T.
  double air_speed(double w, double v) const {
    return std::isinf(zero_thrust_speed)
               ? v
               : std::clamp(v, -zero_thrust_speed * w, 2 * zero_thrust_speed * w);
  }
  double thrust(double w, double v) const {
    return thrust_factor * w * (w - air_speed(w, v) / zero_thrust_speed);
  }
  double torque(double w, double v) const {
    return torque_factor * w * (w - air_speed(w, v) / zero_torque_speed);
  }
  double speed_of(double static_thrust) const {
    return std::sqrt(std::max(0.0, static_thrust) / thrust_factor);
  }
};

// Torque that friction and iron losses of the motor take [N m].
double friction_of(const ActuatorOptions& o, double w) {
  return o.torque_constant * o.propeller->no_load_current * std::min(1.0, w / kCreep);
}

// Changes of the shaft's speed over dt that the voltage and current of the drive allow.
struct ChangeRange {
  double low = -kUnlimited, high = kUnlimited;  // [rad/s]
};

ChangeRange change_range(const Shaft& shaft, const Drive& drive, double dt) {
  const ActuatorOptions& o = drive.options();
  const double k = o.torque_constant, w = shaft.speed, inertia = o.propeller->inertia;
  const bool is_off = drive.supply <= 0;
  if (is_off && inertia == 0) return {-kUnlimited, -kUnlimited};
  if (!is_off && k == 0) return {};  // the motor is not modelled
  const double load = shaft.torque(w, drive.inflow) + friction_of(o, w);
  const double load_decay = 2 * shaft.torque_factor * w / inertia;  // [1/s]
  const auto with_current = [&](double i) {
    return change_over(dt, (k * i - load) / inertia, load_decay);
  };
  if (is_off) return {with_current(0), with_current(0)};  // the motor turns freely
  const auto with_voltage = [&](double volts) {
    return change_over(dt, (k * (volts - k * w) / o.winding_resistance - load) / inertia,
                       load_decay + k * k / (o.winding_resistance * inertia));
  };
  ChangeRange range{with_voltage(0), with_voltage(shaft.supply * shaft.nominal_voltage)};
  if (const double most = o.propeller->current_limit; most > 0)
    range = {std::max(range.low, with_current(-most)), std::min(range.high, with_current(most))};
  return {std::min(range.low, range.high), range.high};
}

class Propellers final : public ActuatorModel {
 public:
  explicit Propellers(std::vector<Shaft> shafts) : shafts_(std::move(shafts)) {}

  std::string_view kind() const override { return "propellers"; }
  // They turn at the speed of the commanded thrust.
  void reset(std::span<Drive> drives) override {
    for (Shaft& shaft : shafts_) {
      Drive& drive = drives[shaft.row];
      shaft.speed =
          shaft.speed_of(std::min(drive.gain * drive.command * drive.gear, shaft.highest));
      shaft.supply = drive.supply;
      drive.shaft_speed = shaft.speed;
    }
  }
  void take_over(const ActuatorModel& before, std::span<const int> old_row) override {
    for (Shaft& shaft : shafts_)
      for (const Shaft& from : static_cast<const Propellers&>(before).shafts_)
        if (static_cast<int>(from.row) == old_row[shaft.row])
          shaft.speed = from.speed, shaft.supply = from.supply;
  }
  bool apply(ActuatorStep& step) override {
    for (Shaft& shaft : shafts_) turn(shaft, step.drives[shaft.row], step.timestep);
    return true;
  }
  uint64_t hash(uint64_t before) const override {
    for (const Shaft& shaft : shafts_) {
      const double memory[] = {shaft.speed, shaft.supply};
      before = hash_span<double>(memory, before);
    }
    return before;
  }
  std::unique_ptr<ActuatorModel> clone() const override {
    return std::make_unique<Propellers>(*this);
  }

 private:
  // The mean speed of the step gives thrust and torque, so that the energy of the shaft balances.
  static void turn(Shaft& shaft, Drive& drive, double dt) {
    const ActuatorOptions& o = drive.options();
    shaft.supply += -std::expm1(-dt / kVoltageTime) * (drive.supply - shaft.supply);
    const ChangeRange range = change_range(shaft, drive, dt);
    const double approach = -std::expm1(-dt / o.propeller->response_time);
    const double wanted = approach * (shaft.speed_of(drive.torque) - shaft.speed);
    const double next = std::max(0.0, shaft.speed + std::clamp(wanted, range.low, range.high));
    const double mean = 0.5 * (shaft.speed + next);
    const double gain = o.propeller->inertia * (next - shaft.speed) / dt;  // [N m]
    shaft.speed = next;
    drive.torque = shaft.thrust(mean, drive.inflow);
    drive.shaft_speed = mean;
    drive.shaft_torque =
        drive.supply > 0 ? gain + shaft.torque(mean, drive.inflow) + friction_of(o, mean) : 0;
  }

  std::vector<Shaft> shafts_;
};

Result<Shaft> make_shaft(const ActuatorParts& parts, size_t row) {
  const DriveSetup& drive = parts.drives[row];
  const PropellerOptions& o = *drive.options.propeller;
  const mjModel& m = parts.model;
  const mjtNum* gear = m.actuator_gear + 6 * drive.output;
  const double d4 = std::pow(o.diameter, 4), pi = M_PI;
  Shaft shaft{.row = row};
  shaft.thrust_factor = o.thrust_coefficient * o.air_density * d4 / (4 * pi * pi);
  const double reaction = std::abs(mju_dot3(gear, gear + 3)) / mju_dot3(gear, gear);  // [m]
  shaft.torque_factor = o.power_coefficient ? *o.power_coefficient * o.air_density * d4 *
                                                  o.diameter / (8 * pi * pi * pi)
                                            : reaction * shaft.thrust_factor;
  if (shaft.torque_factor == 0 && drive.options.torque_constant > 0)
    return Error{ErrorKind::kInput,
                 fmt::format("the propeller of actuator '{}' of robot '{}' has no torque",
                             drive.name, parts.robot.name),
                 drive.options.loc,
                 "specify 'power_coefficient', or the reaction torque in the actuator's gear"};
  const double turn = o.diameter / (2 * pi);  // J = v / (w · turn)
  shaft.zero_thrust_speed = o.zero_thrust_advance ? *o.zero_thrust_advance * turn : kUnlimited;
  shaft.zero_torque_speed = o.zero_torque_advance ? *o.zero_torque_advance * turn : kUnlimited;
  const auto& shared = parts.robot.actuators;
  shaft.nominal_voltage = shared && shared->battery ? nominal_voltage(*shared->battery) : o.voltage;
  const int a = drive.actuator;
  shaft.highest = kUnlimited;
  if (m.actuator_ctrllimited[drive.ctrl])
    shaft.highest = m.actuator_gainprm[mjNGAIN * a] * m.actuator_ctrlrange[2 * drive.ctrl + 1] *
                    mju_norm3(gear);
  return shaft;
}

}  // namespace

Result<std::unique_ptr<ActuatorModel>> make_propellers(const ActuatorParts& parts) {
  std::vector<Shaft> shafts;
  for (size_t row = 0; row < parts.drives.size(); ++row) {
    if (!parts.drives[row].options.propeller) continue;
    GLOAM_TRY(shafts.emplace_back(), make_shaft(parts, row));
  }
  if (shafts.empty()) return std::unique_ptr<ActuatorModel>();
  return std::unique_ptr<ActuatorModel>(std::make_unique<Propellers>(std::move(shafts)));
}

}  // namespace gloam

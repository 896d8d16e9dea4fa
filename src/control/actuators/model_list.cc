#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "control/actuators/actuator_model.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

Result<std::vector<std::unique_ptr<ActuatorModel>>> make_actuator_models(
    const ActuatorParts& parts) {
  // A new model is a line here. Controls become torques of the motor, which become torques at the
  // joint; battery and winding follow from the torque of the motor.
  static constexpr ActuatorModelMaker kMakers[] = {
      make_control_delay, make_drive_law,      make_torque_network, make_torque_limits,
      make_propellers,    make_electric_power, make_winding_heat,   make_battery,
      make_backlash,      make_gear_friction,
  };
  std::vector<std::unique_ptr<ActuatorModel>> models;
  for (const ActuatorModelMaker make : kMakers) {
    GLOAM_TRY(std::unique_ptr<ActuatorModel> model, make(parts));
    if (model != nullptr) models.push_back(std::move(model));
  }
  return models;
}

Result<int64_t> whole_steps(double seconds, Rational timestep, const std::string& what,
                            const SourceLoc& loc) {
  const Rational time = exact_rational(seconds);
  const __int128 up = static_cast<__int128>(time.num) * timestep.den;
  const __int128 down = static_cast<__int128>(time.den) * timestep.num;
  if (up % down == 0) return static_cast<int64_t>(up / down);
  const double step = timestep.value();
  const double below = std::floor(seconds / step) * step;
  return Error{
      ErrorKind::kInput,
      fmt::format("{} is {:g} s, not a multiple of the timestep of {:g} s", what, seconds, step),
      loc, fmt::format("use {:g} or {:g}", below, below + step)};
}

double interpolate(std::span<const std::array<double, 2>> rows, double x) {
  if (x <= rows.front()[0]) return rows.front()[1];
  for (size_t i = 1; i < rows.size(); ++i) {
    if (x > rows[i][0]) continue;
    const double share = (x - rows[i - 1][0]) / (rows[i][0] - rows[i - 1][0]);
    return rows[i - 1][1] + share * (rows[i][1] - rows[i - 1][1]);
  }
  return rows.back()[1];
}

}  // namespace gloam

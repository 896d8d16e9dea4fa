#include "bridge/ros2/services/node_parameters.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bridge/ros2/services/parameter_services.h"
#include "bridge/ros2/services/parameter_values.h"
#include "bridge/ros2/services/simulation_values.h"
#include "ros/codec.h"

namespace gloam::bridge {
namespace {

namespace ri = rcl_interfaces;
using ri::ParameterType;
using Outcome = ri::SetParametersResult;

constexpr OwnParameter kOwn[] = {
    {"use_sim_time", ParameterType::PARAMETER_BOOL, "The node is the clock", true},
    {"paused", ParameterType::PARAMETER_BOOL, "Whether the simulation rests", false},
    {"speed", ParameterType::PARAMETER_DOUBLE,
     "Simulated seconds per second, 0.001 … 1000; 0 = as fast as possible", false},
    {"gravity", ParameterType::PARAMETER_DOUBLE_ARRAY, "Gravity [m/s²]", false},
    {"wind", ParameterType::PARAMETER_DOUBLE_ARRAY, "Wind of MuJoCo's model [m/s]", false},
};

Outcome refused(std::string reason) { return {false, std::move(reason)}; }

}  // namespace

std::vector<OwnParameter> own_parameters() { return {std::begin(kOwn), std::end(kOwn)}; }

const OwnParameter* find_own_parameter(std::string_view name) {
  const auto* found = std::ranges::find_if(kOwn, [&](const auto& own) { return name == own.name; });
  return found == std::end(kOwn) ? nullptr : found;
}

bool is_fixed_option(std::string_view path) {
  constexpr std::string_view kFixed[] = {"sim.",    "record.", "bridge.", "randomize",
                                         "metric.", "goal.",   "scene."};
  return std::ranges::any_of(kFixed,
                             [&](std::string_view begin) { return path.starts_with(begin); });
}

ri::ParameterValue NodeParameters::value(const std::string& name) const {
  if (name == "use_sim_time") return bool_parameter(true);
  if (name == "paused") return bool_parameter(op_.state() != RunState::kPlaying);
  if (name == "speed") return double_parameter(op_.speed().value_or(0));
  if (name == "gravity" || name == "wind") {
    Instant instant;
    if (!instant.solve(op_.simulation().latest()).ok()) return {};
    const auto numbers = instant.value("opt." + name);
    return numbers.ok() ? doubles_parameter(*numbers) : ri::ParameterValue{};
  }
  const Result<std::string> option = op_.option(name);
  return option.ok() ? parameter_from_toml(*option) : ri::ParameterValue{};
}

Outcome NodeParameters::check_own(const ri::Parameter& parameter) const {
  const OwnParameter& own = *find_own_parameter(parameter.name);
  if (own.read_only) {
    if (parameter.value == value(parameter.name)) return {true, ""};
    return refused("'" + parameter.name + "' cannot be changed");
  }
  double number = 0;
  std::vector<double> numbers;
  if (own.type == ParameterType::PARAMETER_BOOL)
    return parameter.value.type == own.type ? Outcome{true, ""}
                                            : refused("'" + parameter.name + "' is a bool");
  if (own.type == ParameterType::PARAMETER_DOUBLE) {
    if (!number_of(parameter.value, &number)) return refused("'speed' is a number");
    const bool good = number == 0 || (number >= 1e-3 && number <= 1e3);
    return good ? Outcome{true, ""} : refused("'speed' is 0, or 0.001 … 1000");
  }
  const bool good = numbers_of(parameter.value, &numbers) && numbers.size() == 3 &&
                    std::ranges::all_of(numbers, [](double v) { return std::isfinite(v); });
  return good ? Outcome{true, ""} : refused("'" + parameter.name + "' has three numbers");
}

Status NodeParameters::set_own(const ri::Parameter& parameter) {
  if (parameter.name == "paused") {
    const bool paused = op_.state() != RunState::kPlaying;
    if (paused == parameter.value.bool_value) return {};
    return parameter.value.bool_value ? op_.pause() : op_.play();
  }
  if (parameter.name == "speed") {
    double speed = 0;
    number_of(parameter.value, &speed);
    return op_.set_speed(speed > 0 ? std::optional(speed) : std::nullopt);
  }
  if (parameter.name == "use_sim_time") return {};
  std::vector<double> numbers;
  numbers_of(parameter.value, &numbers);
  return op_.set_live_field(parameter.name, 0, {numbers.begin(), numbers.end()});
}

// What is checked without a change comes first; options all at once; then the rest.
Outcome NodeParameters::set_all(const std::vector<ri::Parameter>& parameters) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const ri::Parameter& parameter : parameters) {
    const std::string& name = parameter.name;
    if (find_own_parameter(name) != nullptr) {
      if (Outcome checked = check_own(parameter); !checked.successful) return checked;
      continue;
    }
    if (is_fixed_option(name)) return refused("'" + name + "' cannot be changed in a run");
    std::string toml = parameter_to_toml(parameter.value);
    if (toml.empty()) return refused("'" + name + "' cannot have a value of this type");
    options.emplace_back(name, std::move(toml));
  }
  if (!options.empty()) {
    if (const Status status = op_.set_options(options); !status.ok())
      return refused(status.error().to_string());
  }
  for (const ri::Parameter& parameter : parameters) {
    if (find_own_parameter(parameter.name) == nullptr) continue;
    if (const Status status = set_own(parameter); !status.ok())
      return refused(status.error().to_string());
  }
  tell(parameters);
  return {true, ""};
}

void NodeParameters::tell(const std::vector<ri::Parameter>& changed) {
  ri::ParameterEvent event;
  event.stamp = ros_time_of(op_.simulation().latest().time());
  event.node = node_;
  event.changed_parameters = changed;
  std::vector<uint8_t> bytes;
  encode(event, &bytes);
  publish_(kParameterEvents, bytes);
}

}  // namespace gloam::bridge

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
    {"use_sim_time", ParameterType::PARAMETER_BOOL, "Always true: the node publishes the clock",
     true},
    {"paused", ParameterType::PARAMETER_BOOL, "Whether the simulation is paused", false},
    {"speed", ParameterType::PARAMETER_DOUBLE,
     "Simulated seconds per second, 0.001 … 1000; 0 = as fast as possible", false},
    {"pace", ParameterType::PARAMETER_STRING,
     "fast, realtime, or sensors (wait for every subscribed sensor)", false},
};

constexpr std::string_view kLive = "live.";

Outcome refused(std::string reason) { return {false, std::move(reason)}; }

// Whether it is no option.
bool is_own(const std::string& name) {
  return find_own_parameter(name) != nullptr || !live_field_of(name).empty();
}

Outcome check_live(const ri::Parameter& parameter, size_t count) {
  std::vector<double> numbers;
  const bool good = numbers_of(parameter.value, &numbers) && numbers.size() == count &&
                    std::ranges::all_of(numbers, [](double v) { return std::isfinite(v); });
  if (good) return {true, ""};
  return refused("'" + parameter.name + "' must have " + std::to_string(count) + " finite numbers");
}

}  // namespace

std::vector<OwnParameter> own_parameters() { return {std::begin(kOwn), std::end(kOwn)}; }

const OwnParameter* find_own_parameter(std::string_view name) {
  const auto* found = std::ranges::find_if(kOwn, [&](const auto& own) { return name == own.name; });
  return found == std::end(kOwn) ? nullptr : found;
}

std::string live_field_of(const std::string& name) {
  return name.starts_with(kLive) ? name.substr(kLive.size()) : std::string();
}

ri::ParameterValue NodeParameters::value(const std::string& name) const {
  if (name == "use_sim_time") return bool_parameter(true);
  if (name == "paused") return bool_parameter(op_.state() != RunState::kPlaying);
  if (name == "speed") return double_parameter(op_.speed().value_or(0));
  if (name == "pace") return string_parameter(to_string(op_.pace()));
  if (const std::string field = live_field_of(name); !field.empty()) {
    Result<std::vector<double>> numbers = op_.live_field(field);
    return numbers.ok() ? doubles_parameter(std::move(*numbers)) : ri::ParameterValue{};
  }
  const Result<std::string> option = op_.option(name);
  return option.ok() ? parameter_from_toml(*option) : ri::ParameterValue{};
}

Outcome NodeParameters::check_own(const ri::Parameter& parameter) const {
  if (const std::string field = live_field_of(parameter.name); !field.empty()) {
    const Result<std::vector<double>> now = op_.live_field(field);
    return now.ok() ? check_live(parameter, now->size()) : refused(now.error().to_string());
  }
  const OwnParameter& own = *find_own_parameter(parameter.name);
  if (own.read_only) {
    if (parameter.value == value(parameter.name)) return {true, ""};
    return refused("'" + parameter.name + "' cannot be changed");
  }
  if (own.type == ParameterType::PARAMETER_BOOL)
    return parameter.value.type == own.type ? Outcome{true, ""}
                                            : refused("'" + parameter.name + "' must be a bool");
  if (own.type == ParameterType::PARAMETER_STRING) {
    const std::string& name = parameter.value.string_value;
    const bool good =
        parameter.value.type == own.type && enum_named<Pace>(name).ok() && name != "lockstep";
    return good ? Outcome{true, ""} : refused("'pace' must be one of: fast, realtime, sensors");
  }
  double number = 0;
  const bool good =
      number_of(parameter.value, &number) && (number == 0 || (number >= 1e-3 && number <= 1e3));
  return good ? Outcome{true, ""} : refused("'speed' must be 0 or 0.001 … 1000");
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
  if (parameter.name == "pace") return op_.set_pace(parameter.value.string_value);
  if (parameter.name == "use_sim_time") return {};
  std::vector<double> numbers;
  numbers_of(parameter.value, &numbers);
  return op_.set_live_field(live_field_of(parameter.name), 0, std::move(numbers));
}

// Checks without a change come first; options all at once; then the rest.
Outcome NodeParameters::set_all(const std::vector<ri::Parameter>& parameters) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const ri::Parameter& parameter : parameters) {
    const std::string& name = parameter.name;
    if (is_own(name)) {
      if (Outcome checked = check_own(parameter); !checked.successful) return checked;
      continue;
    }
    if (is_fixed_option(name)) return refused("'" + name + "' cannot be changed during a run");
    std::string toml = parameter_to_toml(parameter.value);
    if (toml.empty()) return refused("'" + name + "' cannot have a value of this type");
    options.emplace_back(name, std::move(toml));
  }
  if (!options.empty()) {
    if (const Status status = op_.set_options(options); !status.ok())
      return refused(status.error().to_string());
  }
  for (const ri::Parameter& parameter : parameters) {
    if (!is_own(parameter.name)) continue;
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

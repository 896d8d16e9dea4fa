#include "bridge/ros2/services/parameter_services.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bridge/ros2/services/parameter_values.h"
#include "bridge/ros2/services/simulation_values.h"
#include "bridge/ros2/services/typed_service.h"

namespace gloam::bridge {
namespace {

namespace ri = rcl_interfaces;
namespace rsrv = rcl_interfaces::srv;
using ri::ParameterType;
using Outcome = ri::SetParametersResult;

/// A parameter that is no option.
struct OwnParameter {
  const char* name;
  uint8_t type;
  const char* description;
  bool read_only;
};
constexpr OwnParameter kOwn[] = {
    {"use_sim_time", ParameterType::PARAMETER_BOOL, "The node is the clock", true},
    {"paused", ParameterType::PARAMETER_BOOL, "Whether the simulation rests", false},
    {"speed", ParameterType::PARAMETER_DOUBLE,
     "Simulated seconds per second, 0.001 … 1000; 0 = as fast as possible", false},
    {"gravity", ParameterType::PARAMETER_DOUBLE_ARRAY, "Gravity [m/s²]", false},
    {"wind", ParameterType::PARAMETER_DOUBLE_ARRAY, "Wind of MuJoCo's model [m/s]", false},
};

// What a run is begun with stays.
bool is_fixed_option(std::string_view path) {
  constexpr std::string_view kFixed[] = {"sim.",    "record.", "bridge.", "randomize",
                                         "metric.", "goal.",   "scene."};
  return std::ranges::any_of(kFixed,
                             [&](std::string_view begin) { return path.starts_with(begin); });
}

const OwnParameter* find_own(std::string_view name) {
  const auto* found = std::ranges::find_if(kOwn, [&](const auto& own) { return name == own.name; });
  return found == std::end(kOwn) ? nullptr : found;
}

Outcome refused(std::string reason) { return {false, std::move(reason)}; }

class Parameters {
 public:
  Parameters(Operator& operations, std::string node, Ros2Publish publish)
      : op_(operations), node_(std::move(node)), publish_(std::move(publish)) {}

  rsrv::GetParameters_Response get(const rsrv::GetParameters_Request& request) const {
    rsrv::GetParameters_Response response;
    for (const std::string& name : request.names) response.values.push_back(value(name));
    return response;
  }
  rsrv::GetParameterTypes_Response types(const rsrv::GetParameterTypes_Request& request) const {
    rsrv::GetParameterTypes_Response response;
    for (const std::string& name : request.names) response.types.push_back(value(name).type);
    return response;
  }
  rsrv::ListParameters_Response list(const rsrv::ListParameters_Request& request) const;
  rsrv::DescribeParameters_Response describe(const rsrv::DescribeParameters_Request& request) const;
  rsrv::SetParameters_Response set(const rsrv::SetParameters_Request& request) {
    rsrv::SetParameters_Response response;
    for (const ri::Parameter& parameter : request.parameters)
      response.results.push_back(set_all({parameter}));
    return response;
  }
  rsrv::SetParametersAtomically_Response set_atomically(
      const rsrv::SetParametersAtomically_Request& request) {
    return {set_all(request.parameters)};
  }

 private:
  ri::ParameterValue value(const std::string& name) const;
  Outcome set_all(const std::vector<ri::Parameter>& parameters);
  Outcome check_own(const ri::Parameter& parameter) const;
  Status set_own(const ri::Parameter& parameter);
  void tell(const std::vector<ri::Parameter>& changed);

  Operator& op_;
  const std::string node_;
  const Ros2Publish publish_;
};

ri::ParameterValue Parameters::value(const std::string& name) const {
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

// Names whose prefix is asked for, or all, down to a depth of dots.
rsrv::ListParameters_Response Parameters::list(const rsrv::ListParameters_Request& request) const {
  std::vector<std::string> names;
  for (const OwnParameter& own : kOwn) names.push_back(own.name);
  for (const OptionInfo& option : op_.options()) names.push_back(option.path);
  rsrv::ListParameters_Response response;
  ri::ListParametersResult& result = response.result;
  const auto depth_after = [](std::string_view name, size_t from) {
    return static_cast<uint64_t>(std::ranges::count(name.substr(from), '.')) + 1;
  };
  for (const std::string& name : names) {
    bool is_wanted =
        request.prefixes.empty() && (request.depth == 0 || depth_after(name, 0) <= request.depth);
    for (const std::string& prefix : request.prefixes) {
      if (name == prefix) is_wanted = true;
      if (name.starts_with(prefix + ".") &&
          (request.depth == 0 || depth_after(name, prefix.size() + 1) <= request.depth))
        is_wanted = true;
    }
    if (!is_wanted) continue;
    result.names.push_back(name);
    const size_t dot = name.rfind('.');
    if (dot == std::string::npos) continue;
    const std::string prefix = name.substr(0, dot);
    if (std::ranges::find(result.prefixes, prefix) == result.prefixes.end())
      result.prefixes.push_back(prefix);
  }
  return response;
}

ri::ParameterDescriptor describe_option(const OptionInfo& option) {
  ri::ParameterDescriptor descriptor;
  descriptor.name = option.path;
  descriptor.type = parameter_from_toml(option.value).type;
  descriptor.read_only = is_fixed_option(option.path);
  descriptor.dynamic_typing = true;  // an integer may become a double, and what is not set be set
  if (!option.unit.empty()) descriptor.description = "[" + option.unit + "]";
  for (const std::string& choice : option.choices)
    descriptor.additional_constraints +=
        (descriptor.additional_constraints.empty() ? "one of: " : ", ") + choice;
  if (std::isfinite(option.low) && std::isfinite(option.high)) {
    if (descriptor.type == ParameterType::PARAMETER_INTEGER) {
      descriptor.integer_range.push_back(
          {static_cast<int64_t>(std::clamp(option.low, -9e18, 9e18)),
           static_cast<int64_t>(std::clamp(option.high, -9e18, 9e18)), 0});
    } else if (descriptor.type == ParameterType::PARAMETER_DOUBLE) {
      descriptor.floating_point_range.push_back({option.low, option.high, 0});
    }
  }
  return descriptor;
}

rsrv::DescribeParameters_Response Parameters::describe(
    const rsrv::DescribeParameters_Request& request) const {
  rsrv::DescribeParameters_Response response;
  const std::vector<OptionInfo> options = op_.options();
  for (const std::string& name : request.names) {
    ri::ParameterDescriptor& descriptor = response.descriptors.emplace_back();
    descriptor.name = name;
    if (const OwnParameter* own = find_own(name)) {
      descriptor.type = own->type;
      descriptor.description = own->description;
      descriptor.read_only = own->read_only;
      continue;
    }
    const auto option = std::ranges::find(options, name, &OptionInfo::path);
    if (option != options.end()) descriptor = describe_option(*option);
  }
  return response;
}

Outcome Parameters::check_own(const ri::Parameter& parameter) const {
  const OwnParameter& own = *find_own(parameter.name);
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

Status Parameters::set_own(const ri::Parameter& parameter) {
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
Outcome Parameters::set_all(const std::vector<ri::Parameter>& parameters) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const ri::Parameter& parameter : parameters) {
    const std::string& name = parameter.name;
    if (find_own(name) != nullptr) {
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
    if (find_own(parameter.name) == nullptr) continue;
    if (const Status status = set_own(parameter); !status.ok())
      return refused(status.error().to_string());
  }
  tell(parameters);
  return {true, ""};
}

void Parameters::tell(const std::vector<ri::Parameter>& changed) {
  ri::ParameterEvent event;
  event.stamp = ros_time_of(op_.simulation().latest().time());
  event.node = node_;
  event.changed_parameters = changed;
  std::vector<uint8_t> bytes;
  encode(event, &bytes);
  publish_(kParameterEvents, bytes);
}

}  // namespace

std::vector<Ros2Service> parameter_services(Operator& operations, const std::string& node,
                                            Ros2Publish publish) {
  const auto all = std::make_shared<Parameters>(operations, node, std::move(publish));
  const auto worker = std::make_shared<ServiceWorker>();
  const std::string base = node + "/";
  std::vector<Ros2Service> list;
  list.push_back(make_service<rsrv::GetParameters_Request, rsrv::GetParameters_Response>(
      base + "get_parameters", [all](const auto& r) { return all->get(r); }));
  list.push_back(make_service<rsrv::GetParameterTypes_Request, rsrv::GetParameterTypes_Response>(
      base + "get_parameter_types", [all](const auto& r) { return all->types(r); }));
  list.push_back(make_service<rsrv::ListParameters_Request, rsrv::ListParameters_Response>(
      base + "list_parameters", [all](const auto& r) { return all->list(r); }));
  list.push_back(make_service<rsrv::DescribeParameters_Request, rsrv::DescribeParameters_Response>(
      base + "describe_parameters", [all](const auto& r) { return all->describe(r); }));
  list.push_back(make_slow_service<rsrv::SetParameters_Request, rsrv::SetParameters_Response>(
      base + "set_parameters", worker, {}, [all](const auto& r) { return all->set(r); }));
  list.push_back(make_slow_service<rsrv::SetParametersAtomically_Request,
                                   rsrv::SetParametersAtomically_Response>(
      base + "set_parameters_atomically", worker, {refused("too many requests wait")},
      [all](const auto& r) { return all->set_atomically(r); }));
  return list;
}

}  // namespace gloam::bridge

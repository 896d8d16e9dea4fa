// NodeParameters: lists and descriptions.

#include <algorithm>
#include <cmath>

#include "bridge/ros2/services/node_parameters.h"
#include "bridge/ros2/services/parameter_values.h"

namespace gloam::bridge {
namespace {

namespace ri = rcl_interfaces;
namespace rsrv = rcl_interfaces::srv;
using ri::ParameterType;

constexpr int64_t kMostNumbers = 1024;  // of a live field that is listed

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

}  // namespace

// Names whose prefix is asked for, or all, down to a depth of dots.
rsrv::ListParameters_Response NodeParameters::list(
    const rsrv::ListParameters_Request& request) const {
  std::vector<std::string> names;
  for (const OwnParameter& own : own_parameters()) names.emplace_back(own.name);
  for (const InputInfo& input : op_.simulation().world().inputs())
    if (input.kind == InputKind::kLiveField && input.count <= kMostNumbers)
      names.push_back("live." + input.name);
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

rsrv::DescribeParameters_Response NodeParameters::describe(
    const rsrv::DescribeParameters_Request& request) const {
  rsrv::DescribeParameters_Response response;
  const std::vector<OptionInfo> options = op_.options();
  for (const std::string& name : request.names) {
    ri::ParameterDescriptor& descriptor = response.descriptors.emplace_back();
    descriptor.name = name;
    if (const OwnParameter* own = find_own_parameter(name)) {
      descriptor.type = own->type;
      descriptor.description = own->description;
      descriptor.read_only = own->read_only;
      continue;
    }
    if (!live_field_of(name).empty() && op_.live_field(live_field_of(name)).ok()) {
      descriptor.type = ParameterType::PARAMETER_DOUBLE_ARRAY;
      descriptor.description = "Live field of the model; set as a whole, changes at the next step";
      continue;
    }
    const auto option = std::ranges::find(options, name, &OptionInfo::path);
    if (option != options.end()) descriptor = describe_option(*option);
  }
  return response;
}

}  // namespace gloam::bridge

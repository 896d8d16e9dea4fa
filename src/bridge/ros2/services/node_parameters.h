#pragma once
// NodeParameters: the parameters of the node: some of its own, and the options of the scene.

#include <string>
#include <string_view>
#include <vector>

#include "bridge/operations/operator.h"
#include "bridge/ros2/ros2_action.h"
#include "ros/messages/rcl_interfaces.h"

namespace gloam::bridge {

/// A parameter that is no option.
struct OwnParameter {
  std::string_view name;
  uint8_t type;  ///< of rcl_interfaces::ParameterType
  const char* description;
  bool read_only;
};
std::vector<OwnParameter> own_parameters();
/// nullptr: there is none of that name.
const OwnParameter* find_own_parameter(std::string_view name);
/// "gravity" of "live.gravity": a live field (gloam/command.h); empty = another parameter.
std::string live_field_of(const std::string& name);

class NodeParameters {
 public:
  NodeParameters(Operator& operations, std::string node, Ros2Publish publish)
      : op_(operations), node_(std::move(node)), publish_(std::move(publish)) {}

  rcl_interfaces::srv::GetParameters_Response get(
      const rcl_interfaces::srv::GetParameters_Request& request) const {
    rcl_interfaces::srv::GetParameters_Response response;
    for (const std::string& name : request.names) response.values.push_back(value(name));
    return response;
  }
  rcl_interfaces::srv::GetParameterTypes_Response types(
      const rcl_interfaces::srv::GetParameterTypes_Request& request) const {
    std::vector<uint8_t> types;
    for (const std::string& name : request.names) types.push_back(value(name).type);
    return {std::move(types)};
  }
  rcl_interfaces::srv::ListParameters_Response list(
      const rcl_interfaces::srv::ListParameters_Request& request) const;
  rcl_interfaces::srv::DescribeParameters_Response describe(
      const rcl_interfaces::srv::DescribeParameters_Request& request) const;
  rcl_interfaces::srv::SetParameters_Response set(
      const rcl_interfaces::srv::SetParameters_Request& request) {
    rcl_interfaces::srv::SetParameters_Response response;
    for (const rcl_interfaces::Parameter& parameter : request.parameters)
      response.results.push_back(set_all({parameter}));
    return response;
  }
  rcl_interfaces::srv::SetParametersAtomically_Response set_atomically(
      const rcl_interfaces::srv::SetParametersAtomically_Request& request) {
    return {set_all(request.parameters)};
  }

 private:
  rcl_interfaces::ParameterValue value(const std::string& name) const;
  rcl_interfaces::SetParametersResult set_all(
      const std::vector<rcl_interfaces::Parameter>& parameters);
  rcl_interfaces::SetParametersResult check_own(const rcl_interfaces::Parameter& parameter) const;
  Status set_own(const rcl_interfaces::Parameter& parameter);
  void tell(const std::vector<rcl_interfaces::Parameter>& changed);

  Operator& op_;
  const std::string node_;
  const Ros2Publish publish_;
};

}  // namespace gloam::bridge

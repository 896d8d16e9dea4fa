#pragma once
// Messages and services of ROS 2's package rcl_interfaces: parameters of nodes.

#include "ros/messages/builtin_interfaces.h"

namespace gloam::rcl_interfaces {

inline constexpr std::string_view kPackage = "rcl_interfaces/msg";

struct ParameterType {
  GLOAM_CONSTANTS(uint8, PARAMETER_NOT_SET = 0, PARAMETER_BOOL = 1, PARAMETER_INTEGER = 2,
                  PARAMETER_DOUBLE = 3, PARAMETER_STRING = 4, PARAMETER_BYTE_ARRAY = 5,
                  PARAMETER_BOOL_ARRAY = 6, PARAMETER_INTEGER_ARRAY = 7, PARAMETER_DOUBLE_ARRAY = 8,
                  PARAMETER_STRING_ARRAY = 9)
  GLOAM_MESSAGE(ParameterType)
};

struct ParameterValue {
  uint8_t type = 0;  ///< a ParameterType; tells which of the rest counts
  bool bool_value = false;
  int64_t integer_value = 0;
  double double_value = 0;
  std::string string_value;
  std::vector<std::byte> byte_array_value;
  Bools bool_array_value;
  std::vector<int64_t> integer_array_value;
  std::vector<double> double_array_value;
  std::vector<std::string> string_array_value;
  GLOAM_MESSAGE(ParameterValue, type, bool_value, integer_value, double_value, string_value,
                byte_array_value, bool_array_value, integer_array_value, double_array_value,
                string_array_value)
};

struct Parameter {
  std::string name;
  ParameterValue value;
  GLOAM_MESSAGE(Parameter, name, value)
};

struct ParameterEvent {
  builtin_interfaces::Time stamp;
  std::string node;  ///< "/sim/gloam"
  std::vector<Parameter> new_parameters, changed_parameters, deleted_parameters;
  GLOAM_MESSAGE(ParameterEvent, stamp, node, new_parameters, changed_parameters, deleted_parameters)
};

struct FloatingPointRange {
  double from_value = 0, to_value = 0, step = 0;
  GLOAM_MESSAGE(FloatingPointRange, from_value, to_value, step)
};

struct IntegerRange {
  int64_t from_value = 0, to_value = 0;
  uint64_t step = 0;
  GLOAM_MESSAGE(IntegerRange, from_value, to_value, step)
};

struct ParameterDescriptor {
  std::string name;
  uint8_t type = 0;
  std::string description, additional_constraints;
  bool read_only = false, dynamic_typing = false;
  BoundedVector<FloatingPointRange, 1> floating_point_range;
  BoundedVector<IntegerRange, 1> integer_range;
  GLOAM_MESSAGE(ParameterDescriptor, name, type, description, additional_constraints, read_only,
                dynamic_typing, floating_point_range, integer_range)
};

struct SetParametersResult {
  bool successful = false;
  std::string reason;
  GLOAM_MESSAGE(SetParametersResult, successful, reason)
};

struct ListParametersResult {
  std::vector<std::string> names, prefixes;
  GLOAM_MESSAGE(ListParametersResult, names, prefixes)
};

namespace srv {

inline constexpr std::string_view kPackage = "rcl_interfaces/srv";

struct GetParameters_Request {
  std::vector<std::string> names;
  GLOAM_MESSAGE(GetParameters_Request, names)
};
struct GetParameters_Response {
  std::vector<ParameterValue> values;
  GLOAM_MESSAGE(GetParameters_Response, values)
};

struct GetParameterTypes_Request {
  std::vector<std::string> names;
  GLOAM_MESSAGE(GetParameterTypes_Request, names)
};
struct GetParameterTypes_Response {
  std::vector<uint8_t> types;
  GLOAM_MESSAGE(GetParameterTypes_Response, types)
};

struct SetParameters_Request {
  std::vector<Parameter> parameters;
  GLOAM_MESSAGE(SetParameters_Request, parameters)
};
struct SetParameters_Response {
  std::vector<SetParametersResult> results;
  GLOAM_MESSAGE(SetParameters_Response, results)
};

struct SetParametersAtomically_Request {
  std::vector<Parameter> parameters;
  GLOAM_MESSAGE(SetParametersAtomically_Request, parameters)
};
struct SetParametersAtomically_Response {
  SetParametersResult result;
  GLOAM_MESSAGE(SetParametersAtomically_Response, result)
};

struct ListParameters_Request {
  std::vector<std::string> prefixes;
  uint64_t depth = 0;  ///< 0 = any
  GLOAM_CONSTANTS(uint64, DEPTH_RECURSIVE = 0)
  GLOAM_MESSAGE(ListParameters_Request, prefixes, depth)
};
struct ListParameters_Response {
  ListParametersResult result;
  GLOAM_MESSAGE(ListParameters_Response, result)
};

struct DescribeParameters_Request {
  std::vector<std::string> names;
  GLOAM_MESSAGE(DescribeParameters_Request, names)
};
struct DescribeParameters_Response {
  std::vector<ParameterDescriptor> descriptors;
  GLOAM_MESSAGE(DescribeParameters_Response, descriptors)
};

}  // namespace srv
}  // namespace gloam::rcl_interfaces

#pragma once
// Values of parameters and TOML, of which options are made.

#include <string>
#include <string_view>

#include "ros/messages/rcl_interfaces.h"

namespace gloam::bridge {

rcl_interfaces::ParameterValue bool_parameter(bool value);
rcl_interfaces::ParameterValue double_parameter(double value);
rcl_interfaces::ParameterValue string_parameter(std::string value);
rcl_interfaces::ParameterValue doubles_parameter(std::vector<double> values);
/// A number of either type; false = it is none.
bool number_of(const rcl_interfaces::ParameterValue& value, double* number);
/// Numbers of an array of either type.
bool numbers_of(const rcl_interfaces::ParameterValue& value, std::vector<double>* numbers);

/// The value of an option: bools, integers, doubles, strings and arrays of those as they are;
/// what ROS has no type for as the text; an option that is not given is not set.
rcl_interfaces::ParameterValue parameter_from_toml(std::string_view toml);
/// Text for set_option; empty for bytes and what is not set.
std::string parameter_to_toml(const rcl_interfaces::ParameterValue& value);

}  // namespace gloam::bridge

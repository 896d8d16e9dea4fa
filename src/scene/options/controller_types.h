#pragma once
// Types that [robot.controller] may name, Gloam's own and those that a program has registered, and
// the options that each has.

#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// In the order of their registration, Gloam's own first. Any thread; names live for ever.
std::vector<std::string_view> controller_type_names();

/// Whether a controller of this type has the option `key`, beside type and rate. A type that there
/// is not has all: its name is what is wrong.
bool has_controller_option(std::string_view type, std::string_view key);

/// Adds a type with the options `goals` and `params`. Error: the name is taken, or is no
/// identifier.
Status add_controller_type(const std::string& name);

}  // namespace gloam

#pragma once
// Names that [robot.controller] type may have: Gloam's own and those that a program has registered.

#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// In the order of their registration, Gloam's own first. Any thread; names live for ever.
std::vector<std::string_view> controller_type_names();

/// Error: the name is taken, or is no identifier.
Status add_controller_type(const std::string& name);

}  // namespace gloam

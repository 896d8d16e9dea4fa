#pragma once
// Commands as JSON, for logs: numbers are written so that they are read back to the bit.

#include <string>
#include <string_view>

#include "gloam/command.h"
#include "world/world.h"

namespace gloam {

/// One line: {"run": 0, "step": 12, "command": "set_control", "actuator": 3, "name": "arm/elbow",
/// "value": 0.5}. Things are told by their ids in the World; names are for people.
std::string command_text(const LoggedCommand& logged, const CompiledWorld& world);

/// Reads it; handles are of no World in particular (Handle::world 0). Errors: no JSON, an unknown
/// command, a key that is missing or of another type. Whether it fits a World: check_command.
Result<LoggedCommand> parse_command(std::string_view text);

}  // namespace gloam

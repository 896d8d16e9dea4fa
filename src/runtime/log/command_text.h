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

/// Reads it for a World of the same model. Errors: no JSON, an unknown command, a key that is
/// missing or of another type. Whether ids and values fit the World: check_command.
Result<LoggedCommand> parse_command(std::string_view text, const CompiledWorld& world);

}  // namespace gloam

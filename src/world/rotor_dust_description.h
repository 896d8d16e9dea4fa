#pragma once
// [[rotor]] and [[dust]] on the compiled model: what stirs the air of a gas, and what that raises.

#include "world/gas_description.h"

namespace gloam {

/// Errors: no such actuator or site, an actuator that does not push a site along an axis.
Result<std::vector<RotorDescription>> describe_rotors(const CompiledWorld& world);

/// In source order.
std::vector<DustDescription> describe_dusts(const Scene& scene);

}  // namespace gloam

#pragma once
// [[rotor]] and [[dust]] on the compiled model: what stirs the air of a gas, and what that raises.

#include "world/effects/gas_description.h"

namespace gloam {

/// Errors: no such actuator or site, an actuator that does not push a site along an axis.
Result<std::vector<RotorDescription>> describe_rotors(const CompiledWorld& world);

/// In source order.
std::vector<DustDescription> describe_dusts(const Scene& scene);

/// Errors: rotors without a gas, dust without one that carries dust. `gases`: with the one that is
/// made where the scene has none.
Status check_stirrers(const Scene& scene, const std::vector<GasOptions>& gases);

}  // namespace gloam

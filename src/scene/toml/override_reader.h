#pragma once
// The table [override] of a scene file.

#include <toml++/toml.h>

#include "gloam/scene.h"

namespace gloam {

/// Appends what the table holds, in the order of its lines; validate_overrides checks it. Errors:
/// an unknown tag, a name where an attribute is wanted, or the other way round.
Status read_overrides(const toml::table& table, const std::string& file,
                      std::vector<OverrideOptions>* overrides);

}  // namespace gloam

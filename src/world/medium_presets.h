#pragma once
// Media that a scene may name.

#include <string>
#include <string_view>
#include <vector>

#include "world/medium_description.h"

namespace gloam {

/// Null when there is none of that name.
const MediumDescription* find_medium(std::string_view name);
std::vector<std::string> medium_names();

}  // namespace gloam

#pragma once
// Media that a scene may name.

#include <string>
#include <string_view>
#include <vector>

#include "world/media/medium_description.h"

namespace gloam {

/// Null when there is none of that name.
const MediumDescription* find_medium(std::string_view name);
std::vector<std::string> medium_names();

/// Extinction over the coefficient of scattering straight back, of a medium of this name near 1 µm
/// [sr]; 0 = not known, its phase function must do. Henyey and Greenstein's lacks the peak that
/// drops have there.
float lidar_ratio(std::string_view name);

}  // namespace gloam

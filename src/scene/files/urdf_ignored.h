#pragma once
// Elements of a URDF that nothing reads: motors, limits and sensors for other programs.

#include <functional>
#include <pugixml.hpp>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// A note for each kind of element that is left out, at the first of them.
std::vector<Error> list_ignored_elements(
    const pugi::xml_node& robot, const std::function<SourceLoc(const pugi::xml_node&)>& loc_of);

}  // namespace gloam

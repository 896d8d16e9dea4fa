#pragma once
// Elements that MuJoCo's parser requires beside an element before it reads it, found by trial: the
// facts that specimens (specimen.h) are made of.

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "scene/mjcf/schema.h"

namespace gloam::mjcf {

/// A world with one of each thing that an element may refer to.
extern const char* const kSpecimenWorld;

using Attributes = std::map<std::string, std::string>;

/// Without which the element of this path is not read.
Attributes needed_by(std::string_view path);

/// For an attribute that may not stand beside those: what stands there instead.
std::optional<Attributes> instead_for(const MjcfElement& element, std::string_view attribute);

}  // namespace gloam::mjcf

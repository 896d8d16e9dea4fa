#pragma once
// What an attribute of MJCF takes in TOML, as JSON Schema: in models and in overrides.

#include <nlohmann/json.hpp>

#include "scene/mjcf/schema.h"

namespace gloam {

nlohmann::ordered_json attribute_schema(const MjcfAttribute& attribute);

}  // namespace gloam

#pragma once
// JSON Schema of the values of an MJCF attribute in TOML: in models and in overrides.

#include <nlohmann/json.hpp>

#include "scene/mjcf/schema.h"

namespace gloam {

nlohmann::ordered_json attribute_schema(const MjcfAttribute& attribute);

}  // namespace gloam

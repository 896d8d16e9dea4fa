#pragma once
// [override] of scene files as JSON Schema: below each tag the attributes of its elements.

#include <nlohmann/json.hpp>

namespace gloam {

/// Part of "#/definitions": "override", [override.ROBOT], and all that it refers to.
nlohmann::ordered_json override_definitions();

}  // namespace gloam

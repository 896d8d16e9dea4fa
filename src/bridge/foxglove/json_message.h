#pragma once
// Messages as JSON: objects with the names of their fields, arrays, numbers, texts, true and false.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "gloam/result.h"
#include "ros/message_schema.h"

namespace gloam::bridge::foxglove {

/// CDR of a JSON object. Fields that lack are zero. Errors: a field that the type does not have, a
/// value of another kind or out of range, an array of another length.
Result<std::vector<uint8_t>> cdr_from_json(const MessageSchema& schema,
                                           const nlohmann::json& object);

/// JSON of a message; numbers that are not finite are null. Errors: those of decode().
Result<nlohmann::json> json_from_cdr(const MessageSchema& schema, std::span<const uint8_t> bytes);

}  // namespace gloam::bridge::foxglove

#pragma once
// JSON as commands print it with --json.

#include <nlohmann/json.hpp>
#include <string>

namespace gloam::cli {

/// `json` as text. Bytes that are no UTF-8, as a file's path may have, become U+FFFD.
template <class Json>
std::string json_text(const Json& json, int indent = 2) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gloam::cli

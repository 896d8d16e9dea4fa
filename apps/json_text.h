#pragma once
// JSON as commands print it with --json.

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "gloam/text.h"

namespace gloam::cli {

/// `json` as text. Bytes that are not UTF-8, as in paths of files, become U+FFFD. Control
/// characters of terminals are escaped, which JSON allows in strings; they do not occur elsewhere.
template <class Json>
std::string json_text(const Json& json, int indent = 2) {
  return printable(json.dump(indent, ' ', false, Json::error_handler_t::replace), "\n");
}

template <class Json>
void put_json(const Json& json, int indent = 2) {
  std::puts(json_text(json, indent).c_str());
}

}  // namespace gloam::cli

#pragma once
// JSON that clients send, bounded in depth, because readers of a value recurse.

#include <nlohmann/json.hpp>
#include <string_view>

namespace gloam::web {

/// The value; discarded where the text is not JSON or nests deeper than 64 levels.
inline nlohmann::json parse_client_json(std::string_view text) {
  using nlohmann::json;
  constexpr int kMaxJsonDepth = 64;
  bool is_deep = false;
  const auto keep = [&](int depth, json::parse_event_t, json&) {
    is_deep = is_deep || depth > kMaxJsonDepth;
    return !is_deep;
  };
  json value = json::parse(text, keep, false);
  return is_deep ? json(json::value_t::discarded) : value;
}

}  // namespace gloam::web

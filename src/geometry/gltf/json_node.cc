#include "geometry/gltf/json_node.h"

#include <fmt/format.h>

#include <cmath>

#include "base/nesting.h"

namespace gloam {
using nlohmann::json;

void JsonErrors::add(const std::string& pointer, std::string_view message, std::string hint) {
  if (first_) return;
  first_ = Error{ErrorKind::kInput,
                 fmt::format("{}: {}", pointer.empty() ? "/" : pointer, message),
                 {file_, 0, 0},
                 std::move(hint)};
}

Result<json> parse_bounded_json(std::span<const uint8_t> text, const std::string& file) {
  const auto bad = [&](std::string message) {
    return Error{ErrorKind::kInput,
                 std::move(message),
                 {file, 0, 0},
                 "the file may be truncated or damaged; export the model again"};
  };
  const std::string_view characters(reinterpret_cast<const char*>(text.data()), text.size());
  if (const auto excess = json_excess(characters, kMaxJsonValues))
    return bad(fmt::format("not readable as JSON: at byte {}: {}", excess->at, excess->what));
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::parse_error& error) {
    return bad(fmt::format("not JSON: syntax error at byte {}", error.byte));
  } catch (const json::exception&) {
    return bad("not readable as JSON: a number is too large");
  }
}

bool JsonNode::is_kind(bool (json::*test)() const noexcept, std::string_view kind) const {
  if (value_ == nullptr || !errors_->ok()) return false;
  if ((value_->*test)()) return true;
  fail(fmt::format("must be {}, not {}", kind, value_->type_name()));
  return false;
}

JsonNode JsonNode::operator[](std::string_view key) const {
  std::string pointer = pointer_;
  pointer += '/';
  pointer += key;
  if (!is_kind(&json::is_object, "an object")) return {nullptr, std::move(pointer), errors_};
  const auto found = value_->find(key);
  return {found == value_->end() ? nullptr : &*found, std::move(pointer), errors_};
}

size_t JsonNode::size() const { return is_kind(&json::is_array, "an array") ? value_->size() : 0; }

JsonNode JsonNode::at(size_t i) const {
  const bool there = i < size();
  return {there ? &(*value_)[i] : nullptr, fmt::format("{}/{}", pointer_, i), errors_};
}

float JsonNode::number(float otherwise, float low, float high) const {
  if (!is_kind(&json::is_number, "a number")) return otherwise;
  const double x = value_->get<double>();
  if (std::isfinite(x) && x >= low && x <= high) return static_cast<float>(x);
  fail(fmt::format("is {}; it must be {}", x,
                   high < 3e38f ? fmt::format("from {} to {}", low, high)
                                : (low > -3e38f ? fmt::format("at least {}", low) : "finite")));
  return otherwise;
}

uint64_t JsonNode::integer(uint64_t otherwise, uint64_t high) const {
  if (!is_kind(&json::is_number, "a number")) return otherwise;
  const double x = value_->get<double>();  // 3.0 is an integer in JSON
  if (x >= 0 && x <= 9e15 && x == std::floor(x) && static_cast<uint64_t>(x) <= high)
    return static_cast<uint64_t>(x);
  fail(fmt::format("is {}; it must be an integer from 0 to {}", x, high));
  return otherwise;
}

bool JsonNode::flag(bool otherwise) const {
  return is_kind(&json::is_boolean, "true or false") ? value_->get<bool>() : otherwise;
}

std::string JsonNode::text(std::string_view otherwise) const {
  if (!is_kind(&json::is_string, "text")) return std::string(otherwise);
  return value_->get_ref<const std::string&>();
}

bool JsonNode::numbers(float* out, size_t n) const {
  if (!exists() || !errors_->ok()) return false;
  if (size() != n) {
    fail(fmt::format("must contain {} numbers", n));
    return false;
  }
  for (size_t i = 0; i < n; ++i) out[i] = at(i).number(0);
  return errors_->ok();
}

Vec3f JsonNode::vec3(Vec3f otherwise, float low, float high) const {
  float v[3];
  if (!numbers(v, 3)) return otherwise;
  for (size_t i = 0; i < 3; ++i) (void)at(i).number(0, low, high);
  return {v[0], v[1], v[2]};
}

int JsonNode::index(size_t count, std::string_view what) const {
  if (!exists() || !errors_->ok()) return -1;
  const uint64_t i = integer(0, uint64_t{1} << 53);
  if (errors_->ok() && i >= count)
    fail(fmt::format("refers to {} {}, but there are {}", what, i, count));
  return errors_->ok() ? static_cast<int>(i) : -1;
}

int JsonNode::required_index(size_t count, std::string_view what) const {
  if (!exists()) fail(fmt::format("{} index is missing", what));
  return index(count, what);
}

}  // namespace gloam

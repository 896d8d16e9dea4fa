#pragma once
// JSON of strangers: bounded in depth and size, read with its place at hand. After the first error
// every read gives its default and the error stays.

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/vec.h"
#include "geometry/mesh/model_limits.h"
#include "gloam/result.h"

namespace gloam {

/// The first error of a document.
class JsonErrors {
 public:
  explicit JsonErrors(std::string file) : file_(std::move(file)) {}
  void add(const std::string& pointer, std::string_view message, std::string hint = {});
  void add(Error error) {
    if (!first_) first_ = std::move(error);
  }
  bool ok() const { return !first_; }
  Status status() const { return first_ ? Status(*first_) : Status(); }
  const std::string& file() const { return file_; }

 private:
  std::string file_;
  std::optional<Error> first_;
};

/// Parses text. Errors: not JSON (with the byte), too deep, too many values.
Result<nlohmann::json> parse_bounded_json(std::span<const uint8_t> text, const std::string& file);

/// A value in a document, or the place where one is missing.
class JsonNode {
 public:
  JsonNode(const nlohmann::json* value, std::string pointer, JsonErrors* errors)
      : value_(value), pointer_(std::move(pointer)), errors_(errors) {}

  bool exists() const { return value_ != nullptr; }
  const std::string& pointer() const { return pointer_; }
  void fail(std::string_view message, std::string hint = {}) const {
    errors_->add(pointer_, message, std::move(hint));
  }

  /// Member of an object; one that is not there does not exist. Error: this is no object.
  JsonNode operator[](std::string_view key) const;
  /// Length of an array, 0 when it does not exist. Error: this is no array.
  size_t size() const;
  JsonNode at(size_t i) const;
  /// Calls f(key, node) for each member of an object. Error: this is no object.
  template <class F>
  void for_each_member(F&& f) const {
    if (!is_kind(&nlohmann::json::is_object, "an object")) return;
    for (const auto& [key, value] : value_->items())
      f(key, JsonNode(&value, pointer_ + "/" + key, errors_));
  }

  /// Values, or `otherwise` where there is none. Errors: another type, outside [low, high].
  float number(float otherwise, float low = -3.4e38f, float high = 3.4e38f) const;
  uint64_t integer(uint64_t otherwise, uint64_t high) const;
  bool flag(bool otherwise) const;
  std::string text(std::string_view otherwise = {}) const;
  Vec3f vec3(Vec3f otherwise, float low = -3.4e38f, float high = 3.4e38f) const;
  /// `n` numbers; false when it does not exist or is not that.
  bool numbers(float* out, size_t n) const;
  /// Index into a list of `count` things called `what`; -1 when it does not exist.
  int index(size_t count, std::string_view what) const;
  /// The same; that it does not exist is an error.
  int required_index(size_t count, std::string_view what) const;

 private:
  bool is_kind(bool (nlohmann::json::*test)() const noexcept, std::string_view kind) const;
  const nlohmann::json* value_;
  std::string pointer_;
  JsonErrors* errors_;
};

}  // namespace gloam

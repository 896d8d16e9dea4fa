#pragma once
// Arguments of an operation, checked once against its list and then read without errors.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridge/zmq/pack.h"
#include "gloam/result.h"

namespace gloam::bridge::zeromq {

enum class ArgumentType : uint8_t {
  kInteger,
  kNumber,  ///< finite
  kText,
  kBool,
  kNumbers,  ///< array of finite numbers, or bytes of little-endian float64
  kTexts,    ///< array of texts
  kBytes,
  kNumberMap,   ///< text -> finite number
  kNumbersMap,  ///< text -> kNumbers
  kTextMap,     ///< text -> text
};
std::string_view to_string(ArgumentType type);

struct Argument {
  std::string_view name;
  ArgumentType type = ArgumentType::kText;
  bool is_required = false;
  std::string_view unit = "";   ///< unit and shape: "rad or m, (n)"
  std::string_view about = "";  ///< for people
  size_t count = 0;             ///< of kNumbers: how many there must be; 0 = any number
};

class Arguments {
 public:
  /// Errors: an argument that the list lacks, one of another type, there twice, not there though
  /// required. `map` is nil or a map with texts as keys, and outlives the Arguments.
  static Result<Arguments> check(const msgpack::object& map, std::span<const Argument> list);

  bool has(std::string_view name) const { return find(name) != nullptr; }
  int64_t integer(std::string_view name, int64_t otherwise = 0) const;
  double number(std::string_view name, double otherwise = 0) const;
  std::string text(std::string_view name, std::string_view otherwise = "") const;
  bool flag(std::string_view name, bool otherwise = false) const;
  std::vector<double> numbers(std::string_view name) const;
  std::vector<std::string> texts(std::string_view name) const;
  std::span<const uint8_t> bytes(std::string_view name) const;
  std::map<std::string, double> number_map(std::string_view name) const;
  std::map<std::string, std::vector<double>> numbers_map(std::string_view name) const;
  std::vector<std::pair<std::string, std::string>> text_map(std::string_view name) const;

 private:
  explicit Arguments(const msgpack::object& map) : map_(map) {}
  const msgpack::object* find(std::string_view name) const;

  msgpack::object map_;
};

}  // namespace gloam::bridge::zeromq

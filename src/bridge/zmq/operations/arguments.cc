#include "bridge/zmq/operations/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gloam/program.h"

namespace gloam::bridge::zeromq {
namespace {

using msgpack::type::object_type;

std::string_view text_of(const msgpack::object& value) {
  return {value.via.str.ptr, value.via.str.size};
}

bool is_integer(const msgpack::object& value) {
  if (value.type == object_type::POSITIVE_INTEGER)
    return value.via.u64 <= static_cast<uint64_t>(INT64_MAX);
  return value.type == object_type::NEGATIVE_INTEGER;
}

double number_of(const msgpack::object& value) {
  if (value.type == object_type::POSITIVE_INTEGER) return static_cast<double>(value.via.u64);
  if (value.type == object_type::NEGATIVE_INTEGER) return static_cast<double>(value.via.i64);
  return value.via.f64;
}

bool is_number(const msgpack::object& value) {
  const bool is_float = value.type == object_type::FLOAT32 || value.type == object_type::FLOAT64;
  return (is_float && std::isfinite(value.via.f64)) || is_integer(value);
}

std::vector<double> numbers_of(const msgpack::object& value) {
  std::vector<double> numbers;
  if (value.type == object_type::BIN) {
    numbers.resize(value.via.bin.size / sizeof(double));
    if (!numbers.empty())
      std::memcpy(numbers.data(), value.via.bin.ptr, numbers.size() * sizeof(double));
    return numbers;
  }
  numbers.reserve(value.via.array.size);
  for (uint32_t i = 0; i < value.via.array.size; ++i)
    numbers.push_back(number_of(value.via.array.ptr[i]));
  return numbers;
}

bool are_numbers(const msgpack::object& value) {
  if (value.type == object_type::BIN) {
    if (value.via.bin.size % sizeof(double) != 0) return false;
    const std::vector<double> numbers = numbers_of(value);
    return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
  }
  if (value.type != object_type::ARRAY) return false;
  return std::all_of(value.via.array.ptr, value.via.array.ptr + value.via.array.size, is_number);
}

bool are_texts(const msgpack::object& value) {
  if (value.type != object_type::ARRAY) return false;
  return std::all_of(value.via.array.ptr, value.via.array.ptr + value.via.array.size,
                     [](const msgpack::object& each) { return each.type == object_type::STR; });
}

template <class Fits>
bool is_map_of(const msgpack::object& value, Fits fits) {
  if (value.type != object_type::MAP) return false;
  return std::all_of(value.via.map.ptr, value.via.map.ptr + value.via.map.size,
                     [&fits](const msgpack::object_kv& entry) {
                       return entry.key.type == object_type::STR && fits(entry.val);
                     });
}

bool fits_type(const msgpack::object& value, ArgumentType type) {
  switch (type) {
    case ArgumentType::kInteger:
      return is_integer(value);
    case ArgumentType::kNumber:
      return is_number(value);
    case ArgumentType::kText:
      return value.type == object_type::STR;
    case ArgumentType::kBool:
      return value.type == object_type::BOOLEAN;
    case ArgumentType::kNumbers:
      return are_numbers(value);
    case ArgumentType::kTexts:
      return are_texts(value);
    case ArgumentType::kBytes:
      return value.type == object_type::BIN;
    case ArgumentType::kNumberMap:
      return is_map_of(value, is_number);
    case ArgumentType::kNumbersMap:
      return is_map_of(value, are_numbers);
    case ArgumentType::kTextMap:
      return is_map_of(value,
                       [](const msgpack::object& each) { return each.type == object_type::STR; });
  }
  return false;
}

Error wrong(std::string message, std::string remedy = {}) {
  return {ErrorKind::kUsage, std::move(message), {}, std::move(remedy)};
}

Status check_one(std::string_view name, const msgpack::object& value,
                 std::span<const Argument> list) {
  const auto row = std::ranges::find(list, name, &Argument::name);
  if (row == list.end()) {
    std::vector<std::string> names;
    for (const Argument& argument : list) names.emplace_back(argument.name);
    return wrong(
        fmt::format("there is no argument '{}'", name.substr(0, 60)),
        names.empty() ? "the operation has no arguments" : suggest_name(name.substr(0, 60), names));
  }
  if (!fits_type(value, row->type))
    return wrong(fmt::format("argument '{}' is not {}", name, to_string(row->type)),
                 std::string(row->about));
  if (row->type == ArgumentType::kNumbers && row->count != 0 &&
      numbers_of(value).size() != row->count)
    return wrong(fmt::format("argument '{}' has {} numbers, expected {}", name,
                             numbers_of(value).size(), row->count),
                 std::string(row->about));
  return {};
}

}  // namespace

std::string_view to_string(ArgumentType type) {
  switch (type) {
    case ArgumentType::kInteger:
      return "integer";
    case ArgumentType::kNumber:
      return "number";
    case ArgumentType::kText:
      return "text";
    case ArgumentType::kBool:
      return "bool";
    case ArgumentType::kNumbers:
      return "numbers";
    case ArgumentType::kTexts:
      return "texts";
    case ArgumentType::kBytes:
      return "bytes";
    case ArgumentType::kNumberMap:
      return "map of numbers";
    case ArgumentType::kNumbersMap:
      return "map of arrays of numbers";
    case ArgumentType::kTextMap:
      return "map of strings";
  }
  return "";
}

Result<Arguments> Arguments::check(const msgpack::object& map, std::span<const Argument> list) {
  const Arguments arguments(map);
  const bool is_map = map.type == object_type::MAP;
  for (uint32_t i = 0; is_map && i < map.via.map.size; ++i) {
    const msgpack::object_kv& entry = map.via.map.ptr[i];
    const std::string_view name = text_of(entry.key);
    GLOAM_TRY_STATUS(check_one(name, entry.val, list));
    if (arguments.find(name) != &entry.val)
      return wrong(fmt::format("argument '{}' is given twice", name));
  }
  for (const Argument& argument : list)
    if (argument.is_required && !arguments.has(argument.name))
      return wrong(fmt::format("argument '{}' is missing", argument.name),
                   std::string(argument.about));
  return arguments;
}

const msgpack::object* Arguments::find(std::string_view name) const {
  if (map_.type != object_type::MAP) return nullptr;
  for (uint32_t i = 0; i < map_.via.map.size; ++i)
    if (text_of(map_.via.map.ptr[i].key) == name) return &map_.via.map.ptr[i].val;
  return nullptr;
}

int64_t Arguments::integer(std::string_view name, int64_t otherwise) const {
  const msgpack::object* value = find(name);
  return value != nullptr ? value->via.i64 : otherwise;
}

double Arguments::number(std::string_view name, double otherwise) const {
  const msgpack::object* value = find(name);
  return value != nullptr ? number_of(*value) : otherwise;
}

std::string Arguments::text(std::string_view name, std::string_view otherwise) const {
  const msgpack::object* value = find(name);
  return std::string(value != nullptr ? text_of(*value) : otherwise);
}

bool Arguments::flag(std::string_view name, bool otherwise) const {
  const msgpack::object* value = find(name);
  return value != nullptr ? value->via.boolean : otherwise;
}

std::vector<double> Arguments::numbers(std::string_view name) const {
  const msgpack::object* value = find(name);
  return value != nullptr ? numbers_of(*value) : std::vector<double>();
}

std::vector<std::string> Arguments::texts(std::string_view name) const {
  std::vector<std::string> texts;
  const msgpack::object* value = find(name);
  for (uint32_t i = 0; value != nullptr && i < value->via.array.size; ++i)
    texts.emplace_back(text_of(value->via.array.ptr[i]));
  return texts;
}

std::span<const uint8_t> Arguments::bytes(std::string_view name) const {
  const msgpack::object* value = find(name);
  if (value == nullptr) return {};
  return {reinterpret_cast<const uint8_t*>(value->via.bin.ptr), value->via.bin.size};
}

std::map<std::string, double> Arguments::number_map(std::string_view name) const {
  std::map<std::string, double> numbers;
  const msgpack::object* value = find(name);
  for (uint32_t i = 0; value != nullptr && i < value->via.map.size; ++i)
    numbers.emplace(text_of(value->via.map.ptr[i].key), number_of(value->via.map.ptr[i].val));
  return numbers;
}

std::map<std::string, std::vector<double>> Arguments::numbers_map(std::string_view name) const {
  std::map<std::string, std::vector<double>> numbers;
  const msgpack::object* value = find(name);
  for (uint32_t i = 0; value != nullptr && i < value->via.map.size; ++i)
    numbers.emplace(text_of(value->via.map.ptr[i].key), numbers_of(value->via.map.ptr[i].val));
  return numbers;
}

std::vector<std::pair<std::string, std::string>> Arguments::text_map(std::string_view name) const {
  std::vector<std::pair<std::string, std::string>> texts;
  const msgpack::object* value = find(name);
  for (uint32_t i = 0; value != nullptr && i < value->via.map.size; ++i)
    texts.emplace_back(text_of(value->via.map.ptr[i].key), text_of(value->via.map.ptr[i].val));
  return texts;
}

}  // namespace gloam::bridge::zeromq

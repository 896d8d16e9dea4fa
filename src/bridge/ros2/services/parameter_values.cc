#include "bridge/ros2/services/parameter_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace gloam::bridge {
namespace {

using rcl_interfaces::ParameterType;
using rcl_interfaces::ParameterValue;

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

template <class T>
std::optional<T> parsed(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

// A string in TOML's quotes, without escapes; others keep their text.
std::optional<std::string> plain_string(std::string_view text) {
  if (text.size() < 2 || (text[0] != '"' && text[0] != '\'') || text.back() != text[0]) return {};
  const std::string_view inner = text.substr(1, text.size() - 2);
  if (inner.find(text[0]) != std::string_view::npos) return {};
  if (text[0] == '"' && inner.find('\\') != std::string_view::npos) return {};
  return std::string(inner);
}

// Elements of a flat array; none = it is nested or no array.
std::optional<std::vector<std::string_view>> elements_of(std::string_view text) {
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return {};
  text = trimmed(text.substr(1, text.size() - 2));
  std::vector<std::string_view> elements;
  while (!text.empty()) {
    size_t end = 0;
    char quote = 0;
    for (; end < text.size() && (quote != 0 || text[end] != ','); ++end) {
      const char c = text[end];
      if (quote == 0 && (c == '[' || c == '{')) return {};
      if (quote == 0 && (c == '"' || c == '\'')) {
        quote = c;
      } else if (c == quote) {
        quote = 0;
      }
    }
    elements.push_back(trimmed(text.substr(0, end)));
    text = end < text.size() ? trimmed(text.substr(end + 1)) : std::string_view();
  }
  return elements;
}

template <class T, class F>
bool convert_all(const std::vector<std::string_view>& from, F&& convert, std::vector<T>* to) {
  to->clear();
  for (const std::string_view text : from) {
    const auto value = convert(text);
    if (!value) return false;
    to->push_back(*value);
  }
  return true;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

// TOML tells floats from integers by a dot or an exponent.
std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

template <class T, class F>
std::string array_text(const std::vector<T>& values, F&& text_of) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "" : ", ") + text_of(value);
  return "[" + text + "]";
}

ParameterValue array_parameter(const std::vector<std::string_view>& elements,
                               std::string_view text) {
  ParameterValue value;
  if (!elements.empty() && convert_all(elements, parsed<int64_t>, &value.integer_array_value)) {
    value.type = ParameterType::PARAMETER_INTEGER_ARRAY;
  } else if (value.integer_array_value.clear();
             convert_all(elements, parsed<double>, &value.double_array_value)) {
    value.type = ParameterType::PARAMETER_DOUBLE_ARRAY;
  } else if (value.double_array_value.clear();
             convert_all(elements, plain_string, &value.string_array_value)) {
    value.type = ParameterType::PARAMETER_STRING_ARRAY;
  } else {
    value.string_array_value.clear();
    value.type = ParameterType::PARAMETER_STRING;
    value.string_value = text;
  }
  return value;
}

}  // namespace

ParameterValue bool_parameter(bool value) {
  ParameterValue parameter;
  parameter.type = ParameterType::PARAMETER_BOOL;
  parameter.bool_value = value;
  return parameter;
}

ParameterValue double_parameter(double value) {
  ParameterValue parameter;
  parameter.type = ParameterType::PARAMETER_DOUBLE;
  parameter.double_value = value;
  return parameter;
}

ParameterValue string_parameter(std::string value) {
  ParameterValue parameter;
  parameter.type = ParameterType::PARAMETER_STRING;
  parameter.string_value = std::move(value);
  return parameter;
}

ParameterValue doubles_parameter(std::vector<double> values) {
  ParameterValue parameter;
  parameter.type = ParameterType::PARAMETER_DOUBLE_ARRAY;
  parameter.double_array_value = std::move(values);
  return parameter;
}

bool number_of(const ParameterValue& value, double* number) {
  if (value.type == ParameterType::PARAMETER_DOUBLE) {
    *number = value.double_value;
    return true;
  }
  *number = static_cast<double>(value.integer_value);
  return value.type == ParameterType::PARAMETER_INTEGER;
}

bool numbers_of(const ParameterValue& value, std::vector<double>* numbers) {
  if (value.type == ParameterType::PARAMETER_DOUBLE_ARRAY) {
    *numbers = value.double_array_value;
    return true;
  }
  numbers->assign(value.integer_array_value.begin(), value.integer_array_value.end());
  return value.type == ParameterType::PARAMETER_INTEGER_ARRAY;
}

ParameterValue parameter_from_toml(std::string_view toml) {
  const std::string_view text = trimmed(toml);
  ParameterValue value;
  if (text.empty()) return value;
  if (text == "true" || text == "false") return bool_parameter(text == "true");
  if (const auto number = parsed<int64_t>(text)) {
    value.type = ParameterType::PARAMETER_INTEGER;
    value.integer_value = *number;
    return value;
  }
  if (const auto number = parsed<double>(text)) return double_parameter(*number);
  if (const auto elements = elements_of(text)) return array_parameter(*elements, text);
  value.type = ParameterType::PARAMETER_STRING;
  value.string_value = plain_string(text).value_or(std::string(text));
  return value;
}

std::string parameter_to_toml(const ParameterValue& value) {
  switch (value.type) {
    case ParameterType::PARAMETER_BOOL:
      return value.bool_value ? "true" : "false";
    case ParameterType::PARAMETER_INTEGER:
      return std::to_string(value.integer_value);
    case ParameterType::PARAMETER_DOUBLE:
      return number_text(value.double_value);
    case ParameterType::PARAMETER_STRING:
      return quoted(value.string_value);
    case ParameterType::PARAMETER_BOOL_ARRAY:
      return array_text(value.bool_array_value,
                        [](uint8_t v) { return std::string(v != 0 ? "true" : "false"); });
    case ParameterType::PARAMETER_INTEGER_ARRAY:
      return array_text(value.integer_array_value, [](int64_t v) { return std::to_string(v); });
    case ParameterType::PARAMETER_DOUBLE_ARRAY:
      return array_text(value.double_array_value, number_text);
    case ParameterType::PARAMETER_STRING_ARRAY:
      return array_text(value.string_array_value, quoted);
    default:
      return {};
  }
}

}  // namespace gloam::bridge

#include "ros/default_value.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "ros/message_walk.h"

namespace gloam {
namespace {

using Field = MessageSchema::Field;

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kSpaces = " \t";
  const size_t first = text.find_first_not_of(kSpaces);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpaces) + 1 - first);
}

// Elements of "[1, 2]" or "['a', \"b, c\"]".
std::vector<std::string_view> elements_of(std::string_view list) {
  std::vector<std::string_view> elements;
  list = without_blanks(list);
  if (!list.starts_with('[') || !list.ends_with(']')) return elements;
  list = list.substr(1, list.size() - 2);
  char quote = 0;
  size_t begin = 0;
  for (size_t i = 0; i <= list.size(); ++i) {
    const bool is_end = i == list.size() || (quote == 0 && list[i] == ',');
    if (is_end) {
      if (const auto element = without_blanks(list.substr(begin, i - begin)); !element.empty())
        elements.push_back(element);
      begin = i + 1;
    } else if (quote != 0) {
      if (list[i] == quote) quote = 0;
    } else if (list[i] == '"' || list[i] == '\'') {
      quote = list[i];
    }
  }
  return elements;
}

std::string_view without_quotes(std::string_view text) {
  const bool is_quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
                         text.back() == text.front();
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

// Zero for a text that is none.
template <class T>
T number_of(std::string_view text) {
  if constexpr (std::is_same_v<T, bool>) {
    return text == "true" || text == "True" || text == "1";
  } else {
    T number = {};
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    return read.ec == std::errc() ? number : T{};
  }
}

void write_element(const MessageSchema& schema, const Field& field, std::string_view text,
                   CdrWriter* writer) {
  if (field.type.kind == FieldKind::kString) return writer->write_string(without_quotes(text));
  if (field.type.kind == FieldKind::kMessage) {
    const std::vector<Field>& parts = schema.fields(field.part);
    if (parts.empty()) writer->write(uint8_t{0});
    for (const Field& part : parts) write_default(schema, part, writer);
    return;
  }
  with_primitive(field.type.kind, [&]<class T>(std::type_identity<T>) {
    writer->write(number_of<T>(text));
    return true;
  });
}

}  // namespace

void write_default(const MessageSchema& schema, const Field& field, CdrWriter* writer) {
  const FieldType& type = field.type;
  if (type.array == ArrayKind::kNone)
    return write_element(schema, field, field.default_value, writer);
  std::vector<std::string_view> elements = elements_of(field.default_value);
  if (type.array == ArrayKind::kFixed) {
    elements.resize(type.array_size);
  } else {
    if (type.array == ArrayKind::kBounded && elements.size() > type.array_size)
      elements.resize(type.array_size);
    writer->write_count(elements.size());
  }
  for (const std::string_view element : elements) write_element(schema, field, element, writer);
}

}  // namespace gloam

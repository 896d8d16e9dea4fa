#include "ros/dynamic_message.h"

#include <fmt/format.h>

#include <charconv>

#include "base/text.h"
#include "ros/codec.h"
#include "ros/message_walk.h"

namespace gloam {
namespace {

using SchemaField = MessageSchema::Field;

/// One step of a path, "transforms[2]".
struct PathStep {
  std::string_view name;
  bool has_index = false;
  size_t index = 0;
};

Result<PathStep> parse_step(std::string_view step) {
  const size_t bracket = step.find('[');
  PathStep parsed{.name = step.substr(0, bracket)};
  if (bracket == std::string_view::npos) return parsed;
  const char* end = step.data() + step.size();
  const auto read = std::from_chars(step.data() + bracket + 1, end, parsed.index);
  if (read.ec != std::errc() || read.ptr + 1 != end || *read.ptr != ']') {
    return Error{.message = fmt::format("'{}' is not a field of a path", step.substr(0, 60)),
                 .hint = "use a path such as transforms[2].child_frame_id"};
  }
  parsed.has_index = true;
  return parsed;
}

Error no_field(std::string_view name, const std::vector<SchemaField>& fields) {
  std::vector<std::string> names;
  for (const SchemaField& field : fields) names.push_back(field.name);
  return {.message = fmt::format("there is no field '{}'", name.substr(0, 60)),
          .hint = suggest_name(name, names)};
}

Error other_kind(std::string_view path, const SchemaField& field, std::string_view wanted) {
  const bool is_message = field.type.kind == FieldKind::kMessage;
  return {.message = fmt::format(
              "'{}' is {}{}, not {}", path,
              is_message ? field.type.message : std::string(field_kind_name(field.type.kind)),
              field.type.array == ArrayKind::kNone ? "" : "[]", wanted)};
}

}  // namespace

Result<DynamicMessage> DynamicMessage::open(const MessageSchema& schema,
                                            std::span<const uint8_t> bytes) {
  CdrReader reader(bytes);
  const SchemaField whole{.least_size = 1};
  if (skip_elements(schema, &reader, whole, 1) && reader.left() > kMostPadding) {
    reader.fail("there are unread bytes after the end of the message");
  }
  if (!reader.ok()) {
    Error error = reader.error();
    error.message = schema.name() + ": " + error.message;
    return error;
  }
  return DynamicMessage(schema, bytes);
}

Result<DynamicMessage::Place> DynamicMessage::find(std::string_view path) const {
  Place place{CdrReader(bytes_), {.least_size = 1}};
  CdrReader& reader = place.reader;
  for (bool more = true; more;) {
    const size_t end = std::min(path.find('.'), path.size());
    more = end < path.size();
    GLOAM_TRY(const PathStep step, parse_step(path.substr(0, end)));
    path.remove_prefix(std::min(end + 1, path.size()));
    if (place.field.type.kind != FieldKind::kMessage) return no_field(step.name, {});
    if (place.field.type.array != ArrayKind::kNone) {
      return Error{.message = fmt::format("'{}' is an array", place.field.name),
                   .hint = fmt::format("choose an element: {}[0]", place.field.name)};
    }
    const std::vector<SchemaField>& fields = schema_->fields(place.field.part);
    size_t i = 0;
    while (i < fields.size() && fields[i].name != step.name) {
      if (!skip_field(*schema_, &reader, fields[i++])) return reader.error();
    }
    if (i == fields.size()) return no_field(step.name, fields);
    place.field = fields[i];
    if (!step.has_index) continue;
    if (place.field.type.array == ArrayKind::kNone) {
      return Error{.message = fmt::format("'{}' is not an array", step.name)};
    }
    size_t count = 0;
    if (!read_length(&reader, place.field, &count)) return reader.error();
    if (step.index >= count) {
      return Error{.message = fmt::format("'{}' has {} elements, so index {} is out of range",
                                          step.name, count, step.index)};
    }
    if (!skip_elements(*schema_, &reader, place.field, step.index)) return reader.error();
    place.field.type.array = ArrayKind::kNone;
  }
  return place;
}

Result<double> DynamicMessage::number(std::string_view path) const {
  GLOAM_TRY(Place place, find(path));
  double number = 0;
  const FieldType& type = place.field.type;
  const bool read = type.array == ArrayKind::kNone &&
                    with_primitive(type.kind, [&]<class T>(std::type_identity<T>) {
                      T value = {};
                      if (!place.reader.read(&value)) return false;
                      number = static_cast<double>(value);
                      return true;
                    });
  if (!place.reader.ok()) return place.reader.error();
  if (!read) return other_kind(path, place.field, "a number");
  return number;
}

Result<int64_t> DynamicMessage::integer(std::string_view path) const {
  GLOAM_TRY(Place place, find(path));
  int64_t number = 0;
  const FieldType& type = place.field.type;
  const bool read = type.array == ArrayKind::kNone &&
                    with_primitive(type.kind, [&]<class T>(std::type_identity<T>) {
                      if constexpr (std::is_integral_v<T>) {
                        T value = {};
                        if (!place.reader.read(&value)) return false;
                        number = static_cast<int64_t>(value);
                        return !std::same_as<T, uint64_t> || number >= 0;
                      }
                      return false;
                    });
  if (!place.reader.ok()) return place.reader.error();
  if (!read) return other_kind(path, place.field, "an integer below 2^63");
  return number;
}

Result<std::string> DynamicMessage::text(std::string_view path) const {
  GLOAM_TRY(Place place, find(path));
  const FieldType& type = place.field.type;
  if (type.kind != FieldKind::kString || type.array != ArrayKind::kNone) {
    return other_kind(path, place.field, "a string");
  }
  std::string text;
  if (!place.reader.read_string(&text, type.string_bound)) return place.reader.error();
  return text;
}

Result<std::vector<double>> DynamicMessage::numbers(std::string_view path) const {
  GLOAM_TRY(Place place, find(path));
  std::vector<double> numbers;
  if (!collect_numbers(*schema_, &place.reader, place.field, &numbers)) {
    if (!place.reader.ok()) return place.reader.error();
    return other_kind(path, place.field, "a list of numbers");
  }
  return numbers;
}

Result<std::vector<std::string>> DynamicMessage::texts(std::string_view path) const {
  GLOAM_TRY(Place place, find(path));
  if (place.field.type.kind != FieldKind::kString) return other_kind(path, place.field, "strings");
  size_t count = 0;
  if (!read_length(&place.reader, place.field, &count)) return place.reader.error();
  std::vector<std::string> texts;
  for (size_t i = 0; i < count; ++i) {
    std::string& text = texts.emplace_back();
    if (!place.reader.read_string(&text, place.field.type.string_bound))
      return place.reader.error();
  }
  return texts;
}

Result<std::span<const uint8_t>> DynamicMessage::bytes(std::string_view path) const {
  GLOAM_TRY(Place place, find(path));
  const FieldType& type = place.field.type;
  if (type.array == ArrayKind::kNone || primitive_size(type.kind) != 1) {
    return other_kind(path, place.field, "an array of bytes");
  }
  size_t count = 0;
  if (!read_length(&place.reader, place.field, &count)) return place.reader.error();
  const uint8_t* from = place.reader.take(1, count);
  if (from == nullptr) return place.reader.error();
  return std::span(from, count);
}

Result<size_t> DynamicMessage::count(std::string_view path) const {
  GLOAM_TRY(Place place, find(path));
  if (place.field.type.array == ArrayKind::kNone) return other_kind(path, place.field, "an array");
  size_t count = 0;
  if (!read_length(&place.reader, place.field, &count)) return place.reader.error();
  return count;
}

}  // namespace gloam

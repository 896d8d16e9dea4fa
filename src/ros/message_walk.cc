#include "ros/message_walk.h"

#include <fmt/format.h>

#include <algorithm>

namespace gloam {

bool read_length(CdrReader* reader, const MessageSchema::Field& field, size_t* count) {
  *count = field.type.array == ArrayKind::kFixed ? field.type.array_size : 1;
  if (field.type.array < ArrayKind::kBounded) return true;
  if (!reader->read_count(count, field.least_size)) return false;
  if (field.type.array == ArrayKind::kBounded && *count > field.type.array_size) {
    return reader->fail(
        fmt::format("{} elements exceed the bound of {}", *count, field.type.array_size));
  }
  return true;
}

bool skip_field(const MessageSchema& schema, CdrReader* reader, const MessageSchema::Field& field) {
  size_t count = 0;
  if (read_length(reader, field, &count) && skip_elements(schema, reader, field, count))
    return true;
  reader->add_place(field.name);
  return false;
}

bool skip_elements(const MessageSchema& schema, CdrReader* reader,
                   const MessageSchema::Field& field, size_t count) {
  if (const size_t size = primitive_size(field.type.kind); size > 0) {
    if (count == 0) return true;
    const uint8_t* from = reader->take(size, count);
    if (from == nullptr) return false;
    if (field.type.kind != FieldKind::kBool) return true;
    return std::all_of(from, from + count, [](uint8_t byte) { return byte <= 1; }) ||
           reader->fail("a bool is neither 0 nor 1");
  }
  for (size_t i = 0; i < count; ++i) {
    if (field.type.kind == FieldKind::kString) {
      std::string_view text;
      if (!reader->read_string(&text, field.type.string_bound)) return false;
      continue;
    }
    const std::vector<MessageSchema::Field>& fields = schema.fields(field.part);
    if (fields.empty() && reader->take(1, 1) == nullptr) return false;
    for (const MessageSchema::Field& part : fields) {
      if (!skip_field(schema, reader, part)) return false;
    }
  }
  return true;
}

bool collect_numbers(const MessageSchema& schema, CdrReader* reader,
                     const MessageSchema::Field& field, std::vector<double>* numbers) {
  size_t count = 0;
  if (field.type.kind == FieldKind::kString || !read_length(reader, field, &count)) return false;
  if (field.type.kind != FieldKind::kMessage) {
    return with_primitive(field.type.kind, [&]<class T>(std::type_identity<T>) {
      if (count > reader->left() / sizeof(T)) return reader->fail("the message is truncated");
      for (size_t i = 0; i < count; ++i) {
        T value = {};
        if (!reader->read(&value)) return false;
        numbers->push_back(static_cast<double>(value));
      }
      return true;
    });
  }
  for (size_t i = 0; i < count; ++i) {
    const std::vector<MessageSchema::Field>& fields = schema.fields(field.part);
    if (fields.empty() && reader->take(1, 1) == nullptr) return false;
    for (const MessageSchema::Field& part : fields) {
      if (!collect_numbers(schema, reader, part, numbers)) return false;
    }
  }
  return true;
}

}  // namespace gloam

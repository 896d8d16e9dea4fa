#include "ros/message_schema.h"

#include <fmt/format.h>

#include <map>

#include "ros/definition_parser.h"

namespace gloam {
namespace {

constexpr size_t kDeepest = 32;                    // nested messages
constexpr size_t kLargestLeast = size_t{1} << 32;  // sizes beyond fit into no message anyway

Error at_field(const MessageDescription& message, const FieldDescription& field, std::string text,
               std::string_view file) {
  return {.message = fmt::format("field '{}' of {}: {}", field.name, message.name, text),
          .loc = {std::string(file), field.line}};
}

}  // namespace

size_t primitive_size(FieldKind kind) {
  switch (kind) {
    case FieldKind::kMessage:
    case FieldKind::kString:
      return 0;
    case FieldKind::kInt8:
    case FieldKind::kUint8:
    case FieldKind::kChar:
    case FieldKind::kBool:
    case FieldKind::kByte:
      return 1;
    case FieldKind::kInt16:
    case FieldKind::kUint16:
      return 2;
    case FieldKind::kInt32:
    case FieldKind::kUint32:
    case FieldKind::kFloat32:
      return 4;
    case FieldKind::kInt64:
    case FieldKind::kUint64:
    case FieldKind::kFloat64:
      return 8;
  }
  return 0;
}

Result<MessageSchema> MessageSchema::parse(std::string_view text, std::string_view name) {
  GLOAM_TRY(TypeDescription type, parse_ros2msg(text, name));
  return create(std::move(type));
}

Result<MessageSchema> MessageSchema::create(TypeDescription type) {
  MessageSchema schema;
  schema.type_ = std::move(type);
  GLOAM_TRY_STATUS(schema.look_up_parts());
  schema.least_sizes_.resize(schema.fields_.size());
  schema.heights_.resize(schema.fields_.size());
  schema.being_measured_.resize(schema.fields_.size());
  for (size_t part = 0; part < schema.fields_.size(); ++part) {
    GLOAM_TRY_STATUS(schema.measure(part));
  }
  return schema;
}

Status MessageSchema::look_up_parts() {
  std::map<std::string, size_t, std::less<>> index;
  for (size_t i = 0; i < type_.messages.size(); ++i) index[type_.messages[i].name] = i;
  for (MessageDescription& message : type_.messages) {
    std::vector<Field>& fields = fields_.emplace_back();
    for (FieldDescription& field : message.fields) {
      size_t part = 0;
      if (field.type.kind == FieldKind::kMessage) {
        auto found = index.find(field.type.message);
        // ROS 1 let std_msgs be left out of the header's name; converted logs still do.
        if (found == index.end() && field.type.message.ends_with("/msg/Header")) {
          found = index.find("std_msgs/msg/Header");
        }
        if (found == index.end()) {
          return at_field(message, field, field.type.message + " is not defined", name());
        }
        part = found->second;
        field.type.message = found->first;
      }
      fields.push_back({field.name, field.type, part, field.default_value});
    }
  }
  return {};
}

Status MessageSchema::measure(size_t part) {
  if (least_sizes_[part] > 0) return {};
  const MessageDescription& message = type_.messages[part];
  being_measured_[part] = true;
  size_t size = 0, height = 1;
  for (size_t i = 0; i < fields_[part].size(); ++i) {
    Field& field = fields_[part][i];
    if (field.type.kind == FieldKind::kMessage) {
      if (being_measured_[field.part]) {
        return at_field(message, message.fields[i], "a message contains itself", name());
      }
      GLOAM_TRY_STATUS(measure(field.part));
      height = std::max(height, heights_[field.part] + 1);
      if (height > kDeepest) {
        return at_field(message, message.fields[i], "messages are nested too deeply", name());
      }
      field.least_size = least_sizes_[field.part];
    } else {
      const bool is_string = field.type.kind == FieldKind::kString;
      field.least_size = is_string ? sizeof(uint32_t) : primitive_size(field.type.kind);
    }
    size_t least = field.least_size;
    if (field.type.array == ArrayKind::kFixed) least *= field.type.array_size;
    if (field.type.array >= ArrayKind::kBounded) least = sizeof(uint32_t);  // the count
    size = std::min(size + std::min(least, kLargestLeast), kLargestLeast);
  }
  being_measured_[part] = false;
  least_sizes_[part] = std::max<size_t>(size, 1);
  heights_[part] = height;
  return {};
}

}  // namespace gloam

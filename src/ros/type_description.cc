#include "ros/type_description.h"

#include <fmt/format.h>

#include <map>

#include "base/sha256.h"

namespace gloam {
namespace {

// FieldType's numbers for an element type `kind`: the plain one plus this (REP 2016).
constexpr int kFixedOffset = 48, kBoundedOffset = 96, kUnboundedOffset = 144;
constexpr int kBoundedString = 21;

/// "std_msgs/Header" of "std_msgs/msg/Header"; names of other than messages stay whole.
std::string short_name(std::string_view name) {
  const size_t first = name.find('/'), last = name.rfind('/');
  if (name.substr(first, last - first) != "/msg") return std::string(name);
  return fmt::format("{}{}", name.substr(0, first), name.substr(last));
}

std::string type_text(const FieldType& type) {
  std::string text = type.kind == FieldKind::kMessage ? short_name(type.message)
                                                      : std::string(field_kind_name(type.kind));
  if (type.string_bound > 0) text += fmt::format("<={}", type.string_bound);
  switch (type.array) {
    case ArrayKind::kNone:
      return text;
    case ArrayKind::kFixed:
      return text + fmt::format("[{}]", type.array_size);
    case ArrayKind::kBounded:
      return text + fmt::format("[<={}]", type.array_size);
    case ArrayKind::kUnbounded:
      return text + "[]";
  }
  return text;
}

std::string message_text(const MessageDescription& message) {
  std::string text;
  for (const ConstantDescription& constant : message.constants) {
    text += fmt::format("{} {}={}\n", constant.type, constant.name, constant.value);
  }
  for (const FieldDescription& field : message.fields) {
    text += fmt::format("{} {}", type_text(field.type), field.name);
    text += field.default_value.empty() ? "\n" : " " + field.default_value + "\n";
  }
  return text;
}

// JSON as Python's json.dumps writes it: ", " and ": ", keys in this order. Names need no escapes.
std::string field_json(std::string_view name, const FieldType& type) {
  int id = static_cast<int>(type.kind);
  if (type.kind == FieldKind::kString && type.string_bound > 0) id = kBoundedString;
  // rosidl's adapter makes a uint8 of char before it hashes (rmw_dds_common/msg/Gid shows it).
  if (type.kind == FieldKind::kChar) id = static_cast<int>(FieldKind::kUint8);
  if (type.array == ArrayKind::kFixed) id += kFixedOffset;
  if (type.array == ArrayKind::kBounded) id += kBoundedOffset;
  if (type.array == ArrayKind::kUnbounded) id += kUnboundedOffset;
  return fmt::format(
      R"({{"name": "{}", "type": {{"type_id": {}, "capacity": {}, "string_capacity": {}, )"
      R"("nested_type_name": "{}"}}}})",
      name, id, type.array_size, type.string_bound, type.message);
}

std::string message_json(const MessageDescription& message) {
  std::string fields;
  for (const FieldDescription& field : message.fields) {
    fields += (fields.empty() ? "" : ", ") + field_json(field.name, field.type);
  }
  if (fields.empty()) {
    fields = field_json("structure_needs_at_least_one_member", {.kind = FieldKind::kUint8});
  }
  return fmt::format(R"({{"type_name": "{}", "fields": [{}]}})", message.name, fields);
}

}  // namespace

const MessageDescription* TypeDescription::find(std::string_view name) const {
  for (const MessageDescription& message : messages) {
    if (message.name == name) return &message;
  }
  return nullptr;
}

std::string_view field_kind_name(FieldKind kind) {
  switch (kind) {
    case FieldKind::kMessage:
      return "";
    case FieldKind::kInt8:
      return "int8";
    case FieldKind::kUint8:
      return "uint8";
    case FieldKind::kInt16:
      return "int16";
    case FieldKind::kUint16:
      return "uint16";
    case FieldKind::kInt32:
      return "int32";
    case FieldKind::kUint32:
      return "uint32";
    case FieldKind::kInt64:
      return "int64";
    case FieldKind::kUint64:
      return "uint64";
    case FieldKind::kFloat32:
      return "float32";
    case FieldKind::kFloat64:
      return "float64";
    case FieldKind::kChar:
      return "char";
    case FieldKind::kBool:
      return "bool";
    case FieldKind::kByte:
      return "byte";
    case FieldKind::kString:
      return "string";
  }
  return "";
}

std::string ros2msg_text(const TypeDescription& type) {
  std::string text;
  for (const MessageDescription& message : type.messages) {
    if (&message != type.messages.data()) {
      text += fmt::format("{:=<80}\nMSG: {}\n", "", short_name(message.name));
    }
    text += message_text(message);
  }
  return text;
}

std::string rihs01_hash(const TypeDescription& type) {
  std::map<std::string_view, const MessageDescription*> parts;  // by name
  for (const MessageDescription& message : type.messages) parts[message.name] = &message;
  parts.erase(type.messages.front().name);
  std::string references;
  for (const auto& [name, message] : parts) {
    references += (references.empty() ? "" : ", ") + message_json(*message);
  }
  return "RIHS01_" + sha256_hex(fmt::format(
                         R"({{"type_description": {}, "referenced_type_descriptions": [{}]}})",
                         message_json(type.messages.front()), references));
}

std::string dds_type_name(std::string_view ros_name) {
  const size_t first = ros_name.find('/'), last = ros_name.rfind('/');
  return fmt::format("{}::{}::dds_::{}_", ros_name.substr(0, first),
                     ros_name.substr(first + 1, last - first - 1), ros_name.substr(last + 1));
}

}  // namespace gloam

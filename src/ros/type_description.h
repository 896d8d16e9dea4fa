#pragma once
// Types of messages as data, from a struct of ours (describe<T>) or from a stranger's text
// (definition_parser.h), and what follows of them: the ros2msg text and the RIHS01 hash (REP 2016).

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "ros/message.h"

namespace gloam {

/// Element type; values as in type_description_interfaces/msg/FieldType.
enum class FieldKind : uint8_t {
  kMessage = 1,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
  kChar = 13,  ///< an uint8 on the wire
  kBool = 15,
  kByte = 16,  ///< an uint8 on the wire
  kString = 17,
};

enum class ArrayKind : uint8_t { kNone, kFixed, kBounded, kUnbounded };

struct FieldType {
  FieldKind kind = FieldKind::kMessage;
  std::string message;      ///< "std_msgs/msg/Header" of kMessage
  size_t string_bound = 0;  ///< most characters; 0 = any number
  ArrayKind array = ArrayKind::kNone;
  size_t array_size = 0;  ///< of kFixed, the most of kBounded
};

struct FieldDescription {
  std::string name;
  FieldType type;
  std::string default_value = {};  ///< as in a .msg file: "1", "[1, 2]"; "" = zero or empty
  int line = 0;                    ///< in the text it was read from; 0 = from a struct
};

struct ConstantDescription {
  std::string type, name, value;
};

struct MessageDescription {
  std::string name;                      ///< "sensor_msgs/msg/Imu"
  std::vector<FieldDescription> fields;  ///< may be empty: one byte on the wire then
  std::vector<ConstantDescription> constants;
};

/// A message, [0], and every message that it is made of, each once.
struct TypeDescription {
  std::vector<MessageDescription> messages;

  const MessageDescription* find(std::string_view name) const;
};

/// "float64" of kFloat64; "" of kMessage.
std::string_view field_kind_name(FieldKind kind);

/// The definition as MCAP's encoding ros2msg has it: the message's own lines, then for each message
/// that it is made of a line of 80 =, "MSG: package/Name" and its lines.
std::string ros2msg_text(const TypeDescription& type);

/// "RIHS01_" and 64 hexadecimal digits. Names, types and the order of fields enter, constants do
/// not.
std::string rihs01_hash(const TypeDescription& type);

/// "sensor_msgs::msg::dds_::Imu_" of "sensor_msgs/msg/Imu".
std::string dds_type_name(std::string_view ros_name);

template <Message T>
std::string ros_type_name() {
  return std::string(T::kNamespace) + "/" + std::string(T::kName);
}

template <class T>
constexpr FieldKind field_kind() {
  if constexpr (Message<T>) return FieldKind::kMessage;
  if constexpr (std::derived_from<T, std::string>) return FieldKind::kString;
  if constexpr (std::same_as<T, bool>) return FieldKind::kBool;
  if constexpr (std::same_as<T, char>) return FieldKind::kChar;
  if constexpr (std::same_as<T, std::byte>) return FieldKind::kByte;
  if constexpr (std::same_as<T, int8_t>) return FieldKind::kInt8;
  if constexpr (std::same_as<T, uint8_t>) return FieldKind::kUint8;
  if constexpr (std::same_as<T, int16_t>) return FieldKind::kInt16;
  if constexpr (std::same_as<T, uint16_t>) return FieldKind::kUint16;
  if constexpr (std::same_as<T, int32_t>) return FieldKind::kInt32;
  if constexpr (std::same_as<T, uint32_t>) return FieldKind::kUint32;
  if constexpr (std::same_as<T, int64_t>) return FieldKind::kInt64;
  if constexpr (std::same_as<T, uint64_t>) return FieldKind::kUint64;
  if constexpr (std::same_as<T, float>) return FieldKind::kFloat32;
  if constexpr (std::same_as<T, double>) return FieldKind::kFloat64;
}

template <class F>
FieldDescription describe_field(std::string_view name) {
  using Traits = FieldTraits<F>;
  using Element = typename Traits::Element;
  FieldDescription field{.name = std::string(name)};
  field.type.kind = field_kind<Element>();
  if constexpr (Message<Element>) field.type.message = ros_type_name<Element>();
  field.type.string_bound = kStringBound<Element>;
  field.type.array = Traits::kIsArray       ? ArrayKind::kFixed
                     : !Traits::kIsSequence ? ArrayKind::kNone
                     : Traits::kSize > 0    ? ArrayKind::kBounded
                                            : ArrayKind::kUnbounded;
  field.type.array_size = Traits::kSize;
  return field;
}

/// Adds T and what it is made of, unless it is there.
template <Message T>
void add_description(TypeDescription* type) {
  if (type->find(ros_type_name<T>()) != nullptr) return;
  MessageDescription message{.name = ros_type_name<T>()};
  for_each_field_type<T>([&]<class F>(std::type_identity<F>, std::string_view name) {
    message.fields.push_back(describe_field<F>(name));
  });
  if constexpr (requires { T::kConstants; }) {
    for (const ConstantText& one : T::kConstants)
      message.constants.push_back(
          {std::string(one.type), std::string(one.name), std::string(one.value)});
  }
  if constexpr (requires { T::kDefaults; }) {
    for (const DefaultText& one : T::kDefaults)
      std::ranges::find(message.fields, one.field, &FieldDescription::name)->default_value =
          one.value;
  }
  type->messages.push_back(std::move(message));
  for_each_field_type<T>([&]<class F>(std::type_identity<F>, std::string_view) {
    using Element = typename FieldTraits<F>::Element;
    if constexpr (Message<Element>) add_description<Element>(type);
  });
}

template <Message T>
TypeDescription describe() {
  TypeDescription type;
  add_description<T>(&type);
  return type;
}

}  // namespace gloam

#pragma once
// Steps through a message by its schema, for DynamicMessage. The work is bounded by the message's
// bytes, whatever the schema says: each element takes one at least.

#include <type_traits>
#include <vector>

#include "ros/cdr.h"
#include "ros/message_schema.h"

namespace gloam {

/// Reads how many elements a field has: 1 where it is no array.
bool read_length(CdrReader* reader, const MessageSchema::Field& field, size_t* count);

/// Steps over a field, or over `count` elements of one. False on damage, which the reader tells.
bool skip_field(const MessageSchema& schema, CdrReader* reader, const MessageSchema::Field& field);
bool skip_elements(const MessageSchema& schema, CdrReader* reader,
                   const MessageSchema::Field& field, size_t count);

/// Appends all numbers of a field; false where a string is among them, or on damage.
bool collect_numbers(const MessageSchema& schema, CdrReader* reader,
                     const MessageSchema::Field& field, std::vector<double>* numbers);

/// Calls f(std::type_identity of the C++ type) of a primitive; false for strings and messages.
template <class F>
bool with_primitive(FieldKind kind, F&& f) {
  switch (kind) {
    case FieldKind::kMessage:
    case FieldKind::kString:
      return false;
    case FieldKind::kInt8:
      return f(std::type_identity<int8_t>());
    case FieldKind::kUint8:
    case FieldKind::kChar:
    case FieldKind::kByte:
      return f(std::type_identity<uint8_t>());
    case FieldKind::kInt16:
      return f(std::type_identity<int16_t>());
    case FieldKind::kUint16:
      return f(std::type_identity<uint16_t>());
    case FieldKind::kInt32:
      return f(std::type_identity<int32_t>());
    case FieldKind::kUint32:
      return f(std::type_identity<uint32_t>());
    case FieldKind::kInt64:
      return f(std::type_identity<int64_t>());
    case FieldKind::kUint64:
      return f(std::type_identity<uint64_t>());
    case FieldKind::kFloat32:
      return f(std::type_identity<float>());
    case FieldKind::kFloat64:
      return f(std::type_identity<double>());
    case FieldKind::kBool:
      return f(std::type_identity<bool>());
  }
  return false;
}

}  // namespace gloam

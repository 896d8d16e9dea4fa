#pragma once
// The type of a message whose struct Gloam need not have: names looked up, sizes known.

#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"
#include "ros/type_description.h"

namespace gloam {

class MessageSchema {
 public:
  struct Field {
    std::string name;
    FieldType type;
    size_t part = 0;                 ///< index of the message of kMessage
    std::string default_value = {};  ///< as of FieldDescription
    size_t least_size = 0;           ///< fewest bytes of an element on the wire, at least 1
  };

  /// Out of a definition as text, see parse_ros2msg. Errors besides its: a part without definition,
  /// one that contains itself, messages nested deeper than 32.
  static Result<MessageSchema> parse(std::string_view text, std::string_view name);
  static Result<MessageSchema> create(TypeDescription type);

  const std::string& name() const { return type_.messages.front().name; }
  /// What was read, to make the text or the hash of.
  const TypeDescription& type() const { return type_; }
  /// Fields of message `part`; 0 is the whole.
  const std::vector<Field>& fields(size_t part) const { return fields_[part]; }

 private:
  Status look_up_parts();
  Status measure(size_t part);

  TypeDescription type_;
  std::vector<std::vector<Field>> fields_;  ///< by message
  std::vector<size_t> least_sizes_;         ///< by message; 0 = not measured
  std::vector<size_t> heights_;             ///< by message: levels of messages in it, itself one
  std::vector<bool> being_measured_;
};

/// Bytes of a primitive; 0 of strings and messages.
size_t primitive_size(FieldKind kind);

}  // namespace gloam

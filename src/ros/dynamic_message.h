#pragma once
// A message of any type, read by the names of its fields: "pose.pose.position.x",
// "transforms[2].child_frame_id". Nothing is decoded but what is asked for.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"
#include "ros/cdr.h"
#include "ros/message_schema.h"

namespace gloam {

/// A view of a schema and a message, both of which must outlive it. Errors of all reads: no such
/// field, an index beyond the end, a field of another kind, a part of the message that is damaged.
class DynamicMessage {
 public:
  /// Walks the message once. Errors: those of decode().
  static Result<DynamicMessage> open(const MessageSchema& schema, std::span<const uint8_t> bytes);

  /// A number or a bool. 64-bit integers beyond 2^53 are rounded.
  Result<double> number(std::string_view path) const;
  /// An integer or a bool, exactly. Refuses uint64 beyond 2^63 - 1.
  Result<int64_t> integer(std::string_view path) const;
  Result<std::string> text(std::string_view path) const;
  /// All numbers below a field in the order of the message: 36 of a covariance, three of a point,
  /// seven for each of an array of poses.
  Result<std::vector<double>> numbers(std::string_view path) const;
  /// Strings of an array.
  Result<std::vector<std::string>> texts(std::string_view path) const;
  /// An array of uint8, int8, char or byte, where it stands in the message.
  Result<std::span<const uint8_t>> bytes(std::string_view path) const;
  /// Length of an array.
  Result<size_t> count(std::string_view path) const;

 private:
  struct Place {
    CdrReader reader;
    MessageSchema::Field field;
  };

  DynamicMessage(const MessageSchema& schema, std::span<const uint8_t> bytes)
      : schema_(&schema), bytes_(bytes) {}
  Result<Place> find(std::string_view path) const;

  const MessageSchema* schema_;
  std::span<const uint8_t> bytes_;
};

}  // namespace gloam

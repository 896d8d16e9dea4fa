#pragma once
// Reader of the wire format of Protocol Buffers (protobuf.dev/programming-guides/encoding), of
// which ONNX files consist. It never copies and never reads past the bytes that it was given.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace gloam {

/// Iterates over the fields of one message: `while (reader.next()) …`.
class WireReader {
 public:
  explicit WireReader(std::span<const uint8_t> message) : bytes_(message) {}

  /// Moves to the next field. False at the end, and where the message is damaged.
  bool next();
  bool damaged() const { return damaged_; }

  uint64_t number() const { return number_; }  ///< of the field
  /// Whether the field is an integer; else it is the bytes of a text, a message or a packed list.
  bool is_integer() const { return is_integer_; }
  int64_t integer() const { return static_cast<int64_t>(value_); }
  std::span<const uint8_t> bytes() const { return field_; }
  std::string_view text() const {
    return {reinterpret_cast<const char*>(field_.data()), field_.size()};
  }

 private:
  bool fail();
  bool take_bytes(uint64_t size);

  std::span<const uint8_t> bytes_;
  std::span<const uint8_t> field_;
  uint64_t number_ = 0, value_ = 0;
  bool is_integer_ = false, damaged_ = false;
};

/// Removes a variable-length integer from the front of `bytes`. False: there is none.
bool take_varint(std::span<const uint8_t>* bytes, uint64_t* value);

/// A field of type LEN: its number, its length and `content`.
std::string wire_field(uint64_t number, std::string_view content);

}  // namespace gloam

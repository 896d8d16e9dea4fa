#pragma once
// CDR, the encoding of ROS 2's messages (OMG DDSI-RTPS 2.5, 10.2; XCDR version 1): a head of four
// bytes, then primitives aligned to their size, counted from the end of the head. Strings are a
// uint32 length with the final zero, the characters, a zero; sequences a uint32 count, the
// elements.

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "gloam/result.h"

namespace gloam {

static_assert(std::endian::native == std::endian::little,
              "CdrWriter copies numbers without swapping bytes");

/// Types of fixed size on the wire. `char` and std::byte are the ROS types char and byte.
template <class T>
concept CdrPrimitive = std::is_arithmetic_v<T> || std::same_as<T, std::byte>;

inline constexpr size_t kCdrHead = 4;  ///< bytes: representation, options

/// Appends one message, little endian, to a buffer of the caller's, which is used again and again.
class CdrWriter {
 public:
  /// Writes the head. `bytes` must outlive the writer.
  explicit CdrWriter(std::vector<uint8_t>* bytes);

  template <CdrPrimitive T>
  void write(T value) {
    align(sizeof(T));
    append(&value, sizeof(T));
  }
  void write_string(std::string_view text);
  /// The count of a sequence; its elements are the caller's to write. Checked: below 2^32.
  void write_count(size_t count);
  /// Elements without a count.
  template <CdrPrimitive T>
  void write_array(std::span<const T> values) {
    if (values.empty()) return;  // padding belongs to the elements
    align(sizeof(T));
    append(values.data(), values.size_bytes());
  }
  template <CdrPrimitive T>
  void write_sequence(std::span<const T> values) {
    write_count(values.size());
    write_array(values);
  }

 private:
  void align(size_t size) {
    const size_t past = (bytes_->size() - body_) & (size - 1);
    if (past != 0) bytes_->resize(bytes_->size() + size - past);
  }
  void append(const void* data, size_t size) {
    const auto* begin = static_cast<const uint8_t*>(data);
    bytes_->insert(bytes_->end(), begin, begin + size);
  }

  std::vector<uint8_t>* bytes_;
  size_t body_;  ///< index of the first byte after the head
};

/// Reads one message of either byte order out of bytes that may be a stranger's. After the first
/// read that fails all others fail; what was read into is then without meaning. No length is
/// believed before it is compared with the bytes that are left.
class CdrReader {
 public:
  /// Fails on heads other than those of plain CDR (00 00 big endian, 00 01 little endian).
  explicit CdrReader(std::span<const uint8_t> message);

  bool ok() const { return failure_.empty(); }
  size_t left() const { return body_.size() - at_; }
  /// Bytes read since the start of the message, the head among them.
  size_t offset() const { return kCdrHead + at_; }

  template <CdrPrimitive T>
  bool read(T* value) {
    return read_array(std::span<T>(value, 1));
  }
  /// `bound`: most characters; 0 = any number.
  bool read_string(std::string* text, size_t bound = 0);
  /// A string where it stands in the message.
  bool read_string(std::string_view* text, size_t bound = 0);
  /// The count of a sequence whose elements take `least_size` >= 1 bytes each, or more. Fails when
  /// they cannot fit into the remaining bytes.
  bool read_count(size_t* count, size_t least_size);
  template <CdrPrimitive T>
  bool read_array(std::span<T> values) {
    if (values.empty()) return ok();
    const uint8_t* from = take(sizeof(T), values.size());
    if (from == nullptr) return false;
    if constexpr (std::same_as<T, bool>) {
      for (size_t i = 0; i < values.size(); ++i) {
        if (from[i] > 1) return fail("a bool is neither 0 nor 1");
        values[i] = from[i] == 1;
      }
    } else {
      std::memcpy(values.data(), from, values.size_bytes());
      if (swap_ && sizeof(T) > 1) swap_bytes(values);
    }
    return true;
  }
  template <CdrPrimitive T>
  bool read_sequence(std::vector<T>* values) {
    size_t count = 0;
    if (!read_count(&count, sizeof(T))) return false;
    values->resize(count);
    return read_array(std::span<T>(*values));
  }
  /// `count` elements of `size` bytes (1, 2, 4 or 8) each, where they stand; nullptr on failure.
  const uint8_t* take(size_t size, size_t count);
  bool swaps_bytes() const { return swap_; }

  /// Marks the message as damaged, unless it is already.
  bool fail(std::string_view why);
  /// Names the part in which a read failed, innermost first.
  void add_place(std::string_view name);
  /// The failure in one line; call it only when !ok().
  Error error() const;

 private:
  template <class T>
  static void swap_bytes(std::span<T> values) {
    for (T& value : values) {
      auto* begin = reinterpret_cast<uint8_t*>(&value);
      std::reverse(begin, begin + sizeof(T));
    }
  }

  std::span<const uint8_t> body_;
  size_t at_ = 0;
  bool swap_ = false;
  size_t failed_at_ = 0;
  std::string failure_, place_;
};

}  // namespace gloam

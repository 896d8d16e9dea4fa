#pragma once
// The description of a message's struct by one list of its fields, from which its encoding, its
// definition as text and its hash are derived:
//
//   struct Header {
//     builtin_interfaces::Time stamp;
//     std::string frame_id;
//     GLOAM_MESSAGE(Header, stamp, frame_id)
//   };
//
// in a namespace with `kPackage = "std_msgs/msg"`. The build generates the structs of the messages
// in definitions/, as ros/messages/PACKAGE.h (generator/generate_messages.py). Constants are static
// members, listed again in kConstants; kDefaults lists fields with default values. Types of fields:
// ROS's primitives as bool, int8_t … uint64_t, float, double, `char` (char), std::byte (byte),
// std::string, BoundedString; other messages; std::array (T[N]), std::vector (T[]), BoundedVector
// (T[<=N]), Bytes (uint8[]) and Bools (bool[]) of those.

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "ros/cdr.h"

/// The members of message `T`, in the order of its definition.
#define GLOAM_MESSAGE(T, ...)                                   \
  static constexpr std::string_view kNamespace = kPackage;      \
  static constexpr std::string_view kName = #T;                 \
  static constexpr std::string_view kFieldNames = #__VA_ARGS__; \
  auto members() { return std::tie(__VA_ARGS__); }              \
  auto members() const { return std::tie(__VA_ARGS__); }        \
  friend bool operator==(const T&, const T&) = default;

namespace gloam {

template <class T>
concept Message = requires {
  T::kNamespace;
  T::kFieldNames;
};

/// A constant of a message as in its definition: {"uint8", "INFRARED", "1"}.
struct ConstantText {
  std::string_view type, name, value;
};

/// A field's default value as in its message's definition: {"w", "1"}.
struct DefaultText {
  std::string_view field, value;
};

/// string<=N: the encoder checks that there are no more than N characters, the decoder refuses
/// them.
template <size_t N>
struct BoundedString : std::string {
  using std::string::string;
  BoundedString(std::string text) : std::string(std::move(text)) {}  // NOLINT: implicit, as string
};

/// T[<=N]: the decoder refuses more elements.
template <class T, size_t N>
struct BoundedVector : std::vector<T> {
  using std::vector<T>::vector;
};

/// bool[], one byte each, 0 or 1: std::vector<bool> has no elements to point to.
struct Bools : std::vector<uint8_t> {
  using std::vector<uint8_t>::vector;
};

/// uint8[] that is large: its own bytes, or a view of others', which must outlive the message. A
/// view spares a copy: the encoder copies from where the picture or the points are.
class Bytes {
 public:
  Bytes() = default;
  Bytes(std::vector<uint8_t> own) : bytes_(std::move(own)) {}  // NOLINT: implicit on purpose
  static Bytes view(std::span<const uint8_t> others) {
    Bytes bytes;
    bytes.bytes_ = others;
    return bytes;
  }
  std::span<const uint8_t> span() const {
    if (const auto* own = std::get_if<0>(&bytes_)) return *own;
    return std::get<1>(bytes_);
  }
  size_t size() const { return span().size(); }
  friend bool operator==(const Bytes& a, const Bytes& b) {
    return std::ranges::equal(a.span(), b.span());
  }

 private:
  std::variant<std::vector<uint8_t>, std::span<const uint8_t>> bytes_;
};

/// Entry `index` of a list such as "stamp, frame_id".
constexpr std::string_view list_entry(std::string_view list, size_t index) {
  for (; index > 0; --index) list.remove_prefix(list.find(',') + 1);
  list = list.substr(0, list.find(','));
  list.remove_prefix(std::min(list.find_first_not_of(' '), list.size()));
  return list;
}

/// How a field's type is put together from an element type.
template <class T>
struct FieldTraits {
  using Element = T;
  static constexpr bool kIsArray = false, kIsSequence = false;
  static constexpr size_t kSize = 0;  ///< of an array, the most of a bounded sequence
};
template <class T, size_t N>
struct FieldTraits<std::array<T, N>> {
  using Element = T;
  static constexpr bool kIsArray = true, kIsSequence = false;
  static constexpr size_t kSize = N;
};
template <class T>
struct FieldTraits<std::vector<T>> {
  using Element = T;
  static constexpr bool kIsArray = false, kIsSequence = true;
  static constexpr size_t kSize = 0;
};
template <class T, size_t N>
struct FieldTraits<BoundedVector<T, N>> : FieldTraits<std::vector<T>> {
  static constexpr size_t kSize = N;
};
template <>
struct FieldTraits<Bytes> : FieldTraits<std::vector<uint8_t>> {};
template <>
struct FieldTraits<Bools> : FieldTraits<std::vector<uint8_t>> {
  using Element = bool;
};

/// Most characters of a string type; 0 = any number.
template <class T>
inline constexpr size_t kStringBound = 0;
template <size_t N>
inline constexpr size_t kStringBound<BoundedString<N>> = N;

/// Calls f(std::type_identity of the field's type, its name) for each field of a message's type.
template <Message T, class F>
constexpr void for_each_field_type(F&& f) {
  using Fields = decltype(std::declval<const T&>().members());
  [&]<size_t... I>(std::index_sequence<I...>) {
    (f(std::type_identity<std::remove_cvref_t<std::tuple_element_t<I, Fields>>>(),
       list_entry(T::kFieldNames, I)),
     ...);
  }(std::make_index_sequence<std::tuple_size_v<Fields>>());
}

/// A list of messages' types, such as AllMessages in ros/messages/all_messages.h.
template <Message... T>
struct MessageList {
  /// Calls f(std::type_identity<T>()) for each.
  template <class F>
  static void for_each(F&& f) {
    (f(std::type_identity<T>()), ...);
  }
};

}  // namespace gloam

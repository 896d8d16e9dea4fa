#pragma once
// Messages to CDR and back, derived from their lists of fields.
//
// Encoding into the same vector again allocates only when a message is larger than all before:
//   encode(message, &bytes);
//   Result<sensor_msgs::Imu> imu = decode<sensor_msgs::Imu>(bytes);

#include "base/check.h"
#include "ros/message.h"

namespace gloam {

/// Fewest bytes that a value of a field's type takes on the wire, padding left out.
template <class T>
constexpr size_t least_cdr_size() {
  using Traits = FieldTraits<T>;
  if constexpr (Message<T>) {
    size_t size = 0;
    for_each_field_type<T>(
        [&]<class F>(std::type_identity<F>, auto) { size += least_cdr_size<F>(); });
    return std::max<size_t>(size, 1);
  } else if constexpr (Traits::kIsArray) {
    return Traits::kSize * least_cdr_size<typename Traits::Element>();
  } else if constexpr (CdrPrimitive<T>) {
    return sizeof(T);
  } else {
    return sizeof(uint32_t);  // of strings and sequences the count
  }
}

template <class T>
void put_cdr(CdrWriter& writer, const T& value) {
  using Element = typename FieldTraits<T>::Element;
  if constexpr (Message<T>) {
    std::apply([&](const auto&... field) { (put_cdr(writer, field), ...); }, value.members());
    if (T::kFieldNames.empty()) writer.write(uint8_t{0});  // structure_needs_at_least_one_member
  } else if constexpr (CdrPrimitive<T>) {
    writer.write(value);
  } else if constexpr (std::derived_from<T, std::string>) {
    GLOAM_CHECK(kStringBound<T> == 0 || value.size() <= kStringBound<T>,
                "a string exceeds its bound");
    writer.write_string(value);
  } else if constexpr (std::same_as<T, Bytes>) {
    writer.write_sequence(value.span());
  } else if constexpr (std::same_as<T, Bools>) {
    writer.write_sequence(std::span<const uint8_t>(value));
  } else {
    constexpr size_t kMost = FieldTraits<T>::kSize;
    if constexpr (FieldTraits<T>::kIsSequence)
      GLOAM_CHECK(kMost == 0 || value.size() <= kMost, "a sequence exceeds its bound");
    if constexpr (FieldTraits<T>::kIsSequence) writer.write_count(value.size());
    if constexpr (CdrPrimitive<Element>) {
      writer.write_array(std::span<const Element>(value));
    } else {
      for (const Element& element : value) put_cdr(writer, element);
    }
  }
}

template <class T>
bool get_cdr(CdrReader& reader, T* value);

/// The fields of a message in turn; names the one that fails.
template <Message T>
bool get_cdr_fields(CdrReader& reader, T* value) {
  if constexpr (T::kFieldNames.empty()) {
    uint8_t unused = 0;
    return reader.read(&unused);
  } else {
    size_t index = 0;
    const auto get = [&](auto& field) {
      if (!get_cdr(reader, &field)) {
        reader.add_place(list_entry(T::kFieldNames, index));
        return false;
      }
      ++index;
      return true;
    };
    return std::apply([&](auto&... field) { return (get(field) && ...); }, value->members());
  }
}

template <class T>
bool get_cdr(CdrReader& reader, T* value) {
  using Element = typename FieldTraits<T>::Element;
  if constexpr (Message<T>) {
    return get_cdr_fields(reader, value);
  } else if constexpr (CdrPrimitive<T>) {
    return reader.read(value);
  } else if constexpr (std::derived_from<T, std::string>) {
    return reader.read_string(value, kStringBound<T>);
  } else if constexpr (std::same_as<T, Bytes>) {
    std::vector<uint8_t> own;
    const bool ok = reader.read_sequence(&own);
    *value = std::move(own);
    return ok;
  } else if constexpr (std::same_as<T, Bools>) {
    if (!reader.read_sequence(static_cast<std::vector<uint8_t>*>(value))) return false;
    const bool good = std::ranges::all_of(*value, [](uint8_t v) { return v <= 1; });
    return good || reader.fail("a bool is neither 0 nor 1");
  } else {
    if constexpr (FieldTraits<T>::kIsSequence) {
      size_t count = 0;
      if (!reader.read_count(&count, least_cdr_size<Element>())) return false;
      constexpr size_t kMost = FieldTraits<T>::kSize;
      if (kMost != 0 && count > kMost) return reader.fail("a sequence exceeds its bound");
      value->resize(count);
    }
    if constexpr (CdrPrimitive<Element>) {
      return reader.read_array(std::span<Element>(*value));
    } else {
      for (Element& element : *value) {
        if (!get_cdr(reader, &element)) return false;
      }
      return true;
    }
  }
}

/// Appends the message, head included, to what is in `bytes`.
template <Message T>
void append_encoded(const T& message, std::vector<uint8_t>* bytes) {
  CdrWriter writer(bytes);
  put_cdr(writer, message);
}

/// The message alone, head included; what was in `bytes` is replaced, its memory used again.
template <Message T>
void encode(const T& message, std::vector<uint8_t>* bytes) {
  bytes->clear();
  append_encoded(message, bytes);
}

/// Bytes that writers may add after the last field.
inline constexpr size_t kMostPadding = 3;

/// Errors: truncated, lengths that do not fit, bools that are none, strings without end or over
/// their bound, more than kMostPadding bytes left over, a head that is not plain CDR's.
template <Message T>
Result<T> decode(std::span<const uint8_t> bytes) {
  CdrReader reader(bytes);
  T message;
  if (get_cdr(reader, &message) && reader.left() > kMostPadding) {
    reader.fail("there are unread bytes after the end of the message");
  }
  if (!reader.ok()) {
    Error error = reader.error();
    error.message = std::string(T::kNamespace) + "/" + std::string(T::kName) + ": " + error.message;
    return error;
  }
  return message;
}

}  // namespace gloam

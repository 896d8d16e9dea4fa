#include "bridge/foxglove/json_message.h"

#include <cmath>
#include <limits>
#include <string>

#include "ros/cdr.h"
#include "ros/default_value.h"
#include "ros/message_walk.h"

namespace gloam::bridge::foxglove {
namespace {

using nlohmann::json;
using Field = MessageSchema::Field;

class JsonEncoder {
 public:
  JsonEncoder(const MessageSchema& schema, std::vector<uint8_t>* out)
      : schema_(schema), writer_(out) {}

  Status put_message(size_t part, const json& object) {
    if (!object.is_object()) return wrong("must be an object");
    const auto& fields = schema_.fields(part);
    if (fields.empty()) writer_.write(uint8_t{0});
    size_t known = 0;
    for (const Field& field : fields) {
      const auto value = object.find(field.name);
      if (value == object.end()) {
        write_default(schema_, field, &writer_);
        continue;
      }
      ++known;
      const size_t length = place_.size();
      place_ += "." + field.name;
      GLOAM_TRY_STATUS(put_field(field, *value));
      place_.resize(length);
    }
    if (known != object.size())
      for (const auto& [key, value] : object.items())
        if (std::ranges::none_of(fields, [&](const Field& f) { return f.name == key; }))
          return wrong("has no field '" + key + "'");
    return {};
  }

 private:
  Error wrong(const std::string& what) const {
    const std::string place = place_.empty() ? "the message" : "'" + place_.substr(1) + "'";
    return {ErrorKind::kInput, place + " " + what};
  }

  Status put_field(const Field& field, const json& value) {
    if (field.type.array == ArrayKind::kNone) return put_element(field, value);
    if (!value.is_array()) return wrong("must be an array");
    const size_t count = value.size(), size = field.type.array_size;
    if (field.type.array == ArrayKind::kFixed && count != size)
      return wrong("must have " + std::to_string(size) + " elements");
    if (field.type.array == ArrayKind::kBounded && count > size)
      return wrong("must have at most " + std::to_string(size) + " elements");
    if (field.type.array != ArrayKind::kFixed) writer_.write_count(count);
    for (const json& element : value) GLOAM_TRY_STATUS(put_element(field, element));
    return {};
  }

  Status put_element(const Field& field, const json& value) {
    if (field.type.kind == FieldKind::kMessage) return put_message(field.part, value);
    if (field.type.kind == FieldKind::kString) return put_string(field, value);
    Status status;
    with_primitive(field.type.kind, [&]<class T>(std::type_identity<T>) {
      status = put_number<T>(value);
      return true;
    });
    return status;
  }

  Status put_string(const Field& field, const json& value) {
    if (!value.is_string()) return wrong("must be a string");
    const auto& text = value.get_ref<const std::string&>();
    if (field.type.string_bound > 0 && text.size() > field.type.string_bound)
      return wrong("is too long");
    writer_.write_string(text);
    return {};
  }

  template <class T>
  Status put_number(const json& value) {
    if constexpr (std::same_as<T, bool>) {
      if (!value.is_boolean()) return wrong("must be true or false");
      writer_.write(value.get<bool>());
    } else if constexpr (std::floating_point<T>) {
      if (!value.is_number()) return wrong("must be a number");
      writer_.write(static_cast<T>(value.get<double>()));
    } else {
      // JavaScript's whole numbers are doubles; those of 64 bits come exactly as integers.
      if (value.is_number_unsigned() && std::in_range<T>(value.get<uint64_t>())) {
        writer_.write(static_cast<T>(value.get<uint64_t>()));
      } else if (value.is_number_integer() && !value.is_number_unsigned() &&
                 std::in_range<T>(value.get<int64_t>())) {
        writer_.write(static_cast<T>(value.get<int64_t>()));
      } else {
        return wrong("must be an integer within the range of its type");
      }
    }
    return {};
  }

  const MessageSchema& schema_;
  CdrWriter writer_;
  std::string place_;
};

class JsonDecoder {
 public:
  JsonDecoder(const MessageSchema& schema, std::span<const uint8_t> bytes)
      : schema_(schema), reader_(bytes) {}

  bool get_message(size_t part, json* object) {
    *object = json::object();
    if (schema_.fields(part).empty()) {
      uint8_t unused = 0;
      return reader_.read(&unused);
    }
    for (const Field& field : schema_.fields(part))
      if (!get_field(field, &(*object)[field.name])) return false;
    return true;
  }
  const CdrReader& reader() const { return reader_; }

 private:
  bool get_field(const Field& field, json* value) {
    if (field.type.array == ArrayKind::kNone) return get_element(field, value);
    size_t count = 0;
    if (!read_length(&reader_, field, &count)) return false;
    *value = json::array();
    for (size_t i = 0; i < count; ++i)
      if (!get_element(field, &value->emplace_back())) return false;
    return true;
  }

  bool get_element(const Field& field, json* value) {
    if (field.type.kind == FieldKind::kMessage) return get_message(field.part, value);
    if (field.type.kind == FieldKind::kString) {
      std::string text;
      if (!reader_.read_string(&text, field.type.string_bound)) return false;
      *value = std::move(text);
      return true;
    }
    return with_primitive(field.type.kind, [&]<class T>(std::type_identity<T>) {
      T number = {};
      if (!reader_.read(&number)) return false;
      *value = number;
      return true;
    });
  }

  const MessageSchema& schema_;
  CdrReader reader_;
};

}  // namespace

Result<std::vector<uint8_t>> cdr_from_json(const MessageSchema& schema, const json& object) {
  std::vector<uint8_t> bytes;
  JsonEncoder encoder(schema, &bytes);
  GLOAM_TRY_STATUS(encoder.put_message(0, object));
  return bytes;
}

Result<json> json_from_cdr(const MessageSchema& schema, std::span<const uint8_t> bytes) {
  JsonDecoder decoder(schema, bytes);
  json object;
  if (!decoder.get_message(0, &object)) return decoder.reader().error();
  return object;
}

}  // namespace gloam::bridge::foxglove

#include "messages.h"

#include <map>

#include "gloam/program.h"
#include "gloam/topics.h"
#include "ros/cdr.h"
#include "ros/default_value.h"
#include "ros/message_schema.h"
#include "ros/message_walk.h"

namespace gloam::python {
namespace {

using SchemaField = MessageSchema::Field;

bool is_text(const SchemaField& field) { return field.type.kind == FieldKind::kString; }

nb::object decode_message(const MessageSchema& schema, size_t part, CdrReader& reader);

nb::object decode_element(const MessageSchema& schema, const SchemaField& field,
                          CdrReader& reader) {
  if (is_text(field)) {
    std::string_view text;
    if (!reader.read_string(&text, field.type.string_bound)) return nb::none();
    return nb::steal(
        PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
  }
  if (field.type.kind == FieldKind::kMessage) return decode_message(schema, field.part, reader);
  nb::object value = nb::none();
  with_primitive(field.type.kind, [&]<class T>(std::type_identity<T>) {
    T number = {};
    if (!reader.read(&number)) return false;
    value = nb::cast(number);
    return true;
  });
  return value;
}

// Numbers as one array; bytes as well.
nb::object decode_numbers(const SchemaField& field, size_t count, CdrReader& reader) {
  nb::object array = nb::none();
  with_primitive(field.type.kind, [&]<class T>(std::type_identity<T>) {
    using Kept = std::conditional_t<std::is_same_v<T, bool>, uint8_t, T>;
    std::vector<Kept> values(count);
    if (!reader.read_array(std::span<Kept>(values))) return false;
    array = new_array<Kept>(std::move(values), {count});
    return true;
  });
  return array;
}

nb::object decode_field(const MessageSchema& schema, const SchemaField& field, CdrReader& reader) {
  if (field.type.array == ArrayKind::kNone) return decode_element(schema, field, reader);
  size_t count = 0;
  if (!read_length(&reader, field, &count)) return nb::none();
  if (primitive_size(field.type.kind) > 0) return decode_numbers(field, count, reader);
  nb::list list;
  for (size_t i = 0; i < count && reader.ok(); ++i)
    list.append(decode_element(schema, field, reader));
  return list;
}

nb::object decode_message(const MessageSchema& schema, size_t part, CdrReader& reader) {
  nb::dict made;
  const auto& fields = schema.fields(part);
  if (fields.empty()) reader.take(1, 1);
  for (const SchemaField& field : fields) {
    made[field.name.c_str()] = decode_field(schema, field, reader);
    if (!reader.ok()) break;
  }
  return made;
}

void encode_message(const MessageSchema& schema, size_t part, nb::handle from, CdrWriter& writer);

void encode_element(const MessageSchema& schema, const SchemaField& field, nb::handle from,
                    CdrWriter& writer) {
  if (is_text(field)) return writer.write_string(nb::cast<std::string>(from));
  if (field.type.kind == FieldKind::kMessage)
    return encode_message(schema, field.part, from, writer);
  with_primitive(field.type.kind, [&]<class T>(std::type_identity<T>) {
    writer.write(nb::cast<T>(from));
    return true;
  });
}

void encode_field(const MessageSchema& schema, const SchemaField& field, nb::handle from,
                  CdrWriter& writer) {
  if (!from.is_valid() || from.is_none()) return write_default(schema, field, &writer);
  if (field.type.array == ArrayKind::kNone) return encode_element(schema, field, from, writer);
  const size_t count = nb::len(from);
  const size_t bound = field.type.array_size;
  if (field.type.array == ArrayKind::kFixed) {
    if (count != bound) {
      const std::string text = field.name + ": expected " + std::to_string(bound) + " elements";
      throw nb::value_error(text.c_str());
    }
    for (size_t i = 0; i < bound; ++i) encode_element(schema, field, from[i], writer);
    return;
  }
  writer.write_count(count);
  for (size_t i = 0; i < count; ++i) encode_element(schema, field, from[i], writer);
}

void encode_message(const MessageSchema& schema, size_t part, nb::handle from, CdrWriter& writer) {
  const auto& fields = schema.fields(part);
  if (fields.empty()) writer.write(uint8_t{0});
  if (!nb::isinstance<nb::dict>(from))
    throw nb::type_error("a message must be a dict of its fields");
  const auto given = nb::borrow<nb::dict>(from);
  std::vector<std::string> names;
  for (const SchemaField& field : fields) names.push_back(field.name);
  for (const auto [key, value] : given) {
    const std::string name = nb::cast<std::string>(key);
    if (std::ranges::find(names, name) != names.end()) continue;
    raise("UsageError", "the message has no field '" + name + "'", suggest_name(name, names));
  }
  for (const SchemaField& field : fields) {
    const nb::str key(field.name.c_str());
    encode_field(schema, field, given.contains(key) ? nb::handle(given[key]) : nb::handle(),
                 writer);
  }
}

MessageSchema schema_of(const std::string& type) {
  const MessageInfo info = take(message_info(type));
  return take(MessageSchema::parse(info.definition, type));
}

nb::object decode(const std::string& type, const std::vector<uint8_t>& data) {
  const MessageSchema schema = schema_of(type);
  CdrReader reader(data);
  nb::object made = decode_message(schema, 0, reader);
  if (!reader.ok()) raise(reader.error());
  return made;
}

}  // namespace

void bind_messages(nb::module_& m) {
  nb::class_<Message>(m, "Message", "One message of a topic.")
      .def_ro("topic", &Message::topic)
      .def_ro("type", &Message::type)
      .def_ro("step", &Message::step)
      .def_ro("stamp", &Message::time)
      .def_ro("delivery", &Message::delivery)
      .def_prop_ro("data",
                   [](const Message& message) {
                     return nb::bytes(reinterpret_cast<const char*>(message.data.data()),
                                      message.data.size());
                   })
      .def("__repr__",
           [](const Message& message) {
             return "<gloam.Message of '" + message.topic + "', " + message.type + ", step " +
                    std::to_string(message.step) + ", " + std::to_string(message.data.size()) +
                    " bytes>";
           })
      .def("decode", [](const Message& message) { return decode(message.type, message.data); });
  m.def("decode_message", [](const std::string& type, nb::bytes data) {
    const auto* begin = reinterpret_cast<const uint8_t*>(data.c_str());
    return decode(type, {begin, begin + data.size()});
  });
  m.def("encode_message", [](const std::string& type, const nb::dict& fields) {
    const MessageSchema schema = schema_of(type);
    std::vector<uint8_t> bytes;
    CdrWriter writer(&bytes);
    encode_message(schema, 0, fields, writer);
    return nb::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  });
}

}  // namespace gloam::python

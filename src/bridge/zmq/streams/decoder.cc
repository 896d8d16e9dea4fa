#include "bridge/zmq/streams/decoder.h"

#include <type_traits>

#include "gloam/topics.h"
#include "ros/cdr.h"
#include "ros/message_walk.h"

namespace gloam::bridge::zeromq {
namespace {

using SchemaField = MessageSchema::Field;

bool pack_message(const MessageSchema& schema, size_t part, CdrReader& reader, Packer& packer);

bool pack_text(const SchemaField& field, CdrReader& reader, Packer& packer) {
  std::string_view text;
  if (!reader.read_string(&text, field.type.string_bound)) return false;
  packer.pack(text);
  return true;
}

bool pack_primitives(const SchemaField& field, size_t count, CdrReader& reader, Packer& packer) {
  return with_primitive(field.type.kind, [&]<class T>(std::type_identity<T>) {
    for (size_t i = 0; i < count; ++i) {
      T value = {};
      if (!reader.read(&value)) return false;
      packer.pack(value);
    }
    return true;
  });
}

bool is_bytes(const SchemaField& field) {
  const FieldKind kind = field.type.kind;
  return field.type.array != ArrayKind::kNone &&
         (kind == FieldKind::kUint8 || kind == FieldKind::kByte || kind == FieldKind::kChar);
}

bool pack_field(const MessageSchema& schema, const SchemaField& field, CdrReader& reader,
                Packer& packer) {
  size_t count = 0;
  if (!read_length(&reader, field, &count)) return false;
  if (is_bytes(field)) {
    const uint8_t* bytes = reader.take(1, count);
    if (bytes == nullptr && count > 0) return false;
    pack_bytes(packer, {bytes, count});
    return true;
  }
  if (field.type.array != ArrayKind::kNone) packer.pack_array(static_cast<uint32_t>(count));
  if (primitive_size(field.type.kind) > 0) return pack_primitives(field, count, reader, packer);
  for (size_t i = 0; i < count; ++i) {
    const bool is_packed = field.type.kind == FieldKind::kString
                               ? pack_text(field, reader, packer)
                               : pack_message(schema, field.part, reader, packer);
    if (!is_packed) return false;
  }
  return true;
}

bool pack_message(const MessageSchema& schema, size_t part, CdrReader& reader, Packer& packer) {
  const std::vector<SchemaField>& fields = schema.fields(part);
  packer.pack_map(static_cast<uint32_t>(fields.size()));
  if (fields.empty()) return reader.take(1, 1) != nullptr;
  for (const SchemaField& field : fields) {
    packer.pack(field.name);
    if (!pack_field(schema, field, reader, packer)) {
      reader.add_place(field.name);
      return false;
    }
  }
  return true;
}

}  // namespace

Result<Decoder> Decoder::create(std::string_view type) {
  GLOAM_TRY(const MessageInfo info, message_info(type));
  GLOAM_TRY(MessageSchema schema, MessageSchema::parse(info.definition, type));
  return Decoder(std::move(schema));
}

Status Decoder::pack(std::span<const uint8_t> cdr, Packer& packer) const {
  CdrReader reader(cdr);
  if (!pack_message(schema_, 0, reader, packer)) return reader.error();
  return {};
}

}  // namespace gloam::bridge::zeromq

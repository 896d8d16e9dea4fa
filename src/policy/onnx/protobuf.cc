#include "policy/onnx/protobuf.h"

namespace gloam {
namespace {

constexpr uint64_t kVarint = 0, kFixed64 = 1, kLength = 2, kFixed32 = 5;  // wire types

void add_varint(uint64_t value, std::string* out) {
  for (; value >= 0x80; value >>= 7) out->push_back(static_cast<char>(value | 0x80));
  out->push_back(static_cast<char>(value));
}

}  // namespace

bool take_varint(std::span<const uint8_t>* bytes, uint64_t* value) {
  *value = 0;
  for (unsigned i = 0; i < 10 && i < bytes->size(); ++i) {
    const uint8_t byte = (*bytes)[i];
    *value |= uint64_t{byte & 0x7Fu} << (7 * i);
    if (byte >= 0x80) continue;
    *bytes = bytes->subspan(i + 1);
    return true;
  }
  return false;
}

bool WireReader::fail() {
  damaged_ = true;
  bytes_ = field_ = {};
  return false;
}

bool WireReader::take_bytes(uint64_t size) {
  if (size > bytes_.size()) return fail();
  field_ = bytes_.first(size);
  bytes_ = bytes_.subspan(size);
  return true;
}

bool WireReader::next() {
  if (bytes_.empty()) return false;
  uint64_t key = 0;
  if (!take_varint(&bytes_, &key)) return fail();
  number_ = key >> 3;
  is_integer_ = (key & 7) == kVarint;
  field_ = {};
  value_ = 0;
  switch (key & 7) {
    case kVarint:
      return take_varint(&bytes_, &value_) || fail();
    case kLength: {
      uint64_t size = 0;
      return take_varint(&bytes_, &size) ? take_bytes(size) : fail();
    }
    case kFixed64:
      return take_bytes(8);
    case kFixed32:
      return take_bytes(4);
    default:
      return fail();  // groups, which ONNX does not use
  }
}

std::string wire_field(uint64_t number, std::string_view content) {
  std::string out;
  add_varint(number << 3 | kLength, &out);
  add_varint(content.size(), &out);
  return out.append(content);
}

}  // namespace gloam

#include "bridge/ros2/raw_type.h"

#include <cstring>

namespace gloam::bridge {
namespace {

constexpr uint32_t kUsualSize = 256;         // first payload of a history; it grows [bytes]
constexpr uint32_t kLargestInput = 1 << 24;  // beyond it a message is dropped [bytes]

}  // namespace

RawType::RawType(const std::string& name) {
  setName(name.c_str());
  m_typeSize = kUsualSize;
  m_isGetKeyDefined = false;
  // Type objects of ours would say "bytes" and match nobody.
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool RawType::serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) {
  const auto view = static_cast<RawMessage*>(data)->view;
  payload->reserve(static_cast<uint32_t>(view.size()));
  std::memcpy(payload->data, view.data(), view.size());
  payload->length = static_cast<uint32_t>(view.size());
  payload->encapsulation = CDR_LE;
  return true;
}

bool RawType::deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) {
  if (payload->length > kLargestInput) return false;
  static_cast<RawMessage*>(data)->own.assign(payload->data, payload->data + payload->length);
  return true;
}

std::function<uint32_t()> RawType::getSerializedSizeProvider(void* data) {
  const auto size = static_cast<uint32_t>(static_cast<RawMessage*>(data)->view.size());
  return [size] { return size; };
}

}  // namespace gloam::bridge

#include "bridge/ros2/raw_type.h"

#include <cstring>

namespace gloam::bridge {
namespace {

constexpr uint32_t kInitialPayloadSize = 256;  // first payload of a history; it grows [bytes]
constexpr uint32_t kLargestInput = 1 << 24;    // beyond it a message is dropped [bytes]

}  // namespace

RawType::RawType(const std::string& name) : DdsType(name, kInitialPayloadSize) {}

void RawType::write(const void* message, rtps::SerializedPayload_t* payload) const {
  const auto view = static_cast<const RawMessage*>(message)->view;
  payload->reserve(static_cast<uint32_t>(view.size()));
  std::memcpy(payload->data, view.data(), view.size());
  payload->length = static_cast<uint32_t>(view.size());
  payload->encapsulation = CDR_LE;
}

bool RawType::read(const rtps::SerializedPayload_t& payload, void* message) const {
  if (payload.length > kLargestInput) return false;
  static_cast<RawMessage*>(message)->own.assign(payload.data, payload.data + payload.length);
  return true;
}

uint32_t RawType::size_of(const void* message) const {
  return static_cast<uint32_t>(static_cast<const RawMessage*>(message)->view.size());
}

}  // namespace gloam::bridge

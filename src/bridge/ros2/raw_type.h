#pragma once
// RawType: the one DDS type of all messages. Its data are bytes that are encoded already, so that
// Fast DDS only copies them.

#include <fastdds/dds/topic/TopicDataType.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gloam::bridge {

/// CDR of a message, with its head of four bytes; written from a view, read into bytes of its own.
struct RawMessage {
  std::span<const uint8_t> view;
  std::vector<uint8_t> own;
};

class RawType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  /// `name`: that of DDS.
  explicit RawType(const std::string& name);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override { return new RawMessage; }
  void deleteData(void* data) override { delete static_cast<RawMessage*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

}  // namespace gloam::bridge

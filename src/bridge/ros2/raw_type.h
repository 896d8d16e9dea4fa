#pragma once
// RawType: the one DDS type of all messages. Its data are bytes that are encoded already, so that
// Fast DDS only copies them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bridge/ros2/dds_api.h"

namespace gloam::bridge {

/// CDR of a message, with its head of four bytes; written from a view, read into bytes of its own.
struct RawMessage {
  std::span<const uint8_t> view;
  std::vector<uint8_t> own;
};

class RawType final : public DdsType {
 public:
  /// `name`: the type's name in DDS.
  explicit RawType(const std::string& name);

 private:
  void write(const void* message, rtps::SerializedPayload_t* payload) const override;
  bool read(const rtps::SerializedPayload_t& payload, void* message) const override;
  uint32_t size_of(const void* message) const override;
  void* make_message() const override { return new RawMessage; }
  void delete_message(void* message) const override { delete static_cast<RawMessage*>(message); }
};

}  // namespace gloam::bridge

#pragma once
// Decoder: messages in CDR as msgpack maps by the names of their fields. uint8[] becomes bytes.

#include <cstdint>
#include <span>
#include <string_view>

#include "bridge/zmq/pack.h"
#include "gloam/result.h"
#include "ros/message_schema.h"

namespace gloam::bridge::zeromq {

class Decoder {
 public:
  /// Error: Gloam has no message of this type.
  static Result<Decoder> create(std::string_view type);
  /// Error: the message is damaged.
  Status pack(std::span<const uint8_t> cdr, Packer& packer) const;

 private:
  explicit Decoder(MessageSchema schema) : schema_(std::move(schema)) {}
  MessageSchema schema_;
};

}  // namespace gloam::bridge::zeromq

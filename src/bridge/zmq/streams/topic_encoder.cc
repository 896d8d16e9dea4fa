#include "bridge/zmq/streams/topic_encoder.h"

#include <chrono>
#include <utility>

namespace gloam::bridge::zeromq {
namespace {

zmq::message_t message_of(const PackBuffer& buffer) { return {buffer.data(), buffer.size()}; }

// CLOCK_MONOTONIC, which all processes of a machine share [ns].
int64_t monotonic_now() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void pack_head(Packer& packer, const TopicMessage& message, uint64_t sequence, StreamForm form) {
  packer.pack_map(form == StreamForm::kShared ? 9 : 8);
  pack_pair(packer, "type", message.topic.type);
  pack_pair(packer, "run", message.run);
  pack_pair(packer, "step", message.step);
  pack_pair(packer, "time", message.time);
  pack_pair(packer, "delivery", message.delivery);
  pack_pair(packer, "encoding", std::string_view(form == StreamForm::kDecoded ? "msgpack" : "cdr"));
  pack_pair(packer, "sequence", sequence);
  pack_pair(packer, "sent_ns", monotonic_now());
}

}  // namespace

std::string_view prefix_of(StreamForm form) {
  switch (form) {
    case StreamForm::kCdr:
      return "";
    case StreamForm::kDecoded:
      return "decoded";
    case StreamForm::kShared:
      return "shm";
  }
  return "";
}

Publication error_publication(const std::string& topic, const Error& error) {
  PackBuffer buffer;
  Packer packer(buffer);
  packer.pack_map(2);
  pack_pair(packer, "type", std::string_view("error"));
  packer.pack(std::string_view("error"));
  pack_error(packer, error);
  return {topic, message_of(buffer), {}};
}

void TopicEncoder::take(const TopicMessage& message) {
  const std::lock_guard lock(mutex_);
  for (const StreamForm form : kAllForms)
    if (wants(form)) send(message, form);
  ++sequence_;
}

void TopicEncoder::send(const TopicMessage& message, StreamForm form) {
  std::string topic = std::string(prefix_of(form)) + topic_;
  Result<Parts> parts = make(message, form);
  if (!parts.ok()) return outbox_.publish(error_publication(topic, parts.error()));
  outbox_.publish({std::move(topic), message_of(parts->header), std::move(parts->payload)});
}

Result<TopicEncoder::Parts> TopicEncoder::make(const TopicMessage& message, StreamForm form) {
  Parts parts;
  Packer packer(parts.header);
  pack_head(packer, message, sequence_, form);
  if (form == StreamForm::kCdr) {
    parts.payload = zmq::message_t(message.data.data(), message.data.size());
  } else if (form == StreamForm::kShared) {
    GLOAM_TRY_STATUS(share(message, packer));
  } else {
    if (!decoder_) {
      GLOAM_TRY(Decoder decoder, Decoder::create(message.topic.type));
      decoder_ = std::move(decoder);
    }
    PackBuffer decoded(message.data.size() + 64);
    Packer body(decoded);
    GLOAM_TRY_STATUS(decoder_->pack(message.data, body));
    parts.payload = message_of(decoded);
  }
  return parts;
}

// Readers that still look at an old ring keep its memory until they let go of it.
Status TopicEncoder::share(const TopicMessage& message, Packer& packer) {
  if (ring_ == nullptr || message.data.size() > ring_->slot_bytes()) {
    ring_.reset();
    GLOAM_TRY(ring_, SharedRing::create(message.data.size()));
  }
  const SharedRing::Slot slot = ring_->write(message.data);
  packer.pack(std::string_view("shm"));
  packer.pack_map(5);
  pack_pair(packer, "name", ring_->name());
  pack_pair(packer, "slot", slot.slot);
  pack_pair(packer, "sequence", slot.sequence);
  pack_pair(packer, "offset", slot.offset);
  pack_pair(packer, "bytes", static_cast<uint64_t>(message.data.size()));
  return {};
}

}  // namespace gloam::bridge::zeromq

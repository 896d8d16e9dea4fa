#pragma once
// TopicEncoder: publishes the messages of one topic in the forms that its subscribers asked for:
// CDR, decoded, or a place in shared memory.

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bridge/zmq/outbox.h"
#include "bridge/zmq/streams/decoder.h"
#include "bridge/zmq/streams/shared_ring.h"
#include "gloam/topics.h"

namespace gloam::bridge::zeromq {

/// Forms of a stream's messages; their first frames differ.
enum class StreamForm : uint8_t {
  kCdr,      ///< "/front/odom"
  kDecoded,  ///< "decoded/front/odom"
  kShared,   ///< "shm/front/image_raw"
};
inline constexpr int kStreamForms = 3;
inline constexpr StreamForm kAllForms[] = {StreamForm::kCdr, StreamForm::kDecoded,
                                           StreamForm::kShared};
std::string_view prefix_of(StreamForm form);  ///< "", "decoded", "shm"

/// A message without data that tells subscribers why none comes.
Publication error_publication(const std::string& topic, const Error& error);

/// Any thread.
class TopicEncoder {
 public:
  TopicEncoder(std::string topic, Outbox& outbox) : topic_(std::move(topic)), outbox_(outbox) {}

  void want(StreamForm form, bool is_wanted) { wanted_[static_cast<int>(form)] = is_wanted; }
  bool wants(StreamForm form) const { return wanted_[static_cast<int>(form)]; }
  bool is_wanted() const {
    return std::ranges::any_of(wanted_, [](const auto& wanted) { return wanted.load(); });
  }
  void take(const TopicMessage& message);

 private:
  /// Header and payload of a form.
  struct Parts {
    PackBuffer header;
    zmq::message_t payload;
  };
  void send(const TopicMessage& message, StreamForm form);
  Result<Parts> make(const TopicMessage& message, StreamForm form);
  Status share(const TopicMessage& message, Packer& packer);

  const std::string topic_;
  Outbox& outbox_;
  std::atomic<bool> wanted_[kStreamForms] = {};
  std::mutex mutex_;  // of all below
  uint64_t sequence_ = 0;
  std::optional<Decoder> decoder_;
  std::unique_ptr<SharedRing> ring_;
};

}  // namespace gloam::bridge::zeromq

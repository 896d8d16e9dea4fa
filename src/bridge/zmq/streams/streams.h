#pragma once
// Streams: the subscriptions of all ZeroMQ clients as one subscription to the topics, and streams
// of states.

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "bridge/zmq/outbox.h"
#include "bridge/zmq/streams/state_streams.h"
#include "bridge/zmq/streams/subscription.h"
#include "bridge/zmq/streams/topic_encoder.h"
#include "gloam/simulation.h"

namespace gloam::bridge::zeromq {

class Streams final : private TopicSink {
 public:
  Streams(Simulation& simulation, Outbox& outbox, StateLayouts& layouts, bool shared_memory)
      : outbox_(outbox),
        shared_memory_(shared_memory),
        states_(simulation, outbox, layouts),
        simulation_(simulation) {}

  /// Error: topics that cannot be listed.
  Status open();
  /// Any thread; never blocks. `subscription` is a topic in one of its forms, "state" or
  /// "state/RATE"; others get an error message.
  void set_wanted(const std::string& subscription, bool is_wanted);
  /// Messages that the simulation's streams lost.
  int64_t dropped() const { return topics_->dropped() + states_.dropped(); }

 private:
  void on_message(const TopicMessage& message) override;
  void on_topics(std::span<const TopicInfo>) override {}
  void on_error(const std::string& topic, const Error& why) override;

  void set_wanted(const TopicInForm& topic, bool is_wanted);
  std::shared_ptr<TopicEncoder> encoder_of(const std::string& topic);

  Outbox& outbox_;
  const bool shared_memory_;
  std::mutex mutex_;  // guards these
  std::set<std::string> wanted_;
  std::map<std::string, std::shared_ptr<TopicEncoder>> encoders_;  // by topic
  StateStreams states_;
  Simulation& simulation_;
  std::unique_ptr<TopicSubscription> topics_;  // last: its callbacks use the others
};

}  // namespace gloam::bridge::zeromq

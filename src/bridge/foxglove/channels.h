#pragma once
// Channels: the topics that clients can subscribe to, and who has subscribed to them. All clients
// share one subscription.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "bridge/foxglove/client_messages.h"
#include "bridge/foxglove/counters.h"
#include "gloam/simulation.h"

namespace gloam::bridge::foxglove {

/// Changes by a recompile.
struct ChannelChange {
  std::vector<ChannelInfo> added;
  std::vector<uint64_t> removed;
};

/// Any thread, after open().
class Channels final : private TopicSink {
 public:
  /// `offered`: names or patterns of topics; empty = all.
  Channels(Simulation& simulation, std::vector<std::string> offered, Counters& counters)
      : simulation_(simulation), offered_(std::move(offered)), counters_(counters) {}

  /// `on_change` is called after recompiles that change the channels; `announcing` is held from the
  /// change to its end. Error: topics that cannot be listed.
  Status open(std::mutex& announcing, std::function<void(const ChannelChange&)> on_change);
  /// Nothing is delivered after it.
  void close() { subscription_.reset(); }

  std::vector<ChannelInfo> list() const;
  /// Names of topics with the clients that subscribe to them.
  std::map<std::string, std::vector<int64_t>> subscribers() const;
  int64_t dropped() const { return subscription_ != nullptr ? subscription_->dropped() : 0; }

  void subscribe(const ClientPtr& client, const SubscribeMessage& message);
  void unsubscribe(const ClientPtr& client, const UnsubscribeMessage& message);
  void leave(const ClientPtr& client);

 private:
  struct Reader {
    ClientPtr client;
    uint32_t subscription = 0;
  };

  void on_message(const TopicMessage& message) override;
  void on_topics(std::span<const TopicInfo> topics) override;
  void on_error(const std::string& topic, const Error& why) override;

  Result<ChannelChange> change(std::span<const TopicInfo> topics);
  Status add_reader(const ClientPtr& client, const SubscribeMessage::Item& item);
  /// Returns the number of readers that fit and are removed.
  template <class Fits>
  size_t remove_readers(const Fits& fits);
  std::vector<Reader> readers_of(const std::string& topic) const;
  void send(const Reader& reader, const TopicMessage& message, const Payload& payload);
  void follow_readers();

  Simulation& simulation_;
  const std::vector<std::string> offered_;
  Counters& counters_;
  std::mutex* announcing_ = nullptr;
  std::function<void(const ChannelChange&)> on_change_;
  Status topics_status_;  // of the last on_topics()

  mutable std::mutex mutex_;  // guards these
  uint64_t last_id_ = 0;
  std::map<std::string, uint64_t> schema_ids_;
  std::map<uint64_t, ChannelInfo> channels_;            // by id
  std::map<std::string, std::vector<Reader>> readers_;  // by topic; no empty lists
  std::unique_ptr<TopicSubscription> subscription_;     // last: its callbacks use the others
};

}  // namespace gloam::bridge::foxglove

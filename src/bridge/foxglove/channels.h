#pragma once
// Channels: the topics that clients can subscribe to. A topic is opened for its first subscriber
// and closed after its last one. All topics of a camera are one stream, so that it is rendered
// once.

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
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

class Channels {
 public:
  /// `offered`: names or patterns of topics; empty = all.
  Channels(Simulation& simulation, std::vector<std::string> offered, Counters& counters)
      : simulation_(simulation), offered_(std::move(offered)), counters_(counters) {}
  ~Channels();

  // Any thread.
  std::vector<ChannelInfo> list() const;
  /// Names of topics with the clients that subscribe to them.
  std::map<std::string, std::vector<int64_t>> subscribers() const;
  int64_t dropped() const { return dropped_; }  ///< by the simulation's streams

  // One thread; settle() comes after the others.
  /// Takes the topics of the World that runs. Error: that World's topics cannot be listed.
  Result<ChannelChange> follow();
  void subscribe(const ClientPtr& client, const SubscribeMessage& message);
  void unsubscribe(const ClientPtr& client, const UnsubscribeMessage& message);
  void leave(const ClientPtr& client);
  /// Opens and closes the streams that the calls before ask for; may take seconds.
  void settle();

 private:
  struct Channel {
    ChannelInfo info;
    bool is_latched = false;
    std::string feed;  ///< key of the stream that serves it
  };
  struct Reader {
    ClientPtr client;
    uint32_t subscription = 0;
  };
  /// Readers of one topic.
  struct Outlet {
    bool is_latched = false;
    std::vector<Reader> readers;
    std::optional<std::pair<double, Payload>> latched;  ///< the last message and its time [s]
  };
  /// A stream and the topics that it serves.
  struct Feed {
    std::mutex mutex;  // guards the outlets
    std::map<std::string, Outlet> outlets;
    std::atomic<bool> has_ended{false};
    std::vector<std::string> open_topics;  // of the stream
    std::unique_ptr<TopicStream> stream;   // last: its callbacks use the others
  };

  std::optional<Channel> find(uint64_t id) const;
  ChannelInfo add_channel(const TopicInfo& topic, const MessageInfo& type);
  void remove_channel(uint64_t id);
  Status add_reader(const ClientPtr& client, const SubscribeMessage::Item& item);
  void remove_reader(uint64_t channel, const ClientPtr& client);
  void settle(Feed* feed);
  void close(Feed* feed);
  void deliver(Feed* feed, const TopicMessage& message);
  static void tell_readers(Feed* feed, const Error& why);
  void note_subscribers();

  Simulation& simulation_;
  const std::vector<std::string> offered_;
  Counters& counters_;
  std::atomic<int64_t> dropped_{0};

  mutable std::mutex mutex_;  // guards these two
  std::map<uint64_t, Channel> channels_;
  std::map<std::string, std::vector<int64_t>> subscribers_;

  // The one thread's.
  std::shared_ptr<const CompiledWorld> world_;
  uint64_t last_id_ = 0;
  std::map<std::string, uint64_t> schema_ids_;
  std::map<int64_t, std::map<uint32_t, uint64_t>> subscriptions_;  // channels by client and id
  std::map<std::string, std::unique_ptr<Feed>> feeds_;
};

}  // namespace gloam::bridge::foxglove

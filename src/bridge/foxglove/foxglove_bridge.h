#pragma once
// FoxgloveBridge: puts the parts together and knows who is connected.
//
//   streams -> Channels --------------------------------> clients' outboxes -> Server
//   clients -> Server -> here (who may) -> Publishing                      (network's thread)
//                                       -> Channels                        (worker of
//                                       subscriptions)
//                                       -> Services, Parameters, Playback  (worker of operations)

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "bridge/bridge_list.h"
#include "bridge/foxglove/assets.h"
#include "bridge/foxglove/channels.h"
#include "bridge/foxglove/graph.h"
#include "bridge/foxglove/parameters.h"
#include "bridge/foxglove/playback.h"
#include "bridge/foxglove/publishing.h"
#include "bridge/foxglove/server.h"
#include "bridge/foxglove/services.h"
#include "bridge/worker.h"

namespace gloam::bridge::foxglove {

class FoxgloveBridge final : public Bridge, private ServerEvents {
 public:
  FoxgloveBridge(const BridgeContext& context, const FoxgloveOptions& options);
  ~FoxgloveBridge() override;

  /// Errors: topics that cannot be listed, those of Server::listen.
  Status start();

  std::string name() const override { return "foxglove"; }
  std::string address() const override;
  BridgeStats stats() const override;
  Status status() const override { return {}; }

 private:
  enum Key : int64_t { kFollowKey = 1, kChangesKey, kPlaybackKey };

  // The network's thread.
  void on_open(const ClientPtr& client) override;
  void on_text(const ClientPtr& client, std::string_view text) override;
  void on_binary(const ClientPtr& client, std::span<const uint8_t> bytes) override;
  void on_close(const ClientPtr& client) override;
  void on_tick() override;

  // The same, a kind of request each: foxglove_requests.cc
  void take(const ClientPtr& client, const Result<ClientMessage>& message);
  void obey(const ClientPtr& client, const SubscribeMessage& message);
  void obey(const ClientPtr& client, const UnsubscribeMessage& message);
  void obey(const ClientPtr& client, const AdvertiseMessage& message);
  void obey(const ClientPtr& client, const UnadvertiseMessage& message);
  void obey(const ClientPtr& client, const PublishMessage& message);
  void obey(const ClientPtr& client, const GetParametersMessage& message);
  void obey(const ClientPtr& client, const SetParametersMessage& message);
  void obey(const ClientPtr& client, const WatchParametersMessage& message);
  void obey(const ClientPtr& client, const WatchGraphMessage& message);
  void obey(const ClientPtr& client, const FetchAssetMessage& message);
  void obey(const ClientPtr& client, const CallMessage& message);
  void obey(const ClientPtr& client, const PlaybackMessage& message);
  /// Gives a job to a worker, or tells the client that too many wait.
  void do_later(Worker& worker, const ClientPtr& client, Worker::Job job, int64_t key = 0);

  // The workers' threads.
  /// Streams are opened once for several changes that come in a row.
  void settle_subscriptions();
  void follow_world();
  void tell_changes();
  void play(const ClientPtr& client, const PlaybackMessage& message);
  /// Only the asker, who may be null, is told of his request.
  void tell_playback(PlaybackState state, const ClientPtr& asker);

  Simulation& simulation_;
  LogPlayer* const player_;
  const std::string host_, token_, session_;
  Counters counters_;
  mutable std::mutex clients_mutex_;
  std::map<int64_t, ClientPtr> clients_;

  // The network thread's alone.
  double told_time_ = 0;
  int ticks_ = 0;

  Channels channels_;
  Publishing publishing_;
  Services services_;
  Graph graph_;
  Parameters parameters_;
  Assets assets_;
  std::optional<Playback> playback_;
  static constexpr size_t kMostJobs = 1024;  // that wait
  Worker subscribing_{kMostJobs}, operating_{kMostJobs};
  Server server_;
};

}  // namespace gloam::bridge::foxglove

#pragma once
// FoxgloveBridge: puts the parts together and knows who is connected.
//
//   topics -> Channels -------------------------------> clients' outboxes -> Server
//   clients -> Server -> here (access)  -> Channels, Publishing             (network's thread)
//                                       -> Services, Parameters, Playback   (worker)

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "base/threads/worker.h"
#include "bridge/bridge_list.h"
#include "bridge/foxglove/assets.h"
#include "bridge/foxglove/channels.h"
#include "bridge/foxglove/graph.h"
#include "bridge/foxglove/parameters.h"
#include "bridge/foxglove/playback.h"
#include "bridge/foxglove/publishing.h"
#include "bridge/foxglove/services.h"
#include "web/websocket_server.h"

namespace gloam::bridge::foxglove {

class FoxgloveBridge final : public Bridge, private web::ServerEvents {
 public:
  FoxgloveBridge(const BridgeContext& context, const FoxgloveOptions& options);
  ~FoxgloveBridge() override;

  /// Errors: topics that cannot be listed, and the errors of WebSocketServer::listen.
  Status start();

  std::string name() const override { return "foxglove"; }
  std::string address() const override;
  BridgeStats stats() const override;
  Status status() const override { return {}; }

 private:
  enum Key : int64_t { kChangesKey = 1, kPlaybackKey };

  // The network's thread.
  web::Answer answer(const web::RequestFacts& request) override;
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
  /// Gives a job to the worker, or reports to the client that too many wait.
  void do_later(const ClientPtr& client, Worker::Job job, int64_t key = 0);

  // The thread of the topics.
  void advertise(const ChannelChange& change);

  // The worker's thread.
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
  Worker operating_{kMostJobs, Overflow::kReject};
  web::WebSocketServer server_;
};

}  // namespace gloam::bridge::foxglove

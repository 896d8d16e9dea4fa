// The bridge to Foxglove: puts the parts together and knows who is connected.
//
//   streams -> Channels --------------------------------> clients' outboxes -> Server
//   clients -> Server -> here (who may) -> Publishing                      (network's thread)
//                                       -> Channels                        (worker of
//                                       subscriptions)
//                                       -> Services, Parameters, Playback  (worker of operations)

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <utility>

#include "bridge/bridge_list.h"
#include "bridge/foxglove/assets.h"
#include "bridge/foxglove/channels.h"
#include "bridge/foxglove/parameters.h"
#include "bridge/foxglove/playback.h"
#include "bridge/foxglove/publishing.h"
#include "bridge/foxglove/server.h"
#include "bridge/foxglove/services.h"
#include "bridge/foxglove/worker.h"

namespace gloam::bridge::foxglove {
namespace {

using nlohmann::json;

constexpr int kTicksBetweenChecks = 4;  // ticks of the server, 50 ms each
constexpr const char* kNoControl =
    "you are watching: to change something, connect by the address with the token that Gloam "
    "printed";

/// Whether a message only asks to be told something.
bool only_watches(const ClientMessage& message) {
  return std::holds_alternative<SubscribeMessage>(message) ||
         std::holds_alternative<UnsubscribeMessage>(message) ||
         std::holds_alternative<GetParametersMessage>(message) ||
         std::holds_alternative<WatchParametersMessage>(message) ||
         std::holds_alternative<WatchGraphMessage>(message) ||
         std::holds_alternative<FetchAssetMessage>(message);
}

ServerOptions server_options(const FoxgloveOptions& options, const std::string& token) {
  ServerOptions server;
  server.host = options.host;
  server.port = options.port;
  server.max_clients = options.max_clients;
  server.token = token;
  return server;
}

std::string session_name() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

class FoxgloveBridge final : public Bridge, private ServerEvents {
 public:
  FoxgloveBridge(const BridgeContext& context, const FoxgloveOptions& options)
      : simulation_(context.simulation),
        player_(context.player),
        host_(options.host),
        token_(context.token),
        channels_(simulation_, options.topics, counters_),
        publishing_(simulation_, counters_),
        services_(context.operations, counters_),
        parameters_(context.operations, counters_),
        assets_(simulation_),
        server_(server_options(options, context.token), *this) {
    if (player_ != nullptr) playback_.emplace(*player_, context.operations);
  }
  /// From where the requests come to where they go, so that nobody calls one who is gone.
  ~FoxgloveBridge() override {
    server_.stop();
    subscribing_.stop();
    operating_.stop();
  }

  Status start() {
    GLOAM_TRY_STATUS(channels_.follow());
    told_time_ = simulation_.latest().time();
    return server_.listen();
  }

  std::string name() const override { return "foxglove"; }
  std::string address() const override {
    const std::string plain = "ws://" + host() + ":" + std::to_string(server_.port()) + "/";
    return plain + "?token=" + token_ + " (" + plain + " to watch)";
  }
  BridgeStats stats() const override {
    BridgeStats stats;
    stats.messages_out = counters_.out;
    stats.messages_in = counters_.in;
    stats.refused = counters_.refused;
    stats.dropped = server_.dropped() + channels_.dropped();
    const std::lock_guard lock(clients_mutex_);
    stats.clients = static_cast<int>(clients_.size());
    for (const auto& [id, client] : clients_) stats.dropped += client->outbox.dropped();
    return stats;
  }
  Status status() const override { return {}; }

 private:
  std::string host() const {
    const bool v6 = host_.find(':') != std::string::npos && host_.front() != '[';
    return v6 ? "[" + host_ + "]" : host_;
  }

  // The network's thread.

  void on_open(const ClientPtr& client) override {
    std::optional<PlaybackRange> range;
    if (player_ != nullptr) range = PlaybackRange{player_->end()};
    {
      // No change of the channels may come between the list and the client's entry.
      const std::lock_guard lock(clients_mutex_);
      client->outbox.send(server_info(session_, range));
      client->outbox.send(advertise(channels_.list(), client->protocol));
      clients_[client->id] = client;
    }
    client->outbox.send(advertise_services(services_.list()));
    client->outbox.send(time_message(simulation_.latest().time()));
    if (playback_)
      operate(client, [this, client] { client->outbox.send(playback_state(playback_->state())); });
    graph_changed_ = true;
  }

  void on_close(const ClientPtr& client) override {
    {
      const std::lock_guard lock(clients_mutex_);
      clients_.erase(client->id);
    }
    publishing_.leave(client);
    graph_watchers_.erase(client->id);
    subscribing_.post_always([this, client] {
      channels_.leave(client);
      settle_subscriptions();
    });
    operating_.post_always([this, client] { parameters_.leave(client); });
    graph_changed_ = true;
  }

  void on_text(const ClientPtr& client, std::string_view text) override {
    take(client, parse_text_message(text));
  }
  void on_binary(const ClientPtr& client, std::span<const uint8_t> bytes) override {
    take(client, parse_binary_message(bytes));
  }

  void take(const ClientPtr& client, const Result<ClientMessage>& message) {
    if (!message.ok()) return refuse_request(client, counters_, message.error().to_string());
    if (client->may_control || only_watches(*message))
      return std::visit([&](const auto& m) { obey(client, m); }, *message);
    if (const auto* call = std::get_if<CallMessage>(&*message)) {
      ++counters_.refused;
      return client->outbox.send(service_failure(call->service, call->call, kNoControl));
    }
    refuse_request(client, counters_, kNoControl);
  }

  void on_tick() override {
    const double time = simulation_.latest().time();
    if (time != told_time_) {
      told_time_ = time;
      const std::lock_guard lock(clients_mutex_);
      for (const auto& [id, client] : clients_) client->outbox.offer(time_message(time));
    }
    if (++ticks_ % kTicksBetweenChecks != 0) return;
    subscribing_.post([this] { follow_world(); }, kFollowKey);
    operating_.post([this] { tell_changes(); }, kChangesKey);
    if (!graph_watchers_.empty() && graph_changed_.exchange(false)) tell_graph();
  }

  void obey(const ClientPtr& client, const SubscribeMessage& message) {
    do_later(subscribing_, client, [this, client, message] {
      channels_.subscribe(client, message);
      settle_subscriptions();
    });
  }
  void obey(const ClientPtr& client, const UnsubscribeMessage& message) {
    do_later(subscribing_, client, [this, client, message] {
      channels_.unsubscribe(client, message);
      settle_subscriptions();
    });
  }
  void obey(const ClientPtr& client, const AdvertiseMessage& message) {
    publishing_.advertise(client, message);
    graph_changed_ = true;
  }
  void obey(const ClientPtr& client, const UnadvertiseMessage& message) {
    publishing_.unadvertise(client, message);
    graph_changed_ = true;
  }
  void obey(const ClientPtr& client, const PublishMessage& message) {
    publishing_.publish(client, message);
  }
  void obey(const ClientPtr& client, const GetParametersMessage& message) {
    operate(client, [this, client, message] { parameters_.get(client, message); });
  }
  void obey(const ClientPtr& client, const SetParametersMessage& message) {
    operate(client, [this, client, message] { parameters_.set(client, message); });
  }
  void obey(const ClientPtr& client, const WatchParametersMessage& message) {
    operate(client, [this, client, message] { parameters_.watch(client, message); });
  }
  void obey(const ClientPtr& client, const WatchGraphMessage& message) {
    if (!message.on) {
      graph_watchers_.erase(client->id);
      return;
    }
    graph_watchers_[client->id] = client;
    client->outbox.send(connection_graph(graph()));
  }
  void obey(const ClientPtr& client, const FetchAssetMessage& message) {
    operate(client, [this, client, message] {
      auto asset = assets_.fetch(message.uri);
      const bool ok = asset.ok();
      if (!ok) ++counters_.refused;
      client->outbox.send(asset_response(message.request, ok ? *asset : nullptr,
                                         ok ? "" : asset.error().to_string()));
    });
  }
  void obey(const ClientPtr& client, const CallMessage& message) {
    // The message's bytes are the network's.
    auto data = std::make_shared<std::vector<uint8_t>>(message.data.begin(), message.data.end());
    CallMessage call = message;
    call.data = *data;
    operate(client, [this, client, data, call] { services_.call(client, call); });
  }
  void obey(const ClientPtr& client, const PlaybackMessage& message) {
    if (!playback_) return refuse_request(client, counters_, "no log is played");
    // Of a slider that is dragged only the last place counts.
    if (!operating_.post([this, client, message] { play(client, message); }, kPlaybackKey))
      refuse_request(client, counters_, kBusy);
  }

  void do_later(Worker& worker, const ClientPtr& client, Worker::Job job) {
    if (!worker.post(std::move(job))) refuse_request(client, counters_, kBusy);
  }
  void operate(const ClientPtr& client, Worker::Job job) {
    do_later(operating_, client, std::move(job));
  }

  // The workers' threads.

  // Streams are opened once for several changes that come in a row.
  void settle_subscriptions() {
    if (subscribing_.is_idle()) channels_.settle();
    graph_changed_ = true;
  }

  void follow_world() {
    channels_.settle();
    auto change = channels_.follow();
    if (!change.ok() || (change->added.empty() && change->removed.empty())) return;
    const std::lock_guard lock(clients_mutex_);
    for (const auto& [id, client] : clients_) {
      if (!change->removed.empty()) client->outbox.send(unadvertise(change->removed));
      if (!change->added.empty()) client->outbox.send(advertise(change->added, client->protocol));
    }
    graph_changed_ = true;
  }

  void tell_changes() {
    parameters_.tell_changes();
    if (!playback_) return;
    if (const auto state = playback_->change()) tell_playback(*state, nullptr);
  }

  void play(const ClientPtr& client, const PlaybackMessage& message) {
    const auto state = playback_->control(message);
    if (!state.ok()) return refuse_request(client, counters_, state.error().to_string());
    ++counters_.in;
    tell_playback(*state, client);
  }

  // Only who asked is told of his request.
  void tell_playback(PlaybackState state, const ClientPtr& asker) {
    if (asker != nullptr) asker->outbox.send(playback_state(state));
    state.request.clear();
    const std::lock_guard lock(clients_mutex_);
    for (const auto& [id, client] : clients_)
      if (client != asker) client->outbox.send(playback_state(state));
  }

  // Topics and services with those who give and take them.
  json graph() const {
    const auto peers = [](const std::vector<int64_t>& clients) {
      json names = json::array();
      for (const int64_t client : clients) names.push_back("client " + std::to_string(client));
      return names;
    };
    json published = json::array(), subscribed = json::array(), services = json::array();
    for (const ChannelInfo& channel : channels_.list())
      published.push_back({{"name", channel.topic}, {"publisherIds", {"gloam"}}});
    for (const auto& [topic, clients] : publishing_.publishers()) {
      published.push_back({{"name", topic}, {"publisherIds", peers(clients)}});
    }
    for (const auto& [topic, clients] : channels_.subscribers())
      subscribed.push_back({{"name", topic}, {"subscriberIds", peers(clients)}});
    if (const auto topics = simulation_.topics(); topics.ok())
      for (const TopicInfo& topic : *topics)
        if (topic.is_input)
          subscribed.push_back({{"name", topic.name}, {"subscriberIds", {"gloam"}}});
    for (const ServiceInfo& service : services_.list())
      services.push_back({{"name", service.name}, {"providerIds", {"gloam"}}});
    return {{"publishedTopics", std::move(published)},
            {"subscribedTopics", std::move(subscribed)},
            {"advertisedServices", std::move(services)},
            {"removedTopics", json::array()},
            {"removedServices", json::array()}};
  }

  void tell_graph() {
    json now = graph();
    std::set<std::string> names;
    for (const char* list : {"publishedTopics", "subscribedTopics"})
      for (const json& topic : now[list]) names.insert(topic["name"]);
    for (const std::string& name : graph_names_)
      if (!names.contains(name)) now["removedTopics"].push_back(name);
    graph_names_ = std::move(names);
    for (const auto& [id, client] : graph_watchers_) client->outbox.send(connection_graph(now));
  }

  static constexpr const char* kBusy = "the simulation is busy; this was not carried out";
  enum Key : int64_t { kFollowKey = 1, kChangesKey, kPlaybackKey };

  Simulation& simulation_;
  LogPlayer* const player_;
  const std::string host_, token_, session_ = session_name();
  Counters counters_;
  mutable std::mutex clients_mutex_;
  std::map<int64_t, ClientPtr> clients_;
  std::atomic<bool> graph_changed_{false};

  // The network's thread alone.
  double told_time_ = 0;
  int ticks_ = 0;
  std::map<int64_t, ClientPtr> graph_watchers_;
  std::set<std::string> graph_names_;

  Channels channels_;
  Publishing publishing_;
  Services services_;
  Parameters parameters_;
  Assets assets_;
  std::optional<Playback> playback_;
  Worker subscribing_, operating_;
  Server server_;
};

}  // namespace
}  // namespace gloam::bridge::foxglove

namespace gloam::bridge {

Result<std::unique_ptr<Bridge>> start_foxglove(const BridgeContext& context,
                                               const FoxgloveOptions& options) {
  auto bridge = std::make_unique<foxglove::FoxgloveBridge>(context, options);
  if (Status started = bridge->start(); !started.ok()) {
    Error error = std::move(started).error();
    error.loc = options.loc;
    return error;
  }
  return std::unique_ptr<Bridge>(std::move(bridge));
}

}  // namespace gloam::bridge

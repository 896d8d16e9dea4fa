#include "bridge/foxglove/foxglove_bridge.h"

#include <chrono>
#include <utility>

#include "bridge/foxglove/handshake.h"

namespace gloam::bridge::foxglove {
namespace {

constexpr std::chrono::milliseconds kTick{50};
constexpr int kTicksBetweenChecks = 4;

web::ServerOptions server_options(const FoxgloveOptions& options) {
  return {.host = options.host,
          .port = options.port,
          .port_hint = "try --port 0, or set bridge.foxglove.port in the scene",
          .max_clients = options.max_clients,
          .tick = kTick};
}

Protocol protocol_of(const ClientPtr& client) {
  return choose_protocol(client->protocol).value_or(ProtocolChoice{}).protocol;
}

std::string session_name() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

}  // namespace

FoxgloveBridge::FoxgloveBridge(const BridgeContext& context, const FoxgloveOptions& options)
    : simulation_(context.simulation),
      player_(context.player),
      host_(options.host),
      token_(context.token),
      session_(session_name()),
      channels_(simulation_, options.topics, counters_),
      publishing_(simulation_, counters_),
      services_(context.operations, counters_),
      graph_(simulation_, channels_, publishing_, services_),
      parameters_(context.operations, counters_),
      assets_(simulation_),
      server_(server_options(options), *this) {
  if (player_ != nullptr) playback_.emplace(*player_, context.operations);
}

// From where the requests come to where they go, so that nobody calls one who is gone.
FoxgloveBridge::~FoxgloveBridge() {
  server_.stop();
  channels_.close();
  operating_.stop();
}

Status FoxgloveBridge::start() {
  GLOAM_TRY_STATUS(
      channels_.open(clients_mutex_, [this](const ChannelChange& change) { advertise(change); }));
  told_time_ = simulation_.latest().time();
  return server_.listen();
}

std::string FoxgloveBridge::address() const {
  const bool v6 = host_.find(':') != std::string::npos && host_.front() != '[';
  const std::string host = v6 ? "[" + host_ + "]" : host_;
  const std::string plain = "ws://" + host + ":" + std::to_string(server_.port()) + "/";
  return plain + "?token=" + token_ + " (" + plain + " to watch)";
}

BridgeStats FoxgloveBridge::stats() const {
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

web::Answer FoxgloveBridge::answer(const web::RequestFacts& request) {
  return admit(request, token_, web::is_loopback_name(host_));
}

void FoxgloveBridge::on_open(const ClientPtr& client) {
  std::optional<PlaybackRange> range;
  if (player_ != nullptr) range = PlaybackRange{player_->end()};
  {
    // No change of the channels may come between the list and the client's entry.
    const std::lock_guard lock(clients_mutex_);
    client->outbox.send(server_info(session_, range));
    client->outbox.send(foxglove::advertise(channels_.list(), protocol_of(client)));
    clients_[client->id] = client;
  }
  client->outbox.send(advertise_services(services_.list()));
  client->outbox.send(time_message(simulation_.latest().time()));
  if (playback_)
    do_later(client, [this, client] { client->outbox.send(playback_state(playback_->state())); });
  graph_.note_change();
}

void FoxgloveBridge::on_close(const ClientPtr& client) {
  {
    const std::lock_guard lock(clients_mutex_);
    clients_.erase(client->id);
  }
  publishing_.leave(client);
  graph_.leave(client);
  channels_.leave(client);
  operating_.post_always([this, client] { parameters_.leave(client); });
  graph_.note_change();
}

void FoxgloveBridge::on_text(const ClientPtr& client, std::string_view text) {
  take(client, parse_text_message(text));
}

void FoxgloveBridge::on_binary(const ClientPtr& client, std::span<const uint8_t> bytes) {
  take(client, parse_binary_message(bytes));
}

void FoxgloveBridge::on_tick() {
  const double time = simulation_.latest().time();
  if (time != told_time_) {
    told_time_ = time;
    const std::lock_guard lock(clients_mutex_);
    for (const auto& [id, client] : clients_) client->outbox.offer(time_message(time));
  }
  if (++ticks_ % kTicksBetweenChecks != 0) return;
  operating_.post([this] { tell_changes(); }, kChangesKey);
  graph_.tell_changes();
}

// With the mutex of the clients, so that none misses it.
void FoxgloveBridge::advertise(const ChannelChange& change) {
  for (const auto& [id, client] : clients_) {
    if (!change.removed.empty()) client->outbox.send(unadvertise(change.removed));
    if (!change.added.empty())
      client->outbox.send(foxglove::advertise(change.added, protocol_of(client)));
  }
  graph_.note_change();
}

void FoxgloveBridge::tell_changes() {
  parameters_.tell_changes();
  if (!playback_) return;
  if (const auto state = playback_->change()) tell_playback(*state, nullptr);
}

void FoxgloveBridge::play(const ClientPtr& client, const PlaybackMessage& message) {
  const auto state = playback_->control(message);
  if (!state.ok()) return refuse_request(client, counters_, state.error().to_string());
  ++counters_.in;
  tell_playback(*state, client);
}

void FoxgloveBridge::tell_playback(PlaybackState state, const ClientPtr& asker) {
  if (asker != nullptr) asker->outbox.send(playback_state(state));
  state.request.clear();
  const std::lock_guard lock(clients_mutex_);
  for (const auto& [id, client] : clients_)
    if (client != asker) client->outbox.send(playback_state(state));
}

}  // namespace gloam::bridge::foxglove

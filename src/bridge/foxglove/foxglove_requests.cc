// Requests of clients.

#include <utility>

#include "bridge/foxglove/foxglove_bridge.h"

namespace gloam::bridge::foxglove {
namespace {

constexpr const char* kNoControl =
    "this connection can only watch; to make changes, connect to the printed address that contains "
    "the token";
constexpr const char* kBusy = "the simulation is busy; the request was not executed";

/// Whether a message only requests information.
bool only_watches(const ClientMessage& message) {
  return std::holds_alternative<SubscribeMessage>(message) ||
         std::holds_alternative<UnsubscribeMessage>(message) ||
         std::holds_alternative<GetParametersMessage>(message) ||
         std::holds_alternative<WatchParametersMessage>(message) ||
         std::holds_alternative<WatchGraphMessage>(message) ||
         std::holds_alternative<FetchAssetMessage>(message);
}

}  // namespace

void FoxgloveBridge::take(const ClientPtr& client, const Result<ClientMessage>& message) {
  if (!message.ok()) return refuse_request(client, counters_, message.error().to_string());
  if (client->may_control || only_watches(*message))
    return std::visit([&](const auto& m) { obey(client, m); }, *message);
  if (const auto* call = std::get_if<CallMessage>(&*message)) {
    ++counters_.refused;
    return client->outbox.send(service_failure(call->service, call->call, kNoControl));
  }
  refuse_request(client, counters_, kNoControl);
}

void FoxgloveBridge::obey(const ClientPtr& client, const SubscribeMessage& message) {
  channels_.subscribe(client, message);
  graph_.note_change();
}

void FoxgloveBridge::obey(const ClientPtr& client, const UnsubscribeMessage& message) {
  channels_.unsubscribe(client, message);
  graph_.note_change();
}

void FoxgloveBridge::obey(const ClientPtr& client, const AdvertiseMessage& message) {
  publishing_.advertise(client, message);
  graph_.note_change();
}

void FoxgloveBridge::obey(const ClientPtr& client, const UnadvertiseMessage& message) {
  publishing_.unadvertise(client, message);
  graph_.note_change();
}

void FoxgloveBridge::obey(const ClientPtr& client, const PublishMessage& message) {
  publishing_.publish(client, message);
}

void FoxgloveBridge::obey(const ClientPtr& client, const GetParametersMessage& message) {
  do_later(client, [this, client, message] { parameters_.get(client, message); });
}

void FoxgloveBridge::obey(const ClientPtr& client, const SetParametersMessage& message) {
  do_later(client, [this, client, message] { parameters_.set(client, message); });
}

void FoxgloveBridge::obey(const ClientPtr& client, const WatchParametersMessage& message) {
  do_later(client, [this, client, message] { parameters_.watch(client, message); });
}

void FoxgloveBridge::obey(const ClientPtr& client, const WatchGraphMessage& message) {
  graph_.watch(client, message.on);
}

void FoxgloveBridge::obey(const ClientPtr& client, const FetchAssetMessage& message) {
  do_later(client, [this, client, message] {
    auto asset = assets_.fetch(message.uri);
    const bool ok = asset.ok();
    if (!ok) ++counters_.refused;
    client->outbox.send(asset_response(message.request, ok ? *asset : nullptr,
                                       ok ? "" : asset.error().to_string()));
  });
}

void FoxgloveBridge::obey(const ClientPtr& client, const CallMessage& message) {
  // The message's bytes are the network's.
  auto data = std::make_shared<std::vector<uint8_t>>(message.data.begin(), message.data.end());
  CallMessage call = message;
  call.data = *data;
  do_later(client, [this, client, data, call] { services_.call(client, call); });
}

void FoxgloveBridge::obey(const ClientPtr& client, const PlaybackMessage& message) {
  if (!playback_) return refuse_request(client, counters_, "no log is being replayed");
  // A slider that is dragged counts by its last place alone.
  do_later(client, [this, client, message] { play(client, message); }, kPlaybackKey);
}

void FoxgloveBridge::do_later(const ClientPtr& client, Worker::Job job, int64_t key) {
  if (!operating_.post(std::move(job), key)) refuse_request(client, counters_, kBusy);
}

}  // namespace gloam::bridge::foxglove

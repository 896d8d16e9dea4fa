#pragma once
// Counts that the parts of the bridge share, and how they speak to a client.

#include <atomic>
#include <cstdint>
#include <string>

#include "bridge/foxglove/server_messages.h"
#include "web/websocket_server.h"

namespace gloam::bridge::foxglove {

using web::ClientPtr;

struct Counters {
  std::atomic<int64_t> out{0}, in{0}, refused{0};  ///< as of BridgeStats
};

/// Tells a client that something it asked for was refused, and counts it.
inline void refuse_request(const ClientPtr& client, Counters& counters, const std::string& why) {
  ++counters.refused;
  client->outbox.send(status_message(StatusLevel::kError, why));
}

}  // namespace gloam::bridge::foxglove

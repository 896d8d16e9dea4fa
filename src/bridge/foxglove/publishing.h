#pragma once
// Publishing: channels that clients advertise, and the messages on them, which become Commands.

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "bridge/foxglove/client_messages.h"
#include "bridge/foxglove/counters.h"
#include "gloam/simulation.h"
#include "ros/message_schema.h"

namespace gloam::bridge::foxglove {

/// "geometry_msgs/msg/Twist" of "geometry_msgs/Twist" and of itself.
std::string full_type_name(const std::string& name);

/// The network thread's alone.
class Publishing {
 public:
  Publishing(Simulation& simulation, Counters& counters)
      : simulation_(simulation), counters_(counters) {}

  void advertise(const ClientPtr& client, const AdvertiseMessage& message);
  void unadvertise(const ClientPtr& client, const UnadvertiseMessage& message);
  void publish(const ClientPtr& client, const PublishMessage& message);
  void leave(const ClientPtr& client) { clients_.erase(client->id); }
  /// Topics that clients publish on, with those clients.
  std::map<std::string, std::vector<int64_t>> publishers() const;

 private:
  struct ClientChannel {
    std::string topic;
    std::shared_ptr<const MessageSchema> json;  ///< of what comes as JSON; null: CDR comes
  };
  Result<ClientChannel> check(const AdvertiseMessage::Channel& channel) const;

  Simulation& simulation_;
  Counters& counters_;
  std::map<int64_t, std::map<uint32_t, ClientChannel>> clients_;  // by client and channel
};

}  // namespace gloam::bridge::foxglove

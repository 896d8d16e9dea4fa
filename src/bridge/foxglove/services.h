#pragma once
// Services: what clients may call, as ROS 2 services with their requests in CDR or JSON.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bridge/foxglove/client_messages.h"
#include "bridge/foxglove/counters.h"
#include "bridge/operations/operator.h"
#include "ros/message_schema.h"

namespace gloam::bridge::foxglove {

class Services {
 public:
  Services(Operator& operations, Counters& counters);

  const std::vector<ServiceInfo>& list() const { return infos_; }
  /// Carries a call out and answers it; may take as long as the call says.
  void call(const ClientPtr& client, const CallMessage& message);

 private:
  using Bytes = std::vector<uint8_t>;
  using Answer = std::function<Result<Bytes>(std::span<const uint8_t> request)>;
  struct Service {
    Answer answer;
    MessageSchema request, response;
  };
  void add(const std::string& name, const std::string& type, Answer answer);
  /// A service without arguments.
  void add_trigger(const std::string& name, std::function<Status()> act);
  Result<Bytes> carry_out(const CallMessage& message) const;

  Counters& counters_;
  std::vector<ServiceInfo> infos_;  // ids are places in the list, from 1
  std::vector<Service> services_;
};

}  // namespace gloam::bridge::foxglove

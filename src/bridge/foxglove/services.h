#pragma once
// Services: what clients may call, as ROS 2 services with their requests in CDR or JSON: those of
// simulation_interfaces, and buttons without arguments.

#include <functional>
#include <memory>
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
  /// Carries a call out; the answer is sent when it is there.
  void call(const ClientPtr& client, const CallMessage& message);

 private:
  using Bytes = std::vector<uint8_t>;
  using Reply = std::function<void(Result<Bytes>)>;
  /// Calls the reply once, on any thread.
  using Answer = std::function<void(std::span<const uint8_t> request, const Reply& reply)>;
  struct Service {
    Answer answer;
    MessageSchema request;
    std::shared_ptr<const MessageSchema> response;  ///< shared with answers that come later
  };
  void add(const std::string& name, const std::string& type, Answer answer);
  /// A service without arguments.
  void add_trigger(const std::string& name, std::function<Status()> act);
  /// The request in CDR. Errors: no such service or encoding, a damaged request.
  Result<Bytes> request_of(const CallMessage& message) const;
  static Result<Bytes> encode_answer(const MessageSchema& type, const std::string& encoding,
                                     Bytes response);

  Counters& counters_;
  std::vector<ServiceInfo> infos_;  // ids are places in the list, from 1
  std::vector<Service> services_;
};

}  // namespace gloam::bridge::foxglove

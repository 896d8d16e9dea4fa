#include "bridge/foxglove/services.h"

#include <utility>

#include "bridge/foxglove/json_message.h"
#include "bridge/ros2/services/simulation_services.h"
#include "ros/codec.h"
#include "ros/message_types.h"
#include "ros/messages/std_srvs.h"
#include "web/client_json.h"

namespace gloam::bridge::foxglove {
namespace {

constexpr int kInterfaces = 2;  // shapes of simulation_interfaces 2.x

}  // namespace

Services::Services(Operator& operations, Counters& counters) : counters_(counters) {
  add_trigger("/pause", [&operations] { return operations.pause(); });
  add_trigger("/resume", [&operations] { return operations.play(); });
  add_trigger("/step", [&operations] { return operations.step(1); });
  add_trigger("/reset", [&operations] { return operations.reset(); });
  for (Ros2Service& service : simulation_services(operations, kInterfaces)) {
    if (service.answer_later) {
      add(service.name, service.type,
          [later = std::move(service.answer_later)](std::span<const uint8_t> request,
                                                    const Reply& reply) {
            later(request, [reply](Bytes response) { reply(std::move(response)); });
          });
    } else {
      add(service.name, service.type,
          [now = std::move(service.answer)](std::span<const uint8_t> request, const Reply& reply) {
            reply(now(request));
          });
    }
  }
}

// A service's type is its request's and response's; without both it is not offered.
void Services::add(const std::string& name, const std::string& type, Answer answer) {
  const MessageType* request = find_message_type(type + "_Request");
  const MessageType* response = find_message_type(type + "_Response");
  if (request == nullptr || response == nullptr) return;
  auto request_schema = MessageSchema::parse(request->text, request->name);
  auto response_schema = MessageSchema::parse(response->text, response->name);
  if (!request_schema.ok() || !response_schema.ok()) return;
  infos_.push_back({static_cast<uint32_t>(infos_.size() + 1),
                    name,
                    type,
                    {request->name, request->text},
                    {response->name, response->text}});
  services_.push_back({std::move(answer), *std::move(request_schema),
                       std::make_shared<const MessageSchema>(*std::move(response_schema))});
}

void Services::add_trigger(const std::string& name, std::function<Status()> act) {
  add(name, "std_srvs/srv/Trigger",
      [act = std::move(act)](std::span<const uint8_t>, const Reply& reply) {
        const Status status = act();
        std_srvs::srv::Trigger_Response response{status.ok(), ""};
        if (!status.ok()) response.message = status.error().to_string();
        Bytes bytes;
        encode(response, &bytes);
        reply(std::move(bytes));
      });
}

Result<Services::Bytes> Services::request_of(const CallMessage& message) const {
  if (message.service == 0 || message.service > services_.size())
    return Error{ErrorKind::kInput, "there is no service " + std::to_string(message.service)};
  const Service& service = services_[message.service - 1];
  if (message.encoding == "json") {
    const auto object = web::parse_client_json(
        {reinterpret_cast<const char*>(message.data.data()), message.data.size()});
    return cdr_from_json(service.request, object);
  }
  if (message.encoding != "cdr")
    return Error{ErrorKind::kInput,
                 "the encoding must be cdr or json, got '" + message.encoding + "'"};
  GLOAM_TRY_STATUS(json_from_cdr(service.request, message.data));  // damaged ones have no answer
  return Bytes(message.data.begin(), message.data.end());
}

Result<Services::Bytes> Services::encode_answer(const MessageSchema& type,
                                                const std::string& encoding, Bytes response) {
  if (encoding == "cdr") return response;
  GLOAM_TRY(const nlohmann::json answer, json_from_cdr(type, response));
  const std::string text = answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return Bytes(text.begin(), text.end());
}

void Services::call(const ClientPtr& client, const CallMessage& message) {
  const auto fail = [&counters = counters_, client, service = message.service,
                     call = message.call](const Error& error) {
    ++counters.refused;
    client->outbox.send(service_failure(service, call, error.to_string()));
  };
  const auto request = request_of(message);
  if (!request.ok()) return fail(request.error());
  const Service& service = services_[message.service - 1];
  // It does not hold the service, whose worker runs it: the worker must not end on its own thread.
  const Reply reply = [&counters = counters_, client, type = service.response, fail,
                       id = message.service, call = message.call,
                       encoding = message.encoding](Result<Bytes> response) {
    auto answer = response.ok() ? encode_answer(*type, encoding, *std::move(response))
                                : Result<Bytes>(response.error());
    if (!answer.ok()) return fail(answer.error());
    ++counters.in;
    client->outbox.send(
        service_response(id, call, encoding, std::make_shared<const Bytes>(*std::move(answer))));
  };
  service.answer(*request, reply);
}

}  // namespace gloam::bridge::foxglove

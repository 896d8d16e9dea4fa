#include "bridge/foxglove/services.h"

#include <utility>

#include "bridge/foxglove/json_message.h"
#include "ros/codec.h"
#include "ros/message_types.h"
#include "ros/messages/std_srvs.h"

namespace gloam::bridge::foxglove {
Services::Services(Operator& operations, Counters& counters) : counters_(counters) {
  Simulation& simulation = operations.simulation();
  add_trigger("/pause", [&simulation] {
    simulation.pause();
    return Status();
  });
  add_trigger("/resume", [&simulation] {
    simulation.resume();
    return Status();
  });
  add_trigger("/step", [&simulation] { return simulation.step(1); });
  add_trigger("/reset_simulation",
              [&simulation] { return simulation.post(Command{.what = ResetSim{}}); });
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
  services_.push_back({std::move(answer), *std::move(request_schema), *std::move(response_schema)});
}

void Services::add_trigger(const std::string& name, std::function<Status()> act) {
  add(name, "std_srvs/srv/Trigger",
      [act = std::move(act)](std::span<const uint8_t> request) -> Result<Bytes> {
        GLOAM_TRY_STATUS(decode<std_srvs::Trigger_Request>(request));
        const Status status = act();
        std_srvs::Trigger_Response response{status.ok(), ""};
        if (!status.ok()) response.message = status.error().to_string();
        Bytes bytes;
        encode(response, &bytes);
        return bytes;
      });
}

Result<Services::Bytes> Services::carry_out(const CallMessage& message) const {
  if (message.service == 0 || message.service > services_.size())
    return Error{ErrorKind::kInput, "there is no service " + std::to_string(message.service)};
  const Service& service = services_[message.service - 1];
  if (message.encoding == "cdr") return service.answer(message.data);
  if (message.encoding != "json")
    return Error{ErrorKind::kInput, "encodings are cdr and json, not '" + message.encoding + "'"};
  const auto object =
      nlohmann::json::parse(message.data.begin(), message.data.end(), nullptr, false);
  GLOAM_TRY(const Bytes request, cdr_from_json(service.request, object));
  GLOAM_TRY(const Bytes response, service.answer(request));
  GLOAM_TRY(const nlohmann::json answer, json_from_cdr(service.response, response));
  const std::string text = answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return Bytes(text.begin(), text.end());
}

void Services::call(const ClientPtr& client, const CallMessage& message) {
  auto answer = carry_out(message);
  if (answer.ok()) {
    ++counters_.in;
    client->outbox.send(service_response(message.service, message.call, message.encoding,
                                         std::make_shared<const Bytes>(*std::move(answer))));
  } else {
    ++counters_.refused;
    client->outbox.send(service_failure(message.service, message.call, answer.error().to_string()));
  }
}

}  // namespace gloam::bridge::foxglove

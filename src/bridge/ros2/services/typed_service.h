#pragma once
// Services out of functions from a request's struct to its response's.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "base/threads/worker.h"
#include "bridge/ros2/ros2_service.h"
#include "ros/codec.h"
#include "ros/message_types.h"

namespace gloam::bridge {

/// Requests of services that take long that may wait, for each thread of them.
inline constexpr size_t kMostSlowServices = 64;

/// "simulation_interfaces/srv/StepSimulation" of its request.
template <Message Request>
std::string service_type() {
  std::string name = ros_type_name<Request>();
  return name.substr(0, name.size() - std::string_view("_Request").size());
}

template <Message Request, Message Response>
std::string service_hash_of() {
  return service_hash(service_type<Request>(), describe<Request>(), describe<Response>());
}

/// Answered at once.
template <Message Request, Message Response>
Ros2Service make_service(std::string name, std::function<Response(const Request&)> answer) {
  return {.name = std::move(name),
          .type = service_type<Request>(),
          .answer = [answer = std::move(answer)](
                        std::span<const uint8_t> bytes) -> Result<std::vector<uint8_t>> {
            GLOAM_TRY(const Request request, decode<Request>(bytes));
            std::vector<uint8_t> response;
            encode(answer(request), &response);
            return response;
          },
          .hash = service_hash_of<Request, Response>()};
}

/// Answered by the worker; `busy` is the response when too many requests wait. A damaged request
/// has no answer.
template <Message Request, Message Response>
Ros2Service make_slow_service(std::string name, std::shared_ptr<Worker> worker, Response busy,
                              std::function<Response(const Request&)> answer) {
  using Reply = std::function<void(std::vector<uint8_t>)>;
  const auto send = [](const Response& response, const Reply& reply) {
    std::vector<uint8_t> bytes;
    encode(response, &bytes);
    reply(std::move(bytes));
  };
  return {.name = std::move(name),
          .type = service_type<Request>(),
          .answer_later =
              [worker = std::move(worker), busy = std::move(busy), answer = std::move(answer),
               send](std::span<const uint8_t> bytes, const Reply& reply) {
                Result<Request> request = decode<Request>(bytes);
                if (!request.ok()) return;
                const auto job = [answer, send, reply, request = std::move(*request)] {
                  send(answer(request), reply);
                };
                if (!worker->post(job)) send(busy, reply);
              },
          .hash = service_hash_of<Request, Response>()};
}

}  // namespace gloam::bridge

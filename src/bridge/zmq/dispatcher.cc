#include "bridge/zmq/dispatcher.h"

#include <fmt/format.h>

#include <utility>

#include "web/access.h"

namespace gloam::bridge::zeromq {
namespace {

constexpr std::string_view kPublic = "hello";         // needs no token
constexpr std::string_view kPublicFull = "describe";  // what it is with one

}  // namespace

void Dispatcher::dispatch(const Envelope& from, std::span<const uint8_t> bytes) {
  if (bytes.size() > kMaxUnauthenticatedBytes &&
      !web::equal_in_constant_time(peek_token(bytes), services_.context.token))
    return refuse(
        from, {},
        {ErrorKind::kUsage, fmt::format("a request of more than {} bytes requires the token",
                                        kMaxUnauthenticatedBytes)});
  const Result<Request> request = parse_request(bytes);
  if (!request.ok()) return refuse(from, {}, request.error());
  const Result<const Operation*> operation = admit(from, *request);
  if (!operation.ok()) return refuse(from, request->id, operation.error());
  if ((*operation)->speed == OperationSpeed::kAtOnce) return run(from, *request, **operation);
  const bool is_queued = worker_.post(
      [this, from, request = *request, row = *operation] { run(from, request, *row); });
  if (!is_queued)
    refuse(from, request->id,
           {ErrorKind::kUsage,
            "too many operations are already waiting",
            {},
            "wait for their replies"});
}

Result<const Operation*> Dispatcher::admit(const Envelope& from, const Request& request) {
  const bool has_token = web::equal_in_constant_time(request.token, services_.context.token);
  const bool is_public = request.operation == kPublic && request.token.empty();
  if (!has_token && !is_public)
    return Error{ErrorKind::kUsage,
                 request.token.empty() ? "the request has no token" : "the token is wrong",
                 {},
                 "the program prints the token when it starts; clients of the same user find it "
                 "in the server's address file"};
  if (!has_token) return find_operation(kPublic);
  services_.sessions.note(from);
  return find_operation(request.operation == kPublic ? kPublicFull : request.operation);
}

void Dispatcher::run(const Envelope& from, const Request& request, const Operation& operation) {
  const auto arguments = Arguments::check(request.arguments, operation.arguments);
  if (!arguments.ok()) return refuse(from, request.id, arguments.error());
  PackBuffer result;
  Packer packer(result);
  const Status status = operation.run({services_, from, *arguments}, packer);
  if (!status.ok()) return refuse(from, request.id, status.error());
  ++obeyed_;
  outbox_.reply({from, result_reply(request.id, result)});
}

void Dispatcher::refuse(const Envelope& from, const msgpack::object& id, const Error& error) {
  ++refused_;
  outbox_.reply({from, error_reply(id, error)});
}

}  // namespace gloam::bridge::zeromq

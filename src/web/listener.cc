#include "web/listener.h"

#include <chrono>
#include <utility>

namespace gloam::web {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

constexpr std::chrono::milliseconds kAcceptPause{100};

Error listen_error(const error_code& error, int port, const std::string& hint) {
  const std::string number = std::to_string(port);
  if (error == net::error::address_in_use)
    return {.kind = ErrorKind::kIo, .message = "port " + number + " is in use", .hint = hint};
  if (error == net::error::access_denied)
    return {.kind = ErrorKind::kIo,
            .message = "permission denied to listen on port " + number,
            .hint = "use a port of 1024 or above, for example 8080"};
  return {.kind = ErrorKind::kIo,
          .message = "cannot listen on port " + number + ": " + error.message()};
}

}  // namespace

Status Listener::listen(const std::string& host, int port, const std::string& hint) {
  error_code error;
  const bool v6 = host == "::1" || host == "[::1]";
  const auto address = v6 || host == "localhost"
                           ? net::ip::make_address(v6 ? "::1" : "127.0.0.1", error)
                           : net::ip::make_address(host, error);
  if (error)
    return Error{
        ErrorKind::kUsage, "'" + host + "' is not an IP address", {}, "use 127.0.0.1, for example"};
  const tcp::endpoint endpoint(address, static_cast<unsigned short>(port));
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(net::socket_base::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
  if (!error) port_ = acceptor_.local_endpoint(error).port();
  if (error) return listen_error(error, port, hint);
  return {};
}

void Listener::accept(OnSocket on_socket) {
  on_socket_ = std::move(on_socket);
  accept_next();
}

void Listener::accept_next() {
  acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (error) {
      // Out of file handles, most likely: they come back.
      timer_.expires_after(kAcceptPause);
      timer_.async_wait([this](const error_code& cancelled) {
        if (!cancelled) accept_next();
      });
      return;
    }
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    accept_next();
    on_socket_(std::move(socket));
  });
}

void Listener::close() {
  error_code ignored;
  acceptor_.close(ignored);
  timer_.cancel();
}

}  // namespace gloam::web

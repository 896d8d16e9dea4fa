#include "studio/web_server.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

#include "studio/web_connection.h"

namespace gloam::studio {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

constexpr std::chrono::milliseconds kAcceptPause{100}, kStopTime{700};

Error listen_error(const error_code& error, int port) {
  const std::string number = std::to_string(port);
  if (error == net::error::address_in_use)
    return {
        .kind = ErrorKind::kIo, .message = "port " + number + " is in use", .hint = "try --port 0"};
  if (error == net::error::access_denied)
    return {.kind = ErrorKind::kIo,
            .message = "this user may not listen on port " + number,
            .hint = "ports from 1024 are free to all: try --port 8080"};
  return {.kind = ErrorKind::kIo,
          .message = "cannot listen on port " + number + ": " + error.message()};
}

}  // namespace

class WebServer::Impl {
 public:
  Impl(const WebOptions& options, WebEvents& events) : acceptor_(context_), timer_(context_) {
    shared_.options = options;
    shared_.events = &events;
  }
  ~Impl() { stop(); }

  Status listen() {
    error_code error;
    const auto& name = shared_.options.host;
    // Names are not looked up: a resolver could answer with any address.
    const bool v6 = name == "::1" || name == "[::1]";
    const auto address = v6 || name == "localhost"
                             ? net::ip::make_address(v6 ? "::1" : "127.0.0.1", error)
                             : net::ip::make_address(name, error);
    const int port = shared_.options.port;
    const tcp::endpoint endpoint(address, static_cast<unsigned short>(port));
    if (!error) acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(net::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
    if (!error) port_ = acceptor_.local_endpoint(error).port();
    if (error) return listen_error(error, port);
    shared_.cookie_name = web::cookie_name(port_);
    accept();
    thread_ = std::thread([this] { run(); });
    return {};
  }

  int port() const { return port_; }

  template <class Function>
  void post(Function function) {
    net::post(context_, std::move(function));
  }
  template <class Function>
  void post_to(int64_t client, Function function) {
    post([this, client, function = std::move(function)]() mutable {
      const auto found = shared_.clients.find(client);
      if (found != shared_.clients.end()) function(*found->second);
    });
  }
  template <class Function>
  void post_to_all(Function function) {
    post([this, function = std::move(function)] {
      for (const auto& [client, connection] : shared_.clients) function(*connection);
    });
  }

  void show(std::shared_ptr<const std::string> packet) {
    post([this, packet = std::move(packet)] {
      shared_.picture = packet;
      for (const auto& [client, connection] : shared_.clients) connection->send_picture(packet);
    });
  }

  void stop() {
    if (!thread_.joinable()) return;
    post([this] { say_goodbye(); });
    thread_.join();
    shared_.on_empty = nullptr;
  }

 private:
  void run() {
    while (true) {
      try {
        context_.run();
        return;
      } catch (const std::exception&) {
        // One connection ran out of memory: its operation is gone, the others go on.
      }
    }
  }

  void accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      if (!acceptor_.is_open()) return;
      if (error) {
        // Out of file handles, most likely: they come back.
        timer_.expires_after(kAcceptPause);
        timer_.async_wait([this](const error_code& cancelled) {
          if (!cancelled) accept();
        });
        return;
      }
      if (shared_.connections.size() < static_cast<size_t>(shared_.options.max_connections)) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<WebConnection>(std::move(socket), shared_)->read_request();
      } else {
        turn_away(socket);
      }
      accept();
    });
  }

  static void turn_away(tcp::socket& socket) {
    error_code ignored;
    socket.non_blocking(true, ignored);
    constexpr std::string_view kBusy =
        "HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    socket.write_some(net::buffer(kBusy.data(), kBusy.size()), ignored);
    socket.shutdown(tcp::socket::shutdown_both, ignored);
  }

  void say_goodbye() {
    error_code ignored;
    acceptor_.close(ignored);
    if (shared_.connections.empty()) return context_.stop();
    shared_.on_empty = [this] { context_.stop(); };
    timer_.expires_after(kStopTime);
    timer_.async_wait([this](const error_code&) { context_.stop(); });
    const std::vector<WebConnection*> open(shared_.connections.begin(), shared_.connections.end());
    for (WebConnection* connection : open)
      connection->close(boost::beast::websocket::close_code::going_away,
                        "The simulation has ended.");
  }

  WebShared shared_;  // the connections die with the context: they must find it alive
  net::io_context context_{1};
  tcp::acceptor acceptor_;
  net::steady_timer timer_;
  int port_ = 0;
  std::thread thread_;
};

WebServer::WebServer(const WebOptions& options, WebEvents& events)
    : impl_(std::make_unique<Impl>(options, events)) {}
WebServer::~WebServer() = default;

Status WebServer::listen() { return impl_->listen(); }

int WebServer::port() const { return impl_->port(); }

void WebServer::send(int64_t client, std::string text) {
  impl_->post_to(client, [text = std::move(text)](WebConnection& connection) mutable {
    connection.send(std::move(text));
  });
}

void WebServer::send_state(std::string text) {
  auto shared = std::make_shared<const std::string>(std::move(text));
  impl_->post_to_all([shared](WebConnection& connection) { connection.send_state(shared); });
}

void WebServer::send_picture(std::shared_ptr<const std::string> packet) {
  impl_->show(std::move(packet));
}

void WebServer::picture_seen(int64_t client) {
  impl_->post_to(client, [](WebConnection& connection) { connection.picture_seen(); });
}

void WebServer::stop() { impl_->stop(); }

}  // namespace gloam::studio

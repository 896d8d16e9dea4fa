#include "web/websocket_server.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

#include "web/connection.h"
#include "web/listener.h"

namespace gloam::web {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

constexpr std::chrono::milliseconds kShutdownTimeout{700};

}  // namespace

class WebSocketServer::Impl {
 public:
  Impl(const ServerOptions& options, ServerEvents& events)
      : listener_(context_), timer_(context_), ticker_(context_) {
    state_.options = options;
    state_.events = &events;
  }
  ~Impl() { stop(); }

  Status listen() {
    const ServerOptions& options = state_.options;
    GLOAM_TRY_STATUS(listener_.listen(options.host, options.port, options.port_hint));
    state_.port = port();
    listener_.accept([this](tcp::socket socket) { take(std::move(socket)); });
    if (options.tick.count() > 0) tick();
    thread_ = std::thread([this] { run(); });
    return {};
  }
  int port() const { return listener_.port(); }
  int64_t dropped() const { return state_.dropped; }

  void stop() {
    if (!thread_.joinable()) return;
    net::post(context_, [this] { say_goodbye(); });
    thread_.join();
    state_.on_empty = nullptr;
    state_.events = nullptr;
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

  void take(tcp::socket socket) {
    std::make_shared<Connection>(std::move(socket), state_)->read_request();
  }

  void tick() {
    ticker_.expires_after(state_.options.tick);
    ticker_.async_wait([this](const error_code& cancelled) {
      if (cancelled) return;
      tick();
      if (state_.clients > 0) state_.events->on_tick();
    });
  }

  void say_goodbye() {
    listener_.close();
    ticker_.cancel();
    if (state_.connections.empty()) return context_.stop();
    state_.on_empty = [this] { context_.stop(); };
    timer_.expires_after(kShutdownTimeout);
    timer_.async_wait([this](const error_code&) { context_.stop(); });
    const std::vector<Connection*> open(state_.connections.begin(), state_.connections.end());
    for (Connection* connection : open)
      connection->close(boost::beast::websocket::close_code::going_away,
                        "The simulation has ended.");
  }

  ServerState state_;  // the connections die with the context: they must find it alive
  net::io_context context_{1};
  Listener listener_;
  net::steady_timer timer_, ticker_;
  std::thread thread_;
};

WebSocketServer::WebSocketServer(const ServerOptions& options, ServerEvents& events)
    : impl_(std::make_unique<Impl>(options, events)) {}
WebSocketServer::~WebSocketServer() = default;

Status WebSocketServer::listen() { return impl_->listen(); }
int WebSocketServer::port() const { return impl_->port(); }
int64_t WebSocketServer::dropped() const { return impl_->dropped(); }
void WebSocketServer::stop() { impl_->stop(); }

}  // namespace gloam::web

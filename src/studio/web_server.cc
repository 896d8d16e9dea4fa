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
#include "web/listener.h"

namespace gloam::studio {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

constexpr std::chrono::milliseconds kShutdownTimeout{700};

}  // namespace

class WebServer::Impl {
 public:
  Impl(const WebOptions& options, WebEvents& events) : listener_(context_), timer_(context_) {
    shared_.options = options;
    shared_.events = &events;
  }
  ~Impl() { stop(); }

  Status listen() {
    GLOAM_TRY_STATUS(listener_.listen(shared_.options.host, shared_.options.port, "try --port 0"));
    shared_.port = port();
    shared_.cookie_name = web::cookie_name(port());
    listener_.accept([this](tcp::socket socket) { take(std::move(socket)); });
    thread_ = std::thread([this] { run(); });
    return {};
  }

  int port() const { return listener_.port(); }

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

  void take(tcp::socket socket) {
    std::make_shared<WebConnection>(std::move(socket), shared_)->read_request();
  }

  void say_goodbye() {
    listener_.close();
    if (shared_.connections.empty()) return context_.stop();
    shared_.on_empty = [this] { context_.stop(); };
    timer_.expires_after(kShutdownTimeout);
    timer_.async_wait([this](const error_code&) { context_.stop(); });
    const std::vector<WebConnection*> open(shared_.connections.begin(), shared_.connections.end());
    for (WebConnection* connection : open)
      connection->close(boost::beast::websocket::close_code::going_away,
                        "The simulation has ended.");
  }

  WebShared shared_;  // the connections die with the context: they must find it alive
  net::io_context context_{1};
  web::Listener listener_;
  net::steady_timer timer_;
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

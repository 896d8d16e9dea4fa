#pragma once
// One connection: a request that becomes a WebSocket or is refused. Lives as long as an operation
// on it is pending. Network thread only.

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include "bridge/foxglove/handshake.h"
#include "bridge/foxglove/server.h"
#include "web/half_open.h"

namespace gloam::bridge::foxglove {

class Connection;

/// State that the connections of one server share.
struct ServerState {
  ServerOptions options;
  bool loopback_only = true;
  ServerEvents* events = nullptr;
  int port = 0;
  std::set<Connection*> connections;
  web::HalfOpen half_open;        ///< connections that are no WebSocket yet
  int clients = 0, watchers = 0;  ///< WebSockets, those without the token
  int64_t last_client = 0;
  std::atomic<int64_t> dropped{0};  ///< by clients that have gone
  std::function<void()> on_empty;   ///< the last connection is gone
};

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(boost::asio::ip::tcp::socket socket, ServerState& state);
  ~Connection();

  void read_request();
  /// Says goodbye with a reason and makes sure that the end comes.
  void close(boost::beast::websocket::close_code code, std::string_view reason);

 private:
  using Request = boost::beast::http::request_parser<boost::beast::http::empty_body>;

  void on_request(boost::beast::error_code error);
  void refuse(int status, std::string_view reason);
  void drain();
  void become_websocket(const Admission& admission);
  void open(const Admission& admission);
  void read_message();
  void on_message(boost::beast::error_code error);
  void pump();
  void end();
  void count(bool may_control, int change);

  ServerState& state_;
  int64_t half_open_ = 0;  ///< number among those; 0 = it was let in
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<Request> request_;
  std::optional<boost::beast::http::response<boost::beast::http::string_body>> response_;
  std::optional<boost::beast::websocket::stream<boost::beast::tcp_stream>> websocket_;
  boost::asio::steady_timer last_moment_;
  size_t drained_ = 0;
  ClientPtr client_;
  std::optional<Frame> writing_;
  bool closing_ = false;
};

}  // namespace gloam::bridge::foxglove

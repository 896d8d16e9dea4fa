#pragma once
// Connection: HTTP requests one after the other, until one of them becomes a WebSocket. Lives as
// long as an operation on it is pending. Network thread only.

#include <atomic>
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
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include "web/half_open.h"
#include "web/websocket_server.h"

namespace gloam::web {

class Connection;

/// State that the connections of one server share.
struct ServerState {
  ServerOptions options;
  ServerEvents* events = nullptr;  ///< null after the end of the server's thread
  int port = 0;
  std::set<Connection*> connections;
  HalfOpen half_open;              ///< connections without access
  std::map<Access, int> admitted;  ///< numbers of the others
  int clients = 0;                 ///< open WebSockets
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

  // HTTP
  void on_request(boost::beast::error_code error);
  bool admit(Access access);
  std::chrono::milliseconds patience() const;
  void refuse(int status, std::string_view reason);
  void respond(const Answer& answer, bool keep_alive);
  void drain();

  // WebSocket
  void become_websocket(const Answer& answer);
  void open(const Answer& answer);
  void read_message();
  void on_message(boost::beast::error_code error);
  void deliver();
  void pump();
  void end();
  void leave();

  ServerState& state_;
  int64_t half_open_ = 0;  ///< number in ServerState::half_open
  Access access_ = Access::kNone;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<Request> request_;
  std::optional<boost::beast::http::response<boost::beast::http::string_body>> response_;
  std::optional<boost::beast::websocket::stream<boost::beast::tcp_stream>> websocket_;
  boost::asio::steady_timer last_moment_;
  size_t drained_ = 0;
  ClientPtr client_;  ///< of the open WebSocket
  std::optional<Frame> writing_;
  bool closing_ = false;
};

}  // namespace gloam::web

#pragma once
// One connection: HTTP requests one after the other, until one of them becomes a WebSocket. Lives
// as long as an operation on it is pending. Network thread only.

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "studio/web_server.h"
#include "web/access.h"
#include "web/half_open.h"

namespace gloam::studio {

class WebConnection;

/// State that the connections of one server share.
struct WebShared {
  WebOptions options;
  std::string cookie_name;
  WebEvents* events = nullptr;
  int port = 0;
  std::set<WebConnection*> connections;
  web::HalfOpen half_open;                    ///< connections that have not shown the token yet
  int admitted = 0;                           ///< connections that have
  std::map<int64_t, WebConnection*> clients;  ///< those with a WebSocket
  int64_t last_client = 0;
  std::shared_ptr<const std::string> picture;  ///< the newest, for those who come later
  std::function<void()> on_empty;              ///< the last connection is gone
};

class WebConnection : public std::enable_shared_from_this<WebConnection> {
 public:
  WebConnection(boost::asio::ip::tcp::socket socket, WebShared& shared);
  ~WebConnection();

  void read_request();

  // Once it is a WebSocket.
  void send(std::string text);
  void send_state(std::shared_ptr<const std::string> text);
  void send_picture(std::shared_ptr<const std::string> packet);
  void picture_seen();

  /// Says goodbye with a reason and makes sure that the end comes.
  void close(boost::beast::websocket::close_code code, std::string_view reason);

 private:
  using Text = std::shared_ptr<const std::string>;
  using Request = boost::beast::http::request_parser<boost::beast::http::empty_body>;

  void on_request(boost::beast::error_code error);
  bool let_in();
  std::chrono::milliseconds patience() const;
  void answer(boost::beast::http::status status, std::string_view type, std::string_view body,
              bool keep_alive, bool set_cookie);
  void refuse(unsigned status, std::string_view reason);
  void drain();
  void become_websocket();
  void read_message();
  void on_message(boost::beast::error_code error);
  void pump();
  void write(Text bytes, bool is_text);
  void end();

  WebShared& shared_;
  int64_t half_open_ = 0;  ///< number among those; 0 = it was let in
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<Request> request_;
  std::optional<boost::beast::http::response<boost::beast::http::string_body>> response_;
  std::optional<boost::beast::websocket::stream<boost::beast::tcp_stream>> websocket_;
  boost::asio::steady_timer last_moment_;
  size_t drained_ = 0;

  int64_t client_ = 0;
  std::deque<Text> texts_;
  Text state_, picture_, writing_;
  int pictures_in_flight_ = 0;
  bool closing_ = false;
};

}  // namespace gloam::studio

#pragma once
// Listener: the port of a server, and its connections one after the other. Network thread only, but
// listen() and port().

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <string>

#include "gloam/result.h"

namespace gloam::web {

class Listener {
 public:
  using OnSocket = std::function<void(boost::asio::ip::tcp::socket)>;

  explicit Listener(boost::asio::io_context& context) : acceptor_(context), timer_(context) {}

  /// `host`: an address or localhost; names are not looked up, since a resolver could answer with
  /// any address. `hint` is what to do where the port is in use. Errors: it is, no permission.
  Status listen(const std::string& host, int port, const std::string& hint);
  int port() const { return port_; }

  /// Calls `on_socket` for every connection until close().
  void accept(OnSocket on_socket);
  void close();

 private:
  void accept_next();

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer timer_;
  OnSocket on_socket_;
  int port_ = 0;
};

}  // namespace gloam::web

// A client of the bridge to Foxglove: a WebSocket over loopback.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <nlohmann/json.hpp>

#include "bench/latency/latency.h"

namespace gloam::latency {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
using nlohmann::json;
using WebSocket = beast::websocket::stream<net::ip::tcp::socket>;

// Head of message data: opcode, subscription, time.
constexpr size_t kHead = 1 + 4 + 8;

void open(WebSocket& socket, const std::string& address) {
  // "ws://127.0.0.1:8765/?token=… (…)"
  const int port = std::atoi(address.c_str() + address.find(':', 5) + 1);
  socket.next_layer().connect(
      {net::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)});
  socket.next_layer().set_option(net::ip::tcp::no_delay(true));
  socket.set_option(
      beast::websocket::stream_base::decorator([](beast::websocket::request_type& request) {
        request.set(beast::http::field::sec_websocket_protocol, "foxglove.sdk.v1");
      }));
  socket.read_message_max(0);
  socket.handshake("127.0.0.1", "/");
}

void subscribe(WebSocket& socket, const json& message, const std::string& topic) {
  for (const json& channel : message.value("channels", json::array())) {
    if (channel["topic"] != topic) continue;
    const json subscriptions = json::array({{{"id", 1}, {"channelId", channel["id"]}}});
    const std::string text = json({{"op", "subscribe"}, {"subscriptions", subscriptions}}).dump();
    socket.write(net::buffer(text));
  }
}

}  // namespace

int run_foxglove_client(const std::string& address, const std::string& topic, int out) {
  try {
    net::io_context context;
    WebSocket socket(context);
    open(socket, address);
    beast::flat_buffer buffer;
    while (true) {
      socket.read(buffer);
      const auto* data = static_cast<const char*>(buffer.data().data());
      if (socket.got_text()) {
        subscribe(socket, json::parse(data, data + buffer.size()), topic);
      } else if (data[0] == 1 && buffer.size() > kHead) {
        Arrival arrival{0, now_ms(), buffer.size() - kHead};
        std::memcpy(&arrival.instant, data + 5, sizeof arrival.instant);
        if (!tell(out, arrival)) return 0;
      }
      buffer.clear();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "foxglove client: %s\n", error.what());
    return 1;
  }
}

}  // namespace gloam::latency

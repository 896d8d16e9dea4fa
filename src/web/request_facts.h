#pragma once
// The fields of a Beast request that decide on access.

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <string_view>

#include "web/access.h"

namespace gloam::web {

inline std::string_view view(boost::beast::string_view text) { return {text.data(), text.size()}; }
inline boost::beast::string_view beast_view(std::string_view text) {
  return {text.data(), text.size()};
}

/// Views into the request, which must outlive them. `port`: the server's.
inline RequestFacts facts_of(
    const boost::beast::http::request<boost::beast::http::empty_body>& request, int port) {
  namespace http = boost::beast::http;
  // Who reads the first of two fields and who reads the last would see two requests.
  std::string_view repeated;
  for (const std::string_view name :
       {"Host", "Origin", "Cookie", "Authorization", "Sec-Fetch-Site", "Upgrade",
        "Sec-WebSocket-Key", "Sec-WebSocket-Version", "Content-Length", "Transfer-Encoding"})
    if (request.count(beast_view(name)) > 1) repeated = name;
  const auto field = [&](auto name) { return view(request[name]); };
  return {.method = view(request.method_string()),
          .target = view(request.target()),
          .host = field(http::field::host),
          .origin = field(http::field::origin),
          .sec_fetch_site = field("Sec-Fetch-Site"),
          .cookie = field(http::field::cookie),
          .authorization = field(http::field::authorization),
          .websocket_key = field(http::field::sec_websocket_key),
          .websocket_version = field(http::field::sec_websocket_version),
          .websocket_protocols = field(http::field::sec_websocket_protocol),
          .repeated = repeated,
          .hosts = static_cast<int>(request.count(http::field::host)),
          .port = port,
          .websocket = boost::beast::websocket::is_upgrade(request)};
}

}  // namespace gloam::web

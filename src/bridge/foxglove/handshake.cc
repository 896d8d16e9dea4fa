#include "bridge/foxglove/handshake.h"

#include "bridge/foxglove/server_messages.h"

namespace gloam::bridge::foxglove {

web::Answer admit(const web::RequestFacts& request, std::string_view token, bool loopback_only) {
  if (const std::string_view why = web::why_malformed(request); !why.empty()) return {400, why};
  if (request.method != "GET") return {405, "This server supports only GET."};
  const bool has_token = web::carries_token(request, token);
  if (!has_token) {
    // A page whose name was rebound to this machine has its own name in Host.
    if (!web::is_loopback_name(web::host_name(request.host)))
      return {403, "Without the token this server accepts only loopback host names."};
    if (!web::has_own_port(request))
      return {403,
              "The port in Host is not the port of this server (a tunnel must keep the port)."};
    if (!request.origin.empty())
      return {403, "A web page must use the address that Gloam printed, including the token."};
    if (!loopback_only)
      return {401, "Connections from other machines must include the token that Gloam printed."};
  }
  if (!request.websocket)
    return {426, "This is a WebSocket for Foxglove. Open a connection to it in Foxglove."};
  const auto protocol = choose_protocol(request.websocket_protocols);
  if (!protocol)
    return {400,
            "This server supports foxglove.sdk.v1.1, foxglove.sdk.v1 and foxglove.websocket.v1."};
  return {.access = has_token ? web::Access::kControl : web::Access::kWatch,
          .protocol = protocol->name};
}

}  // namespace gloam::bridge::foxglove

#pragma once
// Who may connect, and for what. Pure functions of a request's fields.
//
//   with the token                     everything
//   without it, on this machine,       to watch
//     from a program that is no page
//   a page (with Origin) without it    refused, whatever its origin
//
// The token is an address's ?token=…, or "Authorization: token …".

#include <string_view>

#include "web/websocket_server.h"

namespace gloam::bridge::foxglove {

/// Status 101, or the refusal: 400, 401, 403, 405, 426. `loopback_only`: the server listens on a
/// loopback address.
web::Answer admit(const web::RequestFacts& request, std::string_view token, bool loopback_only);

}  // namespace gloam::bridge::foxglove

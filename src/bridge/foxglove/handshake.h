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

#include "bridge/foxglove/server_messages.h"
#include "web/access.h"

namespace gloam::bridge::foxglove {

struct Admission {
  int status = 101;         ///< or the refusal: 400, 401, 403, 405, 426
  std::string_view reason;  ///< of a refusal, for people
  ProtocolChoice protocol;
  bool may_control = false;  ///< else only watch
};

/// `protocols` is the request's list of sub-protocols; `loopback_only`: the server listens on a
/// loopback address.
Admission admit(const web::RequestFacts& request, std::string_view protocols,
                std::string_view token, bool loopback_only);

}  // namespace gloam::bridge::foxglove

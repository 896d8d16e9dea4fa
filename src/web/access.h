#pragma once
// Access to servers on this machine. Pure functions of a request's fields, so that the rules can be
// read and tested in one place. The rules follow Jupyter's: a random token, checks of Host and
// Origin against DNS rebinding and cross-site WebSocket hijacking, no CORS.

#include <string>
#include <string_view>

#include "gloam/result.h"

namespace gloam::web {

/// 48 lower-case hexadecimal digits (192 bits) from the operating system's random source.
Result<std::string> make_token();

/// Takes the same time wherever the texts differ. The length of `expected` is no secret.
bool equal_in_constant_time(std::string_view given, std::string_view expected);

/// 127.x.y.z, ::1, [::1] or localhost, without a port.
bool is_loopback_name(std::string_view name);

/// The headers of a request that decide. A field that is absent is empty.
struct RequestFacts {
  std::string_view method, target;
  std::string_view host, origin, sec_fetch_site, cookie, authorization;
  int hosts = 0;  ///< how many Host fields there are
  bool websocket = false;
};

/// Status 200 (go on), or the refusal: 400, 401, 403, 405.
struct Verdict {
  int status = 200;
  std::string_view reason;  ///< for people, one sentence
  bool set_cookie = false;  ///< the token came in the address: hand it back as a cookie
};
Verdict judge(const RequestFacts& request, std::string_view token, std::string_view cookie_name);

/// Whether a request carries the token in its address (?token=…) or as "Authorization: token …" or
/// "Authorization: bearer …".
bool carries_token(const RequestFacts& request, std::string_view token);

/// Name of a Host field without its port; empty when it is malformed.
std::string_view host_name(std::string_view host);

/// Cookies ignore ports: the name carries it, or two views on one machine would log each other out.
std::string cookie_name(int port);

/// Path of a request target without the query; empty when the target is not a path.
std::string_view target_path(std::string_view target);

}  // namespace gloam::web

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
  std::string_view websocket_key, websocket_version, websocket_protocols;
  std::string_view repeated;  ///< name of a field that decides and is there twice; "" = none
  int hosts = 0;              ///< how many Host fields there are
  int port = 0;               ///< the server's own
  bool websocket = false;
};

/// Reason to refuse a request with status 400 whoever sends it: a field that decides is missing or
/// there twice, or the key of its WebSocket is none. Empty: there is none.
std::string_view why_malformed(const RequestFacts& request);

/// Is the port in Host the server's own? A Host without a port tells nothing.
bool has_own_port(const RequestFacts& request);

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

/// 16 bytes in base64 (RFC 6455, 4.2.1).
bool is_websocket_key(std::string_view key);

/// Name of a Host field without its port; empty when it is malformed.
std::string_view host_name(std::string_view host);

/// Cookies ignore ports: the name carries it, or two views on one machine would log each other out.
std::string cookie_name(int port);

/// Path of a request target without the query; empty when the target is not a path.
std::string_view target_path(std::string_view target);

}  // namespace gloam::web

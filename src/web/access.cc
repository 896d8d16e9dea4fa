#include "web/access.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>

namespace gloam::web {
namespace {

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Calls visit(name, value) for each `name=value` of a list.
template <class Visit>
void for_each_pair(std::string_view list, char separator, Visit visit) {
  while (!list.empty()) {
    const auto end = list.find(separator);
    const std::string_view item = trim(list.substr(0, end));
    const auto equals = item.find('=');
    if (equals != std::string_view::npos) visit(item.substr(0, equals), item.substr(equals + 1));
    if (end == std::string_view::npos) break;
    list.remove_prefix(end + 1);
  }
}

bool is_dotted_loopback(std::string_view name) {
  for (int part = 0; part < 4; ++part) {
    unsigned value = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), value);
    const auto digits = static_cast<size_t>(end - name.data());
    if (error != std::errc() || digits > 3 || value > 255 || (part == 0 && value != 127))
      return false;
    name.remove_prefix(digits);
    if (part < 3) {
      if (name.empty() || name.front() != '.') return false;
      name.remove_prefix(1);
    }
  }
  return name.empty();
}

bool token_in_query(std::string_view target, std::string_view token) {
  const auto question = target.find('?');
  if (question == std::string_view::npos) return false;
  bool found = false;
  for_each_pair(target.substr(question + 1), '&', [&](std::string_view name, std::string_view v) {
    if (name == "token" && equal_in_constant_time(v, token)) found = true;
  });
  return found;
}

bool token_in_cookie(std::string_view cookie, std::string_view name, std::string_view token) {
  bool found = false;
  for_each_pair(cookie, ';', [&](std::string_view key, std::string_view value) {
    if (key == name && equal_in_constant_time(value, token)) found = true;
  });
  return found;
}

bool token_in_authorization(std::string_view authorization, std::string_view token) {
  for (const std::string_view scheme : {"token ", "bearer "}) {
    if (authorization.size() > scheme.size() &&
        equal_ignoring_case(authorization.substr(0, scheme.size()), scheme))
      return equal_in_constant_time(trim(authorization.substr(scheme.size())), token);
  }
  return false;
}

}  // namespace

Result<std::string> make_token() {
  std::array<uint8_t, 24> bytes;
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    return Error{
        .kind = ErrorKind::kIo,
        .message = "cannot get random bytes for the access token from the operating system"};
  }
  std::string token;
  for (const uint8_t byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

bool equal_in_constant_time(std::string_view given, std::string_view expected) {
  if (expected.empty()) return false;
  unsigned difference = given.size() == expected.size() ? 0 : 1;
  for (size_t i = 0; i < given.size(); ++i) {
    difference |= static_cast<unsigned char>(given[i]) ^
                  static_cast<unsigned char>(expected[i % expected.size()]);
  }
  return difference == 0;
}

bool is_loopback_name(std::string_view name) {
  return equal_ignoring_case(name, "localhost") || name == "::1" || name == "[::1]" ||
         is_dotted_loopback(name);
}

std::string_view host_name(std::string_view host) {
  size_t end = host.find(':');
  if (!host.empty() && host.front() == '[') {
    end = host.find(']');
    if (end == std::string_view::npos) return {};
    ++end;
  }
  if (end == std::string_view::npos || end == host.size()) return host;
  const std::string_view port = host.substr(end + 1);
  const bool digits = std::all_of(port.begin(), port.end(), [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
  });
  if (host[end] != ':' || port.empty() || port.size() > 5 || !digits) return {};
  return host.substr(0, end);
}

bool carries_token(const RequestFacts& request, std::string_view token) {
  return token_in_query(request.target, token) ||
         token_in_authorization(request.authorization, token);
}

bool is_websocket_key(std::string_view key) {
  if (key.size() != 24 || !key.ends_with("==")) return false;
  const bool is_base64 = std::all_of(key.begin(), key.end() - 2, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '/';
  });
  return is_base64 && std::string_view("AQgw").find(key[21]) != std::string_view::npos;
}

std::string_view why_malformed(const RequestFacts& request) {
  if (request.hosts != 1) return "The request must have exactly one Host field.";
  if (!request.repeated.empty())
    return "Host, Origin, Cookie, Authorization and the WebSocket headers may each appear only "
           "once.";
  if (!request.websocket) return {};
  if (request.websocket_version != "13")
    return "This server supports version 13 of the WebSocket protocol.";
  if (!is_websocket_key(request.websocket_key))
    return "Sec-WebSocket-Key must be 16 bytes in base64.";
  return {};
}

bool has_own_port(const RequestFacts& request) {
  const std::string_view host = request.host, name = host_name(host);
  if (name.empty() || name.size() == host.size()) return !name.empty();
  const std::string_view digits = host.substr(name.size() + 1);
  int port = -1;
  std::from_chars(digits.data(), digits.data() + digits.size(), port);
  return port == request.port;
}

Verdict judge(const RequestFacts& request, std::string_view token, std::string_view cookie_name) {
  if (const std::string_view why = why_malformed(request); !why.empty()) return {400, why};
  if (!is_loopback_name(host_name(request.host)))
    return {403, "This server accepts only loopback host names, such as 127.0.0.1 or localhost."};
  if (!has_own_port(request))
    return {403, "The port in Host is not the port of this server (a tunnel must keep the port)."};
  if (!request.origin.empty()) {
    constexpr std::string_view kScheme = "http://";
    if (request.origin.substr(0, kScheme.size()) != kScheme ||
        !equal_ignoring_case(request.origin.substr(kScheme.size()), request.host))
      return {403, "Pages of other sites may not use this server."};
  }
  if (request.method != "GET" && request.method != "HEAD")
    return {405, "This server supports only GET and HEAD."};

  const bool page = target_path(request.target) == "/" && !request.websocket;
  if (page && token_in_query(request.target, token)) return {.set_cookie = true};
  // A link on another site may open the page's address, but nothing else crosses sites.
  if (!request.sec_fetch_site.empty() && request.sec_fetch_site != "same-origin" &&
      request.sec_fetch_site != "none")
    return {403, "Pages of other sites may not use this server."};
  if (token_in_cookie(request.cookie, cookie_name, token) ||
      token_in_authorization(request.authorization, token))
    return {};
  return {401,
          "Open the address that Gloam printed in the terminal: it contains the access token."};
}

std::string cookie_name(int port) { return "gloam_view_" + std::to_string(port); }

std::string_view target_path(std::string_view target) {
  if (target.empty() || target.front() != '/') return {};
  return target.substr(0, target.find('?'));
}

}  // namespace gloam::web

#include "bridge/zmq/endpoint.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <string_view>
#include <utility>

#include "bridge/zmq/request.h"
#include "web/access.h"

namespace gloam::bridge::zeromq {
namespace {

constexpr size_t kZ85Key = 40;
constexpr int kMaxKeyFile = 1 << 16;
constexpr int kMaxSubscription = 1 << 12;  // bytes of a subscription
constexpr int kMaxQueuedReplies = 64;      // that wait for one client
// Requests of one client that are read before the server takes them: each may be of
// kMaxRequestBytes, whether or not the client has the token.
constexpr int kRequests = 8;
// Messages that wait for one subscriber. A stuck one holds as many pictures, which all stuck ones
// share.
constexpr int kStreamMessages = 64;
constexpr int kHandshakeTimeout = 5000;  // [ms]
// A peer that has vanished from the network is noticed by TCP itself: the kernel probes a silent
// connection after kKeepaliveIdle seconds, kKeepaliveProbes times, and gives up unacknowledged data
// after kUserTimeout.
constexpr int kKeepaliveIdle = 5, kKeepaliveInterval = 1, kKeepaliveProbes = 5;  // [s], [s], number
constexpr int kUserTimeout = 10000;                                              // [ms]

Error key_error(const std::string& file, const SourceLoc& loc, std::string_view why) {
  return {ErrorKind::kUsage, fmt::format("CURVE key '{}' {}", file, why), loc,
          "create one with curve_keygen and keep its secret key in a file of mode 600"};
}

Result<std::string> read_private_file(const std::string& file, const SourceLoc& loc) {
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return key_error(file, loc, "cannot be read");
  struct stat about = {};
  std::string text;
  const bool is_file = fstat(fd, &about) == 0 && S_ISREG(about.st_mode);
  if (is_file) {
    text.resize(kMaxKeyFile);
    const ssize_t bytes = read(fd, text.data(), text.size());
    text.resize(bytes > 0 ? static_cast<size_t>(bytes) : 0);
  }
  close(fd);
  if (!is_file) return key_error(file, loc, "is not a file");
  if ((about.st_mode & 077) != 0) return key_error(file, loc, "is readable by others");
  return text;
}

std::string_view trimmed(std::string_view line) {
  const size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

// The text between quotes of `secret-key = "..."`, ZPL.
std::string_view zpl_value(std::string_view line) {
  const size_t open_quote = line.find('"');
  const size_t close_quote = line.rfind('"');
  if (open_quote == std::string_view::npos || close_quote <= open_quote) return {};
  return line.substr(open_quote + 1, close_quote - open_quote - 1);
}

// The key: a ZPL line, else the line of 40 characters after "SECRET KEY", else the only such line.
std::string find_secret(std::string_view text) {
  bool is_after_title = false;
  std::string bare;
  while (!text.empty()) {
    const size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.starts_with("secret-key")) return std::string(zpl_value(line));
    if (line.find("SECRET KEY") != std::string_view::npos) is_after_title = true;
    if (line.size() != kZ85Key) continue;
    if (is_after_title) return std::string(line);
    if (bare.empty()) bare = line;
  }
  return bare;
}

std::string bindable_host(const std::string& host) {
  if (host == "localhost") return "127.0.0.1";
  if (host.find(':') != std::string::npos && !host.starts_with('[')) return "[" + host + "]";
  return host;
}

Status bind_socket(zmq::socket_t& socket, const ZmqOptions& options, int port,
                   std::string* address) {
  const std::string wanted = fmt::format("tcp://{}:{}", bindable_host(options.host),
                                         port == 0 ? "*" : std::to_string(port));
  try {
    socket.bind(wanted);
    *address = socket.get(zmq::sockopt::last_endpoint);
  } catch (const zmq::error_t& error) {
    if (error.num() == EADDRINUSE)
      return Error{
          ErrorKind::kIo, fmt::format("port {} is in use: {}", port, wanted), options.loc,
          "stop the other program, or set [bridge.zmq] port = 0 to use any two free ports"};
    return Error{ErrorKind::kUsage, fmt::format("cannot listen on {}: {}", wanted, error.what()),
                 options.loc, "set [bridge.zmq] host to an address of this machine"};
  }
  return {};
}

void set_common(zmq::socket_t& socket, const std::string& host, const CurveKey& key) {
  socket.set(zmq::sockopt::linger, 0);
  socket.set(zmq::sockopt::ipv6, host.find(':') != std::string::npos);
  socket.set(zmq::sockopt::backlog, 256);
  socket.set(zmq::sockopt::handshake_ivl, kHandshakeTimeout);
  // No ZMTP heartbeats (ZMQ_HEARTBEAT_IVL): in libzmq up to 4.3.5 their timer asserts, which ends
  // the process, when it fires on a connection that was reset while its input was stopped by a full
  // pipe (libzmq issues 4364 and 3937). Any client could bring that about without a token.
  socket.set(zmq::sockopt::tcp_keepalive, 1);
  socket.set(zmq::sockopt::tcp_keepalive_idle, kKeepaliveIdle);
  socket.set(zmq::sockopt::tcp_keepalive_intvl, kKeepaliveInterval);
  socket.set(zmq::sockopt::tcp_keepalive_cnt, kKeepaliveProbes);
  socket.set(zmq::sockopt::tcp_maxrt, kUserTimeout);
  if (key.secret.empty()) return;
  socket.set(zmq::sockopt::curve_server, true);
  socket.set(zmq::sockopt::curve_secretkey, key.secret);
}

int port_of(std::string_view address) {
  int port = 0;
  const std::string_view digits = address.substr(address.rfind(':') + 1);
  std::from_chars(digits.data(), digits.data() + digits.size(), port);
  return port;
}

}  // namespace

Result<CurveKey> read_curve_key(const std::string& file, const SourceLoc& loc) {
  GLOAM_TRY(const std::string text, read_private_file(file, loc));
  CurveKey key{.secret = find_secret(text), .public_key = {}};
  std::array<char, kZ85Key + 1> public_key = {};
  if (key.secret.size() != kZ85Key || zmq_curve_public(public_key.data(), key.secret.c_str()) != 0)
    return key_error(file, loc, "does not contain a secret key of 40 characters");
  key.public_key = public_key.data();
  return key;
}

Result<std::unique_ptr<Endpoints>> Endpoints::bind(const ZmqOptions& options) {
  CurveKey key;
  if (!options.curve_secret.empty()) {
    if (zmq_has("curve") == 0)
      return Error{ErrorKind::kUnsupported, "libzmq on this machine does not support CURVE",
                   options.loc};
    GLOAM_TRY(key, read_curve_key(options.curve_secret, options.loc));
  } else if (!web::is_loopback_name(options.host)) {
    return Error{
        ErrorKind::kUsage, fmt::format("ZeroMQ on '{}' would be open to the network", options.host),
        options.loc,
        "set [bridge.zmq] curve_secret to a file from curve_keygen, or host = '127.0.0.1'"};
  }
  if (options.port < 0 || options.port > 65534)
    return Error{ErrorKind::kUsage, "port must be 0 ... 65534", options.loc};
  auto endpoints = std::make_unique<Endpoints>();
  endpoints->public_key = key.public_key;
  try {
    set_common(endpoints->operations, options.host, key);
    endpoints->operations.set(zmq::sockopt::router_mandatory, true);
    endpoints->operations.set(zmq::sockopt::maxmsgsize, static_cast<int64_t>(kMaxRequestBytes));
    endpoints->operations.set(zmq::sockopt::sndhwm, kMaxQueuedReplies);
    endpoints->operations.set(zmq::sockopt::rcvhwm, kRequests);
    set_common(endpoints->streams, options.host, key);
    endpoints->streams.set(zmq::sockopt::maxmsgsize, static_cast<int64_t>(kMaxSubscription));
    endpoints->streams.set(zmq::sockopt::sndhwm, kStreamMessages);
    endpoints->streams.set(zmq::sockopt::xpub_verbose, true);  // latched topics are sent again
  } catch (const zmq::error_t& error) {
    return Error{ErrorKind::kIo, fmt::format("ZeroMQ: {}", error.what()), options.loc};
  }
  GLOAM_TRY_STATUS(
      bind_socket(endpoints->operations, options, options.port, &endpoints->operations_address));
  GLOAM_TRY_STATUS(bind_socket(endpoints->streams, options,
                               options.port == 0 ? 0 : options.port + 1,
                               &endpoints->streams_address));
  endpoints->port = port_of(endpoints->operations_address);
  return endpoints;
}

}  // namespace gloam::bridge::zeromq

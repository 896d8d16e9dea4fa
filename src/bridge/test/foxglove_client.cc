#include "foxglove_client.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>

namespace gloam::bridge::foxglove {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_until(Clock::time_point end) {
  return std::chrono::duration<double>(end - Clock::now()).count();
}

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::microseconds(static_cast<int64_t>(1e6 * seconds));
}

}  // namespace

FoxgloveClient::FoxgloveClient(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    close(socket_);
    socket_ = -1;
  }
}

FoxgloveClient::~FoxgloveClient() {
  if (socket_ >= 0) close(socket_);
}

bool FoxgloveClient::send_bytes(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<size_t>(sent));
  }
  return true;
}

bool FoxgloveClient::fill(size_t bytes, double seconds) {
  const auto end = after(seconds);
  while (input_.size() < bytes) {
    pollfd wait = {socket_, POLLIN, 0};
    const int left = static_cast<int>(1000 * std::max(0.0, seconds_until(end)));
    if (poll(&wait, 1, left) <= 0) return false;
    char buffer[65536];
    const ssize_t got = recv(socket_, buffer, sizeof buffer, 0);
    if (got <= 0) return false;
    input_.append(buffer, static_cast<size_t>(got));
  }
  return true;
}

int FoxgloveClient::upgrade(std::string_view target, std::string_view protocols,
                            std::string_view headers) {
  std::string request = "GET " + std::string(target) + " HTTP/1.1\r\n";
  if (headers.find("Host:") == std::string_view::npos) request += "Host: 127.0.0.1\r\n";
  request +=
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  if (!protocols.empty()) request += "Sec-WebSocket-Protocol: " + std::string(protocols) + "\r\n";
  send_bytes(request + std::string(headers) + "\r\n");
  size_t end = std::string::npos;
  for (size_t size = 1; end == std::string::npos && fill(size, 5); size = input_.size() + 1)
    end = input_.find("\r\n\r\n");
  if (end == std::string::npos) return 0;
  answer_ = input_.substr(0, end);
  input_.erase(0, end + 4);
  return std::atoi(answer_.c_str() + std::string_view("HTTP/1.1 ").size());
}

bool FoxgloveClient::send_frame(int opcode, std::string_view payload) {
  std::string frame(1, static_cast<char>(0x80 | opcode));
  const size_t size = payload.size();
  if (size < 126) {
    frame += static_cast<char>(0x80 | size);
  } else {
    frame += static_cast<char>(0x80 | (size < 65536 ? 126 : 127));
    for (int shift = size < 65536 ? 8 : 56; shift >= 0; shift -= 8)
      frame += static_cast<char>(static_cast<uint64_t>(size) >> shift);
  }
  frame.append(4, '\0');  // a mask of zeros changes nothing
  return send_bytes(frame.append(payload));
}

std::optional<FoxgloveClient::Frame> FoxgloveClient::read_frame(double seconds) {
  const auto end = after(seconds);
  while (fill(2, seconds_until(end))) {
    size_t head = 2, size = static_cast<uint8_t>(input_[1]) & 127u;
    const size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (!fill(head + more, seconds_until(end))) return {};
    if (more > 0) size = 0;
    for (size_t i = 0; i < more; ++i) size = size << 8 | static_cast<uint8_t>(input_[head + i]);
    head += more;
    if (!fill(head + size, seconds_until(end))) return {};
    Frame frame{input_[0] & 15, input_.substr(head, size)};
    input_.erase(0, head + size);
    if (frame.opcode != 9) return frame;
    send_frame(10, frame.payload);
  }
  return {};
}

std::optional<FoxgloveClient::Frame> FoxgloveClient::find(
    const std::function<bool(const Frame&)>& fits, double seconds) {
  const auto end = after(seconds);
  while (auto frame = read_frame(seconds_until(end)))
    if (fits(*frame)) return frame;
  return {};
}

std::optional<nlohmann::json> FoxgloveClient::wait_for(std::string_view op, double seconds) {
  nlohmann::json message;
  const auto found = find(
      [&](const Frame& frame) {
        if (frame.opcode != 1) return false;
        message = nlohmann::json::parse(frame.payload);
        return message["op"] == op;
      },
      seconds);
  if (!found) return {};
  return message;
}

std::optional<std::string> FoxgloveClient::wait_for_binary(uint8_t opcode, double seconds) {
  const auto found = find(
      [&](const Frame& frame) {
        return frame.opcode == 2 && !frame.payload.empty() &&
               static_cast<uint8_t>(frame.payload[0]) == opcode;
      },
      seconds);
  if (!found) return {};
  return found->payload.substr(1);
}

std::optional<std::string> FoxgloveClient::wait_for_data(uint32_t subscription, double seconds) {
  const auto found = find(
      [&](const Frame& frame) {
        return frame.opcode == 2 && frame.payload.size() >= 13 && frame.payload[0] == 1 &&
               number_at<uint32_t>(frame.payload, 1) == subscription;
      },
      seconds);
  if (!found) return {};
  return found->payload.substr(13);
}

bool FoxgloveClient::closed_within(double seconds) {
  const auto end = after(seconds);
  while (seconds_until(end) > 0) {
    input_.clear();
    if (!fill(1, seconds_until(end))) return seconds_until(end) > 0;
  }
  return false;
}

}  // namespace gloam::bridge::foxglove

#include "web/test/raw_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

namespace gloam::web {
namespace {

using Clock = std::chrono::steady_clock;

int milliseconds_until(Clock::time_point end) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
  return left.count() > 0 ? static_cast<int>(left.count()) : 0;
}

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::milliseconds(static_cast<int64_t>(1000 * seconds));
}

/// Bytes received, 0 at the end of the stream, -1 when the time is up.
ssize_t receive(int socket, char* bytes, size_t size, Clock::time_point end) {
  pollfd waiting{socket, POLLIN, 0};
  if (poll(&waiting, 1, milliseconds_until(end)) <= 0) return -1;
  const ssize_t got = recv(socket, bytes, size, 0);
  return got < 0 ? 0 : got;  // a reset is an end
}

}  // namespace

RawClient::RawClient(int port) {
  const int socket_fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  if (connect(socket_fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0)
    socket_ = socket_fd;
  else
    ::close(socket_fd);
}

RawClient::~RawClient() {
  if (socket_ >= 0) ::close(socket_);
}

bool RawClient::send_bytes(std::string_view bytes) {
  const auto end = after(5);
  while (!bytes.empty()) {
    pollfd waiting{socket_, POLLOUT, 0};
    if (poll(&waiting, 1, milliseconds_until(end)) <= 0) return false;
    const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<size_t>(sent));
  }
  return true;
}

std::string RawClient::read_all(double seconds) {
  const auto end = after(seconds);
  std::string all = std::exchange(input_, {});
  char bytes[4096];
  while (true) {
    const ssize_t got = receive(socket_, bytes, sizeof bytes, end);
    if (got <= 0) return all;
    all.append(bytes, static_cast<size_t>(got));
  }
}

bool RawClient::closed_within(double seconds) {
  const auto end = after(seconds);
  char bytes[4096];
  while (true) {
    const ssize_t got = receive(socket_, bytes, sizeof bytes, end);
    if (got == 0) return true;
    if (got < 0) return false;
  }
}

int RawClient::request(std::string_view method, std::string_view target, std::string_view headers) {
  send_bytes(std::string(method) + " " + std::string(target) +
             " HTTP/1.1\r\nConnection: close\r\n" + std::string(headers) + "\r\n");
  answer_ = read_all();
  return answer_.size() > 12 ? std::atoi(answer_.c_str() + 9) : 0;
}

int RawClient::upgrade(std::string_view headers, std::string_view target) {
  send_bytes("GET " + std::string(target) +
             " HTTP/1.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: "
             "13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
             std::string(headers) + "\r\n");
  const auto end = after(3);
  while (input_.find("\r\n\r\n") == std::string::npos) {
    if (!fill(input_.size() + 1, milliseconds_until(end) / 1000.0)) return 0;
  }
  const size_t length = input_.find("\r\n\r\n") + 4;
  answer_ = input_.substr(0, length);
  input_.erase(0, length);
  return std::atoi(answer_.c_str() + 9);
}

bool RawClient::send_frame(int opcode, std::string_view payload) {
  std::string frame(1, static_cast<char>(0x80 | opcode));
  const size_t size = payload.size();
  if (size < 126) {
    frame += static_cast<char>(0x80 | size);
  } else {
    const int bytes = size < 65536 ? 2 : 8;
    frame += static_cast<char>(0x80 | (bytes == 2 ? 126 : 127));
    for (int i = bytes - 1; i >= 0; --i) frame += static_cast<char>(size >> (8 * i) & 255);
  }
  const char mask[4] = {0x12, 0x34, 0x56, 0x78};
  frame.append(mask, 4);
  for (size_t i = 0; i < size; ++i) frame += static_cast<char>(payload[i] ^ mask[i % 4]);
  return send_bytes(frame);
}

bool RawClient::fill(size_t bytes, double seconds) {
  const auto end = after(seconds);
  char chunk[65536];
  while (input_.size() < bytes) {
    const ssize_t got = receive(socket_, chunk, sizeof chunk, end);
    if (got <= 0) return false;
    input_.append(chunk, static_cast<size_t>(got));
  }
  return true;
}

std::optional<RawClient::Frame> RawClient::read_frame(double seconds) {
  const auto end = after(seconds);
  while (true) {
    if (!fill(2, milliseconds_until(end) / 1000.0)) return {};
    const auto byte = [&](size_t at) { return static_cast<uint8_t>(input_[at]); };
    size_t header = 2;
    uint64_t size = byte(1) & 127;
    if (size >= 126) {
      header = size == 126 ? 4 : 10;
      if (!fill(header, milliseconds_until(end) / 1000.0)) return {};
      size = 0;
      for (size_t i = 2; i < header; ++i) size = size << 8 | byte(i);
    }
    if (!fill(header + size, milliseconds_until(end) / 1000.0)) return {};
    Frame frame{byte(0) & 15, input_.substr(header, size)};
    input_.erase(0, header + size);
    if (frame.opcode != 9) return frame;
    send_frame(10, frame.payload);
  }
}

std::optional<nlohmann::json> RawClient::wait_for(std::string_view type, double seconds) {
  const auto end = after(seconds);
  while (const auto frame = read_frame(milliseconds_until(end) / 1000.0)) {
    if (frame->opcode == 8) return {};
    if (frame->opcode == 2) send_text(R"({"type":"seen"})");
    if (frame->opcode != 1) continue;
    auto message = nlohmann::json::parse(frame->payload, nullptr, false);
    if (message.is_object() && message.value("type", "") == type) return message;
  }
  return {};
}

std::optional<std::string> RawClient::wait_for_picture(double seconds) {
  const auto end = after(seconds);
  while (auto frame = read_frame(milliseconds_until(end) / 1000.0)) {
    if (frame->opcode == 8) return {};
    if (frame->opcode != 2) continue;
    send_text(R"({"type":"seen"})");
    return std::move(frame->payload);
  }
  return {};
}

int RawClient::wait_for_close(double seconds) {
  const auto end = after(seconds);
  while (const auto frame = read_frame(milliseconds_until(end) / 1000.0)) {
    if (frame->opcode != 8) continue;
    if (frame->payload.size() < 2) return 1005;
    return static_cast<uint8_t>(frame->payload[0]) << 8 | static_cast<uint8_t>(frame->payload[1]);
  }
  return -1;
}

}  // namespace gloam::web

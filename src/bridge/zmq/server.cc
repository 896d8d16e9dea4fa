#include "bridge/zmq/server.h"

#include <cerrno>
#include <chrono>
#include <string_view>
#include <utility>

namespace gloam::bridge::zeromq {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kProbePeriod{1000};
constexpr int kMaxAtOnce = 64;    // messages of one socket before the others have their turn
constexpr size_t kMaxFrames = 8;  // of a request; more are thrown away

PackBuffer alive_event() {
  PackBuffer buffer;
  Packer packer(buffer);
  packer.pack_map(1);
  pack_pair(packer, "event", std::string_view("alive"));
  return buffer;
}

zmq::const_buffer frame_of(std::string_view text) { return zmq::buffer(text.data(), text.size()); }

// All frames of the next message; none when no message waits.
std::vector<zmq::message_t> receive_frames(zmq::socket_t& socket) {
  std::vector<zmq::message_t> frames;
  zmq::message_t frame;
  while (socket.recv(frame, zmq::recv_flags::dontwait)) {
    const bool more = frame.more();
    if (frames.size() <= kMaxFrames) frames.push_back(std::move(frame));
    frame.rebuild();
    if (!more) break;
  }
  return frames;
}

}  // namespace

Server::Server(std::unique_ptr<Endpoints> endpoints, Outbox& outbox, ServerEvents events)
    : endpoints_(std::move(endpoints)), outbox_(outbox), events_(std::move(events)) {}

void Server::start() {
  thread_ = std::thread([this] { run(); });
}

void Server::stop() {
  stopping_ = true;
  outbox_.wake();
  if (thread_.joinable()) thread_.join();
  endpoints_.reset();
}

Status Server::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void Server::run() {
  auto next_probe = Clock::now() + kProbePeriod;
  try {
    while (!stopping_) {
      zmq::pollitem_t items[] = {{endpoints_->operations.handle(), 0, ZMQ_POLLIN, 0},
                                 {endpoints_->streams.handle(), 0, ZMQ_POLLIN, 0},
                                 {nullptr, outbox_.wake_fd(), ZMQ_POLLIN, 0}};
      zmq::poll(items, 3, kProbePeriod);
      if (items[2].revents != 0) outbox_.clear_wake();
      if (items[1].revents != 0) receive_subscriptions();
      if (items[0].revents != 0) receive_requests();
      send_replies();
      send_publications();
      if (Clock::now() < next_probe) continue;
      probe_clients();
      next_probe = Clock::now() + kProbePeriod;
    }
    send_replies();
  } catch (const zmq::error_t& error) {
    const std::lock_guard lock(mutex_);
    status_ = Error{ErrorKind::kIo, std::string("ZeroMQ: ") + error.what()};
  }
}

void Server::receive_requests() {
  for (int i = 0; i < kMaxAtOnce; ++i) {
    const std::vector<zmq::message_t> frames = receive_frames(endpoints_->operations);
    if (frames.empty()) return;
    Envelope from{.client = frames[0].to_string()};
    from.has_delimiter = frames.size() == 3 && frames[1].size() == 0;
    if (frames.size() != 2 && !from.has_delimiter) {
      ++counts_.malformed;
      continue;
    }
    ++counts_.requests;
    const zmq::message_t& payload = frames.back();
    events_.on_request(from, {payload.data<uint8_t>(), payload.size()});
  }
}

void Server::receive_subscriptions() {
  for (int i = 0; i < kMaxAtOnce; ++i) {
    const std::vector<zmq::message_t> frames = receive_frames(endpoints_->streams);
    if (frames.empty()) return;
    // One byte, 1 = subscribe, 0 = the last subscriber has gone, and the topic.
    const std::string text = frames[0].to_string();
    if (frames.size() != 1 || text.empty() || static_cast<uint8_t>(text[0]) > 1) {
      ++counts_.malformed;
      continue;
    }
    events_.on_subscription(text.substr(1), text[0] == 1);
  }
}

bool Server::send_to(const Envelope& to, const PackBuffer& payload) {
  using zmq::send_flags;
  zmq::socket_t& socket = endpoints_->operations;
  const auto more = send_flags::sndmore | send_flags::dontwait;
  try {
    if (!socket.send(frame_of(to.client), more)) {
      ++counts_.dropped;
      return true;  // there, but takes nothing
    }
    if (to.has_delimiter) (void)socket.send(frame_of({}), more);
    (void)socket.send(zmq::buffer(payload.data(), payload.size()), send_flags::dontwait);
  } catch (const zmq::error_t& error) {
    if (error.num() == EHOSTUNREACH) return false;
    throw;
  }
  return true;
}

void Server::send_replies() {
  for (const Reply& reply : outbox_.take_replies())
    if (!send_to(reply.to, reply.payload)) events_.on_gone(reply.to.client);
}

void Server::send_publications() {
  using zmq::send_flags;
  const auto more = send_flags::sndmore | send_flags::dontwait;
  for (Publication& publication : outbox_.take_publications()) {
    zmq::socket_t& socket = endpoints_->streams;
    if (!socket.send(frame_of(publication.topic), more)) {
      ++counts_.dropped;
      continue;
    }
    (void)socket.send(std::move(publication.header), more);
    (void)socket.send(std::move(publication.payload), send_flags::dontwait);
    ++counts_.sent;
  }
}

void Server::probe_clients() {
  for (const Envelope& client : events_.watched())
    if (!send_to(client, alive_event())) events_.on_gone(client.client);
}

}  // namespace gloam::bridge::zeromq

// The bridge to ZeroMQ among bad neighbours: stuck, half-open, flooding and malformed clients.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "bridge/test/zmq_fixture.h"

namespace gloam::bridge::zeromq {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

ArgumentWriter steps(int64_t n) {
  return [n](Packer& packer) { pack_pair(packer, "n", n); };
}

int connect_to(const std::string& address) {
  const int port = std::stoi(address.substr(address.rfind(':') + 1));
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in to = {};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<uint16_t>(port));
  inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
  if (connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0) return fd;
  close(fd);
  return -1;
}

TEST_F(ZmqBridgeTest, HalfOpenConnectionsHinderNobody) {
  start_default();
  const std::string operations = operations_address(), streams = streams_address();
  std::vector<int> sockets;
  std::mt19937 random(3);
  for (int i = 0; i < 64; ++i) {
    const int fd = connect_to(i % 2 == 0 ? operations : streams);
    ASSERT_GE(fd, 0);
    sockets.push_back(fd);
    std::vector<uint8_t> noise(random() % 200);
    for (uint8_t& byte : noise) byte = static_cast<uint8_t>(random());
    if (i % 3 == 0) (void)send(fd, noise.data(), noise.size(), MSG_NOSIGNAL);
  }
  simulation_->set_pace(Pace::kFast, 1);
  simulation_->resume();
  RawClient client(operations);
  for (int i = 0; i < 50; ++i) {
    const auto begin = Clock::now();
    client.call("ping");
    EXPECT_LT(Clock::now() - begin, 2s);
  }
  EXPECT_GT(simulation_->latest().step(), 0);
  for (const int fd : sockets) close(fd);
  EXPECT_TRUE(bridge_->status().ok());
}

TEST_F(ZmqBridgeTest, AStuckSubscriberLosesMessagesAndHoldsUpNobody) {
  start_default();
  const std::string streams = streams_address();
  RawSubscriber stuck(streams), reading(streams);
  stuck.subscribe("state/0");
  reading.subscribe("state/0");
  RawClient client(operations_address());
  client.call("step", 1, steps(1));
  (void)reading.receive(1000);
  client.call("step", 1, steps(20000));
  EXPECT_EQ(simulation_->latest().step(), 20001);
  int64_t last = 0;
  while (const auto message = reading.receive(500)) {
    const auto step = message->header["step"].as<int64_t>();
    EXPECT_GT(step, last);
    last = step;
  }
  EXPECT_GT(last, 0);
  client.call("ping");
}

TEST_F(ZmqBridgeTest, MalformedMessagesAreCountedAndForgotten) {
  start_default();
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::dealer);
  socket.set(zmq::sockopt::linger, 0);
  socket.connect(operations_address());
  std::mt19937 random(11);
  for (int i = 0; i < 500; ++i) {
    std::string noise(random() % 300, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    const int frames = 1 + static_cast<int>(random() % 12);
    for (int frame = 0; frame < frames; ++frame)
      (void)socket.send(zmq::buffer(noise),
                        frame + 1 < frames ? zmq::send_flags::sndmore : zmq::send_flags::none);
  }
  RawClient client(operations_address());
  client.call("ping");
  const auto end = Clock::now() + 10s;
  while (bridge_->stats().refused < 500 && Clock::now() < end) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(bridge_->stats().refused, 500);
}

TEST_F(ZmqBridgeTest, MessagesBeyondTheLimitEndTheirConnectionAlone) {
  start_default();
  RawClient large(operations_address()), client(operations_address());
  large.send_bytes(std::string(size_t{20} << 20, 'a'));
  EXPECT_FALSE(large.receive(500));
  client.call("ping");
  EXPECT_TRUE(bridge_->status().ok());
}

TEST_F(ZmqBridgeTest, PingsAreAnsweredWhileStepsAreTaken) {
  start_default();
  RawClient stepping(operations_address()), client(operations_address());
  stepping.send(make_request("step", 1, steps(100000000)));
  while (client.call("state")["step"].as<int64_t>() < 10) std::this_thread::sleep_for(1ms);
  for (int i = 0; i < 20; ++i) client.call("ping");
  client.call("pause");
  const std::optional<Value> reply = stepping.receive();
  ASSERT_TRUE(reply);
  EXPECT_EQ((*reply)["error"]["kind"].text(), "interrupted");
}

TEST_F(ZmqBridgeTest, AFloodOfOperationsIsRefusedNotStored) {
  start_default();
  RawClient stepping(operations_address()), flooding(operations_address());
  stepping.send(make_request("step", 1, steps(100000000)));
  while (simulation_->latest().step() < 10) std::this_thread::sleep_for(1ms);
  for (int i = 0; i < 200; ++i) flooding.send(make_request("topics"));
  const std::optional<Value> refused = flooding.receive();
  ASSERT_TRUE(refused);
  EXPECT_EQ((*refused)["error"]["kind"].text(), "usage");
  RawClient(operations_address()).call("pause");
}

TEST_F(ZmqBridgeTest, AServerEndsWhileItWorks) {
  start_default();
  RawSubscriber subscriber(streams_address());
  subscriber.subscribe("state/0");
  subscriber.subscribe("/front/image_raw");
  RawClient stepping(operations_address());
  stepping.send(make_request("step", 1, steps(100000000)));
  ASSERT_TRUE(subscriber.receive());
  const auto begin = Clock::now();
  bridge_.reset();
  EXPECT_LT(Clock::now() - begin, 10s);
  start_default();
  RawClient(operations_address()).call("ping");
}

TEST_F(ZmqBridgeTest, ReqSocketsAreServed) {
  start_default();
  RawClient client(operations_address(), zmq::socket_type::req);
  for (int i = 0; i < 3; ++i) client.call("ping");
  client.call("claim");
  std::this_thread::sleep_for(2500ms);  // "alive" comes in between
  client.call("ping");
  client.call("state");
}

}  // namespace
}  // namespace gloam::bridge::zeromq

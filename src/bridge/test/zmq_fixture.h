#pragma once
// A small scene with a bridge to ZeroMQ, and a client that speaks msgpack over bare sockets.

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "bridge/bridge_list.h"
#include "bridge/zmq/pack.h"

namespace gloam::bridge::zeromq {

inline constexpr const char* kTestToken = "0123456789abcdef0123456789abcdef0123456789abcdef";

/// A value of a reply, for comparisons.
class Value {
 public:
  Value(msgpack::object object, std::shared_ptr<msgpack::object_handle> memory)
      : object_(object), memory_(std::move(memory)) {}
  /// Entry of a map; nil if there is none.
  Value operator[](std::string_view key) const;
  bool has(std::string_view key) const { return !(*this)[key].is_nil(); }
  bool is_nil() const { return object_.type == msgpack::type::NIL; }
  template <class T>
  T as() const {
    return object_.as<T>();
  }
  std::string text() const { return object_.as<std::string>(); }
  double number() const { return object_.as<double>(); }
  std::string to_string() const;

 private:
  msgpack::object object_;
  std::shared_ptr<msgpack::object_handle> memory_;
};
Value unpack_value(const zmq::message_t& message);

/// Arguments: packs a map.
using ArgumentWriter = std::function<void(Packer&)>;
/// {op, id, token, args}; `arguments` packs `pairs` pairs.
PackBuffer make_request(std::string_view operation, uint32_t pairs = 0,
                        const ArgumentWriter& arguments = {}, std::string_view token = kTestToken);

class RawClient {
 public:
  RawClient(const std::string& address, zmq::socket_type type = zmq::socket_type::dealer);

  void send(const PackBuffer& request);
  void send_bytes(std::string_view bytes);
  /// The next reply, events left out; none within the time.
  std::optional<Value> receive(int milliseconds = 20000);
  /// Result of an operation; an error is a failure of the test.
  Value call(std::string_view operation, uint32_t pairs = 0, const ArgumentWriter& arguments = {});
  /// Error of an operation that must be refused.
  Value refused(std::string_view operation, uint32_t pairs = 0,
                const ArgumentWriter& arguments = {}, std::string_view token = kTestToken);
  zmq::socket_t& socket() { return socket_; }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_;
};

struct StreamMessage {
  std::string topic;
  Value header;
  zmq::message_t payload;
};
class RawSubscriber {
 public:
  explicit RawSubscriber(const std::string& address);
  void subscribe(std::string_view topic) { socket_.set(zmq::sockopt::subscribe, topic); }
  void unsubscribe(std::string_view topic) { socket_.set(zmq::sockopt::unsubscribe, topic); }
  std::optional<StreamMessage> receive(int milliseconds = 20000);

 private:
  zmq::context_t context_;
  zmq::socket_t socket_;
};

class ZmqBridgeTest : public testing::Test {
 protected:
  ZmqBridgeTest();
  ~ZmqBridgeTest() override;

  /// Starts a bridge at any free ports.
  Result<std::unique_ptr<Bridge>> start(ZmqOptions options = {.port = 0});
  void start_default() {
    auto started = start();
    ASSERT_TRUE(started.ok()) << started.error().to_string();
    bridge_ = std::move(*started);
  }
  static std::string operations_of(const Bridge& bridge);
  std::string operations_address() const { return operations_of(*bridge_); }
  std::string streams_address();

  std::filesystem::path folder_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Operator> operator_;
  std::unique_ptr<BridgeContext> context_;
  std::unique_ptr<Bridge> bridge_;
};

}  // namespace gloam::bridge::zeromq

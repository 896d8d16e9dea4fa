#include "bridge/test/zmq_fixture.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "gloam/scene.h"

namespace gloam::bridge::zeromq {
namespace {

constexpr const char* kZmqCart = R"(<mujoco model="cart"><option timestep="0.002"/>
<worldbody><body name="base" pos="0 0 0.2">
  <joint name="slide" type="slide" axis="1 0 0"/><geom type="box" size=".2 .1 .1" mass="1"/>
  <camera name="eye" pos=".25 0 0" xyaxes="0 -1 0 0 0 1"/>
  <body name="arm" pos="0 0 .1"><joint name="lift" axis="0 1 0" damping="0.1"/>
    <geom type="capsule" size=".02" fromto="0 0 0 .2 0 0" mass=".1"/></body></body></worldbody>
<actuator><motor name="push" joint="slide"/><position name="lift" joint="lift" kp="5"/></actuator>
<sensor><jointpos name="angle" joint="lift"/></sensor>
</mujoco>)";

constexpr const char* kZmqPlace = R"(<mujoco><worldbody><light pos="0 0 3"/>
<geom name="ground" type="plane" size="5 5 .1"/>
<body name="ghost" mocap="true" pos="1 1 1"><geom size=".05" contype="0" conaffinity="0"/></body>
<body name="ball" pos="2 0 1"><freejoint/><geom size=".1"/></body></worldbody></mujoco>)";

constexpr const char* kZmqScene = R"(
[scene]
name = "zmq"
[environment]
file = "place.xml"
[[robot]]
name = "cart"
file = "cart.xml"
[robot.controller]
type = "none"
[[camera]]
name = "front"
position = [3, 0, 1]
look_at = [0, 0, 0]
width = 64
height = 48
rate = 20
[render]
tier = "direct"
spp = 1
)";

std::filesystem::path make_folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "gloam_zmq_XXXXXX").string();
  return mkdtemp(pattern.data());
}

}  // namespace

Value Value::operator[](std::string_view key) const {
  if (object_.type == msgpack::type::MAP)
    for (uint32_t i = 0; i < object_.via.map.size; ++i) {
      const msgpack::object_kv& entry = object_.via.map.ptr[i];
      if (std::string_view(entry.key.via.str.ptr, entry.key.via.str.size) == key)
        return {entry.val, memory_};
    }
  return {msgpack::object(), memory_};
}

std::string Value::to_string() const {
  std::ostringstream text;
  text << object_;
  return text.str();
}

Value unpack_value(const zmq::message_t& message) {
  auto memory = std::make_shared<msgpack::object_handle>(
      msgpack::unpack(message.data<char>(), message.size()));
  return {memory->get(), memory};
}

PackBuffer make_request(std::string_view operation, uint32_t pairs, const ArgumentWriter& arguments,
                        std::string_view token) {
  PackBuffer buffer;
  Packer packer(buffer);
  packer.pack_map(token.empty() ? 3 : 4);
  pack_pair(packer, "op", operation);
  pack_pair(packer, "id", 7);
  if (!token.empty()) pack_pair(packer, "token", token);
  packer.pack(std::string_view("args"));
  packer.pack_map(pairs);
  if (arguments) arguments(packer);
  return buffer;
}

RawClient::RawClient(const std::string& address, zmq::socket_type type) : socket_(context_, type) {
  socket_.set(zmq::sockopt::linger, 0);
  socket_.connect(address);
}

void RawClient::send(const PackBuffer& request) { send_bytes({request.data(), request.size()}); }

void RawClient::send_bytes(std::string_view bytes) {
  socket_.send(zmq::buffer(bytes.data(), bytes.size()));
}

std::optional<Value> RawClient::receive(int milliseconds) {
  socket_.set(zmq::sockopt::rcvtimeo, milliseconds);
  for (;;) {
    zmq::message_t message;
    if (!socket_.recv(message)) return std::nullopt;
    Value value = unpack_value(message);
    if (!value.has("event")) return value;
  }
}

Value RawClient::call(std::string_view operation, uint32_t pairs, const ArgumentWriter& arguments) {
  send(make_request(operation, pairs, arguments));
  std::optional<Value> reply = receive();
  if (!reply) {
    ADD_FAILURE() << operation << ": no reply";
    return {msgpack::object(), nullptr};
  }
  EXPECT_FALSE(reply->has("error")) << operation << ": " << reply->to_string();
  return (*reply)["result"];
}

Value RawClient::refused(std::string_view operation, uint32_t pairs,
                         const ArgumentWriter& arguments, std::string_view token) {
  send(make_request(operation, pairs, arguments, token));
  std::optional<Value> reply = receive();
  if (!reply) {
    ADD_FAILURE() << operation << ": no reply";
    return {msgpack::object(), nullptr};
  }
  EXPECT_TRUE(reply->has("error")) << operation << ": " << reply->to_string();
  EXPECT_FALSE(reply->has("result"));
  return (*reply)["error"];
}

RawSubscriber::RawSubscriber(const std::string& address)
    : socket_(context_, zmq::socket_type::sub) {
  socket_.set(zmq::sockopt::linger, 0);
  socket_.connect(address);
}

std::optional<StreamMessage> RawSubscriber::receive(int milliseconds) {
  socket_.set(zmq::sockopt::rcvtimeo, milliseconds);
  zmq::message_t topic, header, payload;
  if (!socket_.recv(topic)) return std::nullopt;
  EXPECT_TRUE(topic.more());
  (void)socket_.recv(header);
  EXPECT_TRUE(header.more());
  (void)socket_.recv(payload);
  EXPECT_FALSE(payload.more());
  return StreamMessage{topic.to_string(), unpack_value(header), std::move(payload)};
}

ZmqBridgeTest::ZmqBridgeTest() : folder_(make_folder()) {
  std::ofstream(folder_ / "cart.xml") << kZmqCart;
  std::ofstream(folder_ / "place.xml") << kZmqPlace;
  setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1);
  const auto scene = parse_scene(kZmqScene, folder_);
  EXPECT_TRUE(scene.ok()) << scene.error().to_string();
  const auto world = World::compile(*scene);
  EXPECT_TRUE(world.ok()) << world.error().to_string();
  auto simulation = Simulation::create(*world, {});
  EXPECT_TRUE(simulation.ok()) << simulation.error().to_string();
  simulation_ = std::move(*simulation);
  operator_ = std::make_unique<Operator>(*simulation_);
  operator_->set_recording_folder(folder_ / "logs");
  context_ =
      std::make_unique<BridgeContext>(BridgeContext{*simulation_, *operator_, nullptr, kTestToken});
}

ZmqBridgeTest::~ZmqBridgeTest() {
  bridge_.reset();
  context_.reset();
  operator_.reset();
  simulation_.reset();
  std::filesystem::remove_all(folder_);
}

Result<std::unique_ptr<Bridge>> ZmqBridgeTest::start(ZmqOptions options) {
  return start_zmq(*context_, options);
}

std::string ZmqBridgeTest::operations_of(const Bridge& bridge) {
  return bridge.address().substr(0, bridge.address().find(','));
}

std::string ZmqBridgeTest::streams_address() {
  RawClient client(operations_address());
  return client.call("hello")["streams"].text();
}

}  // namespace gloam::bridge::zeromq

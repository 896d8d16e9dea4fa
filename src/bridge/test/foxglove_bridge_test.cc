// The bridge to Foxglove with a real simulation behind it and clients by hand.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "bridge/bridge_list.h"
#include "foxglove_client.h"
#include "ros/codec.h"
#include "ros/messages/sensor_msgs.h"
#include "ros/messages/std_msgs.h"
#include "ros/messages/std_srvs.h"
#include "ros/messages/tf2_msgs.h"

namespace gloam::bridge::foxglove {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

constexpr const char* kCart = R"(<mujoco model="cart">
  <option timestep="0.002" gravity="0 0 -9.81"/>
  <worldbody>
    <light pos="0 0 4" dir="0 0 -1"/>
    <geom name="floor" type="plane" size="5 5 0.1"/>
    <body name="cart" pos="0 0 1">
      <joint name="rail" type="slide" axis="1 0 0"/>
      <geom name="cart" type="box" size="0.2 0.1 0.1" mass="1"/>
    </body>
    <camera name="eye" pos="0 -3 1" xyaxes="1 0 0 0 0 1" resolution="64 48"/>
  </worldbody>
  <actuator><motor name="push" joint="rail"/></actuator>
</mujoco>)";

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
const std::string kWithToken = std::string("/?token=") + kToken;
constexpr const char* kV1 = "foxglove.sdk.v1";

World compile_file(const std::filesystem::path& file) {
  const auto scene = load_scene(file);
  EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().to_string());
  auto world = World::compile(*scene);
  EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().to_string());
  return *world;
}

World compile_text(const std::string& text) {
  const std::filesystem::path file = own_folder() / "cart.xml";  // the robot's name
  std::ofstream(file) << text;
  return compile_file(file);
}

/// A tetrahedron as a binary STL.
std::string tetrahedron() {
  const float p[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string stl(80, '\0');
  stl += as_bytes(4u);
  for (const auto& face : faces) {
    stl += std::string(12, '\0');
    for (const int corner : face)
      for (const float x : p[corner]) stl += as_bytes(x);
    stl += std::string(2, '\0');
  }
  return stl;
}

class FoxgloveBridgeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto simulation = Simulation::create(compile_text(kCart), {});
    ASSERT_TRUE(simulation.ok()) << simulation.error().to_string();
    simulation_ = std::move(*simulation);
    simulation_->set_pace(Pace::kRealTime, 1);
    operations_ = std::make_unique<Operator>(*simulation_);
    start({.port = 0});
  }
  void TearDown() override {
    bridge_.reset();
    operations_.reset();
  }
  void start(const FoxgloveOptions& options) {
    bridge_.reset();
    auto started = start_foxglove({*simulation_, *operations_, nullptr, kToken}, options);
    ASSERT_TRUE(started.ok()) << started.error().to_string();
    bridge_ = std::move(*started);
    const std::string address = bridge_->address();
    port_ = std::stoi(address.substr(address.find(':', 5) + 1));
  }
  static bool eventually(const std::function<bool()>& holds) {
    for (int i = 0; i < 2000; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return false;
  }
  /// Id of a topic's channel, out of what the client is told first.
  static uint64_t channel_of(const json& advertise, const std::string& topic) {
    for (const json& channel : advertise["channels"])
      if (channel["topic"] == topic) return channel["id"];
    return 0;
  }
  static json subscribe(uint64_t channel, uint32_t id) {
    return {{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}};
  }
  static std::string call(uint32_t service, uint32_t id, const std::string& encoding,
                          const std::string& data) {
    return "\x02" + as_bytes(service) + as_bytes(id) +
           as_bytes(static_cast<uint32_t>(encoding.size())) + encoding + data;
  }
  static uint32_t service_of(const json& services, const std::string& name) {
    for (const json& service : services["services"])
      if (service["name"] == name) return service["id"];
    return 0;
  }

  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Operator> operations_;
  std::unique_ptr<Bridge> bridge_;
  int port_ = 0;
};

TEST_F(FoxgloveBridgeTest, SpeaksTheProtocolThatTheClientPrefers) {
  FoxgloveClient newest(port_), older(port_), oldest(port_), none(port_), other(port_);
  ASSERT_EQ(newest.upgrade("/", "foxglove.sdk.v1.1, foxglove.sdk.v1"), 101);
  EXPECT_NE(newest.answer().find("foxglove.sdk.v1.1"), std::string::npos);
  ASSERT_EQ(older.upgrade("/", "graphql, foxglove.sdk.v1,foxglove.sdk.v1.1"), 101);
  EXPECT_EQ(older.answer().find("foxglove.sdk.v1.1"), std::string::npos);
  ASSERT_EQ(oldest.upgrade("/", "foxglove.websocket.v1"), 101);
  EXPECT_EQ(none.upgrade("/", ""), 400);
  EXPECT_EQ(other.upgrade("/", "foxglove.sdk.v2"), 400);

  for (FoxgloveClient* client : {&newest, &older, &oldest}) {
    const auto info = client->wait_for("serverInfo");
    ASSERT_TRUE(info);
    EXPECT_EQ((*info)["supportedEncodings"], json({"cdr", "json"}));
    const auto has = [&](const char* name) {
      for (const json& capability : (*info)["capabilities"])
        if (capability == name) return true;
      return false;
    };
    EXPECT_TRUE(has("time") && has("services") && has("assets") && has("parametersSubscribe"));
    EXPECT_FALSE(has("playbackControl")) << "no log is being replayed";
  }
  const auto v11 = newest.wait_for("advertise"), v1 = older.wait_for("advertise");
  ASSERT_TRUE(v11 && v1);
  const auto infos = simulation_->topics();
  size_t outputs = 0;
  for (const TopicInfo& topic : *infos) outputs += topic.is_input ? 0 : 1;
  ASSERT_EQ((*v1)["channels"].size(), outputs);
  ASSERT_EQ((*v11)["channels"].size(), outputs);
  for (size_t i = 0; i < outputs; ++i) {
    const json &a = (*v1)["channels"][i], &b = (*v11)["channels"][i];
    EXPECT_EQ(a["topic"], b["topic"]);
    EXPECT_EQ(a["encoding"], "cdr");
    bool found = false;
    for (const json& schema : (*v11)["schemas"])
      if (schema["id"] == b["schemaId"]) {
        found = true;
        EXPECT_EQ(schema["name"], a["schemaName"]);
        EXPECT_EQ(schema["data"], a["schema"]);
        EXPECT_EQ(schema["data"], message_info(a["schemaName"].get<std::string>())->definition);
      }
    EXPECT_TRUE(found) << a;
  }
}

TEST_F(FoxgloveBridgeTest, AdmitsByTokenHostAndOrigin) {
  const std::string page = "Origin: https://app.foxglove.dev\r\n";
  const auto status = [&](const std::string& target, const std::string& headers) {
    return FoxgloveClient(port_).upgrade(target, kV1, headers);
  };
  EXPECT_EQ(status("/", ""), 101);
  EXPECT_EQ(status("/", page), 403);
  EXPECT_EQ(status("/", "Origin: null\r\n"), 403);
  EXPECT_EQ(status("/", "Origin: http://127.0.0.1\r\n"), 403);
  EXPECT_EQ(status(kWithToken, page), 101);
  EXPECT_EQ(status(kWithToken + "x", page), 403);
  EXPECT_EQ(status("/", page + "Authorization: Bearer " + kToken + "\r\n"), 101);
  EXPECT_EQ(status("/", "Host: evil.example\r\n"), 403);
  EXPECT_EQ(status(kWithToken, "Host: evil.example\r\n"), 101);
  EXPECT_EQ(status("/", "Host: 127.0.0.1\r\nHost: 127.0.0.1\r\n"), 400);
  FoxgloveClient plain(port_);
  plain.send_bytes("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_TRUE(plain.closed_within(5));
}

TEST_F(FoxgloveBridgeTest, SendsWhatIsSubscribedAndNothingElse) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", kV1), 101);
  const json advertise = *client.wait_for("advertise");
  const uint64_t tf = channel_of(advertise, "/tf"), fixed = channel_of(advertise, "/tf_static");
  ASSERT_TRUE(tf != 0 && fixed != 0);
  simulation_->resume();
  EXPECT_FALSE(client.wait_for_binary(1, 0.3)) << "nobody has subscribed";

  client.send_json(subscribe(tf, 7));
  const auto frame = client.wait_for_binary(1);
  ASSERT_TRUE(frame);
  EXPECT_EQ(number_at<uint32_t>(*frame, 0), 7u);
  const auto bytes = frame->substr(12);
  const auto message =
      decode<tf2_msgs::TFMessage>({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
  ASSERT_TRUE(message.ok()) << message.error().to_string();
  const auto& stamp = message->transforms.at(0).header.stamp;
  EXPECT_EQ(message->transforms.at(0).child_frame_id, "cart");
  EXPECT_EQ(number_at<uint64_t>(*frame, 4), stamp.sec * 1'000'000'000ull + stamp.nanosec);

  client.send_json({{"op", "unsubscribe"}, {"subscriptionIds", {7}}});
  client.send_json(subscribe(fixed, 8));
  EXPECT_TRUE(client.wait_for_data(8)) << "latched";
  EXPECT_FALSE(client.wait_for_data(7, 0.3));
  FoxgloveClient second(port_);
  ASSERT_EQ(second.upgrade("/", kV1), 101);
  second.send_json(subscribe(fixed, 1));
  EXPECT_TRUE(second.wait_for_data(1)) << "a later subscriber of a latched topic";
  EXPECT_GT(bridge_->stats().messages_out, 1);
  EXPECT_EQ(bridge_->stats().clients, 2);
}

TEST_F(FoxgloveBridgeTest, SendsPictures) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", "foxglove.sdk.v1.1"), 101);
  const json advertise = *client.wait_for("advertise");
  client.send_json(subscribe(channel_of(advertise, "/eye/image_raw"), 1));
  simulation_->resume();
  const auto bytes = client.wait_for_data(1, 60);
  ASSERT_TRUE(bytes);
  EXPECT_GT(bytes->size(), 64u * 48 * 3);
}

TEST_F(FoxgloveBridgeTest, TellsTheTimeOfTheSimulation) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", kV1), 101);
  const auto first = client.wait_for_binary(2);
  ASSERT_TRUE(first);
  EXPECT_EQ(number_at<uint64_t>(*first, 0), 0u);
  EXPECT_FALSE(client.wait_for_binary(2, 0.3)) << "time stands still";
  ASSERT_TRUE(simulation_->step(100).ok());
  uint64_t last = 0;
  EXPECT_TRUE(eventually([&] {
    const auto next = client.wait_for_binary(2, 1);
    const uint64_t before = std::exchange(last, next ? number_at<uint64_t>(*next, 0) : 0);
    EXPECT_GT(last, before);
    return last == 200'000'000u || !next;
  }));
  EXPECT_EQ(last, 200'000'000u);
}

TEST_F(FoxgloveBridgeTest, TakesMessagesInCdrAndJson) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade(kWithToken, kV1), 101);
  const std::string topic = "/cart/controls";
  client.send_json({{"op", "advertise"},
                    {"channels",
                     {{{"id", 1},
                       {"topic", topic},
                       {"encoding", "cdr"},
                       {"schemaName", "std_msgs/msg/Float64MultiArray"}},
                      {{"id", 2},
                       {"topic", topic},
                       {"encoding", "json"},
                       {"schemaName", "std_msgs/Float64MultiArray"}}}}});
  std::vector<uint8_t> bytes;
  std_msgs::Float64MultiArray message;
  message.data = {2.5};
  encode(message, &bytes);
  client.send_frame(2, "\x01" + as_bytes(1u) + std::string(bytes.begin(), bytes.end()));
  ASSERT_TRUE(eventually([&] { return bridge_->stats().messages_in == 1; }));
  ASSERT_TRUE(simulation_->step(1).ok());
  const Actuator motor = *simulation_->world().find_actuator("push");
  EXPECT_EQ(simulation_->latest().control(motor), 2.5);
  client.send_frame(2, "\x01" + as_bytes(2u) + R"({"data":[-1.5]})");
  ASSERT_TRUE(eventually([&] { return bridge_->stats().messages_in == 2; }));
  ASSERT_TRUE(simulation_->step(1).ok());
  EXPECT_EQ(simulation_->latest().control(motor), -1.5);

  const auto refused = [&](const std::string& frame) {
    client.send_frame(2, frame);
    return client.wait_for("status").value_or(json{{"level", 0}})["level"] == 2;
  };
  EXPECT_TRUE(refused("\x01" + as_bytes(2u) + R"({"data":[1],"dat":[2]})")) << "unknown field";
  EXPECT_TRUE(refused("\x01" + as_bytes(2u) + R"({"data":["1"]})"));
  EXPECT_TRUE(refused("\x01" + as_bytes(2u) + "{"));
  EXPECT_TRUE(refused("\x01" + as_bytes(2u) + R"({"data":[1,2,3]})")) << "one actuator";
  EXPECT_TRUE(refused("\x01" + as_bytes(1u) + "abc")) << "damaged CDR";
  EXPECT_TRUE(refused("\x01" + as_bytes(9u) + "abc")) << "no such channel";
  client.send_json({{"op", "unadvertise"}, {"channelIds", {1}}});
  EXPECT_TRUE(refused("\x01" + as_bytes(1u) + std::string(bytes.begin(), bytes.end())));
  for (const json& channel :
       {json{{"id", 5}, {"topic", "/tf"}, {"encoding", "cdr"}},
        json{{"id", 5}, {"topic", topic}, {"encoding", "protobuf"}},
        json{
            {"id", 5}, {"topic", topic}, {"encoding", "cdr"}, {"schemaName", "std_msgs/String"}}}) {
    client.send_json({{"op", "advertise"}, {"channels", {channel}}});
    EXPECT_TRUE(client.wait_for("status")) << channel;
  }
  EXPECT_EQ(bridge_->stats().messages_in, 2);
}

TEST_F(FoxgloveBridgeTest, WatchersChangeNothing) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", kV1), 101);
  const json services = *client.wait_for("advertiseServices");
  client.send_frame(2, call(service_of(services, "/resume"), 3, "json", "{}"));
  const auto failure = client.wait_for("serviceCallFailure");
  ASSERT_TRUE(failure);
  EXPECT_EQ((*failure)["callId"], 3);
  client.send_json(
      {{"op", "setParameters"}, {"parameters", {{{"name", "paused"}, {"value", false}}}}});
  EXPECT_TRUE(client.wait_for("status"));
  client.send_json(
      {{"op", "advertise"}, {"channels", {{{"id", 1}, {"topic", "/reset"}, {"encoding", "cdr"}}}}});
  EXPECT_TRUE(client.wait_for("status"));
  client.send_json({{"op", "getParameters"}, {"parameterNames", {"paused"}}, {"id", "x"}});
  const auto values = client.wait_for("parameterValues");
  ASSERT_TRUE(values);
  EXPECT_EQ((*values)["parameters"][0]["value"], true);
  EXPECT_TRUE(simulation_->paused());
  EXPECT_EQ(bridge_->stats().refused, 3);
}

TEST_F(FoxgloveBridgeTest, ServicesAreCalledInCdrAndJson) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade(kWithToken, kV1), 101);
  const json services = *client.wait_for("advertiseServices");
  std::vector<uint8_t> request;
  encode(std_srvs::srv::Trigger_Request{}, &request);
  client.send_frame(2, call(service_of(services, "/step"), 1, "cdr",
                            std::string(request.begin(), request.end())));
  auto answer = client.wait_for_binary(3);
  ASSERT_TRUE(answer);
  EXPECT_EQ(number_at<uint32_t>(*answer, 4), 1u);
  EXPECT_EQ(answer->substr(12, 3), "cdr");
  const auto bytes = answer->substr(15);
  const auto response = decode<std_srvs::srv::Trigger_Response>(
      {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
  ASSERT_TRUE(response.ok());
  EXPECT_TRUE(response->success) << response->message;
  EXPECT_EQ(simulation_->latest().step(), 1);

  client.send_frame(2, call(service_of(services, "/resume"), 2, "json", "{}"));
  answer = client.wait_for_binary(3);
  ASSERT_TRUE(answer);
  EXPECT_EQ(json::parse(answer->substr(16)), json({{"success", true}, {"message", ""}}));
  EXPECT_FALSE(simulation_->paused());
  // The simulation plays: simulation_interfaces says so in its own result code.
  client.send_frame(2, call(service_of(services, "/step_simulation"), 4, "json", R"({"steps":3})"));
  answer = client.wait_for_binary(3);
  ASSERT_TRUE(answer);
  EXPECT_EQ(json::parse(answer->substr(16))["result"]["result"], 4) << *answer;
  client.send_frame(2, call(service_of(services, "/get_entities"), 5, "json", "{}"));
  answer = client.wait_for_binary(3);
  ASSERT_TRUE(answer);
  EXPECT_EQ(json::parse(answer->substr(16))["result"]["result"], 1) << *answer;
  for (const auto& bad : {call(999, 3, "json", "{}"), call(1, 3, "protobuf", ""),
                          call(1, 3, "json", "[]"), call(1, 3, "cdr", "x")}) {
    client.send_frame(2, bad);
    EXPECT_TRUE(client.wait_for("serviceCallFailure"));
  }
}

TEST_F(FoxgloveBridgeTest, ParametersAreReadSetAndWatched) {
  FoxgloveClient client(port_), watcher(port_);
  ASSERT_EQ(client.upgrade(kWithToken, kV1), 101);
  ASSERT_EQ(watcher.upgrade("/", kV1), 101);
  watcher.send_json({{"op", "subscribeParameterUpdates"}, {"parameterNames", {"gravity"}}});
  auto values = watcher.wait_for("parameterValues");
  ASSERT_TRUE(values);
  EXPECT_EQ((*values)["parameters"][0]["value"], json({0.0, 0.0, -9.81}));

  client.send_json({{"op", "getParameters"}, {"parameterNames", json::array()}, {"id", "all"}});
  values = client.wait_for("parameterValues");
  ASSERT_TRUE(values);
  EXPECT_EQ((*values)["id"], "all");
  EXPECT_GE((*values)["parameters"].size(), 5u);

  client.send_json(
      {{"op", "setParameters"},
       {"id", "set"},
       {"parameters",
        {{{"name", "gravity"}, {"value", {0, 0, -1.5}}}, {{"name", "speed"}, {"value", 0.5}}}}});
  values = client.wait_for("parameterValues");
  ASSERT_TRUE(values);
  EXPECT_EQ((*values)["parameters"][1]["value"], 0.5);
  ASSERT_TRUE(simulation_->step(2).ok());
  values = watcher.wait_for("parameterValues");
  ASSERT_TRUE(values);
  EXPECT_EQ((*values)["parameters"][0]["value"], json({0.0, 0.0, -1.5}));

  for (const json& parameter :
       {json{{"name", "gravity"}, {"value", {0, 0}}}, json{{"name", "gravity"}, {"value", "down"}},
        json{{"name", "speed"}, {"value", -1}}, json{{"name", "scene"}, {"value", "x"}},
        json{{"name", "nothing"}, {"value", 1}}, json{{"name", "paused"}}}) {
    client.send_json({{"op", "setParameters"}, {"parameters", {parameter}}});
    EXPECT_TRUE(client.wait_for("status")) << parameter;
  }
}

TEST_F(FoxgloveBridgeTest, TheGraphTellsWhoTakesWhat) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade(kWithToken, kV1), 101);
  const json advertise = *client.wait_for("advertise");
  client.send_json({{"op", "subscribeConnectionGraph"}});
  auto graph = client.wait_for("connectionGraphUpdate");
  ASSERT_TRUE(graph);
  const auto peers = [&](const char* list, const char* ids, const std::string& topic) {
    for (const json& item : (*graph)[list])
      if (item["name"] == topic) return item[ids].size();
    return size_t{0};
  };
  EXPECT_EQ(peers("publishedTopics", "publisherIds", "/tf"), 1u);
  EXPECT_EQ(peers("subscribedTopics", "subscriberIds", "/reset"), 1u);
  EXPECT_EQ(peers("subscribedTopics", "subscriberIds", "/tf"), 0u);
  EXPECT_EQ(peers("advertisedServices", "providerIds", "/pause"), 1u);
  client.send_json(subscribe(channel_of(advertise, "/tf"), 1));
  EXPECT_TRUE(eventually([&] {
    graph = client.wait_for("connectionGraphUpdate");
    return graph && peers("subscribedTopics", "subscriberIds", "/tf") == 1;
  }));
}

TEST_F(FoxgloveBridgeTest, RefusesMalformedMessagesAndGoesOn) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade(kWithToken, kV1), 101);
  for (const char* text : {"", "{", "[]", "1", "{\"op\":5}", R"({"op":"launch"})",
                           R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":[1]})",
                           R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
                           R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":1}]})",
                           R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1e300}]})",
                           R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":99999}]})",
                           R"({"op":"unsubscribe","subscriptionIds":[77]})",
                           R"({"op":"getParameters","parameterNames":"all"})",
                           R"({"op":"setParameters","parameters":[{"value":1}]})"}) {
    client.send_frame(1, text);
    EXPECT_TRUE(client.wait_for("status", 3)) << text;
  }
  for (const std::string& bytes :
       {std::string(), std::string("\xff"), std::string("\x01\x01"), std::string("\x02\0\0\0\0", 5),
        "\x02" + as_bytes(1u) + as_bytes(1u) + as_bytes(0xffffffffu) + "cdr",
        std::string("\x03\x07"), std::string("\x03\x00", 2)}) {
    client.send_frame(2, bytes);
    EXPECT_TRUE(client.wait_for("status", 3)) << bytes.size();
  }
  client.send_frame(1, std::string(200'000, '['));
  EXPECT_TRUE(client.wait_for("status", 3)) << "nested deeply";
  client.send_json({{"op", "getParameters"}, {"parameterNames", {"paused"}}});
  EXPECT_TRUE(client.wait_for("parameterValues")) << "it still answers";
  client.send_frame(1, std::string((1 << 20) + 1, ' '));
  EXPECT_TRUE(client.closed_within(5)) << "too long a message";
}

TEST_F(FoxgloveBridgeTest, GivesNoFilesAway) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", kV1), 101);
  for (const char* uri : {"file:///etc/passwd", "package://../etc/passwd", "/etc/passwd", ""}) {
    client.send_json({{"op", "fetchAsset"}, {"uri", uri}, {"requestId", 5}});
    const auto answer = client.wait_for_binary(4);
    ASSERT_TRUE(answer);
    EXPECT_EQ(number_at<uint32_t>(*answer, 0), 5u);
    EXPECT_EQ(number_at<uint8_t>(*answer, 4), 1) << uri;
  }
}

TEST_F(FoxgloveBridgeTest, GivesMeshesThatARobotNames) {
  namespace fs = std::filesystem;
  const fs::path package = own_folder() / "arm";
  fs::create_directories(package / "meshes");
  fs::create_directories(package / "urdf");
  std::ofstream(package / "package.xml") << "<package><name>arm</name></package>";
  std::ofstream(package / "meshes" / "link.stl", std::ios::binary) << tetrahedron();
  std::ofstream(package / "meshes" / "other.stl", std::ios::binary) << tetrahedron();
  std::ofstream(package / "urdf" / "arm.urdf") << R"(<robot name="arm"><link name="base">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://arm/meshes/link.stl"/></geometry></visual>
    <collision><geometry><mesh filename="package://arm/meshes/link.stl"/></geometry></collision>
    </link></robot>)";
  ASSERT_TRUE(simulation_->recompile(compile_file(package / "urdf" / "arm.urdf")).ok());
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", kV1), 101);
  const auto fetch = [&](const std::string& uri) {
    client.send_json({{"op", "fetchAsset"}, {"uri", uri}, {"requestId", 1}});
    return client.wait_for_binary(4).value_or("");
  };
  EXPECT_EQ(fetch("package://arm/meshes/link.stl").substr(4), std::string(5, '\0') + tetrahedron());
  EXPECT_EQ(fetch("package://arm/meshes/other.stl")[4], 1) << "it is not named";
  EXPECT_EQ(fetch("package://arm/meshes/../meshes/link.stl")[4], 1);
  EXPECT_EQ(fetch("package://arm/package.xml")[4], 1);
}

TEST_F(FoxgloveBridgeTest, TopicsFollowARecompile) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", kV1), 101);
  const json advertise = *client.wait_for("advertise");
  const uint64_t joints = channel_of(advertise, "/cart/joint_states");
  const uint64_t clock = channel_of(advertise, "/clock");
  ASSERT_TRUE(joints != 0 && clock != 0);
  client.send_json(subscribe(clock, 1));
  simulation_->resume();
  ASSERT_TRUE(client.wait_for_data(1));
  const std::string changed = R"(<mujoco model="other"><option timestep="0.002"/><worldbody>
    <body name="ball"><freejoint/><geom size="0.1"/></body></worldbody></mujoco>)";
  ASSERT_TRUE(simulation_->recompile(compile_text(changed)).ok());
  const auto gone = client.wait_for("unadvertise");
  ASSERT_TRUE(gone);
  bool found = false;
  for (const json& id : (*gone)["channelIds"]) found = found || id == joints;
  EXPECT_TRUE(found);
  const auto come = client.wait_for("advertise");
  ASSERT_TRUE(come);
  EXPECT_NE(channel_of(*come, "/cart/odom"), 0u) << *come;
  EXPECT_TRUE(client.wait_for_data(1)) << "what is in both Worlds goes on";
}

TEST_F(FoxgloveBridgeTest, OffersOnlyWhatTheOptionsName) {
  start({.port = 0, .topics = {"/tf*", "/eye/*/compressed"}});
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", kV1), 101);
  const json advertise = *client.wait_for("advertise");
  std::vector<std::string> topics;
  for (const json& channel : advertise["channels"]) topics.push_back(channel["topic"]);
  EXPECT_EQ(topics, (std::vector<std::string>{"/tf_static", "/tf", "/eye/image_raw/compressed"}));
}

TEST_F(FoxgloveBridgeTest, APortInUseIsAnError) {
  const auto second =
      start_foxglove({*simulation_, *operations_, nullptr, kToken}, {.port = port_});
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().kind, ErrorKind::kIo);
  EXPECT_NE(second.error().message.find("in use"), std::string::npos);
  EXPECT_FALSE(
      start_foxglove({*simulation_, *operations_, nullptr, kToken}, {.host = "nobody.example"})
          .ok());
}

TEST_F(FoxgloveBridgeTest, ManyStuckClientsHoldNobodyUp) {
  start({.port = 0, .max_clients = 70});
  std::vector<std::unique_ptr<FoxgloveClient>> stuck;
  for (int i = 0; i < 64; ++i) {
    stuck.push_back(std::make_unique<FoxgloveClient>(port_));
    if (i % 2 == 0) {  // half of them never finish their request
      stuck.back()->send_bytes("GET / HTTP/1.1\r\nHost: loc");
    } else {  // the others never read
      ASSERT_EQ(stuck.back()->upgrade("/", kV1), 101);
      const json advertise = *stuck.back()->wait_for("advertise");
      stuck.back()->send_json(subscribe(channel_of(advertise, "/eye/image_raw"), 1));
      stuck.back()->send_json(subscribe(channel_of(advertise, "/tf"), 2));
    }
  }
  simulation_->resume();
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", kV1), 101);
  client.send_json(subscribe(channel_of(*client.wait_for("advertise"), "/tf"), 1));
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(client.wait_for_data(1, 30));
  const int64_t before = simulation_->latest().step();
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_GT(simulation_->latest().step(), before) << "physics goes on";
  stuck.clear();
  EXPECT_TRUE(eventually([&] { return bridge_->stats().clients == 1; }));
}

TEST_F(FoxgloveBridgeTest, TheOwnerGetsInAmongStrangers) {
  start({.port = 0, .max_clients = 4});
  std::vector<std::unique_ptr<FoxgloveClient>> strangers;
  const auto come = [&] {
    return strangers.emplace_back(std::make_unique<FoxgloveClient>(port_)).get();
  };
  for (int i = 0; i < 4; ++i) ASSERT_EQ(come()->upgrade("/", kV1), 101);
  EXPECT_EQ(come()->upgrade("/", kV1), 503);
  for (int i = 0; i < 200; ++i) come()->send_bytes("GET / HTTP/1.1\r\nHost: loc");
  FoxgloveClient owner(port_);
  EXPECT_EQ(owner.upgrade(kWithToken, kV1), 101);
}

TEST_F(FoxgloveBridgeTest, TheEndIsToldToClients) {
  FoxgloveClient client(port_);
  ASSERT_EQ(client.upgrade("/", kV1), 101);
  client.send_json(subscribe(channel_of(*client.wait_for("advertise"), "/tf"), 1));
  simulation_->resume();
  ASSERT_TRUE(client.wait_for_data(1));
  bridge_.reset();
  EXPECT_TRUE(client.closed_within(3));
}

}  // namespace
}  // namespace gloam::bridge::foxglove

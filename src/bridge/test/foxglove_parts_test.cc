// Parts of the bridge to Foxglove alone: layouts of messages, JSON, names of meshes.

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "bridge/foxglove/assets.h"
#include "bridge/foxglove/client_messages.h"
#include "bridge/foxglove/json_message.h"
#include "bridge/foxglove/publishing.h"
#include "bridge/foxglove/server_messages.h"
#include "bridge/topic_filter.h"
#include "ros/codec.h"
#include "ros/messages/sensor_msgs.h"

namespace gloam::bridge::foxglove {
namespace {

using nlohmann::json;

TEST(FoxgloveMessages, HaveTheLayoutsOfTheSpecification) {
  const auto payload = std::make_shared<const std::vector<uint8_t>>(std::vector<uint8_t>{9, 8});
  const Frame data = message_data(0x01020304, 1.5, payload);
  EXPECT_EQ(data.head, std::string("\x01\x04\x03\x02\x01\x00\x2f\x68\x59\0\0\0\0", 13));
  EXPECT_EQ(data.body, payload);
  EXPECT_EQ(time_message(1e-9).head, std::string("\x02\x01\0\0\0\0\0\0\0", 9));
  EXPECT_EQ(service_response(1, 2, "cdr", payload).head,
            std::string("\x03\x01\0\0\0\x02\0\0\0\x03\0\0\0cdr", 16));
  EXPECT_EQ(asset_response(7, payload, "").head, std::string("\x04\x07\0\0\0\0\0\0\0\0", 10));
  EXPECT_EQ(asset_response(7, nullptr, "no").head,
            std::string("\x04\x07\0\0\0\x01\x02\0\0\0no", 12));
  EXPECT_EQ(playback_state({PlaybackStatus::kEnded, 1e-9, 1.0f, true, "r"}).head,
            std::string("\x05\x03\x01\0\0\0\0\0\0\0\0\0\x80\x3f\x01\x01\0\0\0r", 20));
  EXPECT_EQ(nanoseconds(-1), 0u);
}

TEST(FoxgloveMessages, PlaybackRequestsAreRead) {
  // As foxglove-sdk writes them: play, speed, whether it seeks, the time, the request's name.
  std::string bytes("\x03\x00\x00\x00\xc0\x3f\x01\x00\xca\x9a\x3b\0\0\0\0\x02\0\0\0id", 21);
  const auto message =
      parse_binary_message({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
  ASSERT_TRUE(message.ok()) << message.error().to_string();
  const auto& playback = std::get<PlaybackMessage>(*message);
  EXPECT_TRUE(playback.play);
  EXPECT_EQ(playback.speed, 1.5f);
  EXPECT_EQ(playback.seek, 1'000'000'000u);
  EXPECT_EQ(playback.request, "id");
  bytes[1] = 1;
  bytes[6] = 0;
  const auto pause =
      parse_binary_message({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
  ASSERT_TRUE(pause.ok());
  EXPECT_FALSE(std::get<PlaybackMessage>(*pause).play);
  EXPECT_FALSE(std::get<PlaybackMessage>(*pause).seek);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 2, &nan, sizeof nan);
  EXPECT_FALSE(
      parse_binary_message({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}).ok());
}

template <Message T>
MessageSchema schema() {
  return *MessageSchema::create(describe<T>());
}

TEST(FoxgloveJson, GoesThereAndBack) {
  sensor_msgs::JointState state;
  state.header.frame_id = "base";
  state.header.stamp = {-3, 4'000'000'000u};
  state.name = {"a", "b"};
  state.position = {0.25, -1e300};
  std::vector<uint8_t> bytes;
  encode(state, &bytes);
  const auto object = json_from_cdr(schema<sensor_msgs::JointState>(), bytes);
  ASSERT_TRUE(object.ok()) << object.error().to_string();
  EXPECT_EQ((*object)["name"], json({"a", "b"}));
  EXPECT_EQ((*object)["header"]["stamp"]["nanosec"], 4'000'000'000u);
  const auto again = cdr_from_json(schema<sensor_msgs::JointState>(), *object);
  ASSERT_TRUE(again.ok()) << again.error().to_string();
  EXPECT_EQ(*again, bytes);
  EXPECT_FALSE(json_from_cdr(schema<sensor_msgs::JointState>(), std::span(bytes).first(20)).ok());
}

TEST(FoxgloveJson, MissingFieldsHaveTheDefaultsOfTheirDefinition) {
  const auto pose = decode<geometry_msgs::PoseStamped>(
      *cdr_from_json(schema<geometry_msgs::PoseStamped>(), {{"pose", {{"position", {{"x", 1}}}}}}));
  ASSERT_TRUE(pose.ok()) << pose.error().to_string();
  EXPECT_EQ(pose->pose.orientation, (geometry_msgs::Quaternion{0, 0, 0, 1}));
  const auto part = decode<geometry_msgs::PoseStamped>(*cdr_from_json(
      schema<geometry_msgs::PoseStamped>(), {{"pose", {{"orientation", {{"x", 1}, {"w", 0}}}}}}));
  ASSERT_TRUE(part.ok());
  EXPECT_EQ(part->pose.orientation, (geometry_msgs::Quaternion{1, 0, 0, 0}));

  const auto made = MessageSchema::parse(
      "string name \"no # name\"  \nbool on true # a remark\nint8 level -3\nfloat32 share 0.5\n"
      "uint16[3] sizes [1, 2, 3]\nint32[] list [-7, 8]\nstring[] words ['a, b', \"c\"]\n"
      "uint8 plain # none\ngeometry_msgs/Quaternion[2] q\n"
      "================================================================================\n"
      "MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n",
      "test_msgs/msg/Made");
  ASSERT_TRUE(made.ok()) << made.error().to_string();
  const auto whole = json_from_cdr(*made, *cdr_from_json(*made, json::object()));
  ASSERT_TRUE(whole.ok()) << whole.error().to_string();
  const json q = {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}, {"w", 1.0}};
  EXPECT_EQ(*whole, (json{{"name", "no # name"},
                          {"on", true},
                          {"level", -3},
                          {"share", 0.5},
                          {"sizes", {1, 2, 3}},
                          {"list", {-7, 8}},
                          {"words", {"a, b", "c"}},
                          {"plain", 0},
                          {"q", {q, q}}}));
}

TEST(FoxgloveJson, WhatLacksIsZeroAndWhatIsWrongIsNamed) {
  const auto imu = schema<sensor_msgs::Imu>();
  const auto bytes = cdr_from_json(imu, {{"linear_acceleration", {{"z", 9.81}}}});
  ASSERT_TRUE(bytes.ok()) << bytes.error().to_string();
  const auto message = decode<sensor_msgs::Imu>(*bytes);
  ASSERT_TRUE(message.ok()) << message.error().to_string();
  EXPECT_EQ(message->linear_acceleration.z, 9.81);
  EXPECT_EQ(message->linear_acceleration.x, 0);

  const auto fault = [&](const json& object) {
    const auto encoded = cdr_from_json(imu, object);
    return encoded.ok() ? "" : encoded.error().message;
  };
  EXPECT_EQ(fault({{"linear_acceleration", {{"q", 1}}}}), "'linear_acceleration' has no field 'q'");
  EXPECT_EQ(fault({{"header", {{"stamp", {{"sec", 0.5}}}}}}),
            "'header.stamp.sec' must be an integer within the range of its type");
  EXPECT_EQ(fault({{"header", {{"stamp", {{"nanosec", -1}}}}}}),
            "'header.stamp.nanosec' must be an integer within the range of its type");
  EXPECT_EQ(fault({{"header", {{"frame_id", 1}}}}), "'header.frame_id' must be a string");
  EXPECT_EQ(fault({{"orientation_covariance", {1, 2}}}),
            "'orientation_covariance' must have 9 elements");
  EXPECT_EQ(fault(json::array()), "the message must be an object");
}

TEST(FoxgloveAssets, NamesAreThoseOfMeshesAlone) {
  EXPECT_EQ(
      mesh_names(R"(<robot><link><visual><geometry>
      <mesh filename="package://arm/meshes/a.stl" scale="1 1 1"/></geometry></visual>
      <collision><geometry><mesh scale='2 2 2' filename='package://arm/b.dae'/></geometry></collision>
      <mesh filename="package://arm/meshes/a.stl"/></link>
      <gazebo><plugin filename="/etc/passwd"/></gazebo><mesh filename="unclosed)"),
      (std::vector<std::string>{"package://arm/meshes/a.stl", "package://arm/b.dae", "unclosed"}));
}

TEST(FoxgloveNames, PatternsAndTypes) {
  EXPECT_TRUE(is_offered({}, "/tf"));
  EXPECT_TRUE(is_offered({"/x", "/a*c*e"}, "/abcde"));
  EXPECT_FALSE(is_offered({"/x", "/a*c*e"}, "/abcd"));
  EXPECT_TRUE(fits_topic_pattern("*", ""));
  EXPECT_EQ(full_type_name("geometry_msgs/Twist"), "geometry_msgs/msg/Twist");
  EXPECT_EQ(full_type_name("geometry_msgs/msg/Twist"), "geometry_msgs/msg/Twist");
}

TEST(FoxgloveMutations, DamagedMessagesAreRefusedOrRead) {
  const std::string texts[] = {
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":1,"channelId":5}]})",
      R"({"op":"advertise","channels":[{"id":1,"topic":"/x","encoding":"cdr","schemaName":"y"}]})",
      R"({"op":"setParameters","parameters":[{"name":"speed","value":0.5}],"id":"a"})",
      std::string("\x02\x01\0\0\0\x02\0\0\0\x03\0\0\0cdrxyz", 19)};
  const char* asked = std::getenv("GLOAM_MUTATIONS");
  const int count = asked != nullptr ? std::atoi(asked) : 200;
  uint32_t random = 12345;
  for (int i = 0; i < count; ++i) {
    std::string bytes = texts[i % 4];
    for (int k = 0; k < 3; ++k) {
      random = random * 1664525 + 1013904223;
      bytes[(random >> 8) % bytes.size()] = static_cast<char>(random >> 24);
    }
    if (i % 7 == 0) bytes.resize(random % bytes.size());
    (void)parse_text_message(bytes).ok();
    (void)parse_binary_message({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}).ok();
  }
}

}  // namespace
}  // namespace gloam::bridge::foxglove

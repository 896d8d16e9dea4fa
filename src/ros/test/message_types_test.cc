// Names, definitions and hashes of types. Hashes without another source are those that ROS's own
// generator (rosidl_generator_c, Jazzy) writes into its descriptions.

#include "ros/message_types.h"

#include <gtest/gtest.h>

#include "ros/definition_parser.h"
#include "ros/messages/all_messages.h"

namespace gloam {
namespace {

std::string hash_of(const char* name) {
  const MessageType* type = find_message_type(name);
  return type == nullptr ? "unknown" : type->hash;
}

TEST(MessageTypes, HaveTheHashesOfRos) {
  EXPECT_EQ(hash_of("builtin_interfaces/msg/Time"),
            "RIHS01_b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197");
  EXPECT_EQ(hash_of("std_msgs/msg/Header"),
            "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01");
  EXPECT_EQ(hash_of("diagnostic_msgs/msg/DiagnosticStatus"),  // a byte, constants
            "RIHS01_b0e3e692ea2d54a8af2f4ef1930e81556a2db55216b771f8a7d2724ed47bf0e4");
  EXPECT_EQ(hash_of("rmw_dds_common/msg/Gid"),  // an array of char, which is hashed as uint8
            "RIHS01_ab6f21cfbb0a6dbb837161e1110c2051a2850ed9f9c53944d7115d9bcebedf71");
  EXPECT_EQ(hash_of("rmw_dds_common/msg/NodeEntitiesInfo"),  // bounded strings
            "RIHS01_8ffef65ee2d088c63b1e8fcd31e800ba9fc8dbe0ee15ca60d1676de5218087a7");
}

// Image, Imu and Empty: rosbags 0.11.9 and the wheels of ROS Kilted.
TEST(MessageTypes, HaveTheHashesOfOthers) {
  EXPECT_EQ(hash_of("sensor_msgs/msg/Image"),
            "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47");
  EXPECT_EQ(hash_of("sensor_msgs/msg/Imu"),
            "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b");
  EXPECT_EQ(hash_of("std_msgs/msg/Empty"),
            "RIHS01_20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312");
}

// rosapi_msgs/srv/GetROSVersion as ROS's generator describes it.
TEST(MessageTypes, ServicesHaveTheHashesOfRos) {
  const std::string name = "rosapi_msgs/srv/GetROSVersion";
  const TypeDescription request = parse_ros2msg("", name + "_Request").value();
  const TypeDescription response =
      parse_ros2msg("uint8 version\nstring distro", name + "_Response").value();
  EXPECT_EQ(rihs01_hash(request),
            "RIHS01_1a13df77c875beddacb14977a11bc14651207eeef307e0b42e921464dab13190");
  EXPECT_EQ(rihs01_hash(response),
            "RIHS01_9ea00d29695d4c830228c563a386f1ad48bba313d317a3b1bdefc0d3b5e77801");
  EXPECT_EQ(service_hash(name, request, response),
            "RIHS01_526058384b92d9d5a46cadafdcdfadddc28aa53c593a1ce174bdc36e714cb097");
}

TEST(MessageTypes, HaveTheNamesOfRosAndDds) {
  const MessageType& type = message_type<sensor_msgs::Imu>();
  EXPECT_EQ(type.name, "sensor_msgs/msg/Imu");
  EXPECT_EQ(type.dds_name, "sensor_msgs::msg::dds_::Imu_");
  EXPECT_EQ(message_type<std_srvs::srv::Trigger_Request>().dds_name,
            "std_srvs::srv::dds_::Trigger_Request_");
  EXPECT_EQ(find_message_type("sensor_msgs/msg/Nothing"), nullptr);
}

TEST(MessageTypes, HaveTheirDefinitionsAsTextWithAllParts) {
  EXPECT_EQ(message_type<sensor_msgs::Range>().text,
            "uint8 ULTRASOUND=0\n"
            "uint8 INFRARED=1\n"
            "std_msgs/Header header\n"
            "uint8 radiation_type\n"
            "float32 field_of_view\n"
            "float32 min_range\n"
            "float32 max_range\n"
            "float32 range\n"
            "float32 variance\n"
            "================================================================================\n"
            "MSG: std_msgs/Header\n"
            "builtin_interfaces/Time stamp\n"
            "string frame_id\n"
            "================================================================================\n"
            "MSG: builtin_interfaces/Time\n"
            "int32 sec\n"
            "uint32 nanosec\n");
  EXPECT_EQ(message_type<rmw_dds_common::Gid>().text, "char[16] data\n");
  EXPECT_TRUE(message_type<rmw_dds_common::NodeEntitiesInfo>().text.starts_with(
      "string<=256 node_namespace\nstring<=256 node_name\nrmw_dds_common/Gid[] reader_gid_seq\n"));
  EXPECT_EQ(message_type<std_msgs::Empty>().text, "");
}

// A text says what the struct says: read back it gives the text and the hash again.
TEST(MessageTypes, AreReadBackFromTheirTexts) {
  ASSERT_GE(message_types().size(), 198u);
  for (const MessageType& type : message_types()) {
    const Result<TypeDescription> read = parse_ros2msg(type.text, type.name);
    ASSERT_TRUE(read.ok()) << type.name << ": " << read.error().to_string();
    EXPECT_EQ(rihs01_hash(*read), type.hash) << type.name;
    EXPECT_EQ(ros2msg_text(*read), type.text) << type.name;
  }
}

// Names, types and order enter the hash, constants do not.
TEST(MessageTypes, HashesFollowFieldsAlone) {
  const auto hash = [](const char* text) {
    return rihs01_hash(parse_ros2msg(text, "a_msgs/msg/A").value());
  };
  const std::string base = hash("int32 a\nint32 b");
  EXPECT_EQ(hash("# a remark\nint32 C=5\nint32 a 7 # its default\nint32 b\n"), base);
  EXPECT_NE(hash("int32 b\nint32 a"), base);
  EXPECT_NE(hash("int32 a\nint32 c"), base);
  EXPECT_NE(hash("int32 a\nuint32 b"), base);
  EXPECT_NE(hash("int32 a\nint32[] b"), base);
}

}  // namespace
}  // namespace gloam

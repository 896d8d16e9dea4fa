// Messages read by their definition as text, and what is refused of such a text.

#include "ros/dynamic_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/test/mutator.h"
#include "ros/codec.h"
#include "ros/definition_parser.h"
#include "ros/message_types.h"
#include "ros/messages/all_messages.h"

namespace gloam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

template <Message T>
struct Encoded {
  explicit Encoded(const T& message) {
    encode(message, &bytes);
    schema = MessageSchema::parse(message_type<T>().text, message_type<T>().name).value();
  }
  DynamicMessage open() const { return DynamicMessage::open(schema, bytes).value(); }
  std::vector<uint8_t> bytes;
  MessageSchema schema;
};

template <class T>
std::string error_of(const Result<T>& result) {
  return result.ok() ? "" : result.error().to_string();
}

nav_msgs::Odometry odometry() {
  nav_msgs::Odometry odometry{.header = {{12, 500'000'000}, "odom"}, .child_frame_id = "base"};
  odometry.pose.pose.position = {1.5, -2, 3};
  odometry.pose.pose.orientation = {0.5, 0.5, 0.5, 0.5};
  odometry.pose.covariance[35] = 0.25;
  odometry.twist.twist.angular.z = 7;
  return odometry;
}

TEST(DynamicMessage, FindsFieldsByPath) {
  const Encoded encoded(odometry());
  const DynamicMessage message = encoded.open();
  EXPECT_EQ(message.number("pose.pose.position.x").value(), 1.5);
  EXPECT_EQ(message.number("twist.twist.angular.z").value(), 7);
  EXPECT_EQ(message.number("pose.covariance[35]").value(), 0.25);
  EXPECT_EQ(message.integer("header.stamp.nanosec").value(), 500'000'000);
  EXPECT_EQ(message.text("header.frame_id").value(), "odom");
  EXPECT_EQ(message.text("child_frame_id").value(), "base");
  EXPECT_THAT(message.numbers("pose.pose").value(), ElementsAre(1.5, -2, 3, 0.5, 0.5, 0.5, 0.5));
  EXPECT_EQ(message.numbers("pose.covariance").value().size(), 36u);
  EXPECT_EQ(message.count("pose.covariance").value(), 36u);
}

TEST(DynamicMessage, ReadsArraysOfMessagesStringsAndBytes) {
  tf2_msgs::TFMessage tf;
  for (int i = 0; i < 3; ++i) {
    tf.transforms.push_back({.child_frame_id = std::string(size_t(i) + 1, 'f')});
    tf.transforms.back().transform.translation.y = i * 10;
  }
  const Encoded encoded_tf(tf);
  EXPECT_EQ(encoded_tf.open().count("transforms").value(), 3u);
  EXPECT_EQ(encoded_tf.open().text("transforms[2].child_frame_id").value(), "fff");
  EXPECT_EQ(encoded_tf.open().number("transforms[1].transform.translation.y").value(), 10);

  const Encoded joints(
      sensor_msgs::JointState{.name = {"hip", "knee"}, .position = {0.25, -1}, .effort = {3, 4}});
  EXPECT_THAT(joints.open().texts("name").value(), ElementsAre("hip", "knee"));
  EXPECT_EQ(joints.open().text("name[1]").value(), "knee");
  EXPECT_THAT(joints.open().numbers("position").value(), ElementsAre(0.25, -1));
  EXPECT_THAT(joints.open().numbers("velocity").value(), ElementsAre());
  EXPECT_THAT(joints.open().numbers("effort").value(), ElementsAre(3, 4));

  const Encoded image(sensor_msgs::Image{.width = 3, .data = std::vector<uint8_t>{7, 8, 9}});
  const std::span<const uint8_t> data = image.open().bytes("data").value();
  EXPECT_THAT(std::vector(data.begin(), data.end()), ElementsAre(7, 8, 9));
  EXPECT_EQ(data.data(), image.bytes.data() + image.bytes.size() - 3) << "copied";
}

TEST(DynamicMessage, SaysWhatIsWrongWithAPath) {
  const Encoded encoded(odometry());
  const DynamicMessage message = encoded.open();
  EXPECT_THAT(error_of(message.number("pose.pose.positon.x")),
              AllOf(HasSubstr("no field 'positon'"), HasSubstr("did you mean 'position'?")));
  EXPECT_THAT(error_of(message.number("pose.covariance[36]")),
              HasSubstr("'covariance' has 36 elements, so index 36 is out of range"));
  EXPECT_THAT(error_of(message.number("pose.pose")), HasSubstr("is geometry_msgs/msg/Pose"));
  EXPECT_THAT(error_of(message.number("child_frame_id")), HasSubstr("is string, not a number"));
  EXPECT_THAT(error_of(message.number("pose.covariance")), HasSubstr("float64[], not a number"));
  EXPECT_THAT(error_of(message.text("header.stamp")), HasSubstr("not a string"));
  EXPECT_THAT(error_of(message.integer("pose.pose.position.x")), HasSubstr("not an integer"));
  EXPECT_THAT(error_of(message.numbers("header")), HasSubstr("not a list of numbers"));
  EXPECT_THAT(error_of(message.bytes("pose.covariance")), HasSubstr("not an array of bytes"));
  EXPECT_THAT(error_of(message.number("child_frame_id[0]")), HasSubstr("is not an array"));
  for (const char* path : {"", ".", "pose..x", "pose.covariance[", "pose.covariance[1", "[0]",
                           "pose.covariance[-1]", "pose.covariance[1]x", "child_frame_id.x"}) {
    EXPECT_FALSE(message.number(path).ok()) << path;
  }
}

TEST(DynamicMessage, ReadsEveryPrimitiveOfBothByteOrders) {
  const MessageSchema schema =
      MessageSchema::parse("int8 a\nuint16 b\nint32 c\nuint64 d\nfloat32 e\nbool f\nbyte g\nchar h",
                           "a/B")
          .value();
  // a = -1, b = 256, c = -2, d = 2^63, e = 1, f = true, g = 9, h = 'A'
  const std::vector<uint8_t> big = {0,    0,    0,    0,    0xff, 0, 1, 0, 0xff,
                                    0xff, 0xff, 0xfe, 0x80, 0,    0, 0, 0, 0,
                                    0,    0,    0x3f, 0x80, 0,    0, 1, 9, 65};
  const std::vector<uint8_t> little = {0, 1, 0, 0, 0xff, 0,    0, 1, 0xfe, 0xff, 0xff, 0xff, 0, 0,
                                       0, 0, 0, 0, 0,    0x80, 0, 0, 0x80, 0x3f, 1,    9,    65};
  for (const std::vector<uint8_t>& bytes : {big, little}) {
    const Result<DynamicMessage> message = DynamicMessage::open(schema, bytes);
    ASSERT_TRUE(message.ok()) << message.error().to_string();
    EXPECT_EQ(message->number("a").value(), -1);
    EXPECT_EQ(message->integer("b").value(), 256);
    EXPECT_EQ(message->integer("c").value(), -2);
    EXPECT_EQ(message->number("d").value(), 0x1p63);
    EXPECT_THAT(error_of(message->integer("d")), HasSubstr("below 2^63"));
    EXPECT_EQ(message->number("e").value(), 1);
    EXPECT_EQ(message->integer("f").value(), 1);
    EXPECT_EQ(message->integer("g").value(), 9);
    EXPECT_EQ(message->integer("h").value(), 65);
  }
}

std::string definition_error(const char* text) {
  return error_of(MessageSchema::parse(text, "a_msgs/msg/A"));
}

TEST(Definition, IsReadWithRemarksDefaultsAndConstants) {
  const MessageSchema schema =
      MessageSchema::parse(
          "# remark\r\n\r\nstring NAME= a # b \nfloat64[<=3] x [1, 2] # more\n"
          "  string<=10[] y\nB[2] z\nstring s \"a=b\"\n=====\nMSG: a_msgs/B\nHeader h\n"
          "===\nMSG: std_msgs/Header\nint8 q",
          "a_msgs/msg/A")
          .value();
  const MessageDescription& a = schema.type().messages[0];
  ASSERT_EQ(a.constants.size(), 1u);
  EXPECT_EQ(a.constants[0].value, "a # b");
  EXPECT_THAT(ros2msg_text(schema.type()),
              StartsWith("string NAME=a # b\nfloat64[<=3] x [1, 2]\nstring<=10[] y\na_msgs/B[2] z\n"
                         "string s \"a=b\"\n======="));
  EXPECT_EQ(schema.type().messages[1].fields[0].type.message, "std_msgs/msg/Header");
}

TEST(Definition, ErrorsNameTheLine) {
  EXPECT_THAT(definition_error("int32 a\n\nint32"),
              HasSubstr("a_msgs/msg/A:3: 'int32' is not a field"));
  EXPECT_THAT(definition_error("int32 a\nB b"),
              HasSubstr("A:2: field 'b' of a_msgs/msg/A: a_msgs/msg/B is not defined"));
  EXPECT_THAT(definition_error("int32 a\nint8 a"), HasSubstr("A:2: field 'a' is defined twice"));
  EXPECT_THAT(definition_error("int32[0] a"), HasSubstr("A:1: '0' is not an array size"));
  EXPECT_THAT(definition_error("int32[99999999999] a"), HasSubstr("is not an array size"));
  EXPECT_THAT(definition_error("int32[3 a"), HasSubstr("']' is missing"));
  EXPECT_THAT(definition_error("string<= a"), HasSubstr("is not an array size"));
  EXPECT_THAT(definition_error("wstring a"), HasSubstr("A:1: type wstring is not supported"));
  EXPECT_THAT(definition_error("time a"), HasSubstr("ROS 1"));
  EXPECT_THAT(definition_error("in/ a"), HasSubstr("'in/' is not a type"));
  EXPECT_THAT(definition_error("===\n"), HasSubstr("name of a message is missing"));
  EXPECT_THAT(definition_error("===\nIDL: a/B\n"), HasSubstr("IDL definitions are not supported"));
  EXPECT_THAT(definition_error("===\nMSG: a/B\n===\nMSG: a/msg/B"),
              HasSubstr("A:4: a/msg/B is defined twice"));
  EXPECT_THAT(error_of(MessageSchema::parse("", "A")), HasSubstr("'A' is not a message name"));
}

TEST(Definition, RefusesEndlessAndVeryDeepTypes) {
  EXPECT_THAT(definition_error("A a"), HasSubstr("contains itself"));
  EXPECT_THAT(definition_error("B[] b\n===\nMSG: a_msgs/B\nA a"), HasSubstr("A:4: "));
  const auto chain = [](int levels) {
    std::string text = "M1 m";
    for (int i = 1; i < levels; ++i) {
      text += "\n===\nMSG: a_msgs/M" + std::to_string(i);
      text += i + 1 < levels ? "\nM" + std::to_string(i + 1) + " m" : "\nint8 x";
    }
    return text;
  };
  EXPECT_EQ(definition_error(chain(32).c_str()), "");
  EXPECT_THAT(definition_error(chain(33).c_str()), HasSubstr("nested too deeply"));
}

// A type of 10^30 elements in a text of a few lines: the bytes end the walk, not the type.
TEST(Definition, HugeTypesCostNothing) {
  std::string text = "B1[1000000000] b";
  for (int i = 1; i < 30; ++i) {
    text += "\n===\nMSG: a_msgs/B" + std::to_string(i) + "\n";
    text += i < 29 ? "B" + std::to_string(i + 1) + "[1000000000] b" : "int8 x";
  }
  const MessageSchema schema = MessageSchema::parse(text, "a_msgs/msg/A").value();
  EXPECT_THAT(error_of(DynamicMessage::open(schema, std::vector<uint8_t>{0, 1, 0, 0, 1, 2, 3})),
              HasSubstr("the message is truncated"));
}

TEST(Mutations, DefinitionsDoNoHarm) {
  size_t read = 0;
  std::vector<uint8_t> bytes;
  encode(odometry(), &bytes);
  for (size_t i = 0; i < mutation_count(); ++i) {
    const MessageType& seed = message_types()[i % message_types().size()];
    const std::string text = Mutator(i).mutate(seed.text);
    const Result<MessageSchema> schema = MessageSchema::parse(text, seed.name);
    if (!schema.ok()) {
      ASSERT_TRUE(schema.error().to_string().starts_with(seed.name)) << schema.error().to_string();
      continue;
    }
    ++read;
    // What was read is what is written: a fixed point after the first time.
    const std::string once = ros2msg_text(schema->type());
    const Result<TypeDescription> again = parse_ros2msg(once, seed.name);
    ASSERT_TRUE(again.ok()) << again.error().to_string() << "\n" << once;
    ASSERT_EQ(ros2msg_text(*again), once);
    (void)DynamicMessage::open(*schema, bytes).ok();
  }
  if (mutation_count() >= 200) {
    EXPECT_GT(read, mutation_count() / 20);
  }
}

}  // namespace
}  // namespace gloam

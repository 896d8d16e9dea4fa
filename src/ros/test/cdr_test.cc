// Messages as bytes: layouts worked out by hand, both byte orders, what readers refuse.

#include "ros/cdr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ros/codec.h"
#include "ros/messages/rmw_dds_common.h"
#include "ros/messages/sensor_msgs.h"
#include "ros/messages/std_srvs.h"

namespace gloam {
namespace cdr_test {

inline constexpr std::string_view kPackage = "cdr_test/msg";

struct Padded {
  uint8_t a = 0;
  double b = 0;
  int16_t c = 0;
  std::string d;
  std::vector<double> e;
  bool f = false;
  std::array<uint32_t, 2> g = {};
  GLOAM_MESSAGE(Padded, a, b, c, d, e, f, g)
};

}  // namespace cdr_test

namespace {

using testing::AllOf;
using testing::ElementsAreArray;
using testing::HasSubstr;
using Buffer = std::vector<uint8_t>;

template <class T>
Buffer encoded(const T& message) {
  Buffer bytes;
  encode(message, &bytes);
  return bytes;
}

template <class T>
std::string decode_error(const Buffer& bytes) {
  const Result<T> message = decode<T>(bytes);
  return message.ok() ? "" : message.error().to_string();
}

const Buffer kHeader = {0, 1, 0, 0, 5, 0, 0, 0, 7, 0, 0, 0, 3, 0, 0, 0, 'a', 'b', 0};

TEST(Cdr, WritesStringsWithTheirZero) {
  EXPECT_EQ(encoded(std_msgs::Header{{5, 7}, "ab"}), kHeader);
}

// Alignment is counted from the end of the head, strings and counts to four, doubles to eight.
TEST(Cdr, AlignsEachPrimitiveToItsSize) {
  const cdr_test::Padded message{1, 1.0, -2, "xyz", {2.0}, true, {3, 4}};
  const Buffer expected = {0,    1,    0, 0,                        // head
                           1,    0,    0, 0, 0,   0,   0,    0,     // a, padding to 8
                           0,    0,    0, 0, 0,   0,   0xf0, 0x3f,  // b = 1.0
                           0xfe, 0xff, 0, 0,                        // c, padding to 20
                           4,    0,    0, 0, 'x', 'y', 'z',  0,     // d to 28
                           1,    0,    0, 0,                        // count of e to 32, no padding
                           0,    0,    0, 0, 0,   0,   0,    0x40,  // e[0] = 2.0 to 40
                           1,    0,    0, 0, 3,   0,   0,    0,    4, 0, 0, 0};  // f, padding, g
  EXPECT_EQ(encoded(message), expected);
  const auto decoded = decode<cdr_test::Padded>(expected);
  ASSERT_TRUE(decoded.ok());
  EXPECT_EQ(*decoded, message);
}

TEST(Cdr, EmptySequencesOfDoublesAreNotPadded) {
  EXPECT_EQ(encoded(std_msgs::Float64MultiArray{}),
            (Buffer{0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(Cdr, EmptyMessagesTakeAByte) {
  EXPECT_EQ(encoded(std_srvs::srv::Trigger_Request{}), (Buffer{0, 1, 0, 0, 0}));
  EXPECT_TRUE(decode<std_srvs::srv::Trigger_Request>(Buffer{0, 1, 0, 0, 0}).ok());
  EXPECT_FALSE(decode<std_srvs::srv::Trigger_Request>(Buffer{0, 1, 0, 0}).ok());
}

TEST(Cdr, ReadsBigEndian) {
  const Buffer bytes = {0,    0,    0, 0,                              // head
                        9,    0,    0, 0, 0,    0, 0, 0,               // a
                        0x3f, 0xf0, 0, 0, 0,    0, 0, 0,               // b
                        0xff, 0xfe, 0, 0,                              // c
                        0,    0,    0, 2, 'x',  0, 0, 0,               // d
                        0,    0,    0, 1, 0x40, 0, 0, 0, 0, 0, 0, 0,   // e
                        1,    0,    0, 0, 0,    0, 0, 3, 0, 0, 0, 4};  // f, g
  const auto message = decode<cdr_test::Padded>(bytes);
  ASSERT_TRUE(message.ok()) << message.error().to_string();
  EXPECT_EQ(*message, (cdr_test::Padded{9, 1.0, -2, "x", {2.0}, true, {3, 4}}));
}

TEST(Cdr, BuffersAreUsedAgain) {
  Buffer bytes;
  const sensor_msgs::Image image{
      .height = 2, .width = 3, .encoding = "rgb8", .step = 9, .data = Buffer(18, 7)};
  encode(image, &bytes);
  const uint8_t* where = bytes.data();
  const Buffer first = bytes;
  encode(image, &bytes);
  EXPECT_EQ(bytes, first);
  EXPECT_EQ(bytes.data(), where) << "allocated again";
}

// A log puts its own head before a message; alignment is the message's.
TEST(Cdr, AppendsToWhatIsThere) {
  Buffer bytes = {1, 2, 3};
  const cdr_test::Padded message{1, 1.0, -2, "xyz", {2.0}, true, {3, 4}};
  append_encoded(message, &bytes);
  EXPECT_THAT(std::span(bytes).subspan(3), ElementsAreArray(encoded(message)));
}

TEST(Cdr, ViewsAreEncodedAsTheBytesTheyShow) {
  const Buffer pixels(12, 200);
  sensor_msgs::Image view{.data = Bytes::view(pixels)}, own{.data = pixels};
  EXPECT_EQ(encoded(view), encoded(own));
  EXPECT_EQ(view, own);
  EXPECT_EQ(view.data.span().data(), pixels.data()) << "copied";
}

TEST(Cdr, RefusesOtherHeads) {
  EXPECT_THAT(decode_error<std_msgs::Header>({}), HasSubstr("shorter than the header"));
  for (const Buffer& head : {Buffer{0, 2}, Buffer{0, 3}, Buffer{0, 7}, Buffer{1, 1}}) {
    Buffer bytes = kHeader;
    std::ranges::copy(head, bytes.begin());
    EXPECT_THAT(decode_error<std_msgs::Header>(bytes), HasSubstr("not a plain CDR header"));
  }
}

TEST(Cdr, NamesTheFieldThatIsDamaged) {
  Buffer bytes = kHeader;
  bytes.resize(10);
  EXPECT_THAT(decode_error<std_msgs::Header>(bytes),
              AllOf(HasSubstr("std_msgs/msg/Header"), HasSubstr("byte 8 in stamp.nanosec"),
                    HasSubstr("the message is truncated")));
}

TEST(Cdr, RefusesWhatIsNoString) {
  Buffer bytes = kHeader;
  bytes.back() = 'c';
  EXPECT_THAT(decode_error<std_msgs::Header>(bytes), HasSubstr("is not zero-terminated"));
  bytes = kHeader;
  bytes[12] = 0;  // without its zero, as some write
  bytes.resize(16);
  EXPECT_EQ(decode_error<std_msgs::Header>(bytes), "");
}

TEST(Cdr, RefusesBoolsThatAreNone) {
  EXPECT_THAT(decode_error<std_msgs::Bool>({0, 1, 0, 0, 2}), HasSubstr("neither 0 nor 1"));
}

TEST(Cdr, RefusesStringsOverTheirBound) {
  rmw_dds_common::NodeEntitiesInfo node{.node_namespace = "/"};
  node.node_name = std::string(256, 'n');
  Buffer bytes = encoded(node);
  EXPECT_EQ(decode_error<rmw_dds_common::NodeEntitiesInfo>(bytes), "");
  // The same bytes with a string of 257: the length is at 4 + 8, then one character more.
  bytes[12] = 2, bytes[13] = 1;
  bytes.insert(bytes.begin() + 16, 'n');
  EXPECT_THAT(decode_error<rmw_dds_common::NodeEntitiesInfo>(bytes),
              AllOf(HasSubstr("257 characters"), HasSubstr("in node_name")));
}

TEST(CdrDeathTest, WritesNoStringOverItsBound) {
  rmw_dds_common::NodeEntitiesInfo node;
  node.node_name = std::string(257, 'n');
  EXPECT_DEATH(encoded(node), "exceeds its bound");
}

TEST(Cdr, BytesLeftOverMeanAnotherType) {
  Buffer bytes = kHeader;
  bytes.resize(bytes.size() + 3);  // padding of some writers
  EXPECT_EQ(decode_error<std_msgs::Header>(bytes), "");
  bytes.push_back(0);
  EXPECT_THAT(decode_error<std_msgs::Header>(bytes),
              HasSubstr("unread bytes after the end of the message"));
}

// Counts of what cannot be there are refused before memory is asked for.
TEST(Cdr, ClaimsAloneTakeNoMemory) {
  const Buffer claim = {0, 1, 0, 0, 0, 0, 0,    0,    0,    0,    0, 0, 1, 0,
                        0, 0, 0, 0, 0, 0, 0xff, 0xff, 0xff, 0xff, 0, 0, 0, 0};
  EXPECT_THAT(decode_error<sensor_msgs::JointState>(claim),
              AllOf(HasSubstr("4294967295 elements do not fit into the remaining 4 bytes"),
                    HasSubstr("in name")));
  EXPECT_THAT(decode_error<std_msgs::String>({0, 1, 0, 0, 0xff, 0xff, 0xff, 0x7f, 'a', 0}),
              HasSubstr("do not fit"));
}

}  // namespace
}  // namespace gloam

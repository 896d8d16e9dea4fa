// Events of a gamepad, and a device that comes and goes.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/joystick.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "teleop/gamepad.h"

namespace gloam::teleop {
namespace {

constexpr unsigned char kAxis = JS_EVENT_AXIS, kButton = JS_EVENT_BUTTON, kInitial = JS_EVENT_INIT;

std::vector<unsigned char> event(unsigned char type, unsigned char number, int16_t value) {
  const js_event event{.time = 1, .value = value, .type = type, .number = number};
  std::vector<unsigned char> bytes(sizeof event);
  std::memcpy(bytes.data(), &event, sizeof event);
  return bytes;
}

TEST(GamepadEvents, SticksDeflectWithADeadZone) {
  GamepadEvents pad;
  EXPECT_FALSE(pad.is_alive());
  pad.feed(event(kAxis | kInitial, 1, 0));
  EXPECT_TRUE(pad.is_alive());
  EXPECT_TRUE(pad.deflection().is_zero());
  pad.feed(event(kAxis, 1, -32767));
  EXPECT_EQ(pad.deflection(), (Deflection{.forward = 1})) << "up is negative";
  pad.feed(event(kAxis, 1, 3276));
  EXPECT_TRUE(pad.deflection().is_zero()) << "below a tenth of the travel";
  pad.feed(event(kAxis, 1, -18022));  // 0.55 of the travel: in the middle beyond the dead zone
  EXPECT_NEAR(pad.deflection().forward, 0.5, 1e-3);
  pad.feed(event(kAxis, 1, -32768));
  EXPECT_EQ(pad.deflection().forward, 1);
}

TEST(GamepadEvents, AxesAreXpads) {
  struct Row {
    unsigned char axis;
    Deflection expected;
  };
  for (const Row& row : {Row{0, {.left = -1}}, Row{1, {.forward = -1}}, Row{3, {.turn = -1}},
                         Row{4, {.up = -1}}, Row{6, {.roll = 1}}, Row{7, {.pitch = 1}}}) {
    GamepadEvents pad;
    pad.feed(event(kAxis, row.axis, 32767));
    EXPECT_EQ(pad.deflection(), row.expected) << int{row.axis};
  }
}

TEST(GamepadEvents, TriggersMoveTheGripperOncePerPull) {
  GamepadEvents pad;
  pad.feed(event(kAxis | kInitial, 5, 0));  // xpad's before the first movement
  pad.feed(event(kAxis, 5, -32767));
  EXPECT_TRUE(pad.take_requests().empty());
  for (const int16_t value : {-10000, 10000, 20000, 32767, 30000, 32767})
    pad.feed(event(kAxis, 5, value));
  EXPECT_EQ(pad.take_requests(), std::vector{Request::kGripperClose});
  pad.feed(event(kAxis, 2, 32767));
  EXPECT_EQ(pad.take_requests(), std::vector{Request::kGripperOpen});
}

TEST(GamepadEvents, TheStopButtonHoldsUntilTheSticksAreCentred) {
  GamepadEvents pad;
  pad.feed(event(kAxis, 1, -32767));
  pad.feed(event(kButton, 1, 1));
  EXPECT_EQ(pad.take_requests(), std::vector{Request::kStop});
  EXPECT_TRUE(pad.deflection().is_zero());
  pad.feed(event(kAxis, 1, -20000));
  EXPECT_TRUE(pad.deflection().is_zero());
  pad.feed(event(kAxis, 1, 0));
  pad.feed(event(kAxis, 1, -32767));
  EXPECT_EQ(pad.deflection().forward, 1);
}

TEST(GamepadEvents, ButtonsThatAreDownAtTheStartDoNothing) {
  GamepadEvents pad;
  pad.feed(event(kButton | kInitial, 0, 1));
  EXPECT_TRUE(pad.take_requests().empty());
  pad.feed(event(kButton, 0, 0));
  EXPECT_TRUE(pad.take_requests().empty());
  pad.feed(event(kButton, 0, 1));
  EXPECT_EQ(pad.take_requests(), std::vector{Request::kGripper});
}

TEST(GamepadEvents, EventsInPiecesAreRead) {
  GamepadEvents pad;
  const std::vector<unsigned char> bytes = event(kAxis, 1, -32767);
  for (size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_TRUE(pad.deflection().is_zero()) << i;
    pad.feed({&bytes[i], 1});
  }
  EXPECT_EQ(pad.deflection().forward, 1);
}

TEST(GamepadEvents, UnknownTypesAxesAndButtonsAreIgnored) {
  GamepadEvents pad;
  pad.feed(event(0, 0, 32767));
  pad.feed(event(0x7f, 0, 32767));
  EXPECT_FALSE(pad.is_alive());
  pad.feed(event(kAxis, 255, 32767));
  pad.feed(event(kButton, 255, 1));
  pad.feed(event(kButton, 1, 77));
  EXPECT_TRUE(pad.deflection().is_zero());
  EXPECT_TRUE(pad.take_requests().empty());
}

TEST(GamepadEvents, AnyBytesAreHarmless) {
  std::mt19937 random(1);
  GamepadEvents pad;
  for (int i = 0; i < 20000; ++i) {
    std::vector<unsigned char> bytes(random() % 40);
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random());
    pad.feed(bytes);
    for (const auto axis : kAxes) {
      const double value = pad.deflection().*axis;
      ASSERT_TRUE(value >= -1 && value <= 1);
    }
  }
  EXPECT_LE(pad.take_requests().size(), 64U);
}

class GamepadDevice : public testing::Test {
 protected:
  void SetUp() override {
    const auto pattern = (std::filesystem::temp_directory_path() / "gloam_pad_XXXXXX").string();
    folder_ = pattern;
    ASSERT_NE(::mkdtemp(folder_.data()), nullptr);
    path_ = folder_ + "/pad";
    ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  static void write(int pad, const std::vector<unsigned char>& bytes) {
    ASSERT_EQ(::write(pad, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

  std::string folder_, path_;
};

TEST_F(GamepadDevice, StopsWhenItIsUnpluggedAndResumes) {
  Gamepad gamepad(path_);
  ASSERT_TRUE(gamepad.open().ok());
  EXPECT_FALSE(gamepad.take_notice()) << "nothing is plugged in";
  for (int round = 0; round < 2; ++round) {
    const int pad = ::open(path_.c_str(), O_WRONLY);
    ASSERT_GE(pad, 0);
    write(pad, event(kAxis, 1, -32767));
    gamepad.read();
    EXPECT_EQ(gamepad.deflection().forward, 1);
    EXPECT_NE(gamepad.take_notice().value_or("").find(path_), std::string::npos);
    EXPECT_FALSE(gamepad.take_notice());
    write(pad, {1, 2, 3});  // half an event, then it is unplugged
    ::close(pad);
    gamepad.read();
    gamepad.read();
    EXPECT_TRUE(gamepad.deflection().is_zero());
    EXPECT_EQ(gamepad.descriptor(), -1);
    EXPECT_NE(gamepad.take_notice().value_or("").find("unplugged"), std::string::npos);
    gamepad.reopen(Clock::now() + std::chrono::seconds(2 * round));
    EXPECT_GE(gamepad.descriptor(), 0);
  }
}

TEST_F(GamepadDevice, RejectsOtherDevicesAndFiles) {
  const std::string file = folder_ + "/file";
  std::ofstream(file) << "text";
  for (const std::string& device :
       {file, std::string("/dev/zero"), std::string("/dev/null"), folder_, folder_ + "/missing"}) {
    const Status status = Gamepad(device).open();
    ASSERT_FALSE(status.ok()) << device;
    EXPECT_NE(status.error().message.find(device), std::string::npos);
    EXPECT_NE(status.error().hint.find("/dev/input/js0"), std::string::npos);
  }
}

}  // namespace
}  // namespace gloam::teleop

#include "studio/messages.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "base/test/source_dir.h"
#include "studio/replies.h"

namespace gloam::studio {
namespace {

TEST(Messages, ValuesAreRead) {
  const auto read = []<class T>(const char* text, T) { return std::get<T>(*parse_message(text)); };
  EXPECT_EQ(read(R"({"type":"step","count":7})", StepMessage{}).count, 7);
  EXPECT_EQ(read(R"({"type":"speed","value":0.25})", SpeedMessage{}).value, 0.25);
  EXPECT_EQ(read(R"({"type":"camera","name":"robot/head"})", CameraMessage{}).name, "robot/head");
  EXPECT_EQ(read(R"({"type":"orbit","dx":0.5,"dy":-1})", OrbitMessage{}).dy, -1);
  EXPECT_EQ(read(R"({"type":"drag_move","u":5,"v":6})", DragMoveMessage{}).v, 6);
  EXPECT_FALSE(read(R"({"type":"drag_start","u":3,"v":4})", DragStartMessage{}).turn);
  EXPECT_TRUE(read(R"({"type":"drag_start","u":3,"v":4,"turn":true})", DragStartMessage{}).turn);
  const auto joint =
      read(R"({"type":"set_joint","joint":2,"qpos":[1,0,0,0.5]})", SetJointMessage{});
  EXPECT_EQ(joint.joint, 2);
  EXPECT_EQ(joint.qpos, (std::vector<double>{1, 0, 0, 0.5}));
  const auto watch = read(R"({"type":"watch","fields":["xpos","ctrl"],"rate":5})", WatchMessage{});
  EXPECT_EQ(watch.fields, (std::vector<std::string>{"xpos", "ctrl"}));
  EXPECT_EQ(watch.rate, 5);
}

TEST(Messages, WrongOnesAreRefusedInPlainWords) {
  const std::pair<std::string, const char*> cases[] = {
      {"", "not JSON"},
      {"{", "not JSON"},
      {"{\"type\":\"pause\"} x", "not JSON"},
      {"\"pause\"", "must be an object"},
      {"[]", "must be an object"},
      {"{}", "must be an object"},
      {R"({"type":3})", "must be an object"},
      {R"({"type":"explode"})", "unknown type"},
      {R"({"type":"pause","now":true})", "key"},
      {R"({"type":"step"})", "'count' must be a number"},
      {R"({"type":"step","count":0})", "out of range"},
      {R"({"type":"step","count":101})", "out of range"},
      {R"({"type":"step","count":1.5})", "an integer"},
      {R"({"type":"step","count":"1"})", "must be a number"},
      {R"({"type":"speed","value":0})", "out of range"},
      {R"({"type":"seek","time":-1})", "out of range"},
      {R"({"type":"seek"})", "must be a number"},
      {R"({"type":"speed","value":-1})", "out of range"},
      {R"({"type":"speed","value":1e400})", "not JSON"},
      {R"({"type":"speed","value":null})", "must be a number"},
      {R"({"type":"camera","name":4})", "must be a string"},
      {R"({"type":"camera","name":")" + std::string(2000, 'x') + "\"}", "too long"},
      {R"({"type":"pick","u":1})", "'v' must be a number"},
      {"{\"type\":\"camera\",\"name\":\"\xff\"}", "not JSON"},
      {R"({"type":"set_joint","joint":-1,"qpos":[]})", "'joint' is out of range"},
      {R"({"type":"set_joint","joint":0,"qpos":0})", "'qpos' must be a list"},
      {R"({"type":"set_joint","joint":0,"qpos":["a"]})", "a list of numbers"},
      {R"({"type":"set_joint","joint":0,"qpos":[1e11]})", "out of range"},
      {R"({"type":"set_joint","joint":0,"qpos":[0,0,0,0,0,0,0,0]})", "too many items"},
      {R"({"type":"set_equality","equality":0,"active":1})", "true or false"},
      {R"({"type":"watch","fields":["qpos"],"rate":1000})", "'rate' is out of range"},
      {R"({"type":"watch","fields":[1],"rate":1})", "a list of strings"},
      {R"({"type":"get","id":0,"fields":[]})", "'id' is out of range"},
      {R"({"type":"drag_start","u":1,"v":1,"turn":"yes"})", "true or false"},
      {R"({"type":"pick","u":1,"v":1,"width":0})", "'width' is out of range"},
      {R"({"type":"codec","name":"av1"})", "not one of the words"},
      {std::string(60000, '['), "not JSON"},
  };
  for (const auto& [text, what] : cases) {
    const auto message = parse_message(text);
    ASSERT_FALSE(message.ok()) << text;
    EXPECT_NE(message.error().message.find(what), std::string::npos)
        << text << ": " << message.error().message;
  }
}

TEST(Messages, StateSurvivesOddNamesAndNumbers) {
  ViewState state;
  state.hash = 0xfedcba9876543210;
  state.camera = "bad \xff name";
  state.realtime_factor = std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(state_message(state));
  EXPECT_EQ(json["hash"], "fedcba9876543210");
  EXPECT_TRUE(json["realtime_factor"].is_null());
  EXPECT_EQ(json["controller"], 0);
}

TEST(Messages, PicksSayWhatWasHit) {
  const auto hit = nlohmann::json::parse(picked_message({4, 1}, "trunk", {1, 2, 3}, true));
  EXPECT_EQ(hit["body"], "trunk");
  EXPECT_EQ(hit["point"], nlohmann::json::array({1.0, 2.0, 3.0}));
  EXPECT_EQ(hit["dragging"], true);
  EXPECT_EQ(nlohmann::json::parse(picked_nothing_message())["found"], false);
}

TEST(Messages, EveryExampleOfTheDocumentationIsRead) {
  std::ifstream file(source_dir() / "docs/view_protocol.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::set<size_t> types;
  for (size_t at = text.find("`{"); at != std::string::npos; at = text.find("`{", at + 1)) {
    const std::string example = text.substr(at + 1, text.find('`', at + 1) - at - 1);
    const auto message = parse_message(example);
    ASSERT_TRUE(message.ok()) << example << ": " << message.error().message;
    types.insert(message->index());
  }
  EXPECT_EQ(types.size(), std::variant_size_v<ControlMessage>);
}

}  // namespace
}  // namespace gloam::studio

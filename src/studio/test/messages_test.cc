#include "studio/messages.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "base/test/source_dir.h"

namespace gloam::studio {
namespace {

TEST(Messages, EveryTypeIsRead) {
  const char* texts[] = {R"({"type":"pause"})",
                         R"({"type":"resume"})",
                         R"({"type":"step","count":7})",
                         R"({"type":"speed","value":0.25})",
                         R"({"type":"reset"})",
                         R"({"type":"seek","time":2.5})",
                         R"({"type":"camera","name":"robot/head"})",
                         R"({"type":"orbit","dx":0.5,"dy":-1})",
                         R"({"type":"pan","dx":2,"dy":3})",
                         R"({"type":"zoom","amount":-0.5})",
                         R"({"type":"pick","u":1.5,"v":2})",
                         R"({"type":"drag_start","u":3,"v":4})",
                         R"({"type":"drag_move","u":5,"v":6})",
                         R"({"type":"drag_end"})",
                         R"({"type":"claim"})",
                         R"({"type":"release"})",
                         R"({"type":"seen"})"};
  for (size_t i = 0; i < std::variant_size_v<ControlMessage>; ++i) {
    const auto message = parse_message(texts[i]);
    ASSERT_TRUE(message.ok()) << texts[i] << ": " << message.error().message;
    EXPECT_EQ(message->index(), i) << texts[i];
  }
  EXPECT_EQ(std::get<StepMessage>(*parse_message(texts[2])).count, 7);
  EXPECT_EQ(std::get<SpeedMessage>(*parse_message(texts[3])).value, 0.25);
  EXPECT_EQ(std::get<CameraMessage>(*parse_message(texts[6])).name, "robot/head");
  EXPECT_EQ(std::get<OrbitMessage>(*parse_message(texts[7])).dy, -1);
  EXPECT_EQ(std::get<DragMoveMessage>(*parse_message(texts[12])).v, 6);
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
  const auto hit = nlohmann::json::parse(picked_message("trunk", {1, 2, 3}, true));
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

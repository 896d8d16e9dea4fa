// State through the page: keyframes as text, edits of a paused simulation, the way back.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "real_rig.h"
#include "studio/fields.h"
#include "studio/grab.h"
#include "studio/history.h"
#include "studio/pose_edits.h"
#include "studio/state_key.h"

namespace gloam::studio {
namespace {

Instant instant_of(const Snapshot& snapshot) {
  Instant instant;
  EXPECT_TRUE(instant.solve(snapshot).ok());
  return instant;
}

TEST(StateKey, ComesBackFromTextToTheBit) {
  const auto simulation = make_rig();
  ASSERT_TRUE(simulation->post({.what = SetJointState{{0, 0}, {1.0 / 3}, {0.1 + 0.2}}}).ok());
  ASSERT_TRUE(simulation->post({.what = SetControl{{0, 0}, -2.5}}).ok());
  ASSERT_TRUE(simulation->step(7).ok());
  const Snapshot now = simulation->latest();
  const std::string text = to_mjcf(key_of(instant_of(now)));
  EXPECT_EQ(text.substr(0, 11), "<key qpos=\"");
  const Result<StateKey> key = parse_key(text);
  ASSERT_TRUE(key.ok()) << key.error().to_string();
  ASSERT_TRUE(simulation->step(50).ok());
  const auto commands = set_key(*key, instant_of(simulation->latest()));
  ASSERT_TRUE(commands.ok());
  const Snapshot again = *simulation->latest().with(*commands);
  for (int joint = 0; joint < 2; ++joint) {
    const JointState a = now[Joint{joint}], b = again[Joint{joint}];
    EXPECT_TRUE(std::ranges::equal(a.qpos, b.qpos)) << joint;
    EXPECT_TRUE(std::ranges::equal(a.qvel, b.qvel)) << joint;
  }
  EXPECT_EQ(again.control({0, 0}), -2.5);
}

TEST(StateKey, AModelsKeyframeIsOneToo) {
  const auto simulation = make_rig();
  const Instant instant = instant_of(simulation->latest());
  const auto key = keyframe_of(instant, 0);
  ASSERT_TRUE(key.ok());
  const Snapshot shown = *simulation->latest().with(*set_key(*key, instant));
  EXPECT_EQ(shown[Joint{0}].position(), 0.5);
  EXPECT_EQ(shown[Joint{1}].qpos[2], 2);
  EXPECT_EQ(shown.control({0, 0}), 1.5);
  EXPECT_FALSE(keyframe_of(instant, 1).ok());
  EXPECT_FALSE(keyframe_of(instant, -1).ok());
}

TEST(StateKey, WhatIsNoKeyIsRefusedWithTheReason) {
  for (const auto& [text, reason] : std::initializer_list<std::pair<const char*, const char*>>{
           {"", "no <key>"},
           {"hello", "no <key>"},
           {"<key qpos='1 2'", "no <key>"},
           {"<joint qpos='1'/>", "no <key>"},
           {"<key qpos='1 x'/>", "'x', which is no number"},
           {"<key ctrl='1,2'/>", "no number"}}) {
    const auto key = parse_key(text);
    ASSERT_FALSE(key.ok()) << text;
    EXPECT_NE(key.error().to_string().find(reason), std::string::npos) << key.error().to_string();
  }
  const auto simulation = make_rig();
  const auto commands =
      set_key(*parse_key("<key qpos='1 2 3'/>"), instant_of(simulation->latest()));
  ASSERT_FALSE(commands.ok());
  EXPECT_NE(commands.error().to_string().find("3 numbers; this model has 8"), std::string::npos);
}

TEST(PoseEdits, ShowAtOnceAndApplyBeforeTheNextStep) {
  const auto simulation = make_rig();
  PoseEdits edits(*simulation);
  const auto set = [&](double x) {
    return edits.apply({{.what = SetJointState{{0, 0}, {x}, {}}}});
  };
  for (const double x : {0.1, 0.2, 0.3}) ASSERT_TRUE(set(x).ok());
  EXPECT_EQ(edits.shown()[Joint{0}].position(), 0.3);
  EXPECT_EQ(simulation->latest()[Joint{0}].position(), 0);
  EXPECT_EQ(simulation->latest().step(), 0);
  EXPECT_FALSE(edits.apply({{.what = SetJointState{{0, 0}, {1, 2}, {}}}}).ok());
  EXPECT_EQ(edits.shown()[Joint{0}].position(), 0.3) << "a refused one changes nothing";
  ASSERT_TRUE(edits.post().ok());
  EXPECT_TRUE(edits.empty());
  ASSERT_TRUE(simulation->step(1).ok());
  EXPECT_EQ(simulation->take_command_log().size(), 1u) << "one replaces the other";
  // The same as without the page.
  const auto other = make_rig();
  ASSERT_TRUE(other->post({.what = SetJointState{{0, 0}, {0.3}, {}}}).ok());
  ASSERT_TRUE(other->step(1).ok());
  EXPECT_EQ(simulation->latest().hash(), other->latest().hash());
}

TEST(History, GoesBackStepByStepAndForwardToTheSameStates) {
  const auto simulation = make_rig();
  History history(*simulation);
  ASSERT_TRUE(simulation->post({100, SetControl{{0, 0}, 2}}).ok());
  ASSERT_TRUE(simulation->post({600, SetControl{{0, 0}, -1}}).ok());
  std::vector<uint64_t> hashes;
  for (int64_t step = 0; step < 700; ++step) {
    hashes.push_back(simulation->latest().hash());
    if (step % 50 == 0) history.keep();
    ASSERT_TRUE(simulation->step(1).ok());
  }
  EXPECT_EQ(history.start(), 0);
  for (const int64_t step : {699, 698, 601, 600, 599, 300, 101, 100, 7}) {
    const Status status = history.return_to(step);
    ASSERT_TRUE(status.ok()) << status.error().to_string();
    EXPECT_EQ(simulation->latest().step(), step);
    EXPECT_EQ(simulation->latest().hash(), hashes[static_cast<size_t>(step)]) << step;
    EXPECT_TRUE(simulation->paused());
  }
  ASSERT_TRUE(simulation->step(1).ok());
  EXPECT_EQ(simulation->latest().hash(), hashes[8]);
}

TEST(History, ForgetsWhatDoesNotLeadToThePresent) {
  const auto simulation = make_rig();
  History history(*simulation);
  history.keep();
  ASSERT_TRUE(simulation->step(500).ok());
  history.keep();
  ASSERT_TRUE(simulation->post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(simulation->step(2).ok());
  history.keep();
  EXPECT_GT(history.start(), 0);
  EXPECT_FALSE(history.return_to(0).ok());
}

CameraFrame frame_from_above() {
  CameraFrame frame;
  frame.X_WC = {{0, 0, 5}, {1, 0, 0, 0}};  // looks down, +Y is up in the image
  frame.intrinsics = {200, 100, 100, 100, 100, 50};
  return frame;
}

TEST(Grab, MovesAFreeBodyWhileItIsPausedAndPullsItWhileItRuns) {
  const auto simulation = make_rig();
  const CameraFrame frame = frame_from_above();
  auto grab = Grab::take(1, *simulation, frame, {{100, 50}});
  ASSERT_TRUE(grab.ok()) << grab.error().to_string();
  EXPECT_EQ(grab->hit().name, "box");
  grab->move_to(frame, 120, 50);
  const auto placed = grab->follow(frame, true);
  ASSERT_EQ(placed.size(), 1u);
  const auto& joint = std::get<SetJointState>(placed[0].what);
  EXPECT_EQ(joint.joint.id, 1);
  EXPECT_NEAR(joint.qpos[0], 20 * (5 - 1.3) / 100, 1e-6) << "as far as the mouse at its depth";
  EXPECT_NEAR(joint.qpos[2], 1, 1e-6);
  EXPECT_TRUE(grab->follow(frame, true).empty()) << "nothing new";
  const auto pulled = grab->follow(frame, false);
  ASSERT_EQ(pulled.size(), 1u);
  EXPECT_NEAR(std::get<DragBody>(pulled[0].what).target_W.x, 20 * (5 - 1.3) / 100, 1e-6);
  EXPECT_FALSE(std::get<DragBody>(grab->let_go()[0].what).active);
}

TEST(Grab, TurnsAboutAxesOfTheImage) {
  const auto simulation = make_rig();
  const CameraFrame frame = frame_from_above();
  auto grab = Grab::take(1, *simulation, frame, {{100, 50}, true});
  ASSERT_TRUE(grab.ok());
  grab->move_to(frame, 150, 50);  // half a height to the right: a quarter turn about "up"
  const auto turned = grab->follow(frame, false);
  ASSERT_EQ(turned.size(), 1u);
  const Quat q = std::get<TurnBody>(turned[0].what).target_WB;
  EXPECT_NEAR(q.w, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(q.y, std::sqrt(0.5), 1e-9);
}

TEST(Grab, AMocapBodyGoesWithTheMouseAndTheWorldDoesNot) {
  const auto simulation = make_rig();
  const CameraFrame frame = frame_from_above();
  auto hand = Grab::take(1, *simulation, frame, {{100 + 100 / 3.8, 50}});
  ASSERT_TRUE(hand.ok()) << hand.error().to_string();
  EXPECT_EQ(hand->hit().name, "hand");
  hand->move_to(frame, 140, 50);
  EXPECT_TRUE(std::holds_alternative<SetMocapPose>(hand->follow(frame, false).at(0).what));
  EXPECT_FALSE(Grab::take(1, *simulation, frame, {{5, 5}}).ok()) << "the floor";
}

TEST(Fields, AreWrittenAsTheProtocolSays) {
  const auto simulation = make_rig();
  const Snapshot now = simulation->latest();
  const FieldsMessage message = encode_fields(
      {"qpos", "nothing", "opt.gravity", "contact", "actuated"}, 5, now, instant_of(now));
  ASSERT_EQ(message.problems.size(), 1u);
  EXPECT_NE(message.problems[0].find("nothing"), std::string::npos);
  const auto* bytes = reinterpret_cast<const char*>(message.bytes.data());
  EXPECT_EQ(std::string_view(bytes, 4), "GLF1");
  uint32_t length = 0;
  std::memcpy(&length, bytes + 4, 4);
  EXPECT_EQ(length % 4, 0u);
  const auto head = nlohmann::json::parse(std::string_view(bytes + 8, length));
  EXPECT_EQ(head["id"], 5);
  EXPECT_EQ(head["serial"], simulation->world().serial());
  EXPECT_EQ(head["fields"], nlohmann::json::parse(R"([{"name":"qpos","count":8},
      {"name":"opt.gravity","count":3},{"name":"contact","count":0},{"name":"actuated","count":1}])"));
  EXPECT_EQ(message.bytes.size(), 8 + length + 4 * (8 + 3 + 1));
  float height = 0;
  std::memcpy(&height, bytes + 8 + length + 4 * 3, 4);
  EXPECT_EQ(height, 1) << "z of the free box";
  for (const int id : {1, 10, 100, 1000}) {  // texts of every length
    const FieldsMessage other = encode_fields({"qpos"}, id, now, instant_of(now));
    std::memcpy(&length, other.bytes.data() + 4, 4);
    EXPECT_EQ(length % 4, 0u) << id;
    EXPECT_EQ(other.bytes.size(), 8 + length + 4 * 8);
  }
}

}  // namespace
}  // namespace gloam::studio

// Topics of what stands in a scene: objects, tables of labels.

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <set>

#include "record/run_files.h"
#include "ros/messages/sensor_msgs.h"
#include "ros/messages/vision_msgs.h"
#include "ros/messages/visualization_msgs.h"
#include "scene/test/temp_folder.h"
#include "topics/test/topic_inbox.h"
#include "topics/topic_table.h"

namespace gloam {
namespace {

using testing::ElementsAre;
using testing::Not;
using visualization_msgs::MarkerArray;

constexpr const char* kRobot = R"(<mujoco><worldbody>
<body name="base" pos="0 2 0.5"><freejoint/><geom name="hull" type="box" size=".2 .2 .2"/>
<body name="arm"><joint name="lift" axis="0 1 0"/><geom size=".05"/></body></body></worldbody>
<actuator><motor joint="lift"/></actuator></mujoco>)";

// A crate with a lid that is welded to it and a door that is not, a block that falls, a hand that
// is moved, and a shelf that stands.
constexpr const char* kRoom = R"(<mujoco><compiler angle="radian"/><option timestep="0.002"/>
<worldbody><geom name="ground" type="plane" size="5 5 .1"/><light pos="0 0 3"/>
<body name="crate" pos="1 0 .25"><freejoint/><geom type="box" size=".5 .25 .25"/>
  <body name="lid" pos="0 0 .3" euler="0 0 1.5707963267948966"><geom type="box" size=".5 .1 .05"/></body>
  <body name="door" pos="3 0 0"><joint axis="0 0 1"/><geom type="box" size="1 1 1" contype="0"
    conaffinity="0"/></body></body>
<body name="block 3" pos="-1 0 3" euler="0 0 .5"><freejoint/><geom type="sphere" size=".1"
  pos=".3 0 0"/></body>
<body name="hand" mocap="true" pos="0 0 1"><geom size=".01" contype="0" conaffinity="0"/></body>
<body name="shelf"><geom type="box" size=".1 .1 .1" pos="3 3 .1"/></body></worldbody></mujoco>)";

constexpr const char* kSceneText = R"(
[[robot]]
name = "ada"
file = "robot.xml"
[environment]
file = "room.xml"
[[camera]]
name = "wall"
position = [-3, 0, 2]
look_at = [0, 0, 0.2]
rate = 10
width = 64
height = 48
[render]
tier = "direct"
spp = 1
)";

class SceneTopics : public testing::Test {
 protected:
  SceneTopics() {
    folder_.write("robot.xml", kRobot);
    folder_.write("room.xml", kRoom);
  }
  World world_of(const std::string& more = "") {
    const auto scene = parse_scene(kSceneText + more, folder_.path());
    EXPECT_TRUE(scene.ok()) << scene.error().to_string();
    const auto world = World::compile(*scene);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return *world;
  }
  static std::set<std::string> names_of(const World& world) {
    std::set<std::string> names;
    const auto topics = *list_topics(world);
    for (const TopicInfo& topic : topics) names.insert(topic.name);
    return names;
  }

  TempFolder folder_;
};

TEST_F(SceneTopics, ObjectsAreBoxesAroundWhatFloats) {
  const World world = world_of();
  TopicInbox inbox;
  record_topics(world, {"/objects"}, 100, &inbox);
  const auto messages = inbox.all<MarkerArray>("/objects");
  ASSERT_EQ(messages.size(), 3u);  // 10 Hz
  std::map<std::string, visualization_msgs::Marker> found;
  for (const auto& marker : messages[0].markers) found[marker.ns] = marker;
  std::vector<std::string> names;
  for (const auto& [name, marker] : found) names.push_back(name);
  EXPECT_THAT(names, ElementsAre("block 3", "crate", "hand"));
  // The lid turned by 90 degrees stands 0.25 m out at each side; the door moves by itself.
  const auto& crate = found["crate"];
  EXPECT_EQ(crate.type, visualization_msgs::Marker::CUBE);
  EXPECT_EQ(crate.header.frame_id, "world");
  EXPECT_EQ(crate.text, "crate");
  EXPECT_NEAR(crate.scale.x, 1, 1e-9);
  EXPECT_NEAR(crate.scale.y, 1, 1e-9);
  EXPECT_NEAR(crate.scale.z, 0.6, 1e-9);
  EXPECT_NEAR(crate.pose.position.x, 1, 1e-6);
  EXPECT_NEAR(crate.pose.position.z, 0.25 + 0.05, 1e-6);
  const auto& block = found["block 3"];
  EXPECT_NEAR(block.scale.x, 0.2, 1e-9);
  EXPECT_NEAR(block.pose.position.x, -1 + 0.3 * std::cos(0.5), 1e-6);
  EXPECT_NEAR(block.pose.position.y, 0.3 * std::sin(0.5), 1e-6);
  EXPECT_NEAR(block.pose.orientation.z, std::sin(0.25), 1e-6);
  // It falls: 0.2 s.
  double lower = 0;
  for (const auto& marker : messages[2].markers)
    if (marker.ns == "block 3") lower = marker.pose.position.z;
  EXPECT_NEAR(lower, 3 - 0.5 * 9.81 * 0.04, 0.01);
}

TEST_F(SceneTopics, ThereAreNoObjectsWhereNothingFloats) {
  folder_.write("room.xml",
                "<mujoco><worldbody><geom size='1 1 1' type='plane'/></worldbody></mujoco>");
  EXPECT_THAT(names_of(world_of()), Not(testing::Contains("/objects")));
}

TEST_F(SceneTopics, EqualRunsTellEqualBytes) {
  const World world = world_of();
  const std::vector<std::string> topics = {"/objects", "/wall/segmentation/*/label_info"};
  TopicInbox one, two;
  record_topics(world, topics, 150, &one);
  record_topics(world, topics, 150, &two);
  EXPECT_EQ(one.messages.size(), 3u);
  EXPECT_EQ(one.messages, two.messages);
}

std::map<int, std::string> names_of_ids(const vision_msgs::LabelInfo& info) {
  std::map<int, std::string> names;
  for (const auto& one : info.class_map)
    EXPECT_TRUE(names.emplace(one.class_id, one.class_name).second) << one.class_id;
  return names;
}

// The tables of the topics are those of a results folder, and name every id of the pictures.
TEST_F(SceneTopics, LabelsAreThoseOfResults) {
  const World world = world_of();
  auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
  TopicInbox inbox;
  auto stream = *simulation->open_topics({.topics = {"/wall/segmentation/*"}, .required = true},
                                         inbox.callback());
  ASSERT_TRUE(simulation->step(51).ok());
  stream.reset();
  const std::string json = labels_json(*simulation->labels(), {});
  for (const bool is_semantic : {false, true}) {
    const std::string topic =
        std::string("/wall/segmentation/") + (is_semantic ? "semantic" : "instance");
    ASSERT_EQ(inbox.messages[topic + "/label_info"].size(), 1u);
    const auto info = inbox.all<vision_msgs::LabelInfo>(topic + "/label_info")[0];
    EXPECT_EQ(info.header.frame_id, "wall_optical_frame");
    const auto names = names_of_ids(info);
    EXPECT_EQ(names.at(0), "nothing");
    std::map<int, std::string> expected = {{0, "nothing"}};
    const auto labels = *simulation->labels();
    for (const LabelRow& row : labels) {
      const uint32_t id = is_semantic ? row.semantic : row.instance;
      if (id != 0)
        expected[static_cast<int>(id)] = is_semantic ? row.semantic_name : row.instance_name;
    }
    EXPECT_EQ(names, expected);
    for (const auto& [id, name] : names) {
      if (id == 0) continue;
      EXPECT_THAT(json, testing::HasSubstr("\"" + name + "\""));
    }
    std::set<int> seen;
    const auto images = inbox.all<sensor_msgs::Image>(topic);
    ASSERT_FALSE(images.empty());
    const auto bytes = images[0].data.span();
    for (size_t i = 0; i + 1 < bytes.size(); i += 2) seen.insert(bytes[i] | bytes[i + 1] << 8);
    EXPECT_GT(seen.size(), 2u);
    for (const int id : seen) EXPECT_TRUE(names.contains(id)) << id;
  }
  EXPECT_THAT(
      inbox.all<vision_msgs::LabelInfo>("/wall/segmentation/instance/label_info")[0].class_map,
      testing::Contains(testing::Field(&vision_msgs::VisionClass::class_name, "ada")));
}

}  // namespace
}  // namespace gloam

// Legs and feet by the names in [robot.joints].

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "control/trot_legs.h"
#include "trot_robots.h"

namespace gloam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The other quadruped with names for its joints: front_left_1 … rear_right_3.
RobotInstance named(const mjModel& model) {
  RobotInstance robot = robot_instance(model);
  RobotJoints& joints = robot.options.joints;
  const auto three = [](const std::string& leg) {
    return std::vector<std::string>{leg + "_1", leg + "_2", leg + "_3"};
  };
  joints.front_left = three("front_left");
  joints.front_right = three("front_right");
  joints.rear_left = three("rear_left");
  joints.rear_right = three("rear_right");
  return robot;
}

TEST(TrotNames, GiveTheLegsThatTheShapeGives) {
  const ModelPtr model = load_other_quadruped();
  const Result<Quadruped> found = find_quadruped(*model, robot_instance(*model));
  RobotInstance robot = named(*model);
  for (const bool with_feet : {false, true}) {
    if (with_feet)
      robot.options.joints.feet = {"front_left_foot", "front_right_foot", "rear_left_c",
                                   "rear_right_c"};
    const Result<Quadruped> by_name = find_quadruped(*model, robot);
    ASSERT_TRUE(found.ok() && by_name.ok()) << by_name.error().to_string();
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(by_name->legs[i].qpos, found->legs[i].qpos);
      EXPECT_EQ(by_name->legs[i].foot_geom, found->legs[i].foot_geom);
      EXPECT_EQ(by_name->legs[i].foot_B, found->legs[i].foot_B);
    }
  }
}

// A fourth hinge below each calf hides the legs from the search by shape.
TEST(TrotNames, FindLegsWithMoreJoints) {
  std::string xml = other_quadruped_xml();
  const std::string foot = "<geom name=\"front_left_foot\"";
  xml.insert(xml.find(foot), R"(<body pos="0 0 0"><joint name="wheel"/>
    <geom type="sphere" size="0.001" mass="0.001" contype="0" conaffinity="0"/></body>)");
  const ModelPtr model = compile_text(xml);
  EXPECT_FALSE(find_quadruped(*model, robot_instance(*model)).ok());
  const Result<Quadruped> by_name = find_quadruped(*model, named(*model));
  ASSERT_TRUE(by_name.ok()) << by_name.error().to_string();
  EXPECT_NEAR(by_name->legs[0].foot_radius, 0.03, 1e-12);
}

TEST(TrotNames, ASiteIsTheFoot) {
  std::string xml = other_quadruped_xml();
  for (const char* leg : {"front_left", "front_right", "rear_left", "rear_right"}) {
    const std::string geom = std::string("<geom name=\"") + leg + "_foot\"";
    xml.insert(xml.find(geom),
               std::string("<site name=\"") + leg + "_tip\" pos=\"0 0 -0.01\" size=\"0.02\"/>");
  }
  const ModelPtr model = compile_text(xml);
  RobotInstance robot = named(*model);
  robot.options.joints.feet = {"front_left_tip", "front_right_tip", "rear_left_tip",
                               "rear_right_tip"};
  const Result<Quadruped> by_site = find_quadruped(*model, robot);
  const Result<Quadruped> by_shape = find_quadruped(*model, robot_instance(*model));
  ASSERT_TRUE(by_site.ok()) << by_site.error().to_string();
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(by_site->legs[i].foot_radius, 0.02);
    EXPECT_EQ(by_site->legs[i].foot_geom, by_shape->legs[i].foot_geom);
    EXPECT_NEAR((by_site->legs[i].foot_B - by_shape->legs[i].foot_B).norm(), 0.01, 1e-12);
  }
}

TEST(TrotNames, MistakesAreTold) {
  const ModelPtr model = load_other_quadruped();
  const auto error = [&](auto change) {
    RobotInstance robot = named(*model);
    robot.options.joints.loc = {"s.toml", 7, 1};
    change(robot.options.joints);
    const Result<Quadruped> found = find_quadruped(*model, robot);
    return found.ok() ? "" : found.error().to_string();
  };
  EXPECT_THAT(error([](RobotJoints& j) { j.front_left[1] = "front_lift_2"; }),
              AllOf(HasSubstr("s.toml:7"), HasSubstr("no joint 'front_lift_2'"),
                    HasSubstr("'front_left_2'")));
  EXPECT_THAT(error([](RobotJoints& j) { j.front_left.pop_back(); }),
              HasSubstr("'FL' has 2 joints, not three"));
  EXPECT_THAT(error([](RobotJoints& j) { j.rear_right = {}; }), HasSubstr("'RR' has 0 joints"));
  EXPECT_THAT(error([](RobotJoints& j) { std::ranges::reverse(j.front_left); }),
              HasSubstr("'front_left_2' is not below 'front_left_3'"));
  EXPECT_THAT(error([](RobotJoints& j) { j.feet = {"front_left_foot"}; }),
              HasSubstr("'feet' has 1 names, not four"));
  EXPECT_THAT(error([](RobotJoints& j) {
                j.feet = {"front_right_foot", "front_left_foot", "rear_left_c", "rear_right_c"};
              }),
              HasSubstr("'front_right_foot' is not on the last link"));
  EXPECT_THAT(error([](RobotJoints& j) { j.feet = {"x", "x", "x", "x"}; }),
              HasSubstr("no geom, site or body 'x'"));
}

}  // namespace
}  // namespace gloam

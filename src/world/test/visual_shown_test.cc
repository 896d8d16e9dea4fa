// Of the shapes that a robot has for collisions and for show, which are drawn.

#include "scene/test/temp_folder.h"
#include "visual_test_model.h"

namespace gloam {
namespace {

using visual_test::describe;

std::vector<std::string> shown(const RenderDescription& description) {
  std::vector<std::string> names;
  for (const InstanceDescription& instance : description.instances)
    if (instance.shown) names.push_back(instance.label.geom);
  return names;
}

using Names = std::vector<std::string>;

TEST(VisualShown, GroupsAreThoseThatMuJoCoShows) {
  EXPECT_EQ(shown(describe(R"(<mujoco><worldbody><geom name="wall" size="1" group="4"/>
    <body><freejoint/><geom name="a" size=".1" group="2"/><geom name="b" size=".1" group="3"/>
      <body><joint/><geom name="foot" size=".1" group="3"/></body></body></worldbody></mujoco>)")),
            (Names{"a"}));
}

TEST(VisualShown, WhatMovesAndHasNothingToShowShowsWhatItCollidesWith) {
  EXPECT_EQ(shown(describe(R"(<mujoco><worldbody>
    <body><freejoint/><geom name="base" size=".1" group="3"/>
      <body><joint/><geom name="arm" size=".1" group="5"/></body></body>
    <body><geom name="guard" size="1" group="3"/></body></worldbody></mujoco>)")),
            (Names{"base", "arm"}))
      << "an invisible thing that stands still is meant to be invisible";
}

TEST(VisualShown, AUrdfLinkShowsItsVisualsOrElseWhatItCollidesWith) {
  const std::string sphere = "<geometry><sphere radius='.1'/></geometry>";
  const std::string inertial =
      "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
      "</inertial>";
  const TempFolder folder;
  const auto file = folder.write(
      "r.urdf",
      "<robot name='r'><link name='base'>" + inertial + "<collision>" + sphere +
          "</collision><visual><geometry><box size='.3 .3 .3'/></geometry></visual></link>"
          "<link name='arm'>" +
          inertial + "<collision>" + sphere +
          "</collision></link>"
          "<joint name='j' type='continuous'><parent link='base'/><child link='arm'/></joint>"
          "</robot>");
  const auto world = World::compile(*load_scene(file));
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const RenderDescription out = describe(*world->compiled());
  int boxes = 0, spheres = 0;
  for (const InstanceDescription& instance : out.instances) {
    if (!instance.shown) continue;
    boxes += instance.shape == ShapeType::kBox;
    spheres += instance.shape == ShapeType::kSphere;
  }
  EXPECT_EQ(boxes, 1) << "the base's visual";
  EXPECT_EQ(spheres, 1) << "the arm has no visual; the base's sphere is hidden by its box";
}

}  // namespace
}  // namespace gloam

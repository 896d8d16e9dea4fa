// Files of other formats in place of a model: refused by the name of the format, with a remedy.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/files/model_files.h"
#include "scene/files/urdf_text.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& name, const std::string& text) {
  const TempFolder folder;
  ModelFiles files;
  const Status status = files.add_model(folder.write(name, text), {});
  return status.ok() ? "fine" : status.error().to_string();
}

TEST(ForeignModel, IsNamedWithItsRemedy) {
  struct Case {
    std::string name, text, format, remedy;
  };
  const std::string srdf =
      "<?xml version='1.0'?><robot name='g'><virtual_joint name='v' type='fixed' parent_frame='w' "
      "child_link='b'/></robot>";
  for (const Case& c : {
           Case{"r.srdf", srdf, "is an SRDF, not a URDF", "use the robot's URDF"},
           Case{"r.urdf", "<robot name='g'><disable_collisions link1='a' link2='b'/></robot>",
                "is an SRDF, not a URDF", "use the robot's URDF"},
           Case{"r.urdf", "<robot name='g'/>", "is an empty robot", "xacro"},
           Case{"r.urdf", "<robot name='g'><material name='m'/></robot>", "empty robot", "xacro"},
           Case{"r.urdf", "<robot name='g'><xacro:include filename='a'/></robot>",
                "xacro is not expanded", "xacro FILE"},
           Case{"m.sdf", "<?xml version='1.0'?><sdf version='1.9'><model name='m'/></sdf>",
                "is an SDF (Gazebo)", "sdf2mjcf"},
           Case{"r.usda", "#usda 1.0\n(\n)\n", "is a USD stage", "export"},
           Case{"r.usd", "PXR-USDC\x01\x02", "is a USD stage", "export"},
           Case{"r.xml", "<!DOCTYPE html><html><br></html>", "is a web page", "raw"},
           Case{"r.xml", "\n<HTML><br></HTML>", "is a web page", "raw"},
           Case{"r.urdf", "<launch><node/></launch>", "is a ROS launch file", "URDF"},
           Case{"r.xml", "<COLLADA/>", "is a COLLADA mesh", "[[visual]]"},
           Case{"r.xml", "<mujocoinclude/>", "is an MJCF fragment", "includes it"},
           Case{"r.proto", "#VRML_SIM R2023b utf8\n", "Webots", "export"},
           Case{"r.json", "{\"a\": 1}", "is JSON", "TOML"},
           Case{"r.yaml", "---\na: 1\n", "is YAML", "TOML"},
           Case{"r.xml", "", "is empty", ""},
       }) {
    const std::string error = error_of(c.name, c.text);
    EXPECT_THAT(error, HasSubstr(c.format)) << c.text;
    EXPECT_THAT(error, HasSubstr(c.remedy)) << c.text;
  }
  EXPECT_EQ(error_of("r.urdf", "<robot name='g'><link name='a'/></robot>"), "fine");
  EXPECT_EQ(error_of("r.xml", "<mujoco/>"), "fine");
}

TEST(UrdfText, NotesTheElementsThatAreLeftOut) {
  const TempFolder folder;
  const Result<UrdfText> urdf = prepare_urdf(
      "<robot name='r'><link name='a'/><link name='b'><sensor/></link>\n"
      "<joint name='j' type='fixed'><parent link='a'/><child link='b'/><mimic joint='k'/>"
      "<safety_controller k_velocity='1'/><calibration rising='0'/></joint>\n"
      "<transmission name='t1'/>\n<transmission name='t2'/>\n<ros2_control name='h'/>\n"
      "<gazebo reference='a'/><made_up/></robot>",
      folder.path() / "r.urdf", {}, [](const std::filesystem::path&) { return true; });
  ASSERT_TRUE(urdf.ok());
  std::string notes;
  for (const Error& note : urdf->notes) notes += note.to_string() + "\n";
  EXPECT_THAT(notes, HasSubstr("r.urdf:3: <transmission> is ignored: joints have no motors or "
                               "gears of their own (2 of them)"));
  EXPECT_THAT(notes, HasSubstr("r.urdf:5: <ros2_control> is ignored"));
  EXPECT_THAT(notes, HasSubstr("r.urdf:6: <gazebo> is ignored"));
  EXPECT_THAT(notes, HasSubstr("r.urdf:2: <safety_controller> is ignored"));
  EXPECT_THAT(notes, HasSubstr("r.urdf:2: <calibration> is ignored"));
  EXPECT_THAT(notes, HasSubstr("r.urdf:1: <sensor> is ignored"));
  EXPECT_THAT(notes, HasSubstr("<made_up> is ignored"));
  EXPECT_EQ(notes.find("mimic"), std::string::npos);
}

}  // namespace
}  // namespace gloam

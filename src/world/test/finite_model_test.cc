// Numbers that are none, which MuJoCo takes without a word.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "gloam/world.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;

struct Attributes {
  std::string light, camera, geom = "size='1'", body, joint, material, site;
};

class FiniteModel : public ::testing::Test {
 protected:
  std::string error_of(const Attributes& a) {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    const auto file = folder_.write(
        "m.xml", fmt::format("<mujoco><asset>\n<material name='m' {}/></asset><worldbody>\n"
                             "<light {}/>\n<camera name='c' {}/>\n<geom name='g' {}/>\n"
                             "<site name='s' {}/>\n<body name='b' {}><geom size='1'/>\n"
                             "<joint name='j' {}/></body></worldbody></mujoco>",
                             a.material, a.light, a.camera, a.geom, a.site, a.body, a.joint));
    const auto scene = load_scene(file);
    if (!scene.ok()) return scene.error().to_string();
    const auto world = World::compile(*scene);
    return world.ok() ? "" : world.error().to_string();
  }
  const TempFolder folder_;
};

TEST_F(FiniteModel, WhatIsPlacedSizedOrColouredByNoNumberIsRefused) {
  const struct {
    Attributes attributes;
    const char* error;
  } kCases[] = {
      {{.material = "emission='nan'"}, "m.xml:2: material 'm': emission is not a number"},
      {{.material = "texrepeat='inf 1'"}, "m.xml:2: material 'm': texrepeat is infinite"},
      {{.light = "pos='nan 0 0'"}, "m.xml:3: light without a name in 'world': pos is not"},
      {{.light = "diffuse='inf 0 0'"}, "m.xml:3: light without a name in 'world': diffuse is inf"},
      {{.light = "intensity='nan'"}, "m.xml:3: light without a name in 'world': intensity is not"},
      {{.light = "range='nan'"}, "m.xml:3: light without a name in 'world': range is not"},
      {{.camera = "pos='0 -inf 0'"}, "m.xml:4: camera 'c': pos is infinite"},
      {{.camera = "quat='nan 0 0 1'"}, "m.xml:4: camera 'c': quat is not a number"},
      {{.camera = "fovy='nan'"}, "m.xml:4: camera 'c': fovy is not a number"},
      {{.camera = "resolution='64 64' sensorsize='1 1' focal='nan 1'"},
       "m.xml:4: camera 'c': intrinsic is not a number"},
      {{.geom = "size='inf'"}, "m.xml:5: geom 'g': size is infinite"},
      {{.geom = "size='1' rgba='nan 0 0 1'"}, "m.xml:5: geom 'g': rgba is not a number"},
      {{.site = "pos='nan 0 0'"}, "m.xml:6: site 's': pos is not a number"},
      {{.body = "pos='nan 0 0'"}, "m.xml:7: body 'b': pos is not a number"},
      {{.body = "quat='inf 0 0 0'"}, "m.xml:7: body 'b': quat is not a number"},
      {{.joint = "axis='nan 0 0'"}, "m.xml:8: joint 'j': axis is not a number"},
      {{.joint = "damping='nan'"}, "m.xml:8: joint 'j': damping is not a number"},
  };
  for (const auto& [attributes, error] : kCases) {
    const std::string said = error_of(attributes);
    EXPECT_THAT(said, HasSubstr(error));
    EXPECT_THAT(said, HasSubstr("use a finite one"));
  }
}

TEST_F(FiniteModel, WhereAnElementOfARobotIsWrittenIsSaid) {
  ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
  folder_.write("r.xml",
                "<mujoco>\n<worldbody>\n<camera name='c' fovy='nan'/></worldbody></mujoco>");
  folder_.write("e.xml", "<mujoco><worldbody><camera name='c'/></worldbody></mujoco>");
  const auto scene = load_scene(folder_.write(
      "s.toml", "[environment]\nfile = \"e.xml\"\n[[robot]]\nname = \"go\"\nfile = \"r.xml\"\n"));
  const auto world = World::compile(*scene);
  ASSERT_FALSE(world.ok());
  EXPECT_THAT(world.error().to_string(), HasSubstr("r.xml:3: camera 'go/c': fovy is not a number"));
}

TEST_F(FiniteModel, EndlessRangesAndWhatUsersKeepMayStay) {
  EXPECT_EQ(error_of({.light = "range='inf'",
                      .geom = "size='1' user='nan inf'",
                      .joint = "range='-inf inf' limited='true'"}),
            "");
  EXPECT_EQ(error_of({.geom = "type='plane' size='0 0 1'"}), "");
}

// Without the check these compile for ever.
TEST_F(FiniteModel, ArmaturesWithWhichMusclesNeverCompileAreRefused) {
  const auto error_of_muscle = [&](const char* joint, const char* muscle) {
    const auto file = folder_.write(
        "m.xml",
        fmt::format("<mujoco><worldbody><body>\n<joint name='j' limited='true' range='0 1' {}/>\n"
                    "<geom size='1'/></body></worldbody><actuator>\n<muscle name='m' joint='j' {}/>"
                    "</actuator></mujoco>",
                    joint, muscle));
    const auto world = World::compile(*load_scene(file));
    return world.ok() ? "" : world.error().to_string();
  };
  EXPECT_EQ(error_of_muscle("armature='0.1'", "armature='0.2'"), "");
  EXPECT_THAT(error_of_muscle("armature='-1e9'", ""),
              HasSubstr("m.xml:2: joint 'j': armature is -1000000000"));
  EXPECT_THAT(error_of_muscle("armature='nan'", ""),
              HasSubstr("m.xml:2: joint 'j': armature is nan"));
  EXPECT_THAT(error_of_muscle("", "armature='nan'"),
              HasSubstr("m.xml:4: actuator 'm': armature is nan"));
  EXPECT_THAT(error_of_muscle("", "armature='-2147483648'"),
              HasSubstr("m.xml:4: actuator 'm': armature is -2147483648"));
}

}  // namespace
}  // namespace gloam

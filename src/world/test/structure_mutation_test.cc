// Models whose elements and attributes are damaged, but not their XML, through MuJoCo's parser and
// compiler: an Error or a World, and the process goes on.

#include <gtest/gtest.h>

#include "gloam/world.h"
#include "scene/files/mujoco_guard.h"
#include "scene/files/xml_scan.h"
#include "scene/test/temp_folder.h"
#include "scene/test/xml_mutator.h"
#include "world/world.h"

namespace gloam {
namespace {

const char* const kEverything =
    R"(<mujoco model="m"><compiler angle="degree" balanceinertia="true"/>
<option timestep="0.002" integrator="implicitfast" cone="elliptic"><flag energy="enable"/></option>
<default><geom solref="0.01 1" friction="0.8 0.01 0.001"/><default class="soft"><geom solimp="0.5 0.9 0.01"/></default></default>
<asset><texture name="t" type="2d" builtin="checker" width="16" height="16"/><material name="a" texture="t" rgba="1 0 0 1"/>
<mesh name="tetra" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/><hfield name="h" nrow="3" ncol="3" size="2 2 0.5 0.1" elevation="0 1 0 1 2 1 0 1 0"/></asset>
<worldbody><light pos="0 0 3"/><geom name="floor" type="plane" size="3 3 0.1" material="a"/><geom type="hfield" hfield="h" pos="9 0 0"/>
<frame pos="1 0 0" euler="0 0 30"><body name="box" pos="0 0 1"><freejoint name="f"/><geom name="g" type="box" size="0.1 0.2 0.3" mass="2" class="soft"/>
<site name="s" size="0.01"/><camera name="c" pos="0 0 1" fovy="60"/></body></frame>
<body name="arm" pos="-1 0 1"><joint name="j" type="hinge" axis="0 1 0" range="-90 90" damping="0.1" armature="0.01"/>
<geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.05"/><body name="hand" pos="0.5 0 0"><site name="s2"/><joint name="k" type="slide" axis="1 0 0"/>
<geom type="mesh" mesh="tetra"/><inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/></body></body>
<body pos="2 0 1"><joint type="ball"/><geom type="ellipsoid" size="0.1 0.2 0.1"/></body></worldbody>
<tendon><spatial name="rope"><site site="s"/><site site="s2"/></spatial><fixed name="fix"><joint joint="j" coef="1"/></fixed></tendon>
<contact><exclude body1="box" body2="arm"/></contact><equality><joint joint1="j" joint2="k" polycoef="0 1 0 0 0"/></equality>
<actuator><motor name="m" joint="j" gear="5" ctrlrange="-1 1"/><position joint="k" kp="10"/></actuator>
<sensor><gyro site="s"/><jointpos joint="j"/><touch site="s"/></sensor><keyframe><key name="home"/></keyframe></mujoco>)";

TEST(StructureMutations, OfModelsAreAnsweredByMuJoCo) {
  const TempFolder folder;
  ::setenv("GLOAM_CACHE", (folder.path() / "cache").c_str(), 1);
  const std::string seed = kEverything;
  const auto compile = [&](const std::string& text) -> Result<World> {
    GLOAM_TRY(const Scene scene, load_scene(folder.write("m.xml", text)));
    return World::compile(scene);
  };
  const Result<World> whole = compile(seed);
  ASSERT_TRUE(whole.ok()) << whole.error().to_string();
  const size_t count = mutation_count() / 2;  // they take a while
  size_t parsed = 0, compiled = 0;
  for (size_t i = 0; i < count; ++i) {
    const std::string text = mutate_xml(seed, i);
    const Result<World> world = compile(text);
    compiled += world.ok() ? 1 : 0;
    if (world.ok()) {
      ++parsed;
      continue;
    }
    const std::string told = world.error().to_string();
    ASSERT_EQ(told.find('\n'), std::string::npos) << "file " << i << ": " << told;
    if (!scan_model_xml(text, "m.xml").ok()) continue;  // MuJoCo may not survive it
    const std::string file = (folder.path() / "m.xml").string();
    char message[1000];
    mjSpec* spec = nullptr;
    if (guarded([&] { spec = mj_parseXML(file.c_str(), nullptr, message, sizeof(message)); }).ok())
      parsed += spec != nullptr ? 1 : 0;
    if (spec != nullptr) mj_deleteSpec(spec);
  }
  RecordProperty("past the parser", std::to_string(parsed));
  RecordProperty("compiled", std::to_string(compiled));
  EXPECT_GT(parsed, count / 2) << "most mutants do not get past MuJoCo's parser";
  EXPECT_LT(compiled, count * 9 / 10) << "no harm is done";
}

}  // namespace
}  // namespace gloam

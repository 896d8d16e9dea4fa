// Options of <compiler> hold for each model of a scene as they do for the model alone.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/cache_writer.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "world/model_names.h"
#include "world/world.h"

namespace gloam {
namespace {

using testing::HasSubstr;

const char* const kBodies =
    "<worldbody><body name='s'><geom size='.1' mass='3'/>"
    "<body name='d' pos='0 0 .5' euler='30 20 10'><joint name='j' range='-1 1'/>"
    "<geom size='.1' mass='1' group='1'/><geom size='.1' pos='.3 0 0' mass='1' group='2'/>"
    "<body name='e' pos='0 0 .3'><joint name='k'/>"
    "<inertial pos='0 0 0' mass='.001' diaginertia='.01 .01 .015'/>"
    "<geom size='.05' pos='0 .1 0' group='2'/></body></body></body>"
    "<body name='f' pos='1 0 0'><freejoint/><geom size='.1' pos='.1 0 0' group='2'/>"
    "<geom type='box' size='.1 .2 .3' pos='.1 .1 0'/></body></worldbody>"
    "<actuator><muscle name='m' joint='j'/></actuator>";

std::string model(const std::string& compiler) {
  return "<mujoco>" + compiler + kBodies + "</mujoco>";
}

class CompilerOptions : public testing::Test {
 protected:
  CompilerOptions() { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }
  ~CompilerOptions() override {
    finish_cache_writes();
    ::unsetenv("GLOAM_CACHE");
  }
  Result<World> compile(const std::string& name, const std::string& text) {
    GLOAM_TRY(const Scene scene, load_scene(folder_.write(name, text)));
    return World::compile(scene);
  }

  // The bodies, joints and actuators of the model alone and below `prefix` in the scene.
  static void expect_same(const mjModel& alone, const mjModel& scene, const std::string& prefix) {
    const auto near = [](const char* what, const std::string& name, const double* a,
                         const double* b, int count) {
      for (int i = 0; i < count; ++i)
        EXPECT_NEAR(a[i], b[i], 1e-9 * (1 + std::abs(a[i]))) << what << " of " << name;
    };
    for (int i = 1; i < alone.nbody; ++i) {
      const std::string name = prefix + name_of(alone, mjOBJ_BODY, i);
      const int k = mj_name2id(&scene, mjOBJ_BODY, name.c_str());
      ASSERT_GE(k, 0) << name;
      near("mass", name, alone.body_mass + i, scene.body_mass + k, 1);
      near("inertia", name, alone.body_inertia + 3 * i, scene.body_inertia + 3 * k, 3);
      near("centre", name, alone.body_ipos + 3 * i, scene.body_ipos + 3 * k, 3);
      near("quat", name, alone.body_quat + 4 * i, scene.body_quat + 4 * k, 4);
    }
    for (int i = 0; i < alone.njnt; ++i) {
      const std::string name = name_of(alone, mjOBJ_JOINT, i);
      if (name.empty()) continue;
      const int k = mj_name2id(&scene, mjOBJ_JOINT, (prefix + name).c_str());
      near("range", name, alone.jnt_range + 2 * i, scene.jnt_range + 2 * k, 2);
      EXPECT_EQ(alone.jnt_limited[i], scene.jnt_limited[k]) << name;
    }
    const int muscle = mj_name2id(&scene, mjOBJ_ACTUATOR, (prefix + "m").c_str());
    near("length range", "m", alone.actuator_lengthrange, scene.actuator_lengthrange + 2 * muscle,
         2);
  }

  TempFolder folder_;
};

TEST_F(CompilerOptions, OfAnAttachedModelAreThoseOfTheModelAlone) {
  for (const char* attributes :
       {"", "settotalmass='10'", "settotalmass='10' boundmass='.5' boundinertia='.05'",
        "settotalmass='10' alignfree='true'", "settotalmass='10' inertiafromgeom='true'",
        "settotalmass='10' inertiafromgeom='true' inertiagrouprange='0 2'",
        "settotalmass='10' angle='radian' eulerseq='zyx'", "boundmass='.5'", "boundinertia='.05'",
        "balanceinertia='true'", "inertiafromgeom='true'", "angle='radian'", "eulerseq='zyx'",
        "alignfree='true'", "usethread='false'", "discardvisual='true'"}) {
    SCOPED_TRACE(attributes);
    const std::string text = model(fmt::format("<compiler {}/>", attributes));
    const Result<World> alone = compile("r.xml", text);
    ASSERT_TRUE(alone.ok()) << alone.error().to_string();
    const Result<World> scene =
        compile("s.toml",
                "[[robot]]\nname = 'a'\nfile = 'r.xml'\n[[robot]]\nname = 'b'\nfile = 'r.xml'\n"
                "position = [3, 0, 0]\n");
    ASSERT_TRUE(scene.ok()) << scene.error().to_string();
    for (const char* prefix : {"a/", "b/"})
      expect_same(*alone->compiled()->model, *scene->compiled()->model, prefix);
  }
}

TEST_F(CompilerOptions, OfLengthRangesStayTheModelsOwn) {
  const std::string text =
      model("<compiler><lengthrange uselimit='false' inttotal='1' interval='.5'/></compiler>");
  const Result<World> alone = compile("r.xml", text);
  ASSERT_TRUE(alone.ok()) << alone.error().to_string();
  const Result<World> scene = compile("s.toml", "[[robot]]\nname = 'a'\nfile = 'r.xml'\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  expect_same(*alone->compiled()->model, *scene->compiled()->model, "a/");
}

TEST_F(CompilerOptions, OfTheEnvironmentAreNotTheRobots) {
  folder_.write("place.xml", model("<compiler settotalmass='10'/>"));
  folder_.write("r.xml",
                "<mujoco><worldbody><body name='b'><freejoint/>"
                "<geom size='.1' mass='4'/></body></worldbody></mujoco>");
  const Result<World> scene = compile("s.toml",
                                      "[environment]\nfile = 'place.xml'\n[[robot]]\nname = 'a'\n"
                                      "file = 'r.xml'\nposition = [0, 0, 5]\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  const mjModel& m = *scene->compiled()->model;
  const int robot = mj_name2id(&m, mjOBJ_BODY, "a/b");
  EXPECT_NEAR(m.body_mass[robot], 4, 1e-9);
  EXPECT_NEAR(mj_getTotalmass(&m), 14, 1e-9);
}

TEST_F(CompilerOptions, ThatAreLeftOutAreNoted) {
  folder_.write("r.xml", model("<compiler fusestatic='true'/>"));
  const Result<World> scene = compile("s.toml", "[[robot]]\nname = 'a'\nfile = 'r.xml'\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  std::string notes;
  for (const Error& note : scene->info().notes) notes += note.to_string() + "\n";
  EXPECT_THAT(notes, HasSubstr("r.xml:1: robot 'a': 'fusestatic' is ignored"));
}

}  // namespace
}  // namespace gloam

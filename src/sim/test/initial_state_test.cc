// Robots begin in the keyframes their scene names, where the scene puts them.

#include "test_world.h"

namespace gloam {
namespace {

const char* const kLeg =
    R"(<mujoco><worldbody><body name="base"><freejoint name="f"/><geom size=".1"/>
  <body name="leg" pos="0 0 -.2"><joint name="h" axis="0 1 0"/><geom size=".05"/></body></body></worldbody>
  <actuator><position name="h" joint="h" kp="5"/></actuator>
  <keyframe><key name="stand" qpos="0 0 .5 1 0 0 0 .7" qvel="1 0 0 0 0 0 0" ctrl=".7"/></keyframe></mujoco>)";

// Two of them in one model, as a scene attaches them.
std::shared_ptr<CompiledWorld> two_legs() {
  char error[500];
  auto world = std::make_shared<CompiledWorld>();
  world->spec.reset(mj_makeSpec());
  mjsBody* ground = mjs_findBody(world->spec.get(), "world");
  const Pose poses[2] = {{{1, 0, 0}, {}}, {{0, 2, 0}, {0, 0, 0, 1}}};  // the second turned by 180°
  for (int i = 0; i < 2; ++i) {
    SpecPtr leg(mj_parseXMLString(kLeg, nullptr, error, sizeof(error)));
    mjsFrame* frame = mjs_addFrame(ground, nullptr);
    const Pose& X = poses[i];
    const double p[3] = {X.p.x, X.p.y, X.p.z}, q[4] = {X.q.w, X.q.x, X.q.y, X.q.z};
    mju_copy3(frame->pos, p);
    mju_copy4(frame->quat, q);
    const std::string prefix = i == 0 ? "one/" : "two/";
    EXPECT_NE(
        mjs_attach(frame->element, mjs_findBody(leg.get(), "base")->element, prefix.c_str(), ""),
        nullptr);
    RobotInstance robot;
    robot.name = prefix;
    robot.prefix = prefix;
    robot.options.X_WR = X;
    world->robots.push_back(robot);
  }
  world->model.reset(mj_compile(world->spec.get(), nullptr));
  EXPECT_TRUE(world->model) << mjs_getError(world->spec.get());
  for (RobotInstance& robot : world->robots) {
    robot.root_body = mj_name2id(world->model.get(), mjOBJ_BODY, (robot.prefix + "base").c_str());
  }
  return world;
}

TEST(InitialState, EachRobotTakesItsOwnKeyframeWhereItStands) {
  auto world = two_legs();
  world->robots[1].options.keyframe = "stand";
  auto sim = make_simulator(world, lockstep());
  const Snapshot s = sim->latest();
  const mjModel* m = world->model.get();
  const Joint f1{mj_name2id(m, mjOBJ_JOINT, "one/f")}, h1{mj_name2id(m, mjOBJ_JOINT, "one/h")},
      f2{mj_name2id(m, mjOBJ_JOINT, "two/f")}, h2{mj_name2id(m, mjOBJ_JOINT, "two/h")};
  EXPECT_EQ(s[f1].qpos[0], 1);
  EXPECT_EQ(s[f1].qpos[2], 0);
  EXPECT_EQ(s[h1].position(), 0);
  EXPECT_EQ(s[f2].qpos[1], 2);
  EXPECT_EQ(s[f2].qpos[2], .5);
  EXPECT_NEAR(std::abs(s[f2].qpos[6]), 1, 1e-15);
  EXPECT_NEAR(s[f2].qvel[0], -1, 1e-15);  // forward for a robot that looks back
  EXPECT_EQ(s[h2].position(), .7);
  EXPECT_EQ(s.control(Actuator{mj_name2id(m, mjOBJ_ACTUATOR, "two/h")}), .7);
  EXPECT_EQ(s.control(Actuator{mj_name2id(m, mjOBJ_ACTUATOR, "one/h")}), 0);
}

TEST(InitialState, ABareModelsKeyframeIsTakenWhole) {
  auto world = world_from_mjcf(kLeg);
  world->robots[0].options.keyframe = "stand";
  auto sim = make_simulator(world, lockstep());
  DataPtr d(mj_makeData(world->model.get()));
  mj_resetDataKeyframe(world->model.get(), d.get(), 0);
  const Snapshot s = sim->latest();
  for (int i = 0; i < 8; ++i) EXPECT_EQ(s.state()[static_cast<size_t>(1 + i)], d->qpos[i]);
}

TEST(InitialState, AnUnknownKeyframeIsAnErrorWithTheNearestName) {
  auto world = two_legs();
  world->robots[0].options.keyframe = "stant";
  world->robots[0].options.loc = {"scene.toml", 4};
  auto sim = Simulator::create(world);
  ASSERT_FALSE(sim.ok());
  EXPECT_EQ(sim.error().loc.line, 4);
  EXPECT_NE(sim.error().to_string().find("'stand'"), std::string::npos) << sim.error().to_string();
}

}  // namespace
}  // namespace gloam

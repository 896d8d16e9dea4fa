// Live fields that change how bodies move: at full precision, without a recompile, until a reset.

#include <algorithm>

#include "gloam/command.h"
#include "sim/commands/live_fields.h"
#include "test_world.h"

namespace gloam {
namespace {

const LiveFieldId kDynamics[] = {LiveFieldId::kGravity,         LiveFieldId::kWind,
                                 LiveFieldId::kBodyMass,        LiveFieldId::kGeomFriction,
                                 LiveFieldId::kActuatorGain,    LiveFieldId::kActuatorBias,
                                 LiveFieldId::kDofArmature,     LiveFieldId::kDofDamping,
                                 LiveFieldId::kDofFrictionLoss, LiveFieldId::kJointStiffness};

/// Numbers that no float holds.
std::vector<double> odd_numbers(const mjModel& model, LiveFieldId field) {
  std::vector<double> values = read_live_field(model, field);
  for (size_t i = 0; i < values.size(); ++i)
    values[i] =
        field == LiveFieldId::kBodyMass && values[i] == 0 ? 0 : 0.1 + static_cast<double>(i) / 3;
  return values;
}

TEST(DynamicsFields, ReachTheStepInDoublePrecisionAndAResetTakesThemBack) {
  for (const LiveFieldId field : kDynamics) {
    const auto world = world_from_mjcf(kRichModel);
    const auto sim = make_simulator(world, lockstep());
    std::vector<double> stepped;
    ASSERT_TRUE(sim->set_step_hook([&](const mjModel* model, mjData*) {
                     stepped = read_live_field(*model, field);
                   })
                    .ok());
    sim->start();
    const std::vector<double> wanted = odd_numbers(*world->model, field);
    ASSERT_FALSE(wanted.empty()) << live_field_name(field);
    ASSERT_TRUE(sim->post({.what = SetLiveField{field, 0, wanted}}).ok()) << live_field_name(field);
    ASSERT_TRUE(sim->step().ok());
    EXPECT_EQ(stepped, wanted) << live_field_name(field);
    ASSERT_TRUE(sim->reset().ok());
    ASSERT_TRUE(sim->step().ok());
    EXPECT_EQ(stepped, read_live_field(*world->model, field)) << live_field_name(field);
  }
}

TEST(DynamicsFields, MoveAsAModelThatWasWrittenSo) {
  const std::string plain =
      "<mujoco><option timestep=\"0.01\"/><worldbody><body name=\"arm\"><joint name=\"j\" axis=\"0 "
      "1 "
      "0\" damping=\"0.3\" armature=\"0.01\"/><geom size=\".1\" pos=\".5 0 0\" "
      "mass=\"1\"/></body></worldbody><actuator><position joint=\"j\" "
      "kp=\"10\"/></actuator></mujoco>";
  std::string other = plain;
  for (const auto& [from, to] : {std::pair{"damping=\"0.3\"", "damping=\"0.77\""},
                                 {"armature=\"0.01\"", "armature=\"0.13\""},
                                 {"kp=\"10\"", "kp=\"17.3\""}})
    other.replace(other.find(from), std::string(from).size(), to);
  const auto changed = make_simulator(world_from_mjcf(plain), lockstep());
  const auto written = make_simulator(world_from_mjcf(other), lockstep());
  ASSERT_TRUE(changed->post({0, SetLiveField{LiveFieldId::kDofDamping, 0, {0.77}}}).ok());
  ASSERT_TRUE(changed->post({0, SetLiveField{LiveFieldId::kDofArmature, 0, {0.13}}}).ok());
  ASSERT_TRUE(changed->post({0, SetLiveField{LiveFieldId::kActuatorGain, 0, {17.3}}}).ok());
  ASSERT_TRUE(changed->post({0, SetLiveField{LiveFieldId::kActuatorBias, 1, {-17.3}}}).ok());
  for (const auto& sim : {changed.get(), written.get()}) {
    ASSERT_TRUE(sim->post({0, SetControl{Actuator{0}, 0.4}}).ok());
    sim->start();
    ASSERT_TRUE(sim->step(50).ok());
  }
  EXPECT_EQ(changed->latest()[Joint{0}].position(), written->latest()[Joint{0}].position());
  EXPECT_NE(changed->latest()[Joint{0}].position(), 0);
}

TEST(DynamicsFields, GoAlongInARecompileByTheirJoints) {
  const std::string arm =
      "<body name=\"arm\"><joint name=\"j\" axis=\"0 1 0\"/><geom size=\".1\" mass=\"1\"/></body>";
  const std::string box = "<body name=\"box\"><freejoint/><geom size=\".1\" mass=\"1\"/></body>";
  const auto scene = [](const std::string& bodies) {
    return world_from_mjcf("<mujoco><worldbody>" + bodies + "</worldbody></mujoco>");
  };
  const auto first = scene(arm), second = scene(box + arm);
  const auto sim = make_simulator(first, lockstep());
  sim->start();
  ASSERT_TRUE(sim->post({.what = SetLiveField{LiveFieldId::kDofDamping, 0, {0.7}}}).ok());
  ASSERT_TRUE(sim->step().ok());
  ASSERT_TRUE(sim->recompile(second, {}).ok());
  std::vector<double> damping;
  live_field_at(*second->model, sim->latest().data().live.get(), LiveFieldId::kDofDamping,
                &damping);
  EXPECT_EQ(damping, (std::vector<double>{0, 0, 0, 0, 0, 0, 0.7}));
}

}  // namespace
}  // namespace gloam

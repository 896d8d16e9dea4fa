// Physics through the Simulator is MuJoCo's, bit by bit, and MuJoCo's is physics.

#include <cmath>

#include "sim/state/state_layout.h"
#include "test_world.h"

namespace gloam {
namespace {

TEST(Physics, FreeFallFollowsTheClosedFormOfTheIntegrator) {
  auto world = world_from_mjcf(R"(<mujoco><option timestep="0.002" gravity="0 0 -9.81"/>
    <worldbody><body pos="0 0 10"><freejoint name="f"/><geom size=".1" mass="2"/></body></worldbody></mujoco>)");
  auto sim = make_simulator(world, lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(500).ok());
  const Snapshot s = sim->latest();
  // Semi-implicit Euler: v_n = -g n h, z_n = z_0 - g h² n (n + 1) / 2.
  const double n = 500, h = 0.002, g = 9.81;
  EXPECT_EQ(s.step(), 500);
  EXPECT_NEAR(s.time(), 1.0, 1e-12);
  EXPECT_NEAR(s[Joint{0}].qvel[2], -g * n * h, 1e-11);
  EXPECT_NEAR(s[Joint{0}].qpos[2], 10 - g * h * h * n * (n + 1) / 2, 1e-11);
  EXPECT_EQ(s[Joint{0}].qpos.size(), 7u);
  EXPECT_EQ(s[Joint{0}].qvel.size(), 6u);
}

// Largest relative change of the total energy of a pendulum over ten seconds.
double energy_drift(const char* integrator) {
  auto world = world_from_mjcf(std::string(R"(<mujoco><option timestep="0.002" integrator=")") +
                               integrator + R"("><flag energy="enable"/></option>
    <worldbody><body pos="0 0 2"><joint name="j" type="hinge" axis="0 1 0"/>
    <geom type="sphere" size=".05" pos="1 0 0" mass="1"/></body></worldbody></mujoco>)");
  auto sim = make_simulator(world, lockstep());
  const mjModel& m = *world->model;
  const double inertia = m.dof_M0[0], weight = 9.81;  // m g l
  double drift = 0;
  auto queue = *sim->subscribe({.rate = {100, 1}, .required = true, .capacity = 1001});
  sim->start();
  EXPECT_TRUE(sim->step(5000).ok());
  while (Snapshot s = queue->try_next()) {
    const double q = s[Joint{0}].position(), v = s[Joint{0}].velocity();
    // The height of the mass above the hinge is -sin q; at rest at q = 0 the energy is zero.
    const double energy = inertia * v * v / 2 - weight * std::sin(q);
    drift = std::max(drift, std::abs(energy) / weight);
  }
  return drift;
}

TEST(Physics, PendulumKeepsItsEnergyAsWellAsItsIntegratorCan) {
  const double rk4 = energy_drift("RK4"), euler = energy_drift("Euler"),
               implicit = energy_drift("implicit");
  EXPECT_LT(rk4, 1e-9);       // fourth order
  EXPECT_LT(euler, 0.02);     // symplectic: bounded, first order
  EXPECT_LT(implicit, 0.02);  // no damping here: the same scheme
  EXPECT_GT(euler, 1e-5);
}

// State and sensors of a bare loop at every step, under random controls.
void expect_equal_to_bare_loop(const char* xml, int steps, bool reuse_mocap) {
  auto world = world_from_mjcf(xml);
  const mjModel* m = world->model.get();
  DataPtr d(mj_makeData(m));
  auto sim = make_simulator(world, lockstep());
  ASSERT_TRUE(sim->add_controller(0, std::make_unique<RandomController>(), {500, 1}).ok());
  auto queue = *sim->subscribe({.rate = {500, 1}, .required = true, .capacity = steps + 1});
  if (reuse_mocap) {
    for (int n = 0; n < steps; n += 10) {
      ASSERT_TRUE(sim->post({n, SetMocapPose{Body{mj_name2id(m, mjOBJ_BODY, "hand")},
                                             {{-1, 0.1 * random_control(n, 99), 1}, {}}}})
                      .ok());
    }
  }
  sim->start();
  ASSERT_TRUE(sim->step(steps).ok());
  std::vector<double> state(static_cast<size_t>(state_size(*m)));
  for (int n = 0; n <= steps; ++n) {
    const Snapshot s = queue->try_next();
    ASSERT_TRUE(s);
    ASSERT_EQ(s.step(), n);
    mj_getState(m, d.get(), state.data(), mjSTATE_INTEGRATION);
    ASSERT_TRUE(std::equal(state.begin(), state.end(), s.state().begin())) << "at step " << n;
    if (n > 0) {
      ASSERT_TRUE(
          std::equal(d->sensordata, d->sensordata + m->nsensordata, s.data().sensordata.begin()))
          << "at step " << n;
    }
    for (int i = 0; i < m->nu; ++i) d->ctrl[i] = random_control(n, i);
    if (reuse_mocap && n % 10 == 0) d->mocap_pos[1] = 0.1 * random_control(n, 99);
    mj_step(m, d.get());
  }
  EXPECT_EQ(sim->counters().steps, steps);
}

TEST(Physics, EqualsABareLoopBitByBit) { expect_equal_to_bare_loop(kRichModel, 2000, true); }

TEST(Physics, EqualsABareLoopBitByBitWithOtherIntegrators) {
  for (const char* integrator : {"RK4", "implicit", "implicitfast"}) {
    SCOPED_TRACE(integrator);
    std::string xml = kRichModel;
    const std::string option = "<option timestep=\"0.002\"/>";
    xml.replace(xml.find(option), option.size(),
                std::string("<option timestep=\"0.002\" integrator=\"") + integrator + "\"/>");
    expect_equal_to_bare_loop(xml.c_str(), 300, true);
  }
}

TEST(Physics, EqualsABareLoopBitByBitWithFlexesAndSleep) {
  expect_equal_to_bare_loop(R"(<mujoco><option timestep="0.002"><flag sleep="enable"/></option>
    <worldbody><geom type="plane" size="2 2 .1"/>
      <body pos="0 0 .05"><freejoint/><geom type="box" size=".05 .05 .05"/></body>
      <flexcomp name="cloth" type="grid" count="5 5 1" spacing=".05 .05 .05" pos="0 0 .5" dim="2" radius=".005" mass=".1">
        <contact selfcollide="none"/><edge equality="true"/></flexcomp></worldbody></mujoco>)",
                            600, false);
}

TEST(Physics, SensorsAreStampedWithTheTimeOfTheStateTheyWereComputedFrom) {
  auto world = world_from_mjcf(kRichModel);
  const int clock = mj_name2id(world->model.get(), mjOBJ_SENSOR, "clock");
  auto sim = make_simulator(world, lockstep());
  sim->start();
  Snapshot s = sim->latest();
  EXPECT_EQ(s[SensorHandle{clock}].stamp, 0);
  EXPECT_EQ(s[SensorHandle{clock}].values[0], 0);
  // The sensors of the initial state are there before the first step.
  const int base = mj_name2id(world->model.get(), mjOBJ_SENSOR, "base_pos");
  EXPECT_EQ(s[SensorHandle{base}].values.size(), 3u);
  EXPECT_DOUBLE_EQ(s[SensorHandle{base}].values[2], 0.4);
  const Snapshot first = s;
  ASSERT_TRUE(sim->step(1).ok());
  s = sim->latest();
  EXPECT_EQ(s.time(), 0.002);
  EXPECT_EQ(s[SensorHandle{base}].values[2], first[SensorHandle{base}].values[2]);
  ASSERT_TRUE(sim->step(9).ok());
  s = sim->latest();
  EXPECT_EQ(s[SensorHandle{clock}].stamp, s[SensorHandle{clock}].values[0]);
  EXPECT_NEAR(s[SensorHandle{clock}].stamp, s.time() - 0.002, 1e-15);
}

TEST(Physics, TimestepCanBeChosen) {
  SimulatorOptions options = lockstep();
  options.timestep = 0.004;
  auto sim = make_simulator(world_from_mjcf(kRichModel), options);
  EXPECT_EQ(sim->timestep(), (Rational{1, 250}));
  sim->start();
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_NEAR(sim->latest().time(), 0.04, 1e-15);
  options.timestep = -1;
  EXPECT_FALSE(Simulator::create(world_from_mjcf(kRichModel), options).ok());
}

}  // namespace
}  // namespace gloam

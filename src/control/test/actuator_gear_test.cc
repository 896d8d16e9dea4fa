// Friction and backlash against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

#include "actuator_rig.h"

namespace gloam {
namespace {

TEST(GearFriction, HasTheValuesOfTheStribeckCurve) {
  const ActuatorFriction friction{
      .coulomb = 0.6, .breakaway = 1, .stribeck_speed = 0.5, .viscous = 0.02, .smoothing = 0.01};
  for (const double v : {-3.0, -0.5, 0.1, 0.5, 1.0, 20.0}) {
    ActuatorRig rig(Wheel{.speed = v}, ActuatorOptions{.friction = friction});
    rig.step();
    const double dry = 0.6 + 0.4 * std::exp(-v * v / 0.25);
    EXPECT_NEAR(rig.outputs().drives[0].force, -std::copysign(dry, v) - 0.02 * v, 1e-7) << v;
  }
}

TEST(GearFriction, HoldsBelowTheBreakawayTorqueAndSlidesAboveIt) {
  const ActuatorFriction friction{.coulomb = 0.6, .breakaway = 1, .smoothing = 0.01};
  const Wheel wheel{.timestep = 2e-4};
  ActuatorRig held(wheel, ActuatorOptions{.friction = friction});
  held.command(0.5);
  held.step(20000);
  // It creeps at the speed where the smoothed friction equals the torque.
  const auto creep = [](double v) {
    return (0.6 + 0.4 * std::exp(-v * v / 0.01)) * std::tanh(v / 0.01);
  };
  EXPECT_NEAR(creep(held.speed()), 0.5, 1e-6);
  EXPECT_LT(held.speed(), 0.01);

  ActuatorRig sliding(wheel, ActuatorOptions{.friction = friction});
  sliding.command(1.2);
  sliding.step(10000);
  const double before = sliding.speed();
  sliding.step(5000);
  EXPECT_NEAR(sliding.speed() - before, (1.2 - 0.6) / 0.05, 1e-6);
}

TEST(GearFriction, StopsAWheelAtTheCoulombRate) {
  const Wheel wheel{.timestep = 1e-4, .speed = 12};
  ActuatorRig rig(wheel, ActuatorOptions{.friction = ActuatorFriction{.coulomb = 0.6}});
  rig.step(9000);
  EXPECT_NEAR(rig.speed(), 12 - 0.9 * 0.6 / 0.05, 1e-6);
  rig.step(5000);
  EXPECT_NEAR(rig.speed(), 0, 1e-6);
}

// A light joint: explicit steps of a friction that changes sign too fast would not come to rest.
TEST(GearFriction, IsStableForLightJoints) {
  const Wheel wheel{.inertia = 1e-4, .timestep = 2e-3, .speed = 5};
  ActuatorRig rig(wheel, ActuatorOptions{.friction = ActuatorFriction{.coulomb = 0.5}});
  rig.step(500);
  EXPECT_LT(std::abs(rig.speed()), 1e-3);
}

// In the play the rotor of inertia J speeds up by itself: w = w0 (1 − exp(−t / T)), T = J w0 /
// stall. It crosses the play b when w0 (t − T (1 − exp(−t / T))) = b.
TEST(Backlash, DelaysAReversalByTheTimeInThePlay) {
  constexpr double kPlay = 0.05, kStall = 2, kNoLoad = 10;
  const Wheel wheel{.inertia = 1, .armature = 0.002, .timestep = 1e-5};
  ActuatorRig rig(
      wheel, ActuatorOptions{.stall_torque = kStall, .no_load_speed = kNoLoad, .backlash = kPlay});
  rig.command(kStall);
  rig.step(20000);
  ASSERT_GT(rig.outputs().drives[0].force, 1.5) << "in contact on the driving side";
  const double v = rig.speed();
  rig.command(-2 * kStall);
  int64_t steps = 0;
  do {
    rig.step();
    ++steps;
  } while (rig.outputs().drives[0].force == 0 && steps < 100000);
  // From −v relative to the final speed −w0, while the joint keeps its speed v.
  const double time_constant = wheel.armature * kNoLoad / kStall;
  const auto crossed = [&](double t) {
    const double decay = time_constant * (1 - std::exp(-t / time_constant));
    return (kNoLoad + v) * (t - decay);
  };
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) (crossed((low + high) / 2) < kPlay ? low : high) = (low + high) / 2;
  EXPECT_NEAR(static_cast<double>(steps) * wheel.timestep, low, 0.01 * low);
  EXPECT_GT(low, kPlay / (kNoLoad + v)) << "longer than width / speed, for the rotor speeds up";
}

// The rotor hits the joint: momentum is kept, and they go on together.
TEST(Backlash, KeepsTheMomentumOfTheImpact) {
  const Wheel wheel{.inertia = 0.05, .armature = 0.01, .timestep = 1e-4};
  ActuatorRig rig(wheel, ActuatorOptions{.backlash = 0.2});
  rig.command(0.5);
  int64_t steps = 0;
  do {
    rig.step();
    ++steps;
  } while (rig.speed() == 0 && steps < 100000);
  const double rotor = static_cast<double>(steps) * wheel.timestep * 0.5 / wheel.armature;
  EXPECT_NEAR(rotor, std::sqrt(2 * 0.1 * 0.5 / wheel.armature), 0.01) << "w² = 2 (b / 2) τ / J";
  EXPECT_NEAR(rig.speed(), rotor * wheel.armature / (wheel.armature + wheel.inertia), 1e-9);
  rig.step(100);
  EXPECT_NEAR(rig.outputs().drives[0].force, 0.5, 1e-12) << "in contact";
}

// A position servo with play: its error stays in the band of the play.
TEST(Backlash, LeavesAnErrorBandOfItsWidth) {
  Wheel wheel{.inertia = 0.05, .armature = 0.01, .timestep = 5e-4};
  wheel.actuator = R"(<position name="wheel" joint="wheel" kp="200" kv="6"/>)";
  ActuatorRig rig(wheel,
                  ActuatorOptions{.backlash = 0.04, .friction = ActuatorFriction{.viscous = 0.5}});
  rig.command(0.5);
  rig.step(6000);
  for (int i = 0; i < 2000; ++i) {
    rig.step();
    ASSERT_LT(std::abs(rig.position() - 0.5), 0.04) << i;
  }
}

}  // namespace
}  // namespace gloam

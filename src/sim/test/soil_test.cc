// Beds of soil: how far plates and wheels sink, what they lose, what holds against sliding.

#include "sim/effects/soil/soil_bed.h"

#include "soil_rig.h"

namespace gloam {
namespace {

constexpr double kEarthG = 9.81;

/// Lowered onto a bed by its weight, against a damper that lets it sink without overshoot.
struct Lowered {
  double sinkage = 0, soil_work = 0;  // [m], [J]
};
Lowered lower(const std::string& kind, const std::string& geom, double half_height, double area,
              double pressure, double expected) {
  const double mass = pressure * area / kEarthG;
  const double damping = 3 * mass * std::sqrt(Law(kind).s.n * kEarthG / expected);
  OnSoil plate(world_with_soil(
      fmt::format("<body pos='.013 .007 {}'><joint type='slide' axis='0 0 1' damping='{}'/>"
                  "<geom {} mass='{}'/></body>",
                  half_height, damping, geom, mass),
      bed_of(kind)));
  double lost = 0, before = 0;
  for (int i = 0; i < 2000; ++i) {
    plate.steps(1);
    const double v = plate.v(0);
    lost += damping * (v * v + before * before) / 2 * 0.002;
    before = v;
  }
  const double z = -plate.q(0);
  return {z, mass * kEarthG * z - lost - mass * before * before / 2};
}

std::string round_plate(double radius) {
  return fmt::format("type='cylinder' size='{} .02'", radius);
}

TEST(SoilPlates, SinkAsBekkerSaysAndTakeTheEnergyOfIt) {
  for (const char* kind : {"dry_sand", "clayey_soil"}) {
    const Law law(kind);
    for (const double radius : {0.05, 0.1, 0.15}) {
      const double area = std::numbers::pi * radius * radius;
      for (const double pressure : {30e3, 60e3, 100e3, 150e3, 200e3}) {
        const double z = law.sinkage(pressure, radius);
        const Lowered is = lower(kind, round_plate(radius), 0.02, area, pressure, z);
        const std::string what = fmt::format("{}, radius {} m, {} Pa", kind, radius, pressure);
        EXPECT_NEAR(is.sinkage, z, 0.05 * z) << what;
        const double work = area * law.pressure(z, radius) * z / (law.s.n + 1);
        EXPECT_NEAR(is.soil_work, work, 0.1 * work) << what;
      }
    }
  }
}

// Where pressure grows faster than sinkage, the line of a touch by a hair never meets its curve.
TEST(SoilLaw, IsNotWeakenedByALightTouch) {
  for (const char* kind : {"snow", "dry_sand", "clayey_soil"}) {
    const Law law(kind);
    for (const double before : {1e-9, 1e-6, 1e-3}) {
      const SoilCell cell{static_cast<float>(before),
                          static_cast<float>(law.pressure(before, 0.1))};
      SoilLanes lanes;
      const double still[6] = {}, place[3] = {};
      lanes.set(0, SoilTouch{.area = 2, .depth = 0.05}, place, law.modulus(0.1), 0.5);
      lanes.set(0, cell, 0);
      lanes.find_loading(law.s, still, 0.001);
      lanes.find_unloading(law.s);
      lanes.find_forces(law.s, still, 0.001);
      EXPECT_NEAR(lanes.load[0], 2 * law.pressure(0.05, 0.1), 2) << kind << " after " << before;
      EXPECT_EQ(lanes.stiffness[1], 0) << "nothing is there";
    }
  }
}

// Bekker's b of a long plate is its width.
TEST(SoilPlates, LongOnesSinkByTheirWidth) {
  const Law law("clayey_soil");
  const double width = 0.04, length = 0.8, pressure = 100e3;
  const double b = width * length / (width + length);  // 2 area / edge: 5 % less than the width
  const double z = law.sinkage(pressure, b);
  const Lowered is = lower("clayey_soil", "type='box' size='.4 .02 .02' euler='0 0 30'", 0.02,
                           width * length, pressure, z);
  EXPECT_NEAR(is.sinkage, z, 0.05 * z);
  EXPECT_NEAR(is.sinkage, law.sinkage(pressure, width), 0.1 * z);
}

// Two halves of a plate, each a collider, are one plate.
TEST(SoilPlates, CollidersSideBySideAreOnePatch) {
  const Law law("clayey_soil");
  const double pressure = 100e3, b = 0.2 * 0.1 / 0.3, z = law.sinkage(pressure, b);
  const double mass = pressure * 0.02 / kEarthG;
  OnSoil plate(world_with_soil(
      fmt::format("<body pos='0 0 .02'><joint type='slide' axis='0 0 1' damping='{}'/>"
                  "<geom type='box' size='.05 .05 .02' pos='-.05 0 0' mass='{}'/>"
                  "<geom type='box' size='.05 .05 .02' pos='.05 0 0' mass='{}'/></body>",
                  40 * mass, mass / 2, mass / 2),
      bed_of("clayey_soil")));
  plate.run(4);
  EXPECT_NEAR(-plate.q(0), z, 0.05 * z);
}

TEST(SoilPlates, UnloadedTheRutRemainsButForWhatIsElastic) {
  const Law law("dry_sand");
  const double radius = 0.1, area = std::numbers::pi * radius * radius;
  const double mass = 2, load = 80e3 * area - mass * kEarthG;
  auto world = world_with_soil(
      fmt::format("<body pos='0 0 .02'><joint name='z' type='slide' axis='0 0 1' damping='3000'/>"
                  "<geom {} mass='{}'/></body>",
                  round_plate(radius), mass),
      bed_of("dry_sand"), "<actuator><motor joint='z'/></actuator>");
  OnSoil plate(world);
  const auto press = [&](double force) {
    ASSERT_TRUE(plate.sim->post({.what = SetControl{Actuator{0}, force}}).ok());
    plate.run(3);
  };
  press(-load);
  const double deep = -plate.q(0);
  EXPECT_NEAR(deep, law.sinkage(80e3, radius), 0.05 * deep);
  press(-(20e3 * area - mass * kEarthG));
  const double back = deep + plate.q(0), k_u = law.s.a_u * deep;
  EXPECT_NEAR(back, 60e3 / k_u, 0.05 * 60e3 / k_u) << "the elastic part of 60 kPa";
  press(-load);
  EXPECT_NEAR(-plate.q(0), deep, 0.02 * deep) << "it comes to where it was";
  press(600);
  EXPECT_GT(plate.q(0), 0.1) << "the ground does not hold it";
  EXPECT_NEAR(plate.track(0.01, 0.01), -(deep - 80e3 / k_u), 0.03 * deep);
  EXPECT_EQ(plate.track(0.3, 0.3), 0) << "where nobody was";
}

/// A plate that is drawn along x at a constant speed, after it has sunk in.
struct Drawn {
  static constexpr double kLength = 0.4, kWidth = 0.2, kSpeed = 0.02, kServo = 1e6;
  OnSoil plate;
  double load;
  explicit Drawn(double pressure, const std::string& kind)
      : plate(world_with_soil(
            fmt::format("<body pos='-.2 0 .02'><joint name='x' type='slide' axis='1 0 0'/>"
                        "<joint type='slide' axis='0 0 1' damping='{}'/>"
                        "<geom type='box' size='{} {} .02' mass='{}'/></body>",
                        60 * pressure * kLength * kWidth / kEarthG, kLength / 2, kWidth / 2,
                        pressure * kLength * kWidth / kEarthG),
            bed_of(kind, 2),
            fmt::format("<actuator><velocity joint='x' kv='{}'/></actuator>", kServo))),
        load(pressure * kLength * kWidth) {
    plate.run(3);
    EXPECT_TRUE(plate.sim->post({.what = SetControl{Actuator{0}, kSpeed}}).ok());
  }
  double force() { return kServo * (kSpeed - plate.v(0)); }
};

// Janosi and Hanamoto: what is under the plate from the beginning has been sheared by the way that
// it went, what it has come over since by less.
TEST(SoilShear, ADrawnPlateMeetsMohrAndCoulombsLimit) {
  for (const char* kind : {"dry_sand", "clayey_soil"}) {
    const SoilStrength s = soil_strength(kind);
    Drawn drawn(20e3, kind);
    const double most = s.cohesion * Drawn::kLength * Drawn::kWidth + drawn.load * s.tan_friction;
    const double from = drawn.plate.q(0);
    for (const double way : {0.005, 0.01, 0.02, 0.05, 0.1}) {
      while (drawn.plate.q(0) - from < way) drawn.plate.steps(5);
      const double j = drawn.plate.q(0) - from, K = s.shear, e = 1 - std::exp(-j / K);
      const double share = ((Drawn::kLength - j) * e + j - K * e) / Drawn::kLength;
      EXPECT_NEAR(drawn.force(), most * share, 0.05 * most) << kind << " after " << j << " m";
    }
  }
}

TEST(SoilShear, WhatIsPushedLessThanTheLimitStays) {
  const SoilStrength s = soil_strength("dry_sand");
  const double load = 20e3 * 0.04, mass = load / kEarthG;
  const double most = s.cohesion * 0.04 + load * s.tan_friction;
  OnSoil block(world_with_soil(
      fmt::format("<body pos='0 0 .02'><joint name='x' type='slide' axis='1 0 0' damping='{}'/>"
                  "<joint type='slide' axis='0 0 1' damping='{}'/>"
                  "<geom type='box' size='.1 .1 .02' mass='{}'/></body>",
                  20 * mass, 60 * mass, mass),
      bed_of("dry_sand"), "<actuator><motor joint='x'/></actuator>"));
  block.run(2);
  const double from = block.q(0);
  ASSERT_TRUE(block.sim->post({.what = SetControl{Actuator{0}, 0.6 * most}}).ok());
  block.run(4);
  const double at = block.q(0) - from, expected = -s.shear * std::log(1 - 0.6);
  EXPECT_NEAR(at, expected, 0.08 * expected) << "where shear has grown to 0.6 of what it can";
  block.run(4);
  EXPECT_NEAR(block.q(0) - from, at, 1e-5) << "it creeps";
  ASSERT_TRUE(block.sim->post({.what = SetControl{Actuator{0}, 1.3 * most}}).ok());
  block.run(1);
  EXPECT_GT(block.q(0) - from, at + 0.05) << "beyond the limit it slides";
}

// A rigid wheel that is towed slowly: Bekker's formula takes z along the circle for a parabola and
// leaves out what shear carries.
TEST(SoilWheel, SinksAsBekkersRigidWheel) {
  const Law law("dry_sand");
  const double radius = 0.25, width = 0.15;
  for (const double load : {150.0, 300.0, 600.0}) {
    auto world = world_with_soil(
        fmt::format("<body pos='-1.2 0 {0}'><joint name='x' type='slide' axis='1 0 0'/>"
                    "<joint type='slide' axis='0 0 1' damping='{1}'/><inertial pos='0 0 0' "
                    "mass='{2}' diaginertia='1 1 1'/>"
                    "<body><joint type='hinge' axis='0 1 0'/><geom type='cylinder' size='{0} {3}' "
                    "euler='90 0 0' mass='{2}'/></body></body>",
                    radius, 20 * load / kEarthG, load / kEarthG / 2, width / 2),
        bed_of("dry_sand", 4), "<actuator><velocity joint='x' kv='1e5'/></actuator>");
    OnSoil wheel(world);
    wheel.run(1);
    ASSERT_TRUE(wheel.sim->post({.what = SetControl{Actuator{0}, 0.3}}).ok());
    wheel.run(3);
    double z = 0, drag = 0;
    for (int i = 0; i < 100; ++i) {
      wheel.steps(10);
      z += -wheel.q(1) / 100;
      drag += 1e5 * (0.3 - wheel.v(0)) / 100;
    }
    const double n = law.s.n;
    const double formula = std::pow(
        3 * load / (width * (3 - n) * law.modulus(width) * std::sqrt(2 * radius)), 2 / (2 * n + 1));
    EXPECT_NEAR(z, formula, 0.2 * formula) << load << " N";
    // Of compaction: b modulus z^(n+1) / (n+1).
    const double resistance = width * law.modulus(width) * std::pow(z, n + 1) / (n + 1);
    EXPECT_NEAR(drag, resistance, 0.3 * resistance) << load << " N";
    const double rut = wheel.track(wheel.q(0) - 1.2 - 0.4, 0.005);
    EXPECT_NEAR(-rut, z, 0.2 * z) << "the rut behind it";
  }
}

// ---- what cannot be ----

TEST(SoilBedRun, StandsWhatIsAbsurd) {
  const std::string floor = "<geom type='plane' size='3 3 .1' pos='0 0 -.15'/>";
  for (const char* kind : {"dry_sand", "lean_clay", "mud", "snow"}) {
    OnSoil pin(world_with_soil(
        floor +
            "<body pos='0 0 10'><freejoint/><geom type='capsule' size='.004 .2' "
            "mass='1000'/></body>"
            "<body pos='.5 0 10'><freejoint/><geom type='box' size='.2 .2 .2' mass='1000'/></body>"
            "<body pos='-.5 0 3' quat='.9 .1 .3 .2'><freejoint/><geom type='ellipsoid' "
            "size='.1 .02 .05' mass='1e-4'/></body>",
        bed_of(kind, 2, 0.15)));
    for (int i = 0; i < 20; ++i) {
      pin.run(0.25);
      for (int body = 0; body < 3; ++body) {
        EXPECT_TRUE(std::isfinite(pin.q(body, 2))) << kind;
        EXPECT_LT(pin.q(body, 2), 11) << kind << ": thrown up";
      }
    }
    EXPECT_GT(pin.q(1, 2), -0.16) << kind << ": through the floor";
    EXPECT_LT(std::abs(pin.v(1, 2)), 0.2) << kind;
  }
}

// What a ball has pushed aside lies no steeper than its friction holds, and none of it is lost.
TEST(SoilBedRun, HeapsLieAtTheirAngleOfRepose) {
  SoilOptions o = bed_of("dry_sand", 1, 0.3);
  o.cell = 0.01;
  OnSoil rig(world_with_soil(
      "<body pos='0 0 .4'><freejoint/><geom size='.05' density='9000'/></body>", o));
  rig.run(1);
  double hole = 0, heap = 0, highest = 0;
  for (int i = -48; i < 48; ++i) {
    for (int j = -48; j < 48; ++j) {
      const double x = 0.01 * i + 0.005, y = 0.01 * j + 0.005, here = rig.track(x, y);
      (here < 0 ? hole : heap) += here;
      highest = std::max(highest, here);
      if (here <= 0 || std::hypot(x, y) < 0.07) continue;
      for (const double beside : {rig.track(x + 0.01, y), rig.track(x, y + 0.01)})
        EXPECT_LT(std::abs(here - beside), 0.01 * std::tan(28 * M_PI / 180) * 1.2) << x << " " << y;
    }
  }
  EXPECT_NEAR(heap, -0.5 * hole, 0.05 * heap);
  EXPECT_GT(highest, 0.003);
  EXPECT_LT(highest, 0.03);
}

// Steepest slope of the walls of a rut that a wheel has left at an angle to the rows of cells.
double steepest_wall(const char* kind) {
  SoilOptions o = bed_of(kind, 2, 0.3);
  constexpr double kCell = 0.0125;
  o.cell = kCell;
  OnSoil wheel(world_with_soil(
      "<body pos='-.6 -.1 .1' euler='0 0 4'><joint type='slide' axis='1 0 0'/>"
      "<joint name='z' type='slide' axis='0 0 1' damping='200'/><inertial pos='0 0 0' mass='1' "
      "diaginertia='1 1 1'/>"
      "<body><joint name='turn' type='hinge' axis='0 1 0'/><geom type='cylinder' size='.1 .03' "
      "euler='90 0 0' mass='9'/></body></body>",
      o, "<actuator><velocity joint='turn' kv='50'/></actuator>"));
  wheel.run(0.5);
  EXPECT_TRUE(wheel.sim->post({.what = SetControl{Actuator{0}, 6}}).ok());
  wheel.run(2);
  EXPECT_GT(wheel.q(0), 0.5) << kind << ": it is stuck";
  double steepest = 0, deepest = 0;
  for (int i = 0; i < 24; ++i) {  // what is behind the wheel
    for (int j = -40; j < 40; ++j) {
      const double x = -0.5 + kCell * i, y = kCell * (j + 0.5), here = wheel.track(x, y);
      deepest = std::min(deepest, here);
      for (const double beside : {wheel.track(x + kCell, y), wheel.track(x, y + kCell)})
        steepest = std::max(steepest, std::abs(here - beside) / kCell);
      const double across = std::abs(here - wheel.track(x + kCell, y + kCell));
      steepest = std::max(steepest, across / kCell / std::numbers::sqrt2);
    }
  }
  EXPECT_LT(deepest, -0.008) << kind << ": there is no rut";
  return steepest;
}

TEST(SoilBedRun, WallsOfDrySandFallInBehindAWheelAndThoseOfRegolithStand) {
  EXPECT_LT(steepest_wall("dry_sand"), 1.1 * std::tan(28 * M_PI / 180));
  EXPECT_GT(steepest_wall("lunar"), 1.5 * std::tan(35 * M_PI / 180));
}

TEST(SoilBedRun, ABallThatFallsStaysWhereItFell) {
  OnSoil ball(world_with_soil(
      "<body pos='0 0 1'><freejoint/><geom type='sphere' size='.1' density='3000'/></body>",
      bed_of("dry_sand")));
  double highest = -1;
  ball.run(0.6);
  for (int i = 0; i < 200; ++i) {
    ball.steps(5);
    highest = std::max(highest, ball.v(0, 2));
  }
  EXPECT_LT(highest, 0.5) << "it fell at 4.2 m/s and bounces by a tenth of that at most";
  EXPECT_LT(ball.q(0, 2), 0.095);
  EXPECT_LT(std::abs(ball.v(0, 2)), 1e-3);
}

// What docs/soil.md says of the cost.
TEST(SoilEffectCost, DISABLED_Measure) {
  struct Case {
    const char *what, *geom;
    double height;
  };
  const Case cases[] = {{"feet (balls, 2 cm)", "type='sphere' size='.02' mass='3'", 0.02},
                        {"wheels (25 cm, 15 cm wide)",
                         "type='cylinder' size='.25 .075' euler='90 0 0' mass='30'", 0.25},
                        {"plates (15 cm)", "type='cylinder' size='.15 .02' mass='100'", 0.02}};
  for (const Case& c : cases) {
    double micros[2] = {};
    constexpr int kCount = 8;
    for (const bool soft : {false, true}) {
      std::string bodies;
      for (int i = 0; i < kCount; ++i)
        bodies += fmt::format(
            "<body pos='{} {} {}'><joint type='slide' axis='0 0 1' damping='500'/>"
            "<geom {}/></body>",
            i % 4 - 1.5, i / 4 - 0.5, c.height, c.geom);
      auto world = world_with_soil(bodies, bed_of("dry_sand", 4));
      if (!soft) world->soils.clear();
      auto sim = make_simulator(world, lockstep());
      sim->start();
      ASSERT_TRUE(sim->step(300).ok());
      const double before = sim->cpu_time();
      ASSERT_TRUE(sim->step(2000).ok());
      micros[soft ? 1 : 0] = (sim->cpu_time() - before) / 2000 * 1e6;
    }
    printf("%d %s: without %.1f, with %.1f microseconds a step: %.2f each\n", kCount, c.what,
           micros[0], micros[1], (micros[1] - micros[0]) / kCount);
  }
}

}  // namespace
}  // namespace gloam

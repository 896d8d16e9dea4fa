// Vehicles: wheels that do not slip, bends that are taken slowly, gaps that are kept.

#include "sim/agents/vehicle.h"
#include "agent_rig.h"
#include "places/catalogue.h"
#include "same_hash.h"

namespace gloam {
namespace {

constexpr double kStep = 0.002;  // [s]

AgentOptions& add_vehicle(AgentRig* rig, const std::string& kind, Vec3 position,
                          std::vector<WaypointOptions> route, const std::string& behavior) {
  AgentOptions& agent = rig->add("v", position, behavior);
  agent.kind = kind;
  agent.route = std::move(route);
  agent.loop = false;
  agent.speed.reset();
  return agent;
}

std::vector<WaypointOptions> bend() {
  return {{{-8, -6, 0}, 0, {}}, {{2, -6, 0}, 0, {}}, {{8, 0, 0}, 0, {}}, {{8, 9, 0}, 0, {}}};
}

double to_spline(const AgentSpline& spline, Vec3d p) {
  double nearest = 1e9;
  Vec3d direction;
  for (double way = 0; way <= spline.length(); way += 0.05)
    nearest = std::min(nearest, flat_norm(spline.at(way, &direction) - p));
  return nearest;
}

TEST(Vehicle, WheelsRollAsFarAsTheyGoAndPointThere) {
  for (const char* kind : {"car", "forklift", "cart"}) {
    SCOPED_TRACE(kind);
    AgentRig rig(agent_place("", 24));
    add_vehicle(&rig, kind, {-8, -6, 0}, bend(), "spline");
    auto stepper = rig.stepper();
    const AgentDescription& d = *agents_of(*stepper).bodies()[0].description;
    const mjModel& m = stepper->model();
    std::array<double, 4> way = {}, rolled = {}, before = {};
    std::array<Vec3d, 4> at;
    double aside = 0, steered = 0;
    for (int i = 0; i < 5000; ++i) {
      ASSERT_TRUE(stepper->step());
      const AgentBody& agent = agents_of(*stepper).bodies()[0];
      for (size_t w = 0; w < 4; ++w) {
        const mjtNum* p = stepper->data().mocap_pos + 3 * d.mocap[kWheelFL + w];
        const Vec3d now{p[0], p[1], p[2]};
        const VehicleAxle& axle = w < 2 ? d.vehicle.front_axle : d.vehicle.rear_axle;
        EXPECT_NEAR(now.z, static_cast<double>(axle.radius), 1e-6) << "it stands on the ground";
        const double heading = agent.motion.heading + agent.vehicle.angle[w];
        if (i > 0) {
          const Vec3d by = now - at[w];
          way[w] += dot(by, heading_vector(heading));
          aside += std::abs(dot(by, heading_vector(heading + M_PI / 2)));
          rolled[w] += wrapped(agent.vehicle.roll[w] - before[w]);
        }
        at[w] = now;
        before[w] = agent.vehicle.roll[w];
        const bool steers = (w < 2) != d.vehicle.steers_rear;
        steered = std::max(steered, steers ? std::abs(agent.vehicle.angle[w]) : 0);
        EXPECT_TRUE(steers || agent.vehicle.angle[w] == 0);
      }
    }
    for (size_t w = 0; w < 4; ++w) {
      const VehicleAxle& axle = w < 2 ? d.vehicle.front_axle : d.vehicle.rear_axle;
      EXPECT_GT(way[w], 4);
      EXPECT_NEAR(rolled[w] * static_cast<double>(axle.radius) / way[w], 1, 0.01) << "wheel " << w;
      EXPECT_LT(aside, 0.02 * 4 * way[w]) << "they slip sideways";
    }
    EXPECT_GT(steered, 0.05) << "nothing was steered";
    EXPECT_GE(mj_name2id(&m, mjOBJ_BODY, "v/front_left_wheel"), 0);
  }
}

TEST(Vehicle, ShowsWhatItsSizeSays) {
  for (const char* kind : {"car", "forklift", "cart"}) {
    SCOPED_TRACE(kind);
    MaterialSet materials;
    const Prop prop = make_prop({kind, 3}, {}, &materials).value();
    const AgentKind row = kind[2] == 'r' && kind[3] == '\0' ? AgentKind::kCar
                          : kind[0] == 'f'                  ? AgentKind::kForklift
                                                            : AgentKind::kCart;
    const VehicleSize& size = vehicle_size(row);
    const Prop::Box box = prop.bounds();
    EXPECT_NEAR(box.high.x, size.front, 0.02);
    EXPECT_NEAR(box.low.x, size.rear, 0.02);
    EXPECT_NEAR(box.high.z, size.height, 0.03);
    EXPECT_NEAR(box.low.z, 0, 1e-3);
    EXPECT_NEAR(prop.mass(), size.mass, 1);
    size_t wheels = 0;
    for (const PropPart& part : prop.parts) wheels += part.name.ends_with("wheel");
    EXPECT_EQ(wheels, 4u);
  }
}

TEST(Vehicle, StaysOnItsWayAndSlowsInBends) {
  AgentRig rig(agent_place("", 24));
  add_vehicle(&rig, "car", {-8, -6, 0}, bend(), "spline").speed = 6;
  auto stepper = rig.stepper();
  const AgentSpline spline(rig.scene.agents[0].route, false);
  double off = 0, fastest = 0, sideways = 0;
  for (int i = 0; i < 4500; ++i) {
    ASSERT_TRUE(stepper->step());
    const AgentMotion& m = motion_of(*stepper, 0);
    off = std::max(off, to_spline(spline, m.p));
    fastest = std::max(fastest, norm(m.velocity));
    sideways = std::max(sideways, std::abs(norm(m.velocity) * m.yaw_rate));
  }
  EXPECT_LT(off, 0.6);
  EXPECT_GT(fastest, 3);
  EXPECT_LT(sideways, 2.5) << "1.8 m/s² and what a bend grows by while it slows down";
  EXPECT_LT(flat_norm(motion_of(*stepper, 0).p - Vec3d{8, 9, 0}), 1.5);
}

/// A road along x and a bend to y at its end.
std::vector<WaypointOptions> road(double length) {
  return {{{0, 0, 0}, 0, {}}, {{length / 2, 0, 0}, 0, {}}, {{length, 0, 0}, 0, {}}};
}

// v²/2a to speed up, and as far as planned to stop.
TEST(Vehicle, CarsReachTheSpeedsThatTheyAreGiven) {
  for (const double speed : {8.0, 14.0, 29.0}) {
    SCOPED_TRACE(speed);
    AgentRig rig(
        "<mujoco><option timestep='0.002'/><worldbody>"
        "<geom type='plane' size='800 20 0.1'/></worldbody></mujoco>");
    rig.scene.navigation.cell = 1;
    const double length = 1.5 * speed * speed / (2 * kCarSize.thrust) +
                          1.2 * speed * speed / (2 * 0.55 * kCarSize.brakes) + 2 * speed;
    add_vehicle(&rig, "car", {0, 0, 0}, road(length), "spline").speed = speed;
    auto stepper = rig.stepper();
    double fastest = 0, at_half = 0;
    const double until = speed / kCarSize.thrust + length / speed + 12;
    for (int i = 0; i * kStep < until; ++i) {
      ASSERT_TRUE(stepper->step());
      const double now = norm(motion_of(*stepper, 0).velocity);
      fastest = std::max(fastest, now);
      if (i * kStep < 0.5 * speed / kCarSize.thrust) at_half = now;
    }
    EXPECT_NEAR(fastest / speed, 1, 0.05);
    EXPECT_NEAR(at_half / (speed / 2), 1, 0.1) << "v = a t";
    EXPECT_NEAR(motion_of(*stepper, 0).p.x, length, 1.5) << "it stops at the end of its way";
    EXPECT_NEAR(motion_of(*stepper, 0).p.y, 0, 0.3);
    EXPECT_LT(norm(motion_of(*stepper, 0).velocity), 0.1);
  }
}

TEST(Vehicle, FastCarsSlowDownBeforeBendsAndStopForPeople) {
  AgentRig rig(
      "<mujoco><option timestep='0.002'/><worldbody>"
      "<geom type='plane' size='300 300 0.1'/></worldbody></mujoco>");
  rig.scene.navigation.cell = 1;
  add_vehicle(&rig, "car", {0, 0, 0},
              {{{0, 0, 0}, 0, {}},
               {{100, 0, 0}, 0, {}},
               {{160, 0, 0}, 0, {}},
               {{180, 20, 0}, 0, {}},
               {{180, 80, 0}, 0, {}},
               {{180, 180, 0}, 0, {}}},
              "spline")
      .speed = 15;
  rig.add("ann", {180, 150, 0}, "stand").speed = 1;
  auto stepper = rig.stepper();
  const AgentSpline spline(rig.scene.agents[0].route, false);
  double off = 0, fastest = 0, sideways = 0;
  for (int i = 0; i * kStep < 40; ++i) {
    ASSERT_TRUE(stepper->step());
    if (i % 50 != 0) continue;
    const AgentMotion& m = motion_of(*stepper, 0);
    off = std::max(off, to_spline(spline, m.p));
    fastest = std::max(fastest, norm(m.velocity));
    sideways = std::max(sideways, std::abs(norm(m.velocity) * m.yaw_rate));
  }
  EXPECT_GT(fastest, 14);
  EXPECT_LT(off, 1);
  EXPECT_LT(sideways, 2.7);
  const double gap = 150 - motion_of(*stepper, 0).p.y - length_ahead(kCarSize) - 0.3;
  EXPECT_GT(gap, 0.3) << "it stands before her";
  EXPECT_LT(gap, 2);
}

TEST(Vehicle, RoutesAreDrivenFastToo) {
  AgentRig rig(
      "<mujoco><option timestep='0.002'/><worldbody>"
      "<geom type='plane' size='150 10 0.1'/></worldbody></mujoco>");
  rig.scene.navigation.cell = 0.5;
  add_vehicle(&rig, "car", {-140, 0, 0}, {{{140, 0, 0}, 0, {}}}, "route").speed = 14;
  auto stepper = rig.stepper();
  double fastest = 0;
  for (int i = 0; i * kStep < 35; ++i) {
    ASSERT_TRUE(stepper->step());
    fastest = std::max(fastest, norm(motion_of(*stepper, 0).velocity));
  }
  EXPECT_NEAR(fastest, 14, 0.7);
  EXPECT_NEAR(motion_of(*stepper, 0).p.x, 140, 1.5);
}

TEST(Vehicle, RoutesLeadThroughAGap) {
  AgentRig rig(
      agent_place("<geom type='box' size='0.1 4.5 1' pos='0 -7 1'/>"
                  "<geom type='box' size='0.1 4.5 1' pos='0 7 1'/>",
                  24));
  add_vehicle(&rig, "forklift", {-6, -5, 0}, {{{6, 5, 0}, 0, {}}}, "route");
  auto stepper = rig.stepper();
  double aside = 9;
  for (int i = 0; i < 10000; ++i) {
    ASSERT_TRUE(stepper->step());
    const Vec3d p = motion_of(*stepper, 0).p;
    if (std::abs(p.x) < 0.1) aside = std::min(aside, 2.5 - std::abs(p.y));
  }
  EXPECT_GT(aside, 0.6) << "it is in the wall";
  EXPECT_LT(aside, 3) << "it never was in the gap";
  EXPECT_LT(flat_norm(motion_of(*stepper, 0).p - Vec3d{6, 5, 0}), 0.8);
}

TEST(Vehicle, StopsForSomebodyInItsWayAndGoesOn) {
  for (const char* kind : {"car", "forklift"}) {
    SCOPED_TRACE(kind);
    AgentRig rig(agent_place("", 30));
    add_vehicle(&rig, kind, {-10, 0, 0},
                {{{-10, 0, 0}, 0, {}}, {{0, 0, 0}, 0, {}}, {{11, 0, 0}, 0, {}}}, "spline");
    AgentOptions& ann = rig.add("ann", {0, 0, 0}, "route");
    ann.route = {{{0, 6, 0}, 0, {}}};
    ann.loop = false;
    ann.start = 9;
    auto stepper = rig.stepper();
    double nearest = 99, waited = 0;
    for (int i = 0; i < 14000; ++i) {
      ASSERT_TRUE(stepper->step());
      const AgentBody& v = agents_of(*stepper).bodies()[0];
      const Vec3d to = flat(motion_of(*stepper, 1).p - v.motion.p);
      if (std::abs(to.y) < 1)
        nearest = std::min(nearest, to.x > 0 ? to.x - length_ahead(v.description->vehicle) : 99.0);
      if (i * kStep < 9 && norm(v.motion.velocity) < 0.02 && i * kStep > 5) waited += kStep;
    }
    EXPECT_GT(nearest - 0.3, 0.45) << "0.6 m from a person of 0.3 m";
    EXPECT_LT(nearest - 0.3, 0.9);
    EXPECT_GT(waited, 1) << "it stood while she did";
    EXPECT_GT(motion_of(*stepper, 0).p.x, 8) << "and went on";
  }
}

TEST(Vehicle, BeginningsWithoutRoomAreMovedOrRefused) {
  AgentRig rig(agent_place("<geom type='box' size='0.5 1.2 1' pos='2 0 1'/>"));
  add_vehicle(&rig, "forklift", {2.2, 0, 0}, {}, "stand");
  ::testing::internal::CaptureStderr();
  auto stepper = rig.stepper();
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("agent 'v' starts at (2.2, 0, 0), where there is no room"), std::string::npos)
      << said;

  AgentRig full(agent_place("<geom type='box' size='6 6 1' pos='0 0 1'/>"));
  add_vehicle(&full, "car", {0, 0, 0}, {}, "stand");
  const auto refused = Stepper::create(full.compile(), 1, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("no room"), std::string::npos)
      << refused.error().to_string();
}

TEST(Vehicle, AWayThatIsTooNarrowIsSaid) {
  // 1.2 m are enough for a person, not for a car.
  AgentRig rig(
      agent_place("<geom type='box' size='0.1 5.4 1' pos='0 -6 1'/>"
                  "<geom type='box' size='0.1 5.4 1' pos='0 6 1'/>",
                  24));
  add_vehicle(&rig, "car", {-6, 0, 0}, {{{6, 0, 0}, 0, {}}}, "route");
  ::testing::internal::CaptureStderr();
  auto stepper = rig.stepper();
  for (int i = 0; i < 2500; ++i) ASSERT_TRUE(stepper->step());
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("'v' cannot reach (6.00, 0.00, 0.00)"), std::string::npos) << said;
  EXPECT_LT(motion_of(*stepper, 0).p.x, 0);
}

TEST(Vehicle, ABodyOfItsNameIsAnError) {
  AgentRig rig(agent_place("<body name='v' pos='3 3 1'><geom type='sphere' size='0.1'/></body>"));
  add_vehicle(&rig, "cart", {0, 0, 0}, {}, "stand").loc = {"scene.toml", 7, 1};
  const Result<World> world = World::compile(rig.scene);
  ASSERT_FALSE(world.ok());
  EXPECT_NE(world.error().message.find("already has a body 'v'"), std::string::npos);
  EXPECT_EQ(world.error().loc.line, 7);
}

TEST(Vehicle, HashDoesNotDependOnThreadsPaceOrWatchers) {
  AgentRig rig(agent_place(""));
  add_vehicle(&rig, "cart", {0, 0, 0}, {}, "wander");
  rig.add("f", {3, 3, 0}, "wander").kind = "forklift";
  rig.add("ann", {-3, 3, 0}, "wander");
  const auto world = rig.compile();
  expect_one_hash([&](SimulatorOptions options, bool watched) {
    auto sim = make_simulator(world, std::move(options));
    return hash_after_steps(
        std::move(sim), 2500,
        watched ? [](const Snapshot&) {} : std::function<void(const Snapshot&)>());
  });
}

}  // namespace
}  // namespace gloam

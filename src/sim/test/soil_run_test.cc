// Beds of soil: their parts against MuJoCo's own answers, and that a run is the same however it is
// run.

#include "same_hash.h"
#include "sim/effects/bodies/collider_bottom.h"
#include "soil_rig.h"

namespace gloam {
namespace {

// A bed whose cells have heights of their own, all the same where the ball rolls.
TEST(SoilBedRun, LevelGroundUnderneathIsAsALevelBed) {
  const auto roll = [](bool over_ground) {
    auto world = world_with_soil("<body pos='-.3 .007 .04'><freejoint/><geom size='.05'/></body>",
                                 bed_of("dry_sand"));
    SoilDescription& soil = world->soils[0];
    if (over_ground) {
      soil.rest.assign(soil.cells(), 0);
      soil.rest.back() = -0.1f;
    }
    OnSoil ball(world);
    const SetJointState start{Joint{0}, {-.3, .007, .04, 1, 0, 0, 0}, {1, 0, 0, 0, 0, 0}};
    EXPECT_TRUE(ball.sim->post({.what = start}).ok());
    ball.run(0.5);
    return std::array{ball.q(0, 0), ball.q(0, 2)};
  };
  const auto level = roll(false), over_ground = roll(true);
  EXPECT_GT(level[0], -0.25) << "it rolls";
  EXPECT_EQ(level, over_ground) << "its ends were not found as those in a level bed";
}

TEST(ColliderBottom, IsWhereARayFromBelowMeetsIt) {
  auto world = world_from_mjcf(R"(<mujoco><asset>
    <mesh name="wedge" vertex="-.2 -.2 -.1  .3 -.2 -.1  -.2 .2 -.1  .3 .2 -.1  -.2 -.2 .3  -.2 .2 .3"/>
    </asset><worldbody>
    <body pos="0 0 0" quat=".9 .3 -.2 .25"><freejoint/><geom type="box" size=".2 .1 .3"/></body>
    <body pos="2 0 0" quat=".5 .3 .7 .25"><freejoint/><geom type="sphere" size=".2"/></body>
    <body pos="4 0 0" quat=".5 .3 .7 .25"><freejoint/><geom type="ellipsoid" size=".2 .1 .3"/></body>
    <body pos="6 0 0" quat=".9 .5 .1 .25"><freejoint/><geom type="capsule" size=".1 .2"/></body>
    <body pos="8 0 0" quat=".9 .5 .1 .25"><freejoint/><geom type="cylinder" size=".2 .05"/></body>
    <body pos="10 0 0"><freejoint/><geom type="cylinder" size=".2 .05"/></body>
    <body pos="12 0 0" quat=".9 .5 .1 .25"><freejoint/><geom type="mesh" mesh="wedge"/></body>
    </worldbody></mujoco>)");
  const mjModel& m = *world->model;
  DataPtr d(mj_makeData(&m));
  mj_kinematics(&m, d.get());
  for (int geom = 0; geom < m.ngeom; ++geom) {
    ASSERT_TRUE(ColliderBottom::can_be(m, geom));
    ColliderBottom bottom(m, geom);
    bottom.set_pose(*d);
    const double* p = d->geom_xpos + 3 * geom;
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
      const double x = p[0] + 0.4 * random_control(i, 0), y = p[1] + 0.4 * random_control(i, 1);
      const double from[3] = {x, y, -5}, up[3] = {0, 0, 1};
      const auto ray = [&](double dx, double dy) {
        const double o[3] = {x + dx, y + dy, -5};
        int hit = -1;
        return mj_ray(&m, d.get(), o, up, nullptr, 1, -1, &hit, nullptr) - 5;
      };
      int hit = -1;
      const double distance = mj_ray(&m, d.get(), from, up, nullptr, 1, -1, &hit, nullptr);
      BottomPoint is;
      ASSERT_EQ(bottom.at(x, y, &is), distance >= 0) << "geom " << geom << " at " << x << ", " << y;
      if (distance < 0) continue;
      ++hits;
      EXPECT_NEAR(is.z, distance - 5, 1e-6) << "geom " << geom;
      EXPECT_GE(is.z, bottom.low(2) - 1e-9);
      constexpr double h = 1e-4;
      if (std::abs(is.slope[0]) > 1 || std::abs(is.slope[1]) > 1) continue;
      const double slope = (ray(h, 0) - ray(-h, 0)) / (2 * h);
      const double bend = (ray(h, 0) + ray(-h, 0) - 2 * ray(0, 0)) / h;
      if (std::abs(bend) > 0.01) continue;  // an edge
      EXPECT_NEAR(is.slope[0], slope, 0.01) << "geom " << geom;
    }
    EXPECT_GT(hits, 20) << "geom " << geom;
  }
}

TEST(ColliderBottom, RoundOnesEndWhereTheyComeOutOfALevel) {
  auto world = world_from_mjcf(R"(<mujoco><worldbody>
    <body quat=".5 .3 .7 .25"><freejoint/><geom type="sphere" size=".2"/></body>
    <body quat=".9 .5 .1 .25"><freejoint/><geom type="capsule" size=".1 .2"/></body>
    <body quat="1 0 0 0"><freejoint/><geom type="capsule" size=".1 .2"/></body>
    <body quat=".70710678 .70710678 0 0"><freejoint/><geom type="capsule" size=".1 .2"/></body>
    <body quat=".70710678 0 .70710678 0"><freejoint/><geom type="capsule" size=".1 .2"/></body>
    </worldbody></mujoco>)");
  const mjModel& m = *world->model;
  DataPtr d(mj_makeData(&m));
  mj_kinematics(&m, d.get());
  constexpr int kCount = 4000;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    ColliderBottom bottom(m, geom);
    bottom.set_pose(*d);
    int hits = 0;
    for (int i = 0; i < 60; ++i) {
      const double y = 0.3 * random_control(i, 0), level = 0.3 * random_control(i, 1);
      double left = 0, right = 0;
      bottom.round_ends(level, {&y, 1}, &left, &right);
      double low = 1, high = 0;
      for (int n = 0; n < kCount; ++n) {
        const double x = -0.4 + 0.8 * n / kCount;
        double z = 0;
        if (!bottom.height_at(x, y, &z) || z >= level) continue;
        if (low > high) low = x;
        high = x;
      }
      if (high - low < 1e-3) continue;  // a point of it, or nothing
      ++hits;
      EXPECT_NEAR(left, low, 3e-4) << "geom " << geom << " at " << y << ", " << level;
      EXPECT_NEAR(right, high, 3e-4) << "geom " << geom << " at " << y << ", " << level;
    }
    EXPECT_GT(hits, 5) << "geom " << geom;
    const double beside = 0.5;
    double left = 0, right = 0;
    bottom.round_ends(0, {&beside, 1}, &left, &right);
    EXPECT_GT(left, right) << "nothing is there";
  }
}

TEST(ResponseSolver, IsTheInverseInertiaOfTheWholeTree) {
  auto world = world_from_mjcf(kRichModel);
  const mjModel& m = *world->model;
  DataPtr d(mj_makeData(&m));
  for (int i = 0; i < m.nv; ++i) d->qvel[i] = random_control(1, i);
  mj_forward(&m, d.get());
  ResponseSolver solver(m);
  std::vector<double> jacobian(static_cast<size_t>(6 * m.nv)), answer(jacobian.size());
  for (int body = 1; body < m.nbody; ++body) {
    if (last_dof(m, body) < 0) continue;
    const double* p = d->xipos + 3 * body;
    mj_jac(&m, d.get(), jacobian.data(), jacobian.data() + 3 * m.nv, p, body);
    mj_solveM(&m, d.get(), answer.data(), jacobian.data(), 6);
    const BodyResponse is = solver.solve(m, *d, body, p, {});
    const double wrench[6] = {1, -2, 3, 0.1, 0.2, -0.3};
    std::vector<double> joints(static_cast<size_t>(chain_length(m, body)));
    solver.accelerations(m, *d, body, wrench, joints);
    int dof = last_dof(m, body);
    for (const double acceleration : joints) {
      double sum = 0;
      for (int a = 0; a < 6; ++a) sum += wrench[a] * answer[static_cast<size_t>(a * m.nv + dof)];
      EXPECT_NEAR(acceleration, sum, 1e-9 * (1 + std::abs(sum))) << "body " << body;
      dof = m.dof_parentid[dof];
    }
    for (int a = 0; a < 6; ++a) {
      double velocity = 0;
      for (int k = 0; k < m.nv; ++k)
        velocity += jacobian[static_cast<size_t>(a * m.nv + k)] * d->qvel[k];
      EXPECT_NEAR(is.velocity[a], velocity, 1e-9) << "body " << body;
      for (int b = 0; b < 6; ++b) {
        double sum = 0;
        for (int k = 0; k < m.nv; ++k)
          sum += jacobian[static_cast<size_t>(a * m.nv + k)] *
                 answer[static_cast<size_t>(b * m.nv + k)];
        EXPECT_NEAR(is.inverse[6 * a + b], sum, 1e-9 * (1 + std::abs(sum))) << "body " << body;
      }
    }
  }
}

TEST(BodyForces, FactorsATreeAsMujocoDoes) {
  auto world = world_from_mjcf(kRichModel);
  ModelPtr heavier(mj_copyModel(nullptr, world->model.get()));
  const mjModel& m = *world->model;
  DataPtr is(mj_makeData(&m)), exact(mj_makeData(&m));
  mj_forward(&m, is.get());
  for (int dof = 0; dof < m.nv; ++dof) {
    heavier->dof_armature[dof] += 0.1 * (dof + 1), heavier->dof_M0[dof] += 0.1 * (dof + 1);
    is->M[m.M_rowadr[dof] + m.M_rownnz[dof] - 1] += 0.1 * (dof + 1);
  }
  for (int tree = 0; tree < m.ntree; ++tree) factor_tree(m, *is, tree);
  mj_forward(heavier.get(), exact.get());
  for (int i = 0; i < m.nC; ++i) EXPECT_NEAR(is->qLD[i], exact->qLD[i], 1e-12) << i;
  for (int dof = 0; dof < m.nv; ++dof)
    EXPECT_NEAR(is->qLDiagInv[dof], exact->qLDiagInv[dof], 1e-12 * exact->qLDiagInv[dof]) << dof;
}

/// Balls, boxes and a wheel that fall and roll over a bed.
std::shared_ptr<CompiledWorld> busy_bed(const std::string& kind = "dry_sand") {
  std::string bodies = "<geom type='plane' size='9 9 .1' pos='0 0 -.2'/>";
  for (int i = 0; i < 4; ++i) {
    bodies += fmt::format(
        "<body pos='{} {} .3' quat='.9 .1 {} .3'><freejoint/><geom type='{}' size='.08 .06 .05' "
        "density='2500'/></body>",
        i * 0.4 - 0.6, 0.2 * i - 0.3, 0.2 * i, i % 2 == 0 ? "box" : "sphere");
  }
  bodies +=
      "<body pos='-.7 .5 .2'><freejoint/><geom type='cylinder' size='.15 .04' euler='90 0 0' "
      "density='2000'/></body>";
  return world_with_soil(bodies, bed_of(kind, 2, 0.2));
}

uint64_t busy_hash(SimulatorOptions options, bool watched, const std::string& kind = "dry_sand") {
  std::function<void(const Snapshot&)> look;
  if (watched) look = [](const Snapshot&) {};
  return hash_after_steps(make_simulator(busy_bed(kind), std::move(options)), 600, look);
}

TEST(SoilEffectRun, HashDoesNotDependOnThreadsPaceOrWatchers) {
  const uint64_t reference = expect_one_hash(
      [](SimulatorOptions options, bool watched) { return busy_hash(options, watched); });
  EXPECT_NE(busy_hash({}, false, "sandy_loam"), reference);
}

TEST(SoilEffectRun, ResetRepeatsTheRun) {
  auto sim = make_simulator(busy_bed(), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(400).ok());
  const uint64_t first = sim->latest().hash();
  ASSERT_NE(sim->latest().data().effects.surfaces[0].field, nullptr);
  const std::vector<float> heights = sim->latest().data().effects.surfaces[0].field->height;
  ASSERT_TRUE(sim->reset().ok());
  EXPECT_EQ(sim->latest().data().effects.surfaces[0].field, nullptr) << "tracks of a run before";
  ASSERT_TRUE(sim->step(400).ok());
  EXPECT_EQ(sim->latest().hash(), first);
  EXPECT_EQ(sim->latest().data().effects.surfaces[0].field->height, heights);
}

TEST(SoilEffectRun, ARecompileKeepsTheTracks) {
  auto sim = make_simulator(busy_bed(), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(400).ok());
  const std::vector<float> before = sim->latest().data().effects.surfaces[0].field->height;
  ASSERT_TRUE(sim->recompile(busy_bed(), {}).ok());
  EXPECT_EQ(sim->latest().data().effects.surfaces[0].field->height, before);
  ASSERT_TRUE(sim->step(100).ok());
}

/// Keeps what soil did, of every call.
class ReactionRecorder final : public Controller {
 public:
  explicit ReactionRecorder(std::vector<std::vector<ContactLoad>>& calls) : calls_(calls) {}
  void reset(const mjModel*, const mjData*) override { calls_.clear(); }
  void control(const ControlInputs& in) override {
    calls_.emplace_back(in.loads.begin(), in.loads.end());
  }
  std::vector<std::vector<ContactLoad>>& calls_;
};

TEST(SoilReactions, CarryWhatRestsThereAndAreNoneInTheAirOrOnRock) {
  auto world = world_with_soil(
      "<geom type='box' size='.2 .2 .1' pos='2 0 -.1'/>"
      "<body pos='.1 .2 .3'><freejoint/><geom name='shell' contype='0' conaffinity='0' size='.05' "
      "mass='1'/><geom name='ball' size='.05' mass='2'/></body>"
      "<body pos='2 0 .1'><freejoint/><geom name='on rock' size='.05'/></body>",
      bed_of("dry_sand"));
  OnSoil rig(world);
  std::vector<std::vector<ContactLoad>> calls;
  ASSERT_TRUE(rig.sim->add_controller(0, std::make_unique<ReactionRecorder>(calls), {500, 1}).ok());
  rig.run(1.5);
  EXPECT_TRUE(calls[60].empty()) << "in the air";
  ASSERT_EQ(calls.back().size(), 1u);
  const ContactLoad& ball = calls.back().front();
  EXPECT_EQ(ball.geom, mj_name2id(world->model.get(), mjOBJ_GEOM, "ball"));
  EXPECT_EQ(ball.body, world->model->geom_bodyid[ball.geom]);
  const double weight[3] = {0, 0, 3 * 9.81};
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(ball.force[a], weight[a], 0.01 * weight[2]) << a;
    EXPECT_NEAR(ball.normal[a], a == 2, 0.01) << a;
  }
  EXPECT_NEAR(ball.p[0], 0.1, 0.002);
  EXPECT_NEAR(ball.p[1], 0.2, 0.002);
  EXPECT_LT(ball.p[2], 0);
  EXPECT_GT(ball.p[2], -0.05);
}

// As MuJoCo's own sensor on rigid ground: what weighs on the site's volume, up to the cutoff.
TEST(SoilReactions, TouchSensorsFeelThem) {
  auto world = world_with_soil(
      R"(<geom type='box' size='.2 .2 .1' pos='2 0 -.1'/>
      <body pos='0 0 .1'><freejoint/><geom size='.05' mass='2'/>
        <site name='sole' size='.055'/><site name='top' size='.02' pos='0 0 .04'/></body>
      <body pos='.3 0 .1'><freejoint/><geom size='.05' mass='2'/><site name='other' size='.055'/></body>
      <body pos='2 0 .1'><freejoint/><geom size='.05' mass='2'/><site name='rock' size='.055'/></body>)",
      bed_of("dry_sand"),
      R"(<sensor><touch name='sole' site='sole'/><touch name='top' site='top'/>
      <touch name='other' site='other' cutoff='5'/><touch name='rock' site='rock'/></sensor>)");
  OnSoil rig(world);
  const auto read = [&](const char* name) {
    const int sensor = mj_name2id(world->model.get(), mjOBJ_SENSOR, name);
    return rig.sim->latest()
        .data()
        .sensordata[static_cast<size_t>(world->model->sensor_adr[sensor])];
  };
  rig.run(0.06);
  EXPECT_EQ(read("sole"), 0) << "in the air";
  rig.run(1.5);
  const double weight = 2 * 9.81;
  EXPECT_NEAR(read("rock"), weight, 0.02 * weight);
  EXPECT_NEAR(read("sole"), weight, 0.02 * weight);
  EXPECT_EQ(read("top"), 0);
  EXPECT_EQ(read("other"), 5);
}

// A Snapshot keeps the tracks of its instant, whatever comes later.
TEST(SoilEffectRun, SnapshotsKeepTheirTracks) {
  auto sim = make_simulator(busy_bed(), lockstep());
  sim->start();
  std::vector<Snapshot> held;
  std::vector<std::vector<float>> heights;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(sim->step(60).ok());
    held.push_back(sim->latest());
    const auto& field = held.back().data().effects.surfaces[0].field;
    heights.push_back(field != nullptr ? field->height : std::vector<float>{});
  }
  EXPECT_NE(heights.front(), heights.back());
  for (size_t i = 0; i < held.size(); ++i) {
    const auto& field = held[i].data().effects.surfaces[0].field;
    EXPECT_EQ(field != nullptr ? field->height : std::vector<float>{}, heights[i]) << i;
  }
}

}  // namespace
}  // namespace gloam

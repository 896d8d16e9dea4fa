// Poses of a Snapshot are those mj_forward gives for the same state, exactly.

#include "sim/snapshots/pose_solver.h"

#include <cstring>
#include <thread>

#include "test_world.h"
#include "world/shapes/capsule_mesh.h"
#include "world/shapes/tendon_path.h"

namespace gloam {
namespace {

// Bodies that move, every tracking mode of cameras and lights, mocap, a skin over two bones, an
// inflated one, flexes of two kinds.
const char* const kSeen = R"(
<mujoco><option timestep="0.002"/>
  <asset><material name="red" rgba="1 0 0 1" emission=".5"/>
    <hfield name="hills" nrow="3" ncol="4" size="1 1 .5 .1" elevation="0 0 0 0 0 1 .5 0 0 0 0 0"/></asset>
  <worldbody>
    <geom type="plane" size="5 5 .1"/><geom type="hfield" hfield="hills" pos="5 5 0"/>
    <light name="sun" pos="0 0 5" dir="0 0 -1"/>
    <camera name="still" pos="3 0 2"/><camera name="aims" mode="targetbody" target="b" pos="2 2 2"/>
    <camera name="aims_com" mode="targetbodycom" target="a" pos="-2 2 2"/>
    <body name="a" pos="0 0 1"><freejoint/><geom type="box" size=".2 .1 .1" mass="3"/>
      <camera name="fixed" pos=".3 0 0"/><camera name="track" mode="track" pos="0 -1 .5"/>
      <camera name="trackcom" mode="trackcom" pos="0 -1 .5"/>
      <light name="lamp" mode="trackcom" pos="0 0 1"/><light name="torch" mode="fixed" dir="1 0 0"/>
      <light name="aimed" mode="targetbody" target="b"/>
      <body name="b" pos=".4 0 0"><joint name="j" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 .4 0 0" size=".05" mass="1"/></body></body>
    <body name="hand" mocap="true" pos="-1 0 1"><geom type="sphere" size=".05"/><camera name="held" pos="0 0 .2"/></body>
    <flexcomp name="cloth" type="grid" count="4 4 1" spacing=".1 .1 .1" pos="2 0 1" dim="2" radius=".005" mass=".2">
      <edge equality="true"/></flexcomp>
    <flexcomp name="jelly" type="grid" count="3 3 3" spacing=".1 .1 .1" pos="-2 0 1" dim="3" radius=".005" mass=".5" dof="trilinear"><elasticity young="1e4" poisson=".2"/></flexcomp>
  </worldbody>
  <deformable>
    <skin name="s" vertex="0 0 0  .4 0 0  .8 0 0  .4 .1 0" face="0 1 3 1 2 3">
      <bone body="a" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 3" vertweight="1 .5 .5"/>
      <bone body="b" bindpos=".4 0 0" bindquat=".8 .6 0 0" vertid="1 2 3" vertweight=".5 1 .5"/></skin>
    <skin name="fat" inflate=".01" vertex="0 0 0  .1 0 0  0 .1 0  0 0 .1" face="0 2 1 0 1 3 1 2 3 2 0 3">
      <bone body="b" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2 3" vertweight="1 1 1 1"/></skin>
  </deformable>
  <actuator><motor joint="j" gear="3"/></actuator>
</mujoco>)";

template <class T, class U>
void expect_same(const std::vector<T>& got, const U* expected, const char* what) {
  for (size_t i = 0; i < got.size(); ++i) {
    ASSERT_EQ(got[i], static_cast<T>(expected[i])) << what << " element " << i;
  }
}

void expect_forward_poses(const mjModel& m, mjData& d, const Snapshot& s, const PoseFrame& frame) {
  mj_setState(&m, &d, s.state().data(), mjSTATE_INTEGRATION);
  mj_forward(&m, &d);
  ASSERT_EQ(frame.body_p.size(), static_cast<size_t>(3 * m.nbody));
  ASSERT_EQ(frame.camera_R.size(), static_cast<size_t>(9 * m.ncam));
  ASSERT_EQ(frame.light_p.size(), static_cast<size_t>(3 * m.nlight));
  expect_same(frame.body_p, d.xpos, "xpos");
  expect_same(frame.body_R, d.xmat, "xmat");
  expect_same(frame.camera_p, d.cam_xpos, "cam_xpos");
  expect_same(frame.camera_R, d.cam_xmat, "cam_xmat");
  expect_same(frame.light_p, d.light_xpos, "light_xpos");
  expect_same(frame.light_dir, d.light_xdir, "light_xdir");
}

TEST(PoseSolver, GivesThePosesOfTheSnapshotsOwnInstant) {
  auto world = world_from_mjcf(kSeen);
  const mjModel& m = *world->model;
  DataPtr d(mj_makeData(&m));
  auto sim = make_simulator(world, lockstep());
  ASSERT_TRUE(sim->add_controller(0, std::make_unique<RandomController>(), {500, 1}).ok());
  auto solver = *PoseSolver::create(world);
  PoseFrame frame;
  sim->start();
  std::vector<double> before;
  for (int i = 0; i < 20; ++i) {
    const Body hand{mj_name2id(&m, mjOBJ_BODY, "hand")};
    ASSERT_TRUE(
        sim->post({.what = SetMocapPose{hand, {{-1, 0.1 * i, 1}, {1, 0.1 * i, 0, 0}}}}).ok());
    const Snapshot s = sim->latest();
    ASSERT_TRUE(solver->solve(s, frame).ok());
    EXPECT_EQ(frame.step, s.step());
    EXPECT_EQ(frame.time, s.time());
    expect_forward_poses(m, *d, s, frame);
    EXPECT_NE(frame.body_p, before);
    before = frame.body_p;
    ASSERT_TRUE(sim->step(25).ok());
  }
}

TEST(PoseSolver, BodiesAloneAreWhereTheyAreWithTheRestAndNothingIsMeshed) {
  auto world = world_from_mjcf(kSeen);
  auto sim = make_simulator(world, lockstep());
  auto solver = *PoseSolver::create(world);
  sim->start();
  ASSERT_TRUE(sim->step(25).ok());
  PoseFrame all, bodies;
  ASSERT_TRUE(solver->solve(sim->latest(), all).ok());
  EXPECT_EQ(solver->meshed(), 1);
  ASSERT_TRUE(solver->solve_bodies(sim->latest(), bodies).ok());
  EXPECT_EQ(solver->meshed(), 1);
  EXPECT_FALSE(all.vertices.empty());
  EXPECT_TRUE(bodies.vertices.empty());
  EXPECT_EQ(bodies.body_p, all.body_p);
  EXPECT_EQ(bodies.body_R, all.body_R);
  EXPECT_EQ(bodies.camera_p, all.camera_p);
  EXPECT_EQ(bodies.light_dir, all.light_dir);
  EXPECT_EQ(bodies.step, all.step);
}

TEST(PoseSolver, SkinsAndFlexesAreWhereMuJoCoDrawsThem) {
  auto world = world_from_mjcf(kSeen);
  const mjModel& m = *world->model;
  DataPtr d(mj_makeData(&m));
  auto sim = make_simulator(world, lockstep());
  ASSERT_TRUE(sim->add_controller(0, std::make_unique<RandomController>(), {10, 1}).ok());
  auto solver = *PoseSolver::create(world);
  PoseFrame frame;
  mjvScene scene;
  mjv_defaultScene(&scene);
  mjv_makeScene(&m, &scene, 100);
  mjvOption option;
  mjv_defaultOption(&option);
  option.flags[mjVIS_SKIN] = 1;
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  sim->start();
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(sim->step(60).ok());
    const Snapshot s = sim->latest();
    ASSERT_TRUE(solver->solve(s, frame).ok());
    mj_setState(&m, d.get(), s.state().data(), mjSTATE_INTEGRATION);
    mj_forward(&m, d.get());
    mjv_updateScene(&m, d.get(), &option, nullptr, &camera, mjCAT_ALL, &scene);
    const DeformableLayout& layout = solver->layout();
    ASSERT_EQ(layout.nvertex, m.nskinvert + m.nflexvert);
    ASSERT_EQ(frame.vertices.size(), static_cast<size_t>(3 * layout.nvertex));
    for (int v = 0; v < 3 * m.nskinvert; ++v) {
      ASSERT_NEAR(frame.vertices[static_cast<size_t>(v)], scene.skinvert[v], 2e-6) << v;
    }
    for (int flex = 0; flex < m.nflex; ++flex) {
      const float* got = frame.vertices.data() + 3 * layout.flex_first[static_cast<size_t>(flex)];
      const double* expected = d->flexvert_xpos + 3 * m.flex_vertadr[flex];
      for (int v = 0; v < 3 * m.flex_vertnum[flex]; ++v) {
        ASSERT_EQ(got[v], static_cast<float>(expected[v]));
      }
    }
  }
  mjv_freeScene(&scene);
}

// A rope over a drum, one around a ball the long way, one that hangs slack, one that is slack by
// its spring and hangs straight down, one over a pulley.
const char* const kRopes = R"(
<mujoco><option timestep="0.002"/>
  <worldbody>
    <site name="anchor" pos="-.8 0 1.6"/><site name="above" pos="0 0 1.9"/>
    <geom name="drum" type="cylinder" size=".2 .15" pos="0 0 1.5" euler="80 10 0"/>
    <body name="weight" pos=".6 0 .7"><joint name="lift" type="slide" axis="0 0 1" damping="2"/>
      <geom type="box" size=".1 .1 .1" mass="1"/><site name="hook" pos="0 0 .1"/></body>
    <site name="left" pos="-1.2 .3 1.1"/>
    <body pos="-.5 .3 1.2"><joint name="swing" type="hinge" axis="0 1 0" pos="0 0 .3"/>
      <geom size=".08" mass=".2"/><site name="right"/></body>
    <site name="over" pos="2 0 2"/><site name="under" pos="2 0 1.9"/>
    <geom name="ball" size=".12" pos="1.2 .2 1.4"/><site name="behind" pos="1.4 .2 1.4"/>
    <site name="p0" pos=".9 .2 1.7"/><site name="p1" pos="1 .2 1"/>
    <site name="p2" pos="1.5 .2 1"/><site name="p3" pos="1.5 .2 1.7"/>
  </worldbody>
  <tendon>
    <spatial name="rope" width=".01"><site site="anchor"/><geom geom="drum" sidesite="above"/>
      <site site="hook"/></spatial>
    <spatial name="slack" limited="true" range="0 1.2"><site site="left"/><site site="right"/></spatial>
    <spatial name="loop" stiffness="3" springlength="0 .7"><site site="over"/><site site="under"/></spatial>
    <spatial name="pulley"><site site="p0"/><geom geom="ball" sidesite="behind"/><site site="p1"/>
      <pulley divisor="2"/><site site="p2"/><site site="p3"/></spatial>
  </tendon>
</mujoco>)";

struct Rod {
  double a[3], b[3], radius;
};

double distance(const double* p, const Rod& rod) {
  double along[3], to_p[3];
  mju_sub3(along, rod.b, rod.a);
  mju_sub3(to_p, p, rod.a);
  const double t = mju_clip(mju_dot3(to_p, along) / std::max(mju_dot3(along, along), 1e-12), 0, 1);
  mju_addToScl3(to_p, along, -t);
  return mju_norm3(to_p);
}

// MuJoCo's visualizer draws tendons as capsules, too: each end of one chain lies on the other.
TEST(PoseSolver, TendonsRunWhereMuJoCoDrawsThem) {
  auto world = world_from_mjcf(kRopes);
  const mjModel& m = *world->model;
  auto sim = make_simulator(world, lockstep());
  auto solver = *PoseSolver::create(world);
  PoseFrame frame;
  DataPtr d(mj_makeData(&m));
  mjvScene scene;
  mjv_defaultScene(&scene);
  mjv_makeScene(&m, &scene, 1000);
  mjvOption option;
  mjv_defaultOption(&option);
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  sim->start();
  for (int round = 0; round < 4; ++round) {
    ASSERT_TRUE(sim->step(40).ok());
    ASSERT_TRUE(solver->solve(sim->latest(), frame).ok());
    mj_setState(&m, d.get(), sim->latest().state().data(), mjSTATE_INTEGRATION);
    mj_forward(&m, d.get());
    mjv_updateScene(&m, d.get(), &option, nullptr, &camera, mjCAT_ALL, &scene);
    for (int tendon = 0; tendon < m.ntendon; ++tendon) {
      std::vector<Rod> ours, theirs;
      const float* v =
          frame.vertices.data() + 3 * solver->layout().tendon_first[static_cast<size_t>(tendon)];
      for (int k = 0; k < tendon_segments(m, tendon); ++k, v += 3 * kCapsuleVertices) {
        Rod rod{};
        constexpr int kEnd = kCapsuleVertices / 2;  // vertices of one end
        for (int i = 0; i < kCapsuleVertices; ++i)
          for (int axis = 0; axis < 3; ++axis)
            (i < kEnd ? rod.a : rod.b)[axis] += double{v[3 * i + axis]} / kEnd;
        // The mean of an end lies inside by a little; a point is no capsule.
        if (std::memcmp(v, v + 3, 3 * sizeof(float)) != 0) ours.push_back(rod);
      }
      for (int g = 0; g < scene.ngeom; ++g) {
        const mjvGeom& geom = scene.geoms[g];
        if (geom.objtype != mjOBJ_TENDON || geom.objid != tendon) continue;
        Rod rod{};
        for (int axis = 0; axis < 3; ++axis) {
          const double half = double{geom.size[2]} * geom.mat[3 * axis + 2];
          rod.a[axis] = geom.pos[axis] - half;
          rod.b[axis] = geom.pos[axis] + half;
        }
        theirs.push_back(rod);
      }
      ASSERT_FALSE(ours.empty());
      ASSERT_FALSE(theirs.empty());
      const auto farthest = [](const std::vector<Rod>& from, const std::vector<Rod>& to) {
        double most = 0;
        for (const Rod& rod : from)
          for (const double* p : {rod.a, rod.b}) {
            double least = 1e9;
            for (const Rod& other : to) least = std::min(least, distance(p, other));
            most = std::max(most, least);
          }
        return most;
      };
      EXPECT_LT(farthest(ours, theirs), 6e-3) << "tendon " << tendon << " round " << round;
      EXPECT_LT(farthest(theirs, ours), 6e-3) << "tendon " << tendon << " round " << round;
    }
  }
  mjv_freeScene(&scene);
}

TEST(PoseSolver, FollowsLiveFields) {
  auto world = world_from_mjcf(kSeen);
  const mjModel& m = *world->model;
  auto sim = make_simulator(world, lockstep());
  auto solver = *PoseSolver::create(world);
  PoseFrame before, frame;
  sim->start();
  ASSERT_TRUE(sim->step(100).ok());
  const Snapshot old = sim->latest();
  ASSERT_TRUE(solver->solve(old, before).ok());
  EXPECT_EQ(before.live_serial, 0u);
  EXPECT_TRUE(before.height_field.empty());
  EXPECT_EQ(before.material_rgba[1], 0);

  const int b = mj_name2id(&m, mjOBJ_BODY, "b");
  ASSERT_TRUE(sim->post({.what = SetLiveField{LiveFieldId::kBodyMass, b, {9}}}).ok());
  ASSERT_TRUE(sim->post({.what = SetLiveField{LiveFieldId::kMaterialColor, 1, {1, .5f}}}).ok());
  ASSERT_TRUE(sim->post({.what = SetLiveField{LiveFieldId::kLightActive, 2, {0}}}).ok());
  ASSERT_TRUE(sim->post({.what = SetLiveField{LiveFieldId::kHeightField, 3, {.75f}}}).ok());
  // Poses are those of the model as the simulation has it, tracked centres of mass included.
  ModelPtr live_model;
  ASSERT_TRUE(sim->set_step_hook([&](const mjModel* model, mjData*) {
                   live_model.reset(mj_copyModel(nullptr, model));
                 })
                  .ok());
  ASSERT_TRUE(sim->step(50).ok());
  const Snapshot s = sim->latest();
  ASSERT_TRUE(solver->solve(s, frame).ok());
  DataPtr d(mj_makeData(live_model.get()));
  expect_forward_poses(*live_model, *d, s, frame);
  EXPECT_EQ(frame.live_serial, 4u);
  EXPECT_EQ(frame.height_field_serial, 4u);
  ASSERT_EQ(frame.height_field.size(), 12u);
  EXPECT_EQ(frame.height_field[3], .75f);
  EXPECT_EQ(frame.height_field[5], 1.f);
  EXPECT_EQ(frame.material_rgba[1], 1.f);
  EXPECT_EQ(frame.material_rgba[2], .5f);
  EXPECT_EQ(frame.material_emission[0], .5f);
  EXPECT_EQ(frame.light_active[2], 0);
  EXPECT_EQ(frame.light_active[1], 1);

  // And back: an older Snapshot is seen as it was then.
  PoseFrame again;
  ASSERT_TRUE(solver->solve(old, again).ok());
  EXPECT_EQ(again.camera_p, before.camera_p);
  EXPECT_EQ(again.material_rgba, before.material_rgba);
  ASSERT_TRUE(solver->solve(old, frame).ok());
  EXPECT_TRUE(frame.height_field.empty());

  // The fifth change since the simulation was made is the first of its second run.
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->post({.what = SetLiveField{LiveFieldId::kHeightField, 3, {.25f}}}).ok());
  ASSERT_TRUE(sim->step(1).ok());
  ASSERT_TRUE(solver->solve(sim->latest(), frame).ok());
  EXPECT_EQ(sim->latest().data().live->version, 1u);
  EXPECT_EQ(frame.live_serial, 5u);
  EXPECT_EQ(frame.height_field_serial, 5u);
  EXPECT_EQ(frame.height_field[3], .25f);
}

TEST(PoseSolver, SeesWhatSleeps) {
  auto world = world_from_mjcf(R"(<mujoco><option timestep="0.002"><flag sleep="enable"/></option>
    <worldbody><geom type="plane" size="2 2 .1"/>
      <body pos="0 0 .05"><freejoint/><geom type="box" size=".05 .05 .05"/></body></worldbody></mujoco>)");
  auto sim = make_simulator(world, lockstep());
  int awake = -1;
  ASSERT_TRUE(
      sim->set_step_hook([&awake](const mjModel*, mjData* d) { awake = d->ntree_awake; }).ok());
  sim->start();
  ASSERT_TRUE(sim->step(3000).ok());
  EXPECT_EQ(awake, 0) << "the box should be asleep by now";
  auto solver = *PoseSolver::create(world);
  PoseFrame frame;
  ASSERT_TRUE(solver->solve(sim->latest(), frame).ok());
  EXPECT_NEAR(frame.body_p[5], .05, 1e-3);
}

TEST(PoseSolver, ThreadsEachWithTheirOwnAgree) {
  auto world = world_from_mjcf(kSeen);
  auto sim = make_simulator(world, lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(77).ok());
  const Snapshot s = sim->latest();
  std::vector<PoseFrame> frames(4);
  std::vector<std::thread> threads;
  for (PoseFrame& frame : frames) {
    threads.emplace_back([&, s] {
      auto solver = *PoseSolver::create(world);
      for (int i = 0; i < 20; ++i) EXPECT_TRUE(solver->solve(s, frame).ok());
    });
  }
  for (std::thread& t : threads) t.join();
  for (const PoseFrame& frame : frames) {
    EXPECT_EQ(frame.body_R, frames[0].body_R);
    EXPECT_EQ(frame.vertices, frames[0].vertices);
  }
}

}  // namespace
}  // namespace gloam

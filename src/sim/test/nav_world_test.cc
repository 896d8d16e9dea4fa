// Where agents can go: the mesh against places whose free ground is known.

#include "agent_rig.h"
#include "base/parallel.h"

namespace gloam {
namespace {

struct Ground {
  explicit Ground(const std::string& xml, NavigationOptions options = {}, double radius = 0) {
    world = world_from_mjcf(xml);
    world->robots.clear();
    world->scene.navigation = options;
    AgentDescription agent;
    agent.name = "ann";
    agent.height = options.headroom;
    agent.radius = radius > 0 ? radius : options.radius;
    world->agents.push_back(agent);
    const mjModel* m = world->model.get();
    data.reset(mj_makeData(m));
    mj_kinematics(m, data.get());
    mj_comPos(m, data.get());
    auto made = NavWorld::create(*world, *m, *data);
    if (!made.ok()) {
      ADD_FAILURE() << made.error().to_string();
      abort();
    }
    nav = std::move(*made);
    nav->reset(*m, *data);
  }
  const NavMesh& mesh() const { return nav->mesh_of(0); }
  NavPoint at(double x, double y, double z = 0) const {
    return mesh().nearest({x, y, z}, 0.05, 0.5);
  }

  std::shared_ptr<CompiledWorld> world;
  DataPtr data;
  std::unique_ptr<NavWorld> nav;
};

TEST(NavWorld, ARoomIsFreeUpToTheRadiusFromItsWalls) {
  const Ground ground(agent_place("", 8));
  // 8 m less 0.3 m on each side; voxels of 0.1 m make it a little less.
  EXPECT_NEAR(ground.mesh().area_around(ground.at(0, 0)), 7.4 * 7.4, 1.6);
  EXPECT_NE(ground.at(3.5, 0).ref, 0u);
  EXPECT_EQ(ground.at(3.85, 0).ref, 0u) << "nearer to the wall than a person is wide";
}

TEST(NavWorld, NobodyStandsInASolid) {
  const Ground ground(agent_place("<geom type='box' size='1.5 1.5 1.5' pos='0 0 1.5'/>"));
  EXPECT_EQ(ground.at(0, 0).ref, 0u) << "the floor inside a box is no floor";
  EXPECT_NE(ground.at(2.2, 0).ref, 0u);
  const NavPoint out = ground.mesh().nearest({0.9, 0, 0}, 2, 0.5);
  ASSERT_NE(out.ref, 0u);
  EXPECT_NEAR(out.p.x, 1.8, 0.15);
}

TEST(NavWorld, StepsAndHeadroom) {
  const Ground ground(
      agent_place("<geom type='box' size='1 1 0.075' pos='-3 0 0.075'/>"
                  "<geom type='box' size='1 1 0.25' pos='0 0 0.25'/>"
                  "<geom type='box' size='1 1 0.1' pos='3 0 1.7'/>"));
  const NavPoint floor = ground.at(-4.8, 4);
  ASSERT_NE(floor.ref, 0u);
  const NavPoint step = ground.at(-3, 0, 0.15);
  ASSERT_NE(step.ref, 0u);
  EXPECT_NEAR(step.p.z, 0.15, 0.11) << "within two voxels";
  EXPECT_TRUE(ground.mesh().are_connected(floor, step)) << "0.15 m are a step";
  const NavPoint table = ground.at(0, 0, 0.5);
  EXPECT_FALSE(table.ref != 0 && ground.mesh().are_connected(floor, table)) << "0.5 m are none";
  EXPECT_EQ(ground.at(3, 0).ref, 0u) << "1.6 m of headroom for people of 1.9 m";
  EXPECT_NEAR(ground.nav->ground_below({-3, 0, 0.1}, 0.3, 0.3), 0.15, 1e-6);
  EXPECT_NEAR(ground.nav->ground_below({4.9, 4, 0.1}, 0.3, 0.3), 0, 1e-6);
}

TEST(NavWorld, GapsAreForThoseWhoFit) {
  const std::string gap =
      "<geom type='box' size='0.1 2.5 1' pos='0 3.5 1'/>"
      "<geom type='box' size='0.1 3.5 1' pos='0 -2.5 1'/>"  // no gap
      "<geom type='box' size='0.1 0.1 1' pos='0 5.9 1'/>";
  const std::string wide =
      "<geom type='box' size='0.1 2.4 1' pos='0 3.6 1'/>"
      "<geom type='box' size='0.1 3.5 1' pos='0 -2.5 1'/>";
  const std::string door =
      "<geom type='box' size='0.1 2.0 1' pos='0 4.0 1'/>"
      "<geom type='box' size='0.1 3.5 1' pos='0 -2.5 1'/>";
  const auto connects = [](const std::string& place, double radius) {
    const Ground ground(agent_place(place), {}, radius);
    return ground.mesh().are_connected(ground.at(-2, 0), ground.at(2, 0));
  };
  EXPECT_FALSE(connects(gap, 0.3));
  EXPECT_FALSE(connects(wide, 0.3)) << "0.2 m";
  EXPECT_TRUE(connects(door, 0.3)) << "1 m is a door for a person";
  EXPECT_FALSE(connects(door, 0.6)) << "and none for a car";
}

TEST(NavWorld, WhatIsAtRestIsInTheWayAndWhatHasGoneIsNot) {
  Ground ground(
      agent_place("<body name='crate' pos='2 0 0.5'><freejoint/>"
                  "<geom type='box' size='0.5 0.5 0.5'/></body>"));
  EXPECT_EQ(ground.at(2, 0).ref, 0u);
  ground.data->qpos[0] = -2;
  const mjModel* m = ground.world->model.get();
  mj_kinematics(m, ground.data.get());
  ground.nav->follow(*m, *ground.data, 0.1);
  EXPECT_FALSE(ground.nav->obstacles()[0].is_in_mesh) << "while it moves it is avoided";
  for (int i = 0; i < 30; ++i) ground.nav->follow(*m, *ground.data, 0.1);
  EXPECT_NE(ground.at(2, 0).ref, 0u) << "its old place is free";
  EXPECT_EQ(ground.at(-2, 0).ref, 0u) << "its new one is not";
  EXPECT_TRUE(ground.nav->obstacles()[0].is_in_mesh);
  ground.data->qpos[0] = 2;
  mj_kinematics(m, ground.data.get());
  ground.nav->reset(*m, *ground.data);
  EXPECT_EQ(ground.at(2, 0).ref, 0u) << "as at first";
  EXPECT_NE(ground.at(-2, 0).ref, 0u);
}

TEST(NavWorld, SlopesAndHeightFields) {
  const std::string hill = R"(<mujoco><asset><hfield name='h' nrow='3' ncol='3' size='10 10 %s 1'
    elevation='0 0 0  0 1 0  0 0 0'/></asset><worldbody><geom type='hfield' hfield='h'/></worldbody></mujoco>)";
  const auto with = [&](const char* height) {
    std::string text = hill;
    return text.replace(text.find("%s"), 2, height);
  };
  const Ground gentle(with("3"));  // 17 degrees
  const NavPoint top = gentle.mesh().nearest({0.5, 0.5, 2.8}, 0.5, 0.5);
  ASSERT_NE(top.ref, 0u);
  EXPECT_NEAR(gentle.nav->ground_below({5, 0, 1.6}, 0.5, 0.5), 1.5, 1e-5);
  const Ground steep(with("12"));  // 50 degrees
  EXPECT_EQ(steep.mesh().nearest({4, 1, 7}, 0.3, 1).ref, 0u) << "nobody walks up 50 degrees";
}

TEST(NavWorld, RandomPointsAreSpreadEvenly) {
  const Ground ground(agent_place("", 8));
  int left = 0, low = 0;
  const RandomStream stream{5, 1};
  for (uint64_t i = 0; i < 4000; ++i) {
    const NavPoint p = ground.mesh().random_point({}, stream.uniform(i, 0), stream.uniform(i, 1),
                                                  stream.uniform(i, 2));
    ASSERT_NE(p.ref, 0u);
    // A plane without an end reaches beyond the walls: what is outside counts too.
    left += p.p.x < 0, low += p.p.y < 0;
  }
  EXPECT_NEAR(left, 2000, 160);
  EXPECT_NEAR(low, 2000, 160);
}

TEST(NavWorld, TheMeshDoesNotDependOnThreads) {
  const std::string place = agent_place("<geom type='cylinder' size='1 1' pos='1 2 1'/>");
  set_thread_count(1);
  const Ground one(place);
  set_thread_count(4);
  const Ground four(place);
  set_thread_count(0);
  const RandomStream stream{5, 1};
  for (uint64_t i = 0; i < 100; ++i) {
    const double u = stream.uniform(i, 0), v = stream.uniform(i, 1), w = stream.uniform(i, 2);
    EXPECT_EQ(one.mesh().random_point({}, u, v, w).p, four.mesh().random_point({}, u, v, w).p);
  }
}

TEST(NavWorld, TooManyCellsAreRefused) {
  NavigationOptions fine;
  fine.cell = 0.02;
  auto world = world_from_mjcf(agent_place("<geom type='box' size='200 0.1 1' pos='0 150 1'/>"));
  world->scene.navigation = fine;
  AgentDescription agent;
  agent.radius = 0.3, agent.height = 1.9;
  world->agents.push_back(agent);
  const DataPtr data(mj_makeData(world->model.get()));
  mj_kinematics(world->model.get(), data.get());
  const auto made = NavWorld::create(*world, *world->model, *data);
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().hint.find("'cell'"), std::string::npos) << made.error().to_string();
}

}  // namespace
}  // namespace gloam

// The topic /scene: shapes of a model as Foxglove's primitives, in the frames of their bodies.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "foxglove_client.h"
#include "gloam/simulation.h"
#include "ros/codec.h"
#include "ros/messages/foxglove_msgs.h"

namespace gloam::bridge::foxglove {
namespace {

constexpr const char* kShapes = R"(<mujoco model="shapes">
  <asset>
    <material name="blue" rgba="0 0 1 1"/>
    <mesh name="wedge" vertex="0 0 0  2 0 0  0 1 0  0 0 1"/>
    <hfield name="hill" nrow="2" ncol="3" size="3 2 4 1" elevation="0 0.5 1 0 0.5 1"/>
  </asset>
  <worldbody>
    <geom name="floor" type="plane" size="0 3 0.1"/>
    <geom name="hill" type="hfield" hfield="hill" pos="0 0 5"/>
    <body name="thing" pos="0 0 1">
      <freejoint/>
      <geom type="box" size="0.1 0.2 0.3" pos="1 2 3" quat="0 0 0 1" rgba="1 0 0 0.5" mass="1"/>
      <geom type="sphere" size="0.4" material="blue"/>
      <geom type="ellipsoid" size="0.1 0.2 0.3"/>
      <geom type="cylinder" size="0.1 0.5"/>
      <geom type="capsule" size="0.05 0.25"/>
      <geom type="box" size="1 1 1" group="3"/>
      <geom type="box" size="1 1 1" rgba="1 1 1 0"/>
      <body name="part" pos="0 0 1"><geom type="mesh" mesh="wedge"/></body>
      <body name="empty" pos="0 0 1"><site name="s"/></body>
    </body>
  </worldbody>
</mujoco>)";

std::map<std::string, foxglove_msgs::SceneEntity> entities_of(const char* model) {
  const std::filesystem::path file = own_folder() / "shapes.xml";
  std::ofstream(file) << model;
  const auto scene = load_scene(file);
  EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().to_string());
  const auto world = World::compile(*scene);
  EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().to_string());
  const auto simulation = Simulation::create(*world, {.pace = Pace::kLockstep});
  std::vector<uint8_t> bytes;
  const auto stream =
      (*simulation)->open_topics({.topics = {"/scene"}}, [&](const TopicMessage& message) {
        bytes.assign(message.data.begin(), message.data.end());
      });
  EXPECT_TRUE(stream.ok()) << (stream.ok() ? "" : stream.error().to_string());
  const auto update = decode<foxglove_msgs::SceneUpdate>(bytes);
  EXPECT_TRUE(update.ok()) << (update.ok() ? "" : update.error().to_string());
  EXPECT_EQ(update->deletions.at(0).type, foxglove_msgs::SceneEntityDeletion::ALL);
  std::map<std::string, foxglove_msgs::SceneEntity> entities;
  for (const auto& entity : update->entities) entities[entity.id] = entity;
  return entities;
}

TEST(FoxgloveScene, ShapesAreThoseOfTheModel) {
  const auto entities = entities_of(kShapes);
  ASSERT_EQ(entities.size(), 3u) << "a body without shapes is none";
  const auto& thing = entities.at("thing");
  EXPECT_EQ(thing.frame_id, "thing");
  EXPECT_TRUE(thing.frame_locked);
  ASSERT_EQ(thing.cubes.size(), 1u) << "hidden groups and what is clear are not shown";
  EXPECT_EQ(thing.cubes[0].size, (geometry_msgs::Vector3{0.2, 0.4, 0.6}));
  EXPECT_EQ(thing.cubes[0].pose.position, (geometry_msgs::Point{1, 2, 3}));
  EXPECT_EQ(thing.cubes[0].pose.orientation, (geometry_msgs::Quaternion{0, 0, 1, 0}));
  EXPECT_EQ(thing.cubes[0].color, (foxglove_msgs::Color{1, 0, 0, 0.5}));
  ASSERT_EQ(thing.spheres.size(), 4u) << "two are the ends of the capsule";
  EXPECT_EQ(thing.spheres[0].size, (geometry_msgs::Vector3{0.8, 0.8, 0.8}));
  EXPECT_EQ(thing.spheres[0].color, (foxglove_msgs::Color{0, 0, 1, 1})) << "the material's";
  EXPECT_EQ(thing.spheres[1].size, (geometry_msgs::Vector3{0.2, 0.4, 0.6}));
  EXPECT_EQ(thing.spheres[2].pose.position.z, -0.25);
  EXPECT_EQ(thing.spheres[3].pose.position.z, 0.25);
  ASSERT_EQ(thing.cylinders.size(), 2u);
  EXPECT_EQ(thing.cylinders[0].size, (geometry_msgs::Vector3{0.2, 0.2, 1}));
  EXPECT_EQ(thing.cylinders[1].size, (geometry_msgs::Vector3{0.1, 0.1, 0.5}));
  EXPECT_EQ(thing.cylinders[1].top_scale, 1);
}

TEST(FoxgloveScene, MeshesAndGroundAreTriangles) {
  const auto entities = entities_of(kShapes);
  const auto& world = entities.at("world");
  ASSERT_EQ(world.cubes.size(), 1u);
  EXPECT_EQ(world.cubes[0].size.y, 6);
  EXPECT_GT(world.cubes[0].size.x, 6) << "without end";
  EXPECT_LT(world.cubes[0].pose.position.z, 0) << "its upper face is the plane";
  ASSERT_EQ(world.triangles.size(), 1u);
  const auto& hill = world.triangles[0];
  EXPECT_EQ(hill.pose.position.z, 5);
  ASSERT_EQ(hill.points.size(), 6u);
  EXPECT_EQ(hill.points[0], (geometry_msgs::Point{-3, -2, 0}));
  EXPECT_EQ(hill.points[1], (geometry_msgs::Point{0, -2, 2}));
  EXPECT_EQ(hill.points[5], (geometry_msgs::Point{3, 2, 4}));
  EXPECT_EQ(hill.indices.size(), 12u);

  // Each corner of the wedge stands where the model has it.
  const auto& part = entities.at("part");
  ASSERT_EQ(part.triangles.size(), 1u);
  const auto& mesh = part.triangles[0];
  ASSERT_EQ(mesh.indices.size(), 12u);
  const auto& q = mesh.pose.orientation;
  const auto& o = mesh.pose.position;
  double low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
  for (const uint32_t index : mesh.indices) {
    ASSERT_LT(index, mesh.points.size());
    const auto& p = mesh.points[index];
    // p + 2 w (u x p) + 2 u x (u x p)
    const double c[3] = {q.y * p.z - q.z * p.y, q.z * p.x - q.x * p.z, q.x * p.y - q.y * p.x};
    const double at[3] = {p.x + 2 * (q.w * c[0] + q.y * c[2] - q.z * c[1]) + o.x,
                          p.y + 2 * (q.w * c[1] + q.z * c[0] - q.x * c[2]) + o.y,
                          p.z + 2 * (q.w * c[2] + q.x * c[1] - q.y * c[0]) + o.z};
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], at[i]);
      high[i] = std::max(high[i], at[i]);
    }
  }
  const double size[3] = {2, 1, 1};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(low[i], 0, 1e-5);
    EXPECT_NEAR(high[i], size[i], 1e-5);
  }
}

}  // namespace
}  // namespace gloam::bridge::foxglove

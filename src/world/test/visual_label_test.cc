#include "world/visual_label.h"
#include "visual_test_model.h"

namespace gloam {
namespace {

using visual_test::compile;
using visual_test::describe;
using visual_test::expect_near;

TEST(VisualLabel, ClassOfAName) {
  EXPECT_EQ(semantic_class("chair_3"), "chair");
  EXPECT_EQ(semantic_class("chair3"), "chair");
  EXPECT_EQ(semantic_class("kitchen/table_02"), "table");
  EXPECT_EQ(semantic_class("a/b/wall.001"), "wall");
  EXPECT_EQ(semantic_class("side_table"), "side_table");
  EXPECT_EQ(semantic_class("3d_printer"), "3d_printer");
  for (const char* nothing : {"", "007", "_", "robot/"})
    EXPECT_EQ(semantic_class(nothing), "object");
}

TEST(VisualLabel, ObjectsAreRobotsBodiesAndWorldGeoms) {
  CompiledWorld world = compile(R"(<mujoco><worldbody>
      <geom name="floor" type="plane" size="1 1 1"/><geom name="wall_1" size="1"/>
      <geom name="wall_2" size="1"/><geom size="1"/>
      <body name="chair_3"><geom size="1"/><body name="cushion"><joint/><geom size="1"/></body></body>
      <body name="chair_4"><freejoint/><geom size="1"/></body>
      <body name="go1/trunk"><freejoint/><geom name="go1/shell" size="1"/>
        <body name="go1/foot"><joint/><geom size="1" group="3"/></body></body>
      <body name="go1/tether"><geom size="1"/></body>
      <body name="target" mocap="true"><geom size="1"/><body><geom size="1"/></body></body>
    </worldbody></mujoco>)");
  RobotInstance robot;
  robot.name = "go1";
  robot.prefix = "go1/";
  robot.root_body = mj_name2id(world.model.get(), mjOBJ_BODY, "go1/trunk");
  world.robots.push_back(robot);
  const RenderDescription out = describe(world);
  ASSERT_EQ(out.instances.size(), 12u);
  struct Row {
    const char* instance;
    const char* semantic;
    bool is_static;
  };
  const Row rows[12] = {{"floor", "floor", true},    {"wall_1", "wall", true},
                        {"wall_2", "wall", true},    {"body 0 geom 3 (sphere)", "object", true},
                        {"chair_3", "chair", true},  {"chair_3", "chair", false},
                        {"chair_4", "chair", false}, {"go1", "robot", false},
                        {"go1", "robot", false},     {"go1", "robot", true},
                        {"target", "target", false}, {"target", "target", false}};
  for (size_t i = 0; i < 12; ++i) {
    const InstanceDescription& instance = out.instances[i];
    EXPECT_EQ(instance.label.part, i + 1);
    EXPECT_EQ(instance.label.instance_name, rows[i].instance) << i;
    EXPECT_EQ(instance.label.semantic_name, rows[i].semantic) << i;
    EXPECT_EQ(instance.is_static, rows[i].is_static) << i;
    for (size_t j = 0; j < i; ++j) {
      const LabelRow& other = out.instances[j].label;
      EXPECT_EQ(other.semantic == instance.label.semantic,
                std::string(rows[i].semantic) == rows[j].semantic);
      EXPECT_EQ(other.instance == instance.label.instance,
                std::string(rows[i].instance) == rows[j].instance);
    }
  }
  EXPECT_EQ(out.instances[7].label.geom, "go1/shell");
  EXPECT_EQ(out.instances[8].label.body, "go1/foot");
  EXPECT_EQ(out.instances[8].group, 3);
  EXPECT_EQ(out.instances[0].label.instance, 1);
}

// Where a bare model's table comes first, the arm is the robot all the same.
TEST(VisualLabel, ABareModelsRobotsAreWhatIsDriven) {
  const char* kBodies = R"(<mujoco model="kitchen"><worldbody>
      <body name="table"><geom size="1"/></body>
      <body name="apple"><freejoint/><geom size="1"/></body>
      <body name="cupboard"><geom size="1"/><body><joint name="door"/><geom size="1"/></body></body>
      <body name="arm"><joint name="j"/><geom size="1"/></body>
      <body><geom size="1"/></body></worldbody>
      <actuator><motor joint="j"/></actuator></mujoco>)";
  CompiledWorld world = compile(kBodies);
  world.scene.name = "kitchen";
  world.scene.bare_model = "kitchen.xml";
  const RenderDescription out = describe(world);
  ASSERT_EQ(out.instances.size(), 6u);
  const std::pair<const char*, const char*> rows[] = {
      {"table", "table"},       {"apple", "apple"}, {"cupboard", "cupboard"},
      {"cupboard", "cupboard"}, {"arm", "robot"},   {"body 6", "object"}};
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(out.instances[i].label.instance_name, rows[i].first);
    EXPECT_EQ(out.instances[i].label.semantic_name, rows[i].second);
  }
  EXPECT_EQ(out.instances[3].label.body, "body 4");
  EXPECT_EQ(out.instances[3].label.geom, "body 4 geom 3 (sphere)");
}

// Of a model that is one robot, the robot has the model's name.
TEST(VisualLabel, ABareRobotHasTheModelsName) {
  CompiledWorld world = compile(R"(<mujoco><worldbody><geom name="floor" size="1"/>
      <body name="base"><freejoint/><geom size="1"/><body><joint name="j"/><geom size="1"/></body>
      </body></worldbody></mujoco>)");
  world.scene.name = "go1";
  world.scene.bare_model = "go1.xml";
  const RenderDescription out = describe(world);
  EXPECT_EQ(out.instances[0].label.semantic_name, "floor");
  EXPECT_EQ(out.instances[1].label.instance_name, "go1");
  EXPECT_EQ(out.instances[2].label.semantic_name, "robot");
}

TEST(VisualLabel, EveryShapeWithItsPose) {
  const RenderDescription out = describe(R"(<mujoco><worldbody>
      <geom type="plane" size="0 2 1"/><geom type="sphere" size=".1"/>
      <geom type="ellipsoid" size=".1 .2 .3"/><geom type="capsule" fromto="0 0 0 0 0 1" size=".1"/>
      <geom type="cylinder" size=".1 .2" castshadow="false"/>
      <body pos="5 5 5"><geom type="box" size=".1 .2 .3" pos="1 2 3" quat="1 0 0 1"/></body>
    </worldbody></mujoco>)");
  const ShapeType shapes[6] = {ShapeType::kPlane,   ShapeType::kSphere,   ShapeType::kEllipsoid,
                               ShapeType::kCapsule, ShapeType::kCylinder, ShapeType::kBox};
  ASSERT_EQ(out.instances.size(), 6u);
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(out.instances[i].shape, shapes[i]);
  expect_near(out.instances[0].size, {0, 2, 0}, 0);
  expect_near(out.instances[3].size, {.1f, .5f, 0}, 1e-7f);
  expect_near(out.instances[3].X_BG.p, {0, 0, .5f}, 1e-7f);
  EXPECT_FALSE(out.instances[4].casts_shadow);
  const InstanceDescription& box = out.instances[5];
  EXPECT_EQ(box.body, 1);
  // About z by 90 degrees: x goes to y.
  expect_near(transform_point(box.X_BG, {1, 0, 0}), {1, 3, 3}, 1e-6f);
  expect_near(transform_point(box.X_BG, {0, 1, 0}), {0, 2, 3}, 1e-6f);
}

TEST(VisualLabel, VisualOnlyGeomsComeFromTheirOwnModel) {
  CompiledWorld world = compile(R"(<mujoco><worldbody><body name="link"><joint/>
      <geom name="hull" type="box" size="1 1 1" group="3"/></body></worldbody></mujoco>)");
  CompiledWorld visual = compile(R"(<mujoco><asset><material name="paint" rgba="1 0 0 1"/>
      <mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody>
      <geom size="1"/><geom name="cover" type="mesh" mesh="m" material="paint"/></worldbody></mujoco>)");
  world.visual_model = std::move(visual.model);
  VisualOnlyGeom geom;
  geom.body = 1;
  geom.geom = 1;
  geom.X_BG = {{1, 2, 3}, {}};
  world.visual_only.push_back(geom);
  const RenderDescription out = describe(world);
  ASSERT_EQ(out.instances.size(), 2u);
  const InstanceDescription& cover = out.instances[1];
  EXPECT_EQ(cover.shape, ShapeType::kMesh);
  EXPECT_EQ(out.meshes[static_cast<size_t>(cover.mesh)].triangle_count(), 4u);
  EXPECT_EQ(cover.body, 1);
  EXPECT_FALSE(cover.is_static);
  expect_near(cover.X_BG.p, {1, 2, 3}, 0);
  EXPECT_EQ(cover.label.geom, "cover");
  EXPECT_EQ(cover.label.instance_name, "link");
  EXPECT_EQ(cover.label.instance, out.instances[0].label.instance);
  const MaterialDescription& paint = out.materials[static_cast<size_t>(cover.material)];
  expect_near(paint.base_color, {1, 0, 0}, 0);
  EXPECT_EQ(paint.model_material, -1) << "live fields are those of the simulated model";
}

}  // namespace
}  // namespace gloam

#include <cmath>
#include <set>

#include "visual_test_model.h"

namespace gloam {
namespace {

using visual_test::compile;
using visual_test::describe;
using visual_test::expect_near;

/// MuJoCo's own abstract picture of the model at qpos0.
class Picture {
 public:
  explicit Picture(const mjModel* model) : data_(mj_makeData(model), mj_deleteData) {
    mj_forward(model, data_.get());
    mjv_defaultScene(&scene_);
    mjv_makeScene(model, &scene_, 100);
    mjvOption option;
    mjv_defaultOption(&option);
    mjvCamera camera;
    mjv_defaultFreeCamera(model, &camera);
    mjv_updateScene(model, data_.get(), &option, nullptr, &camera, mjCAT_ALL, &scene_);
  }
  ~Picture() { mjv_freeScene(&scene_); }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  const mjvScene& scene() const { return scene_; }
  const mjData& data() const { return *data_; }

 private:
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  mjvScene scene_;
};

TEST(VisualDeformable, SkinIsSkinnedAtQpos0) {
  // The bind pose differs from qpos0, so the bones bend it.
  const CompiledWorld world = compile(R"(<mujoco><asset><material name="m" rgba="1 0 0 1"/></asset>
    <worldbody><body name="a" pos="0 0 1"><freejoint/><geom size=".1"/>
      <body name="b" pos="0 0 1" quat="1 .3 0 0"><joint/><geom size=".1"/></body></body></worldbody>
    <deformable><skin name="hide" material="m" group="1" vertex="0 0 0 1 0 0 0 1 0 0 0 2"
      texcoord="0 0 1 0 0 1 1 1" face="0 2 1 0 1 3 1 2 3 2 0 3">
      <bone body="a" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2" vertweight="1 1 .4"/>
      <bone body="b" bindpos="0 0 2" bindquat="1 0 0 0" vertid="2 3" vertweight=".6 1"/>
    </skin></deformable></mujoco>)");
  const RenderDescription out = describe(world);
  ASSERT_EQ(out.deformables.size(), 1u);
  const InstanceDescription& instance = out.instances.back();
  EXPECT_EQ(instance.shape, ShapeType::kDeformable);
  EXPECT_EQ(instance.group, 1);
  EXPECT_EQ(instance.label.geom, "hide");
  EXPECT_EQ(instance.label.instance_name, "a");
  EXPECT_EQ(instance.label.material, "m");
  const TriangleMesh& rest = out.deformables[0].rest;
  EXPECT_EQ(out.deformables[0].first_vertex, 0);
  EXPECT_EQ(rest.triangle_count(), 4u);
  ASSERT_EQ(rest.positions.size(), 4u);
  EXPECT_FLOAT_EQ(rest.uvs[2].y, 0) << "MuJoCo's t = 1 is the bottom of the image";
  const Picture picture(world.model.get());
  for (size_t i = 0; i < 4; ++i) {
    const float* v = picture.scene().skinvert + 3 * i;
    expect_near(rest.positions[i], {v[0], v[1], v[2]}, 1e-6f);
  }
}

TEST(VisualDeformable, ClothAndSolid) {
  const CompiledWorld world = compile(R"(<mujoco><asset><material name="m" rgba="1 0 0 1"/></asset>
    <worldbody><body name="base" pos="1 2 3">
      <flexcomp name="cloth" type="grid" dim="2" count="3 2 1" spacing=".1 .1 .1" mass="1"
        radius=".01" texcoord="0 0 0 1 .5 0 .5 1 1 0 1 1" material="m"/>
      <flexcomp name="jelly" type="grid" dim="3" count="3 3 3" spacing=".1 .1 .1" mass="1"
        radius=".01" rgba="0 1 0 1"/>
      <flexcomp name="rope" type="grid" dim="1" count="4 1 1" spacing=".1 .1 .1" mass="1"
        radius=".01"/></body></worldbody>
    <deformable><skin vertex="0 0 0 1 0 0 0 1 0" face="0 1 2">
      <bone body="world" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2" vertweight="1 1 1"/>
    </skin></deformable></mujoco>)");
  const RenderDescription out = describe(world);
  ASSERT_EQ(out.deformables.size(), 4u);
  const Picture picture(world.model.get());
  const TriangleMesh& cloth = out.deformables[1].rest;
  EXPECT_EQ(out.deformables[1].first_vertex, 3) << "flexes come after skins";
  EXPECT_EQ(cloth.triangle_count(), 4u);
  ASSERT_EQ(cloth.positions.size(), 6u);
  ASSERT_EQ(cloth.uvs.size(), 6u);
  EXPECT_FLOAT_EQ(cloth.uvs[2].x, .5f);
  EXPECT_FLOAT_EQ(cloth.uvs[1].y, 0);
  const InstanceDescription& cloth_instance = out.instances[1];
  expect_near(out.materials[static_cast<size_t>(cloth_instance.material)].base_color, {1, 0, 0}, 0);
  EXPECT_EQ(cloth_instance.label.instance_name, "cloth");

  const TriangleMesh& jelly = out.deformables[2].rest;
  EXPECT_EQ(out.deformables[2].first_vertex, 9);
  EXPECT_EQ(jelly.positions.size(), 27u);
  EXPECT_EQ(jelly.triangle_count(), 48u) << "six sides of 2 x 2 squares";
  double volume = 0;
  for (size_t f = 0; f < jelly.indices.size(); f += 3)
    volume += dot(jelly.positions[jelly.indices[f]] - jelly.positions[0],
                  cross(jelly.positions[jelly.indices[f + 1]] - jelly.positions[0],
                        jelly.positions[jelly.indices[f + 2]] - jelly.positions[0])) /
              6.0;
  EXPECT_NEAR(volume, .008, 1e-7) << "closed and facing outwards";

  for (const auto* mesh : {&cloth, &jelly})
    for (size_t i = 0; i < mesh->positions.size(); ++i) {
      const size_t row = i + (mesh == &cloth ? 0 : 6);
      const mjtNum* v = picture.data().flexvert_xpos + 3 * row;
      expect_near(mesh->positions[i],
                  {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])},
                  1e-6f);
    }
  // The rope is three capsules of its radius around its elements, closed and facing outwards.
  const TriangleMesh& rope = out.deformables[3].rest;
  EXPECT_EQ(out.deformables[3].first_vertex, 3 + 6 + 27 + 4);
  double rope_volume = 0;
  for (size_t f = 0; f < rope.indices.size(); f += 3)
    rope_volume +=
        dot(rope.positions[rope.indices[f]],
            cross(rope.positions[rope.indices[f + 1]], rope.positions[rope.indices[f + 2]])) /
        6.0;
  const double one = 3.14159265 * .01 * .01 * (.1 + 4. / 3 * .01);
  EXPECT_NEAR(rope_volume, 3 * one, .05 * 3 * one);
  const mjtNum* end = picture.data().flexvert_xpos + 3 * 33;
  for (const Vec3f p : rope.positions) {
    EXPECT_NEAR(p.y, end[1], .0103);
    EXPECT_GT(p.x, end[0] - .0101);
    EXPECT_LT(p.x, end[0] + .3101);
  }
  EXPECT_EQ(out.instances[3].label.instance_name, "rope");
  EXPECT_TRUE(out.unsupported.empty());
}

TEST(VisualDeformable, EachMaterialOfAFlexIsAPart) {
  CompiledWorld world = compile(R"(<mujoco><asset><material name="red" rgba="1 0 0 1"/>
      <material name="blue" rgba="0 0 1 1"/></asset><worldbody>
      <flexcomp name="cube" type="grid" dim="3" count="2 2 2" spacing=".1 .1 .1" mass="1"
        radius=".01" material="red"/></worldbody></mujoco>)");
  world.model->flex_matid[2] = 1;
  const RenderDescription out = describe(world);
  ASSERT_EQ(out.deformables.size(), 2u);
  EXPECT_EQ(out.deformables[0].rest.triangle_count() + out.deformables[1].rest.triangle_count(),
            12u);
  EXPECT_EQ(out.instances[0].label.material, "red");
  EXPECT_EQ(out.instances[1].label.material, "blue");
  EXPECT_EQ(out.instances[0].label.instance, out.instances[1].label.instance);
  // The blue triangles are those of the third tetrahedron's surface.
  std::set<int> corners(world.model->flex_elem + 8, world.model->flex_elem + 12);
  EXPECT_GT(out.deformables[1].rest.triangle_count(), 0u);
  for (const uint32_t v : out.deformables[1].rest.indices)
    EXPECT_TRUE(corners.count(static_cast<int>(v)) == 1);
}

TEST(VisualDeformable, SpatialTendonsAreDrawn) {
  const RenderDescription out = describe(R"(<mujoco>
      <asset><material name="hemp" rgba="1 0 0 1"/></asset><worldbody><site name="a"/>
      <body><joint name="j"/><geom size=".1"/><site name="b" pos="0 0 1"/></body></worldbody>
      <tendon><spatial name="string" width=".02" material="hemp" group="1">
          <site site="a"/><site site="b"/></spatial>
        <spatial name="unseen" rgba="1 1 1 0"><site site="a"/><site site="b"/></spatial>
        <fixed name="sum"><joint joint="j" coef="1"/></fixed></tendon></mujoco>)");
  EXPECT_TRUE(out.unsupported.empty());
  ASSERT_EQ(out.instances.size(), 2u) << "neither sites nor what has no path are drawn";
  const InstanceDescription& string = out.instances[1];
  EXPECT_EQ(string.label.geom, "string");
  EXPECT_EQ(string.label.material, "hemp");
  EXPECT_EQ(string.group, 1);
  expect_near(out.materials[static_cast<size_t>(string.material)].base_color, {1, 0, 0}, 0);
  float low = 1, high = 0, widest = 0;
  for (const Vec3f p : out.deformables[0].rest.positions) {
    low = std::min(low, p.z);
    high = std::max(high, p.z);
    widest = std::max(widest, std::hypot(p.x, p.y));
  }
  EXPECT_NEAR(low, -.02, 1e-4);
  EXPECT_NEAR(high, 1.02, 1e-4);
  EXPECT_NEAR(widest, .02, .001);
}

}  // namespace
}  // namespace gloam

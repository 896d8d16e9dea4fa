#include <cmath>

#include "visual_test_model.h"

namespace gloam {
namespace {

using visual_test::describe;
using visual_test::expect_near;

TEST(VisualCamera, FieldOfViewAndResolution) {
  const RenderDescription out = describe(R"(<mujoco><worldbody><geom size="1"/>
      <camera name="plain"/><camera name="wide" fovy="90" resolution="200 100"/>
      <camera name="ortho" projection="orthographic" fovy="2" resolution="300 200"/>
    </worldbody></mujoco>)");
  ASSERT_EQ(out.cameras.size(), 4u);
  const Intrinsics& plain = out.cameras[0].intrinsics;
  EXPECT_EQ(plain.width, 640);
  EXPECT_EQ(plain.height, 480);
  EXPECT_NEAR(plain.fy, 240 / std::tan(22.5 * M_PI / 180), 1e-9);
  EXPECT_EQ(plain.fx, plain.fy);
  EXPECT_EQ(plain.cx, 320);
  EXPECT_EQ(plain.cy, 240);
  const Intrinsics& wide = out.cameras[1].intrinsics;
  EXPECT_EQ(wide.width, 200);
  EXPECT_NEAR(wide.fy, 50, 1e-9);
  const Intrinsics& ortho = out.cameras[2].intrinsics;
  EXPECT_TRUE(ortho.orthographic);
  EXPECT_DOUBLE_EQ(ortho.fy, 100) << "200 px over 2 m";
  EXPECT_EQ(out.cameras[2].camera, 2);
  EXPECT_EQ(out.cameras[2].name, "ortho");
}

TEST(VisualCamera, SensorAndPrincipalPoint) {
  // MuJoCo's own picture of this camera has the axis at pixel (220, 190) and a point at (0.3, 0.2)
  // of a plane 2 m away at (310, 110).
  const RenderDescription out = describe(R"(<mujoco><worldbody><geom size="1"/>
      <camera resolution="640 480" sensorsize="6.4 4.8" focal="6 8" principal="1 .5"/>
      <camera resolution="640 480" sensorsize="6.4 4.8" focalpixel="600 800"
        principalpixel="100 50"/></worldbody></mujoco>)");
  for (int i = 0; i < 2; ++i) {
    const Intrinsics& k = out.cameras[static_cast<size_t>(i)].intrinsics;
    EXPECT_NEAR(k.fx, 600, 1e-3);
    EXPECT_NEAR(k.fy, 800, 1e-3);
    EXPECT_NEAR(k.cx, 220, 1e-3);
    EXPECT_NEAR(k.cy, 190, 1e-3);
    EXPECT_NEAR(k.cx + k.fx * .3 / 2, 310, 1e-3);
    EXPECT_NEAR(k.cy - k.fy * .2 / 2, 110, 1e-3);
  }
}

TEST(VisualCamera, WithoutFocalLengthIsSaidAndStillSees) {
  const RenderDescription out = describe(R"(<mujoco><worldbody><geom size="1"/>
      <camera name="blind" resolution="64 48" sensorsize="1 1"/></worldbody></mujoco>)");
  EXPECT_NEAR(out.cameras[0].intrinsics.fy, 24 / std::tan(22.5 * M_PI / 180), 1e-9);
  ASSERT_EQ(out.unsupported.size(), 1u);
  EXPECT_NE(out.unsupported[0].message.find("'blind'"), std::string::npos);
}

TEST(VisualCamera, FreeCameraIsMuJoCosDefault) {
  const CompiledWorld world = visual_test::compile(R"(<mujoco><statistic center="1 2 3" extent="2"/>
      <visual><global azimuth="30" elevation="-20" fovy="60" offwidth="320" offheight="200"/></visual>
      <worldbody><geom size="1"/></worldbody></mujoco>)");
  const RenderDescription out = describe(world);
  const CameraDescription& camera = out.cameras.back();
  EXPECT_EQ(camera.name, "free");
  EXPECT_EQ(camera.camera, -1);
  EXPECT_EQ(camera.intrinsics.width, 320);
  EXPECT_NEAR(camera.intrinsics.fy, 100 / std::tan(M_PI / 6), 1e-4);

  mjvCamera free;
  mjv_defaultFreeCamera(world.model.get(), &free);
  mjvScene scene;
  mjv_defaultScene(&scene);
  mjv_makeScene(world.model.get(), &scene, 10);
  const std::unique_ptr<mjData, void (*)(mjData*)> data{mj_makeData(world.model.get()),
                                                        mj_deleteData};
  mj_forward(world.model.get(), data.get());
  mjv_updateCamera(world.model.get(), data.get(), &free, &scene);
  const mjvGLCamera* eyes = scene.camera;  // left and right, half the eye distance apart
  const auto vec = [](const float* v) { return Vec3f{v[0], v[1], v[2]}; };
  expect_near(camera.X_WC.p, (vec(eyes[0].pos) + vec(eyes[1].pos)) * 0.5f, 1e-5f);
  expect_near(-camera.X_WC.z, vec(eyes[0].forward), 1e-6f);
  expect_near(camera.X_WC.y, vec(eyes[0].up), 1e-6f);
  expect_near(camera.X_WC.x, cross(camera.X_WC.y, camera.X_WC.z), 1e-6f);
  mjv_freeScene(&scene);
}

}  // namespace
}  // namespace gloam

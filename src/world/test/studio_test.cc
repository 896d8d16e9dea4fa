// The studio and the free camera's view of models that bring no light, or stand beside large
// things.

#include "world/view/studio.h"

#include <cmath>

#include "visual_test_model.h"
#include "world/materials/visual_rules.h"

namespace gloam {
namespace {

using visual_test::compile;
using visual_test::describe;

RenderDescription look(const std::string& xml, RenderLook look = RenderLook::kAuto) {
  CompiledWorld world = compile(xml);
  world.scene.bare_model = "model.xml";
  world.scene.render.look = look;
  return describe(world);
}

const char* kStudioRobot = R"(<mujoco><worldbody><body pos="0 0 0.5"><freejoint/>
    <geom type="box" size="0.2 0.1 0.05" rgba="0.4 0.4 0.4 1"/>
    <geom type="capsule" fromto="0.2 0.1 0 0.2 0.1 -0.4" size="0.02" rgba="0.1 0.1 0.1 1"/>
  </body></worldbody></mujoco>)";

int studio_floors(const RenderDescription& d) {
  int count = 0;
  for (const InstanceDescription& in : d.instances) count += in.color_only;
  return count;
}

/// Half width and half height that the points of the model take up in the free camera's picture,
/// 1 = all of it.
Vec2f filled(const RenderDescription& d, int body) {
  const CameraDescription& camera = d.cameras.back();
  std::vector<Affine3f> poses(8);  // of more bodies than any model here has
  poses[static_cast<size_t>(body)].p = {0, 0, 0.5f};
  float x = 0, y = 0;
  for (const DrawnPart& part : drawn_parts(d, poses)) {
    if (d.instances[part.instance].body != body) continue;
    for (const Vec3f& p : part.points) {
      const Vec3f v = p - camera.X_WC.p;
      const float depth = -dot(v, camera.X_WC.z);
      x = max(x, std::fabs(dot(v, camera.X_WC.x)) / depth * 2 *
                     static_cast<float>(camera.intrinsics.fx / camera.intrinsics.width));
      y = max(y, std::fabs(dot(v, camera.X_WC.y)) / depth * 2 *
                     static_cast<float>(camera.intrinsics.fy / camera.intrinsics.height));
    }
  }
  return {x, y};
}

TEST(Studio, LightsAModelThatBringsNone) {
  const RenderDescription d = look(kStudioRobot);
  EXPECT_GT(d.sky.environment.width, 0);
  EXPECT_EQ(studio_floors(d), 1);
  ASSERT_FALSE(d.lights.empty());
  EXPECT_EQ(d.lights.back().name, "studio key");
  EXPECT_FALSE(d.lights.front().active) << "the headlight is off";
  const InstanceDescription& floor = d.instances.back();
  EXPECT_NEAR(floor.X_BG.p.z, 0.5f - 0.4f - 0.02f, 2e-3f) << "at the lowest drawn point";
}

TEST(Studio, LeavesModelsWithLightOrSkyAlone) {
  const std::string model = kStudioRobot;
  const auto with = [&](const std::string& before, const std::string& lines) {
    std::string xml = model;
    return xml.insert(xml.find(before), lines);
  };
  for (const std::string& xml :
       {with("<body", "<light pos='0 0 3'/>"),
        with("<worldbody",
             "<asset><texture type='skybox' builtin='flat' width='8' height='48' "
             "rgb1='1 1 1'/></asset>")}) {
    const RenderDescription d = look(xml);
    EXPECT_EQ(d.sky.environment.width, 0);
    EXPECT_EQ(studio_floors(d), 0);
    EXPECT_LT(d.ev100, look(xml, RenderLook::kModel).ev100)
        << "the exposure is opened for a dark robot";
    EXPECT_GT(look(xml, RenderLook::kStudio).sky.environment.width, 0) << "look = studio insists";
  }
  const RenderDescription as_it_is = look(kStudioRobot, RenderLook::kModel);
  EXPECT_EQ(as_it_is.sky.environment.width, 0);
  EXPECT_TRUE(as_it_is.lights.back().active) << "the headlight";
  EXPECT_FLOAT_EQ(as_it_is.ev100, ev100_for(kWhiteLuminance, kWhiteExposed));
}

TEST(Studio, AFloorOfTheModelIsEnough) {
  std::string xml = kStudioRobot;
  xml.insert(xml.find("<body "), "<geom type='plane' size='0 0 1'/>");
  EXPECT_EQ(studio_floors(look(xml)), 0);
  EXPECT_GT(look(xml).sky.environment.width, 0);
}

TEST(Studio, TheFloorIsAsBrightAsTheSkyBehindIt) {
  const RenderDescription d = look(kStudioRobot);
  const EnvironmentDescription& sky = d.sky.environment;
  const Vec3f below = sky.texels.back() * sky.scale;
  const auto& floor = d.materials[static_cast<size_t>(d.instances.back().material)];
  // The map's rows are 32: irradiance of a level surface by hand, then the key light.
  double level = 0;
  for (int y = 0; y < sky.height / 2; ++y) {
    const double theta = (y + 0.5) * M_PI / sky.height;
    level += luminance(sky.texels[static_cast<size_t>(y * sky.width)]) * std::cos(theta) *
             std::sin(theta) * 2 * M_PI * (M_PI / sky.height);
  }
  const LightDescription& key = d.lights.back();
  level += luminance(key.intensity) * key.X_BL.z.z;
  EXPECT_NEAR(floor.base_color.x * level / M_PI / luminance(below), 1, 0.03);
}

TEST(Studio, ADarkRobotIsExposedLonger) {
  std::string dark = kStudioRobot, bright = kStudioRobot;
  dark.replace(dark.find("0.4 0.4 0.4"), 11, "0.2 0.2 0.2");
  bright.replace(bright.find("0.4 0.4 0.4"), 11, "0.9 0.9 0.9");
  EXPECT_LT(look(dark).ev100, look(bright).ev100 - 1);
}

TEST(FreeView, TheModelFillsThePicture) {
  const Vec2f share = filled(look(kStudioRobot), 1);
  EXPECT_NEAR(max(share.x, share.y), 0.94, 0.02);
  const CameraDescription camera = look(kStudioRobot).cameras.back();
  EXPECT_GT(camera.X_WC.z.z, 0.2f) << "from above";
  EXPECT_GT(std::fabs(camera.X_WC.z.x), 0.2f) << "from a corner";
  EXPECT_GT(std::fabs(camera.X_WC.z.y), 0.2f);
}

TEST(FreeView, FloorsPropsAndPlatesDoNotSpoilIt) {
  const Vec2f alone = filled(look(kStudioRobot), 1);
  for (const char* beside :
       {"<geom type='plane' size='0 0 1'/>", "<geom type='plane' size='50 50 1'/>",
        "<geom type='box' size='40 40 0.1' pos='0 0 -0.1'/>",
        "<geom type='sphere' size='0.1' pos='300 0 0'/>"}) {
    std::string xml = kStudioRobot;
    xml.insert(xml.find("<body "), beside);
    const Vec2f share = filled(look(xml), 1);
    EXPECT_NEAR(share.x, alone.x, 1e-4f) << beside;
    EXPECT_NEAR(share.y, alone.y, 1e-4f) << beside;
  }
  std::string far = kStudioRobot;
  far.insert(far.find("</worldbody>"), "<body pos='300 0 0'><freejoint/><geom size='0.1'/></body>");
  EXPECT_NEAR(filled(look(far), 1).x, alone.x, 1e-4f);
  const RenderDescription plate = look(
      "<mujoco><worldbody><body><geom type='box' size='1 1 1e-6'/></body></worldbody></mujoco>");
  EXPECT_TRUE(std::isfinite(plate.cameras.back().X_WC.p.x));
  EXPECT_LT(length(plate.cameras.back().X_WC.p), 6);
}

TEST(FreeView, TakesTheDirectionThatAModelGives) {
  std::string xml = kStudioRobot;
  xml.insert(xml.find("<worldbody"), "<visual><global azimuth='0' elevation='-10'/></visual>");
  const CameraDescription camera = look(xml).cameras.back();
  EXPECT_NEAR(camera.X_WC.z.x, -std::cos(10 * M_PI / 180), 1e-5);
  EXPECT_NEAR(camera.X_WC.z.y, 0, 1e-5);
  EXPECT_NEAR(camera.X_WC.z.z, std::sin(10 * M_PI / 180), 1e-5);
}

TEST(FreeView, WhatIsTallAndThinIsSeenFromHigherUp) {
  const auto pole = [](const char* size) {
    return look(std::string("<mujoco><worldbody><body><geom type='box' size='") + size +
                "'/></body></worldbody></mujoco>");
  };
  const float usual = look(kStudioRobot).cameras.back().X_WC.z.z;
  EXPECT_GT(pole("0.02 0.02 1").cameras.back().X_WC.z.z, usual + 0.2f);
  EXPECT_NEAR(pole("0.5 0.5 0.5").cameras.back().X_WC.z.z, usual, 1e-5f);
}

TEST(FreeView, TheModelsLookHasMuJoCosView) {
  const RenderDescription d = look(kStudioRobot, RenderLook::kModel);
  EXPECT_NEAR(d.cameras.back().X_WC.z.z, std::sin(45 * M_PI / 180), 1e-5);
}

TEST(FreeView, AnOrthographicOneShowsItAll) {
  std::string xml = kStudioRobot;
  xml.insert(xml.find("<worldbody"), "<visual><global orthographic='true' fovy='45'/></visual>");
  const Intrinsics k = look(xml).cameras.back().intrinsics;
  EXPECT_GT(k.height / k.fy, 0.4);
  EXPECT_LT(k.height / k.fy, 1.0) << "metres, not the 45 of a perspective";
}

}  // namespace
}  // namespace gloam

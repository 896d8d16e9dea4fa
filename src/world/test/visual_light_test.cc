#include <cmath>

#include "visual_test_model.h"
#include "world/materials/visual_rules.h"

namespace gloam {
namespace {

using visual_test::describe;
using visual_test::expect_near;

std::string scene(const std::string& lights, const std::string& visual = "",
                  const std::string& assets = "") {
  return "<mujoco><statistic center='0 0 1' extent='4'/><visual>" + visual + "</visual><asset>" +
         assets + "</asset><worldbody><geom size='1'/>" + lights + "</worldbody></mujoco>";
}

TEST(VisualLight, LegacyLightsLightFacingWhiteToTheirDiffuse) {
  const RenderDescription out = describe(scene(R"(
      <light type="directional" diffuse=".5 .6 .7" castshadow="false"/>
      <light type="point" pos="0 0 4" diffuse="1 1 .5" bulbradius=".1"/>
      <light type="point" pos="0 0 3" diffuse="1 1 1" attenuation="1 .5 .25"/>
      <light name="off" pos="0 0 2" active="false"/>)"));
  ASSERT_EQ(out.lights.size(), 5u) << "four and the headlight";
  // E = pi L for a Lambert surface of albedo 1 and L = 100 d; a point source has I = E r².
  const float E = 100 * kPi;
  EXPECT_EQ(out.lights[0].type, PunctualLightType::kDirectional);
  EXPECT_FALSE(out.lights[0].casts_shadow);
  expect_near(out.lights[0].intensity, Vec3f{.5f, .6f, .7f} * E, 1e-3f);
  EXPECT_EQ(out.lights[1].type, PunctualLightType::kPoint);
  EXPECT_FLOAT_EQ(out.lights[1].radius, .1f);
  expect_near(out.lights[1].intensity, Vec3f{1, 1, .5f} * (E * 9), 1e-2f);  // centre 3 m away
  expect_near(out.lights[2].intensity, Vec3f{1, 1, 1} * (E * 4 / 3), 1e-2f);
  EXPECT_FALSE(out.lights[3].active);
  EXPECT_EQ(out.lights[3].name, "off");
  EXPECT_EQ(out.lights[3].light, 3);
}

TEST(VisualLight, DistanceIsToTheCentreAtQpos0AndHasAFloor) {
  // On a body that is turned and moved; and one that sits in the centre (floor: extent / 4 = 1 m).
  const RenderDescription out = describe(scene(R"(
      <body pos="0 0 1" quat="1 1 0 0"><joint/><geom size=".1"/>
        <light type="point" pos="0 2 0" diffuse="1 1 1"/>
        <light type="point" pos="0 .1 0" diffuse="1 1 1"/></body>)"));
  EXPECT_NEAR(out.lights[0].intensity.x, 400 * kPi, 1e-2);
  EXPECT_NEAR(out.lights[1].intensity.x, 100 * kPi, 1e-2);
}

TEST(VisualLight, CandelaAreCandelaAndDiffuseIsTheirHue) {
  const RenderDescription out = describe(scene(R"(
      <light type="point" pos="0 0 3" intensity="800" diffuse=".2 .4 .1"/>
      <light type="spot" pos="0 0 3" intensity="500" diffuse=".3 .3 .3" cutoff="60" softness=".3"/>
      <light type="point" intensity="800" diffuse="0 0 0"/>)"));
  EXPECT_NEAR(luminance(out.lights[0].intensity), 800, 1e-2);
  EXPECT_NEAR(out.lights[0].intensity.y / out.lights[0].intensity.x, 2, 1e-5);
  expect_near(out.lights[1].intensity, {500, 500, 500}, 1e-2f);
  EXPECT_NEAR(out.lights[1].cos_cutoff, .5, 1e-6);
  EXPECT_FLOAT_EQ(out.lights[1].softness, .3f);
  EXPECT_EQ(out.lights[2].intensity.x, 0);
}

TEST(VisualLight, LiveFieldsFollowTheSameRule) {
  const CompiledWorld world = visual_test::compile(scene(R"(
      <light type="point" pos="0 0 4" diffuse="1 1 .5"/>
      <light type="point" pos="0 0 3" intensity="800" diffuse=".2 .4 .1"/>)"));
  const RenderDescription out = describe(world);
  for (size_t i = 0; i < 2; ++i) {
    const float* d = world.model->light_diffuse + 3 * i;
    expect_near(light_intensity({d[0], d[1], d[2]}, world.model->light_intensity[i],
                                out.lights[i].legacy_scale),
                out.lights[i].intensity, 0);
  }
}

TEST(VisualLight, LegacySpotFadesWhereItsExponentDoes) {
  const RenderDescription out = describe(scene(R"(
      <light pos="0 0 3" cutoff="45" exponent="3"/><light pos="0 0 3" cutoff="180"/>)"));
  EXPECT_EQ(out.lights[0].type, PunctualLightType::kSpot);
  // The fade is centred where cos^3 = 1/2.
  const float half = std::acos(std::cbrt(.5f));
  EXPECT_NEAR(kPi / 4 * (1 - out.lights[0].softness / 2), half, 1e-4);
  EXPECT_EQ(out.lights[1].type, PunctualLightType::kPoint);
}

TEST(VisualLight, HeadlightIsTheLastLight) {
  const std::string head = "<headlight diffuse='.4 .5 .6' ambient='.1 .2 .3' active='";
  const std::string lamp = "<light pos='0 0 3' ambient='.05 .05 .05'/>";
  const auto light = [&](const std::string& lights, const std::string& active) {
    const RenderDescription out = describe(scene(lights, head + active + "'/>"));
    EXPECT_EQ(out.lights.back().light, -1);
    EXPECT_FALSE(out.lights.back().casts_shadow);
    expect_near(out.lights.back().intensity, Vec3f{.4f, .5f, .6f} * (100 * kPi), 1e-2f);
    return std::pair{out.lights.back().active, out.sky.ambient};
  };
  EXPECT_TRUE(light("", "auto").first);
  EXPECT_TRUE(light(lamp, "auto").first) << "as in MuJoCo's own renderer";
  const std::string candela = "<light pos='0 0 3' intensity='100' active='";
  EXPECT_FALSE(light(candela + "true'/>", "auto").first) << "real light replaces it";
  EXPECT_TRUE(light(candela + "false'/>", "auto").first);
  EXPECT_TRUE(light(candela + "true'/>", "true").first);
  EXPECT_TRUE(light(lamp, "true").first);
  EXPECT_FALSE(light("", "false").first);
  expect_near(light(lamp, "auto").second, {15, 25, 35}, 1e-4f);
  expect_near(light(lamp, "false").second, {5, 5, 5}, 1e-4f);
}

TEST(VisualLight, Skybox) {
  const RenderDescription out =
      describe(scene("", "", R"(<texture type="2d" name="t" builtin="flat" width="4" height="4"/>
      <texture type="skybox" builtin="gradient" rgb1="1 1 1" rgb2="0 0 0" width="16"/>)"));
  ASSERT_GE(out.sky.texture, 0);
  EXPECT_EQ(out.sky.scale, 100);
  const TextureDescription& sky = out.textures[static_cast<size_t>(out.sky.texture)];
  ASSERT_EQ(sky.faces.size(), 6u);
  EXPECT_EQ(sky.faces[0].width, 16);
  EXPECT_EQ(sky.faces[0].color_space, ColorSpace::kSrgb);
  // A sigmoid along +Y of the cube, which stands upright in the sky.
  EXPECT_GT(sky.faces[0].texels[0], 180);
  EXPECT_LT(sky.faces[0].texels[sky.faces[0].texels.size() - 1], 75);
  EXPECT_GT(sky.faces[2].texels[400], 200);
  EXPECT_LT(sky.faces[3].texels[400], 55);
  EXPECT_EQ(describe(scene("")).sky.texture, -1);
}

TEST(VisualLight, ExposureShowsWhiteJustBelowWhite) {
  // One legacy light of diffuse 1, nothing else: facing white has 100 cd/m², shown at 0.85.
  const auto ev = [](const std::string& lights, const std::string& ambient) {
    return describe(scene(lights, "<headlight diffuse='0 0 0' ambient='" + ambient + "'/>")).ev100;
  };
  const auto display = [](float luminance, float ev100) {
    return luminance / (1.2f * std::exp2(ev100));
  };
  const std::string full = "<light type='directional' diffuse='1 1 1'/>";
  EXPECT_NEAR(display(100, ev(full, "0 0 0")), .85, 1e-4);
  // A dim legacy scene stays dim: its colours mean what they say.
  EXPECT_NEAR(display(100, ev("<light type='directional' diffuse='.1 .1 .1'/>", "0 0 0")), .85,
              1e-4);
  // Lights that add up beyond white are stopped down: 100 + a quarter of 100 + 30 ambient.
  EXPECT_NEAR(display(155, ev(full + full, ".3 .3 .3")), .85, 1e-4);
  // Lights in candela set the exposure, up and down: 900 cd at 3 m give 100 lx = 31.8 cd/m².
  EXPECT_NEAR(display(100 / kPi, ev("<light type='point' pos='0 0 4' intensity='900'/>", "0 0 0")),
              .85, 1e-4);
  EXPECT_NEAR(display(3e4f / kPi, ev("<light type='directional' intensity='30000'/>", "0 0 0")),
              .85, 1e-4);
}

TEST(VisualLight, SkyCountsByItsMeanLuminance) {
  // A sky of sRGB 188 = 0.5 linear: 50 cd/m² on top of the 100 of the light.
  const float ev100 = describe(scene("<light type='directional' diffuse='1 1 1'/>",
                                     "<headlight diffuse='0 0 0' ambient='0 0 0'/>",
                                     R"(<texture type="skybox" builtin="flat" width="32"
                                        rgb1=".7354 .7354 .7354" rgb2=".7354 .7354 .7354"/>)"))
                          .ev100;
  EXPECT_NEAR(150 / (1.2f * std::exp2(ev100)), .85, 3e-3);
}

TEST(VisualRules, SrgbAndRoughness) {
  expect_near(linear_color({0, 1, .5f}), {0, 1, .2140411f}, 1e-6f);
  EXPECT_NEAR(linear_color({.04f, 0, 0}).x, .04 / 12.92, 1e-7);
  // Exponent n and GGX alpha: alpha² = 2 / (n + 2) (Walter et al. 2007), alpha = roughness².
  const float n = 128 * .5f;
  EXPECT_NEAR(std::pow(roughness_of_shininess(.5f), 4), 2 / (n + 2), 1e-6);
  EXPECT_FLOAT_EQ(roughness_of_shininess(0), 1);
}

}  // namespace
}  // namespace gloam

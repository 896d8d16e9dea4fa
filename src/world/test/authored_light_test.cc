// [[light]] tables in the description: units, shapes, bodies, schedules, bad files.

#include "world/lights/authored_light.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cmath>

#include "scene/test/temp_folder.h"
#include "world/lights/lamp_mesh.h"
#include "world/lights/light_strength.h"
#include "world/test/visual_test_model.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;
using visual_test::expect_near;

constexpr const char* kLitModel = R"(<mujoco><statistic center='0 0 0' extent='4'/><worldbody>
  <body name="arm" pos="1 0 0"><joint/><geom size="1"/></body>
  <body name="wall" pos="0 2 0"><geom size="1"/></body></worldbody></mujoco>)";

/// A beam of 500 cd within 10 degrees of -Z and 100 cd up to 90.
constexpr const char* kBeam =
    "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 5 1 1 2 0.1 0.1 0\n1 1 10\n0 10 20 40 90\n0\n"
    "500 500 100 100 100\n";

class AuthoredLight : public ::testing::Test {
 protected:
  AuthoredLight() : world_(visual_test::compile(kLitModel)) {}

  RenderDescription describe(std::vector<LightOptions> lights) {
    world_.scene.lights = std::move(lights);
    return visual_test::describe(world_);
  }
  std::string error_of(LightOptions light) {
    light.loc = {"scene.toml", 7, 1};
    world_.scene.lights = {std::move(light)};
    return visual_test::refusal(world_);
  }
  static const LightDescription& lamp(const RenderDescription& d, const std::string& name) {
    for (const LightDescription& light : d.lights) {
      if (light.name == name) return light;
    }
    ADD_FAILURE() << "no lamp " << name;
    return d.lights.front();
  }
  static const InstanceDescription& shape(const RenderDescription& d, const std::string& name) {
    for (const InstanceDescription& instance : d.instances) {
      if (instance.label.geom == name) return instance;
    }
    ADD_FAILURE() << "no shape " << name;
    return d.instances.front();
  }
  static const MaterialDescription& look(const RenderDescription& d, const std::string& name) {
    return d.materials[static_cast<size_t>(shape(d, name).material)];
  }

  CompiledWorld world_;
  TempFolder folder_;
};

TEST_F(AuthoredLight, PointLightsInEveryUnit) {
  const RenderDescription d = describe(
      {{.name = "cd", .type = LightType::kPoint, .intensity = 5},
       {.name = "lm", .type = LightType::kPoint, .flux = 4 * M_PI * 5},
       {.name = "nit", .type = LightType::kPoint, .luminance = 5 / (M_PI * 0.01), .radius = 0.1}});
  for (const char* name : {"cd", "lm", "nit"}) {
    const LightDescription& light = lamp(d, name);
    EXPECT_EQ(light.type, PunctualLightType::kPoint);
    expect_near(light.intensity, {5, 5, 5}, 1e-4f);
    EXPECT_EQ(light.light, -1);
    EXPECT_EQ(light.body, 0);
    EXPECT_TRUE(light.is_static);
  }
  EXPECT_FLOAT_EQ(lamp(d, "nit").radius, 0.1f);
}

// The flux of a cone without softness: 2 pi (1 - cos); with it, less.
TEST_F(AuthoredLight, SpotsSpreadTheirFluxOverTheirCone) {
  const double hard = 2 * M_PI * (1 - std::cos(M_PI / 6));
  const RenderDescription d =
      describe({{.name = "hard", .type = LightType::kSpot, .flux = 100, .angle = 30},
                {.name = "soft", .type = LightType::kSpot, .flux = 100, .angle = 30, .softness = 1},
                {.name = "wide", .type = LightType::kSpot, .flux = 100}});
  EXPECT_NEAR(lamp(d, "hard").intensity.x, 100 / hard, 0.01);
  EXPECT_FLOAT_EQ(lamp(d, "hard").cos_cutoff, std::cos(kPi / 6));
  EXPECT_FLOAT_EQ(lamp(d, "wide").cos_cutoff, std::cos(kPi / 4));
  // Near the axis the share is smooth (3 x² - 2 x³ of x = 1 - angle / cutoff); in a flat disc its
  // mean is 3/10.
  EXPECT_NEAR(lamp(d, "soft").intensity.x * hard / 100, 1 / 0.3, 0.1);
  EXPECT_FLOAT_EQ(lamp(d, "soft").softness, 1);
}

TEST_F(AuthoredLight, TheSunHasLuxAndAnAngle) {
  const RenderDescription d = describe({{.name = "sun",
                                         .type = LightType::kDirectional,
                                         .illuminance = 1e5,
                                         .temperature = 5800,
                                         .angle = 0.53}});
  EXPECT_NEAR(luminance(lamp(d, "sun").intensity), 1e5, 1);
  EXPECT_NEAR(lamp(d, "sun").radius, std::sin(0.265 * M_PI / 180), 1e-7);
}

TEST_F(AuthoredLight, ColoursGiveTheHueAlone) {
  const RenderDescription d = describe(
      {{.name = "red", .type = LightType::kPoint, .intensity = 10, .color = Vec3{0.5, 0, 0}},
       {.name = "warm", .type = LightType::kPoint, .intensity = 10, .temperature = 2700},
       {.name = "day", .type = LightType::kPoint, .intensity = 10, .temperature = 6500},
       {.name = "blue", .type = LightType::kPoint, .intensity = 10, .temperature = 20000}});
  for (const char* name : {"red", "warm", "day", "blue"})
    EXPECT_NEAR(luminance(lamp(d, name).intensity), 10, 1e-3) << name;
  EXPECT_EQ(lamp(d, "red").intensity.y, 0);
  // Published chromaticity of a black body at 2700 K: x = 0.4599, y = 0.4106 (CIE 15).
  const Vec3f warm = lamp(d, "warm").intensity / 10;
  const double X = 0.4599 / 0.4106, Z = (1 - 0.4599 - 0.4106) / 0.4106;
  EXPECT_NEAR(warm.x, 3.2405 * X - 1.5371 - 0.4985 * Z, 0.03);
  EXPECT_NEAR(warm.y, -0.9693 * X + 1.8760 + 0.0416 * Z, 0.02);
  EXPECT_NEAR(warm.z, 0.0557 * X - 0.2040 + 1.0572 * Z, 0.03);
  const Vec3f day = lamp(d, "day").intensity / 10;
  EXPECT_NEAR(day.x, day.z, 0.1);
  EXPECT_GT(lamp(d, "blue").intensity.z, lamp(d, "blue").intensity.x);
}

TEST_F(AuthoredLight, PosesFollowBodiesAndLookAt) {
  const RenderDescription d = describe({{.name = "head",
                                         .type = LightType::kSpot,
                                         .body = "arm",
                                         .position = {0, 0, 1},
                                         .look_at = Vec3{2, 0, 1},
                                         .intensity = 1},
                                        {.name = "fixed",
                                         .type = LightType::kSpot,
                                         .body = "wall",
                                         .position = {0, 0, 1},
                                         .orientation = Quat{0, 1, 0, 0},
                                         .intensity = 1}});
  const LightDescription& head = lamp(d, "head");
  EXPECT_EQ(head.body, 1);
  EXPECT_FALSE(head.is_static);
  expect_near(-head.X_BL.z, {1, 0, 0}, 1e-6f);
  expect_near(head.X_BL.p, {0, 0, 1}, 0);
  EXPECT_TRUE(lamp(d, "fixed").is_static);
  expect_near(-lamp(d, "fixed").X_BL.z, {0, 0, 1}, 1e-6f);
}

// What a flat lamp shines forward is its luminance times its area; all around, pi times that.
TEST_F(AuthoredLight, AreasHaveTheFluxThatTheyWereGiven) {
  folder_.write("lamp.obj", tetrahedron_obj());
  const std::filesystem::path mesh = folder_.path() / "lamp.obj";
  const RenderDescription d =
      describe({{.name = "rect", .type = LightType::kRect, .flux = 100, .size = {{0.5, 2}}},
                {.name = "disk", .type = LightType::kDisk, .flux = 100, .radius = 0.3},
                {.name = "ball", .type = LightType::kSphere, .flux = 100, .radius = 0.3},
                {.name = "axis", .type = LightType::kDisk, .intensity = 10, .radius = 0.3},
                {.name = "glow", .type = LightType::kSphere, .intensity = 10, .radius = 0.3},
                {.name = "nit", .type = LightType::kRect, .luminance = 7, .size = {{1, 1}}},
                {.name = "mesh", .type = LightType::kMesh, .flux = 100, .file = mesh},
                {.name = "mesh2", .type = LightType::kMesh, .luminance = 3, .file = mesh}});
  const auto area = [&](const char* name) {
    return area_of(d.meshes[static_cast<size_t>(shape(d, name).mesh)]);
  };
  EXPECT_NEAR(area("rect"), 1, 1e-6);
  EXPECT_NEAR(area("disk"), M_PI * 0.09, 1e-6);
  EXPECT_NEAR(area("mesh"), 1.5 + std::sqrt(3) / 2, 1e-6);
  for (const char* name : {"rect", "disk", "mesh"}) {
    EXPECT_NEAR(look(d, name).emission.x * M_PI * area(name), 100, 1e-3) << name;
    EXPECT_TRUE(look(d, name).emits_outwards) << name;
  }
  EXPECT_EQ(shape(d, "ball").shape, ShapeType::kSphere);
  EXPECT_NEAR(look(d, "ball").emission.x * M_PI * 4 * M_PI * 0.09, 100, 1e-3);
  EXPECT_NEAR(look(d, "axis").emission.x * M_PI * 0.09, 10, 1e-4);
  EXPECT_NEAR(look(d, "glow").emission.x * M_PI * 0.09, 10, 1e-4);
  EXPECT_EQ(look(d, "nit").emission.x, 7);
  EXPECT_EQ(shape(d, "mesh").mesh, shape(d, "mesh2").mesh) << "a file is read once";
}

// Every triangle of a flat lamp is counter-clockwise from -Z.
TEST(LampMesh, FlatLampsFaceAlongMinusZ) {
  for (const TriangleMesh& mesh : {rect_lamp(1, 2), disk_lamp(1)}) {
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const Vec3f a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                  c = mesh.positions[mesh.indices[i + 2]];
      const Vec3f normal = cross(b - a, c - a);
      EXPECT_LT(normal.z, 0);
      EXPECT_EQ(normal.x, 0);
      EXPECT_EQ(normal.y, 0);
    }
  }
}

TEST_F(AuthoredLight, AreasAreLabelledAndLeftAloneByLiveColours) {
  const RenderDescription d = describe(
      {{.name = "panel_1", .type = LightType::kRect, .flux = 1, .size = {{1, 1}}},
       {.name = "panel_2", .type = LightType::kRect, .flux = 1, .size = {{1, 1}}},
       {.name = "torch", .type = LightType::kSphere, .body = "arm", .flux = 1, .radius = 0.01}});
  const InstanceDescription &one = shape(d, "panel_1"), &two = shape(d, "panel_2");
  EXPECT_EQ(one.geom, -1);
  EXPECT_EQ(look(d, "panel_1").model_material, -1);
  EXPECT_TRUE(one.shown);
  EXPECT_TRUE(one.is_static);
  EXPECT_EQ(one.label.part, static_cast<uint32_t>(&one - d.instances.data()) + 1);
  EXPECT_NE(one.label.instance, two.label.instance);
  EXPECT_EQ(one.label.semantic_name, "panel");
  EXPECT_EQ(one.label.semantic, two.label.semantic);
  EXPECT_FALSE(shape(d, "torch").is_static);
  EXPECT_EQ(shape(d, "torch").label.body, "arm");
  EXPECT_EQ(shape(d, "torch").label.instance, d.instances[0].label.instance) << "the arm's";
}

TEST_F(AuthoredLight, ProfilesKeepTheirShapeAndTakeTheGivenStrength) {
  folder_.write("beam.ies", kBeam);
  const std::filesystem::path ies = folder_.path() / "beam.ies";
  const RenderDescription d =
      describe({{.name = "own", .type = LightType::kPoint, .ies = ies},
                {.name = "cd", .type = LightType::kPoint, .intensity = 50, .ies = ies},
                {.name = "lm", .type = LightType::kPoint, .flux = 1000, .ies = ies},
                {.name = "cone", .type = LightType::kSpot, .flux = 1000, .angle = 8, .ies = ies}});
  ASSERT_EQ(d.ies_profiles.size(), 1u) << "a file is read once";
  const IesProfile& profile = d.ies_profiles[0];
  EXPECT_FLOAT_EQ(profile.most, 500);
  for (const char* name : {"own", "cd", "lm", "cone"}) EXPECT_EQ(lamp(d, name).profile, 0);
  EXPECT_NEAR(lamp(d, "own").intensity.x, 500, 1e-3);
  EXPECT_NEAR(lamp(d, "cd").intensity.x, 50, 1e-4);
  EXPECT_NEAR(lamp(d, "lm").intensity.x * profile.flux / profile.most, 1000, 0.1);
  // Within 8 degrees the profile is even: the flux of a cone.
  EXPECT_NEAR(lamp(d, "cone").intensity.x * 2 * M_PI * (1 - std::cos(8 * M_PI / 180)), 1000, 1);
}

TEST_F(AuthoredLight, SchedulesBecomeRows) {
  LightOptions blink{.name = "blink", .type = LightType::kPoint, .flux = 1};
  blink.schedule = LightScheduleOptions{.on_off = OnOffOptions{.period = 2, .duty = 0.25},
                                        .keys = {{0, 1}, {5, 0}},
                                        .hold = true,
                                        .mains = MainsOptions{60, 0.2},
                                        .starter = StarterOptions{1, 5},
                                        .flame = FlameOptions{3, 0.1}};
  LightOptions panel{.name = "panel", .type = LightType::kRect, .flux = 1, .size = {{1, 1}}};
  panel.schedule = LightScheduleOptions{.on_off = OnOffOptions{}};
  world_.scene.sim.seed = 42;
  const RenderDescription d =
      describe({blink, {.name = "still", .type = LightType::kPoint, .flux = 1}, panel});
  EXPECT_EQ(d.schedule_seed, 42u);
  ASSERT_EQ(d.schedules.size(), 2u);
  EXPECT_EQ(lamp(d, "blink").schedule, 0);
  EXPECT_EQ(lamp(d, "still").schedule, -1);
  EXPECT_EQ(look(d, "panel").schedule, 1);
  ASSERT_EQ(d.schedules[0].parts.size(), 5u);
  EXPECT_EQ(std::get<OnOff>(d.schedules[0].parts[0]).duty, 0.25);
  EXPECT_FALSE(std::get<Keyframes>(d.schedules[0].parts[1]).linear);
  EXPECT_EQ(std::get<Keyframes>(d.schedules[0].parts[1]).keys.at(1).time, 5);
  EXPECT_EQ(std::get<MainsRipple>(d.schedules[0].parts[2]).frequency, 60);
  EXPECT_EQ(std::get<FluorescentStart>(d.schedules[0].parts[3]).warm_up, 5);
  EXPECT_EQ(std::get<Flame>(d.schedules[0].parts[4]).depth, 0.1);

  blink.schedule = LightScheduleOptions{.keys = {{5, 1}, {4, 0}}};
  EXPECT_THAT(error_of(blink), HasSubstr("scene.toml:7"));
}

TEST_F(AuthoredLight, NamesWhatIsNotThereOrDamaged) {
  EXPECT_THAT(error_of({.name = "a", .type = LightType::kPoint, .body = "arn", .flux = 1}),
              testing::AllOf(HasSubstr("scene.toml:7"), HasSubstr("there is no body 'arn'"),
                             HasSubstr("did you mean 'arm'?")));
  folder_.write("bad.ies", "IESNA:LM-63-1995\nTILT=NONE\n1 1000 x\n");
  EXPECT_THAT(
      error_of({.name = "a", .type = LightType::kPoint, .ies = folder_.path() / "bad.ies"}),
      testing::AllOf(HasSubstr("scene.toml:7"), HasSubstr("light 'a'"), HasSubstr("bad.ies:3")));
  std::string dark = kBeam;
  dark.replace(dark.find("500 500 100 100 100"), 19, "0 0 0 0 0");
  folder_.write("dark.ies", dark);
  EXPECT_THAT(
      error_of({.name = "a", .type = LightType::kPoint, .ies = folder_.path() / "dark.ies"}),
      HasSubstr("emits no light"));
  folder_.write("bad.obj", "f 1 2 3\n");
  EXPECT_THAT(
      error_of(
          {.name = "a", .type = LightType::kMesh, .flux = 1, .file = folder_.path() / "bad.obj"}),
      testing::AllOf(HasSubstr("scene.toml:7"), HasSubstr("light 'a'")));
  folder_.write("empty.obj", "v 0 0 0\n");
  EXPECT_NE(
      error_of(
          {.name = "a", .type = LightType::kMesh, .flux = 1, .file = folder_.path() / "empty.obj"}),
      "");
  EXPECT_THAT(
      error_of({.name = "a", .type = LightType::kPoint, .ies = folder_.path() / "none.ies"}),
      HasSubstr("no such file"));
}

TEST_F(AuthoredLight, TheHeadlightYieldsAndTheExposureFollows) {
  const auto ev = [](double white) { return std::log2(white / (1.2 * 0.85)); };
  const RenderDescription d = describe(
      {{.name = "a", .type = LightType::kPoint, .position = {0, 0, 2}, .intensity = 4000}});
  for (const LightDescription& light : d.lights) {
    EXPECT_TRUE(light.name != "headlight" || !light.active);
  }
  // 4000 cd over 2 m; the headlight's ambient light of 0.1 stays: 10 cd/m².
  EXPECT_NEAR(d.ev100, ev(1000 / M_PI + 10), 1e-3);
  const RenderDescription panel = describe({{.name = "a",
                                             .type = LightType::kRect,
                                             .position = {0, 0, 2},
                                             .luminance = 4000,
                                             .size = {{1, 1}}}});
  EXPECT_NEAR(panel.ev100, ev(1000 / M_PI + 10), 1e-3);
  const RenderDescription wall = describe({{.name = "a",
                                            .type = LightType::kRect,
                                            .position = {0, 0, 2},
                                            .luminance = 50,
                                            .size = {{99, 99}}}});
  EXPECT_NEAR(wall.ev100, ev(50 + 10), 1e-3) << "no brighter than right in front of it";
  world_ = visual_test::compile(R"(<mujoco><statistic extent='0.4'/><worldbody><body name='arm'>
      <joint/><geom size='.1'/></body></worldbody></mujoco>)");
  const RenderDescription torch =
      describe({{.name = "a", .type = LightType::kPoint, .body = "arm", .intensity = 1000}});
  EXPECT_NEAR(torch.ev100, ev(250 / M_PI + 10), 1e-3) << "what is carried shines ahead";
}

TEST_F(AuthoredLight, HundredThousandLampsTakeNoQuadraticTime) {
  std::vector<LightOptions> lights;
  for (int i = 0; i < 100000; ++i) {
    lights.push_back(
        {.name = "l" + std::to_string(i), .type = LightType::kPoint, .body = "arm", .flux = 1});
    if (i % 10 == 0)
      lights.back() = {
          .name = lights.back().name, .type = LightType::kSphere, .flux = 1, .radius = 1};
  }
  const auto start = std::chrono::steady_clock::now();
  const RenderDescription d = describe(std::move(lights));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(d.lights.size(), 90001u);
  EXPECT_LT(took.count(), 5);
}

}  // namespace
}  // namespace gloam

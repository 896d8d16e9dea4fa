// [sky] in the description: maps, clear skies, even ones, and what they take the place of.

#include "world/sky/authored_sky.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cmath>

#include "geometry/test/image_writer.h"
#include "scene/test/temp_folder.h"
#include "world/sky/atmosphere.h"
#include "world/sky/environment.h"
#include "world/test/visual_test_model.h"

namespace gloam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using visual_test::expect_near;

constexpr const char* kSkyModel =
    R"(<mujoco><visual><headlight ambient=".3 .3 .3" active="1"/></visual>
  <asset><texture type="skybox" builtin="gradient" width="16" height="16" rgb1="1 1 1"/></asset>
  <worldbody><geom size="1"/><light name="lamp" pos="0 0 3" ambient=".2 .2 .2"/></worldbody></mujoco>)";

class AuthoredSky : public ::testing::Test {
 protected:
  AuthoredSky() : world_(visual_test::compile(kSkyModel)) {}

  RenderDescription describe(SkyOptions sky) {
    world_.scene.sky = std::move(sky);
    return visual_test::describe(world_);
  }
  std::string error_of(SkyOptions sky) {
    sky.loc = {"scene.toml", 7, 1};
    world_.scene.sky = std::move(sky);
    return visual_test::refusal(world_);
  }
  /// Texels as f(row, column); kNone of one component each is one.
  std::filesystem::path map(int width, int height, auto&& rgbe) {
    std::vector<uint8_t> texels;
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const std::array<uint8_t, 4> t = rgbe(row, column);
        texels.insert(texels.end(), t.begin(), t.end());
      }
    }
    return folder_.write("sky.hdr", hdr_file(width, height, texels, HdrPacking::kNone));
  }
  static const LightDescription* sun(const RenderDescription& d) {
    for (const LightDescription& light : d.lights) {
      if (light.name == "sun") return &light;
    }
    return nullptr;
  }

  CompiledWorld world_;
  TempFolder folder_;
};

constexpr std::array<uint8_t, 4> kOne = {128, 128, 128, 129};  // 1, 1, 1

TEST_F(AuthoredSky, TakesThePlaceOfWhatStandsInForASky) {
  world_.scene.sky.reset();
  RenderDescription d = visual_test::describe(world_);
  EXPECT_GE(d.sky.texture, 0);
  EXPECT_GT(d.sky.ambient.x, 0);
  ASSERT_EQ(d.lights.size(), 2u);

  d = describe({.luminance = 1000, .color = Vec3{0, 0, 1}});
  EXPECT_EQ(d.sky.texture, -1);
  EXPECT_EQ(d.sky.ambient, Vec3f{});
  EXPECT_TRUE(d.textures.empty());
  ASSERT_EQ(d.lights.size(), 1u) << "the lamp stays, the headlight goes";
  EXPECT_EQ(d.lights[0].name, "lamp");
  EXPECT_EQ(d.lights[0].ambient, Vec3f{});
  const EnvironmentDescription& e = d.sky.environment;
  ASSERT_EQ(e.texels.size(), static_cast<size_t>(e.width) * static_cast<size_t>(e.height));
  EXPECT_EQ(e.texels[0].x, 0);
  EXPECT_NEAR(e.scale * luminance(e.texels[0]), 1000, 1e-3);
}

TEST_F(AuthoredSky, MapsKeepTheirTexelsTurnAndScale) {
  const auto path = map(4, 2, [](int row, int column) {
    return std::array<uint8_t, 4>{static_cast<uint8_t>(128 + column), 128, 128,
                                  static_cast<uint8_t>(129 - row)};
  });
  const EnvironmentDescription e =
      describe({.file = path, .scale = 500, .turn = 90}).sky.environment;
  EXPECT_EQ(e.width, 4);
  EXPECT_EQ(e.height, 2);
  EXPECT_FLOAT_EQ(e.turn, kPi / 2);
  EXPECT_EQ(e.scale, 500);
  EXPECT_NEAR(e.texels[1].x, 129 / 128.0, 0.01);
  EXPECT_NEAR(e.texels[4].x, 0.5, 0.01) << "row 1 is the lower one";
  EXPECT_EQ(describe({.file = path}).sky.environment.scale, 1);
}

TEST_F(AuthoredSky, AnIlluminanceScalesTheMap) {
  const auto path = map(64, 32, [](int, int) { return kOne; });
  // An even sky of luminance L lights level ground with pi L.
  EXPECT_NEAR(describe({.file = path, .illuminance = 10000}).sky.environment.scale, 10000 / M_PI,
              10);
  const auto dark =
      map(8, 4, [](int row, int) { return row < 2 ? std::array<uint8_t, 4>{0, 0, 0, 0} : kOne; });
  EXPECT_THAT(error_of({.file = dark, .illuminance = 1}),
              AllOf(HasSubstr("scene.toml:7"), HasSubstr("black above the horizon")));
}

// Lit half a world: the cosine law gives pi L / 2 to the side, pi L to the front, nothing behind.
TEST(Environment, SidesAreLitByTheirHalfOfTheWorld) {
  EnvironmentDescription e;
  e.width = 256, e.height = 128;
  e.scale = 2;
  for (int row = 0; row < e.height; ++row) {
    for (int column = 0; column < e.width; ++column) {
      // Columns of the left half go from -X by +Y to +X.
      e.texels.push_back(column < e.width / 2 ? Vec3f{1, 1, 1} : Vec3f{});
    }
  }
  EXPECT_NEAR(illuminance(e, {0, 1, 0}), 2 * M_PI, 0.01);
  EXPECT_NEAR(illuminance(e, {0, -1, 0}), 0, 0.01);
  EXPECT_NEAR(illuminance(e, {0, 0, 1}), M_PI, 0.01);
  EXPECT_NEAR(illuminance(e, {1, 0, 0}), M_PI, 0.01);
  EXPECT_NEAR(brightest_side(e), 2 * M_PI, 0.01);
}

TEST_F(AuthoredSky, TheSunStandsWhereItIsPut) {
  // 30 degrees up in the west: -X; with north along +X instead of +Y, west is +Y.
  for (const double north : {0.0, -90.0}) {
    const RenderDescription d = describe({.sun_elevation = 30, .sun_azimuth = 270, .north = north});
    const LightDescription* light = sun(d);
    ASSERT_NE(light, nullptr);
    const float c = std::cos(kPi / 6);
    expect_near(light->X_BL.z, north == 0 ? Vec3f{-c, 0, 0.5f} : Vec3f{0, c, 0.5f}, 1e-5f);
    EXPECT_EQ(light->type, PunctualLightType::kDirectional);
    EXPECT_EQ(light->body, 0);
    EXPECT_TRUE(light->is_static && light->casts_shadow);
    EXPECT_NEAR(light->radius, std::sin(kSunAngularRadius), 1e-7);
    // The brightest column of the map is the sun's.
    const EnvironmentDescription& e = d.sky.environment;
    const int row = e.height * 60 / 180;
    int brightest = 0;
    const auto at = [&](int column) {
      return luminance(e.texels[static_cast<size_t>(row * e.width + column)]);
    };
    for (int column = 0; column < e.width; ++column)
      if (at(column) > at(brightest)) brightest = column;
    const double azimuth = M_PI * (1 - 2 * (brightest + 0.5) / e.width);
    const double wanted = north == 0 ? M_PI : M_PI / 2;
    EXPECT_LT(std::abs(std::remainder(azimuth - wanted, 2 * M_PI)), 0.05);
  }
}

TEST_F(AuthoredSky, DateAndPlaceGiveTheSun) {
  // Solar noon of the solstice in Munich: 90 - 48.14 + 23.44 degrees in the south.
  const RenderDescription d = describe({.date = CalendarDate{2026, 6, 21},
                                        .time = ClockTime{13, 15, 0},
                                        .utc_offset = 2,
                                        .latitude = 48.14,
                                        .longitude = 11.58});
  ASSERT_NE(sun(d), nullptr);
  const Vec3f to_sun = sun(d)->X_BL.z;
  EXPECT_NEAR(std::asin(to_sun.z) * 180 / M_PI, 65.3, 0.1);
  EXPECT_NEAR(to_sun.x, 0, 0.02);
  EXPECT_LT(to_sun.y, 0);
}

TEST_F(AuthoredSky, BelowTheHorizonThereIsNoSun) {
  const RenderDescription d = describe({.sun_elevation = -10});
  EXPECT_EQ(sun(d), nullptr);
  EXPECT_GT(brightest_side(d.sky.environment), 0);
}

// A white surface that faces the sun lands below the top of the scale and far above black; the same
// at dusk.
TEST_F(AuthoredSky, DaylightIsExposedForDaylight) {
  for (const double elevation : {60.0, 5.0, -4.0}) {
    const RenderDescription d = describe({.sun_elevation = elevation});
    const float level = illuminance(d.sky.environment, {0, 0, 1});
    const double sunlight = sun(d) != nullptr ? luminance(sun(d)->intensity) : 0;
    const double top = 1.2 * std::exp2(d.ev100);
    const double ground = (level + sunlight * std::sin(elevation * M_PI / 180)) / M_PI;
    EXPECT_LT(0.5 * ground, top) << elevation;
    EXPECT_GT(0.5 * ground, 0.02 * top) << elevation;
    EXPECT_LT((sunlight + level) / M_PI, top) << elevation;
  }
  EXPECT_NEAR(describe({.sun_elevation = 60}).ev100, 15, 0.7) << "the photographers' sunny 16";
}

TEST_F(AuthoredSky, AMapIsExposedByItsBrightestSide) {
  const auto path = map(64, 32, [](int, int) { return kOne; });
  EXPECT_NEAR(
      describe({.file = path, .scale = 102}).ev100 - describe({.file = path, .scale = 51}).ev100,
      0.5, 0.5);
  EXPECT_GT(describe({.file = path, .scale = 10000}).ev100, 13);
}

TEST_F(AuthoredSky, WrongPicturesAreClearErrors) {
  const auto square = map(4, 4, [](int, int) { return kOne; });
  EXPECT_THAT(error_of({.file = square}),
              AllOf(HasSubstr("scene.toml:7"), HasSubstr("4 x 4 pixels"), HasSubstr("twice as")));
  const auto broken =
      folder_.write("broken.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n");
  EXPECT_THAT(error_of({.file = broken}), AllOf(HasSubstr("scene.toml:7"), HasSubstr("[sky]")));
  const auto text = folder_.write("text.hdr", "hello");
  EXPECT_NE(error_of({.file = text}), "");
  EXPECT_THAT(error_of({.file = folder_.path() / "none.hdr"}), HasSubstr("no such file"));
  const std::vector<float> bad = {1, 2, 3, 4, 5, 6, std::nanf(""), 8};
  const auto nan = folder_.write("nan.exr", exr_file(4, 2, {"B", "G", "R"}, {bad, bad, bad}));
  EXPECT_THAT(error_of({.file = nan}), HasSubstr("not finite in column 2, row 1"));
  const std::vector<float> low = {-1, -1, -1, -1, -1, -1, -1, 8};
  const auto under = folder_.write("low.exr", exr_file(4, 2, {"B", "G", "R"}, {low, low, low}));
  EXPECT_EQ(describe({.file = under}).sky.environment.texels[0], Vec3f{});
}

TEST_F(AuthoredSky, IsMadeFastEnoughForAFirstPicture) {
  const auto start = std::chrono::steady_clock::now();
  (void)describe({.sun_elevation = 40});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(took.count()));
  EXPECT_LT(took.count(), 5) << "0.5 s on an idle machine of two cores";
}

}  // namespace
}  // namespace gloam

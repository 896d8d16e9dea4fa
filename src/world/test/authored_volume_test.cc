// [[volume]] tables in the description: media, amounts, grids, patterns.

#include "world/media/authored_volume.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "geometry/test/npy_writer.h"
#include "scene/test/temp_folder.h"
#include "world/media/medium_presets.h"
#include "world/media/volume_pattern.h"
#include "world/test/visual_test_model.h"

namespace gloam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr size_t kGreen = static_cast<size_t>(MediumBand::kGreen);

class AuthoredVolume : public ::testing::Test {
 protected:
  AuthoredVolume()
      : world_(visual_test::compile("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")) {}

  RenderDescription describe(std::vector<VolumeOptions> volumes) {
    world_.scene.volumes = std::move(volumes);
    return visual_test::describe(world_);
  }
  std::string error_of(VolumeOptions volume) {
    volume.loc = {"scene.toml", 7, 1};
    world_.scene.volumes = {std::move(volume)};
    return visual_test::refusal(world_);
  }
  CompiledWorld world_;
  TempFolder folder_;
};

TEST_F(AuthoredVolume, ABoxOfItsOwnNumbers) {
  const RenderDescription d = describe({{.name = "box",
                                         .position = {1, 2, 3},
                                         .orientation = Quat{0, 0, 0, 1},
                                         .size = {1, 2, 4},
                                         .mass_extinction = {100},
                                         .albedo = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6},
                                         .density = 0.01,
                                         .temperature = 400,
                                         .emission = 1,
                                         .fade = 0.1}});
  ASSERT_EQ(d.volumes.size(), 1u);
  ASSERT_EQ(d.media.size(), 1u);
  const VolumeDescription& v = d.volumes[0];
  EXPECT_EQ(v.X_WV.p, (Vec3f{1, 2, 3}));
  visual_test::expect_near(v.X_WV.x, {-1, 0, 0}, 1e-6f);
  EXPECT_EQ(v.size, (Vec3f{1, 2, 4}));
  EXPECT_FLOAT_EQ(v.even_density, 0.01f);
  EXPECT_EQ(v.even_temperature, 400);
  EXPECT_FLOAT_EQ(v.fade, 0.1f);
  EXPECT_EQ(v.density, nullptr);
  const MediumDescription& m = d.media[0];
  for (const float k : m.mass_extinction) EXPECT_EQ(k, 100);
  EXPECT_FLOAT_EQ(m.albedo[5], 0.6f);
  EXPECT_EQ(m.g[0], 0);
  EXPECT_EQ(m.emission, 1);
}

// Koschmieder: what is seen through as much of it as the visibility keeps 2 % of its contrast.
TEST_F(AuthoredVolume, VisibilityGivesTheDensity) {
  std::vector<VolumeOptions> volumes;
  for (const std::string& name : medium_names())
    volumes.push_back({.name = name, .size = {1, 1, 1}, .medium = name, .visibility = 25});
  const RenderDescription d = describe(std::move(volumes));
  for (const VolumeDescription& v : d.volumes) {
    const MediumDescription& m = d.media[static_cast<size_t>(v.medium)];
    EXPECT_NEAR(std::exp(-25 * v.even_density * m.mass_extinction[kGreen]), 0.02, 1e-4) << v.name;
  }
}

TEST_F(AuthoredVolume, PresetsAreSharedAndDiffer) {
  const RenderDescription d =
      describe({{.name = "a", .size = {1, 1, 1}, .medium = "fog", .density = 1e-4},
                {.name = "b", .size = {1, 1, 1}, .medium = "smoke", .density = 1e-4},
                {.name = "c", .size = {1, 1, 1}, .medium = "fog", .density = 2e-4},
                {.name = "d", .size = {1, 1, 1}, .medium = "fog", .density = 1, .emission = 1}});
  EXPECT_EQ(d.media.size(), 3u);
  EXPECT_EQ(d.volumes[0].medium, d.volumes[2].medium);
  EXPECT_NE(d.volumes[0].medium, d.volumes[3].medium);
}

// What the numbers of the list have to have in common with the physics that they come from.
TEST(MediumPresets, AgreeWithPhysics) {
  for (const std::string& name : medium_names()) {
    const MediumDescription* m = find_medium(name);
    ASSERT_NE(m, nullptr);
    EXPECT_TRUE(check_medium(*m).ok()) << name;
  }
  EXPECT_EQ(find_medium("soup"), nullptr);
  const auto& smoke = *find_medium("smoke");
  // Mulholland and Croarkin: 8700 m²/kg at 633 nm, as 1 / wavelength.
  EXPECT_NEAR(smoke.mass_extinction[0], 8700 * 633 / 612.0, 50);
  EXPECT_NEAR(smoke.mass_extinction[4], 8700 * 633 / 1550.0, 50);
  // Drops much larger than the wavelength take out twice their shadow: 3 / (2 density radius).
  EXPECT_NEAR(find_medium("fog")->mass_extinction[kGreen], 1.5 / (1000 * 20e-6), 4);
  EXPECT_NEAR(find_medium("mist")->mass_extinction[kGreen], 1.5 / (1000 * 3e-6), 60);
  // Fog is as thick for a lidar as for the eye; smoke is not.
  EXPECT_NEAR(find_medium("fog")->mass_extinction[3], find_medium("fog")->mass_extinction[kGreen],
              3);
}

TEST_F(AuthoredVolume, GridsAreReadAndScaled) {
  folder_.write("rho.npy",
                npy_file(npy_head("1, 2, 3"), npy_values(std::vector<float>{0, 1, 2, 3, 4, 5})));
  folder_.write("T.npy", npy_file(npy_head("1, 2, 3"),
                                  npy_values(std::vector<float>{300, 300, 900, 900, 300, 300})));
  folder_.write("T2.npy",
                npy_file(npy_head("1, 3, 2"), npy_values(std::vector<float>{1, 1, 1, 1, 1, 1})));
  VolumeOptions o{.name = "grid",
                  .size = {1, 1, 1},
                  .medium = "smoke",
                  .density = 0.5,
                  .grid = folder_.path() / "rho.npy",
                  .temperature_grid = folder_.path() / "T.npy"};
  const RenderDescription d = describe({o});
  const VolumeDescription& v = d.volumes[0];
  EXPECT_EQ(v.nx, 3);
  EXPECT_EQ(v.ny, 2);
  EXPECT_EQ(v.nz, 1);
  EXPECT_EQ(v.density->at(5), 2.5f);
  EXPECT_EQ(v.temperature->at(2), 900);
  o.temperature_grid = folder_.path() / "T2.npy";
  EXPECT_THAT(error_of(o), AllOf(HasSubstr("scene.toml:7"), HasSubstr("2 x 3 x 1")));
  o.grid.clear();
  EXPECT_EQ(describe({o}).volumes[0].ny, 3) << "temperatures alone";
}

TEST_F(AuthoredVolume, WrongGridsAndMediaAreClearErrors) {
  EXPECT_THAT(
      error_of({.name = "a", .size = {1, 1, 1}, .medium = "smog", .density = 1}),
      AllOf(HasSubstr("scene.toml:7"), HasSubstr("there is no medium 'smog'"), HasSubstr("smoke")));
  EXPECT_THAT(error_of({.name = "a", .size = {1, 1, 1}, .mass_extinction = {0}, .visibility = 5}),
              HasSubstr("does not attenuate green light"));
  folder_.write("huge.npy", npy_file(npy_head("1024, 1024, 513"), ""));
  EXPECT_THAT(error_of({.name = "a",
                        .size = {1, 1, 1},
                        .medium = "fog",
                        .density = 1,
                        .grid = folder_.path() / "huge.npy"}),
              AllOf(HasSubstr("scene.toml:7"), HasSubstr("volume 'a'"), HasSubstr("the limit is")));
  folder_.write("big.npy", npy_file(npy_head("1, 1, 1"), npy_values(std::vector<float>{3e38f})));
  EXPECT_THAT(error_of({.name = "a",
                        .size = {1, 1, 1},
                        .medium = "fog",
                        .density = 100,
                        .grid = folder_.path() / "big.npy"}),
              HasSubstr("infinite"));
}

TEST(VolumePattern, PlumesRiseAndWidenAndCloudsStayInTheirBox) {
  for (const char* kind : {"plume", "cloud"}) {
    const VolumeFile grid = make_pattern({.kind = kind, .seed = 1, .resolution = 32}, {1, 1, 2});
    EXPECT_EQ(grid.nx, 16);
    EXPECT_EQ(grid.nz, 32);
    ASSERT_EQ(grid.values.size(), 16u * 16 * 32);
    float most = 0;
    for (const float x : grid.values) {
      ASSERT_TRUE(x >= 0 && x <= 1);
      most = max(most, x);
    }
    EXPECT_GT(most, 0.5f) << kind;
    const auto row = [&](int k, int j) {
      const float* first = &grid.values[static_cast<size_t>((k * 16 + j) * 16)];
      return std::accumulate(first, first + 16, 0.0f);
    };
    EXPECT_NEAR(row(31, 8), 0, 0.01f) << kind << " ends below the ceiling";
    if (kind[0] == 'c') continue;
    EXPECT_GT(row(0, 8), 0.5f) << "rises from the middle of the floor";
    EXPECT_EQ(row(0, 0) + row(0, 15), 0) << "and not from its edges";
    const auto reach = [&](int k) {
      int rows = 0;
      for (int j = 0; j < 16; ++j) rows += row(k, j) > 0.01f ? 1 : 0;
      return rows;
    };
    EXPECT_GT(reach(24), reach(1));
  }
}

TEST(VolumePattern, AreTheSameForEverySameSeed) {
  const auto values = [](uint64_t seed) {
    return make_pattern({.kind = "cloud", .seed = seed, .resolution = 16}, {1, 1, 1}).values;
  };
  EXPECT_EQ(values(1), values(1));
  EXPECT_NE(values(1), values(2));
}

}  // namespace
}  // namespace gloam

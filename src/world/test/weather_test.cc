// [weather] and [adversity] on the compiled model: what falls, where it cannot, and what it leaves.

#include <gmock/gmock.h>

#include "scene/test/temp_folder.h"
#include "world/media/medium_presets.h"
#include "world/render_description.h"
#include "world/shapes/extent.h"
#include "world/weather/rain_splash.h"
#include "world/world.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;

double water_flux(const ParticleSet& set, double solid) {
  double flux = 0;  // [m/s] of what lies as water, by volume of spheres of the class's diameter
  for (const ParticleClass& c : set.classes)
    flux += static_cast<double>(c.number) * M_PI / 6 * std::pow(c.diameter, 3) * solid *
            static_cast<double>(c.fall_speed);
  return flux;
}

TEST(Particles, RainHasTheWaterOfMarshallAndPalmerAndFallsAtItsRate) {
  for (const double rate : {1.0, 5.0, 25.0, 100.0}) {
    const ParticleSet rain = rain_particles(rate);
    // Pi rho N0 / Lambda⁴ of the whole distribution.
    const double water = M_PI * 8000e-6 / std::pow(4.1 * std::pow(rate, -0.21), 4);  // [kg/m³]
    EXPECT_NEAR(static_cast<double>(rain.water) / water, 1, 0.06) << rate << " mm/h";
    // Sizes and speeds are of two sources, which agree no better.
    EXPECT_GT(water_flux(rain, 1) / (rate * 1e-3 / 3600), 0.9) << rate << " mm/h";
    EXPECT_LT(water_flux(rain, 1) / (rate * 1e-3 / 3600), 1.5) << rate << " mm/h";
  }
}

TEST(Particles, OneSeesAsFarThroughThemAsIsMeasured) {
  const auto visibility = [](const ParticleSet& set) {
    return kKoschmieder / static_cast<double>(set.extinction());
  };
  // Atlas 1953, "Optical extinction by rainfall": 0.2 to 0.3 R^0.63 per km.
  EXPECT_THAT(visibility(rain_particles(10)),
              ::testing::AllOf(::testing::Ge(2000), ::testing::Le(5000)));
  // Rasmussen et al. 1999, "The estimation of snowfall rate using visibility": half a kilometre to
  // two at 1 mm/h of water.
  EXPECT_THAT(visibility(snow_particles(1)),
              ::testing::AllOf(::testing::Ge(500), ::testing::Le(2000)));
}

/// Density of what the weather puts at a place, of the nearest voxels [kg/m³].
double density_at(const RenderDescription& d, Vec3f p) {
  double sum = 0;
  for (const VolumeDescription& v : d.volumes) {
    const Vec3f at = p - v.X_WV.p + v.size * 0.5f;
    if (!(at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < v.size.x && at.y < v.size.y &&
          at.z < v.size.z))
      continue;
    const auto row = [](float x, float size, int n) {
      return std::min(static_cast<int>(x / size * static_cast<float>(n)), n - 1);
    };
    const int i = row(at.x, v.size.x, v.nx), j = row(at.y, v.size.y, v.ny),
              k = row(at.z, v.size.z, v.nz);
    sum += static_cast<double>(v.density == nullptr
                                   ? v.even_density
                                   : (*v.density)[static_cast<size_t>((k * v.ny + j) * v.nx + i)]);
  }
  return sum;
}

class Weather : public ::testing::Test {
 protected:
  Weather() {
    folder_.write("yard.xml", R"(<mujoco><worldbody><geom type="plane" size="0 0 1"/>
      <geom type="box" size="2 2 0.1" pos="5 0 3"/>
      <body pos="5 0 1.5"><geom type="box" size="0.1 0.1 1.4"/></body>
      <body name="cart" pos="-3 0 1"><freejoint/><geom type="box" size=".5 .5 .1"/></body>
      </worldbody></mujoco>)");
  }
  Result<RenderDescription> describe(const std::string& text) {
    GLOAM_TRY(const Scene scene,
              load_scene(folder_.write("s.toml", "environment.file = \"yard.xml\"\n" + text)));
    GLOAM_TRY(const World world, World::compile(scene));
    return describe_for_rendering(*world.compiled());
  }
  RenderDescription described(const std::string& text) {
    Result<RenderDescription> result = describe(text);
    EXPECT_TRUE(result.ok()) << result.error().to_string();
    return result.ok() ? std::move(*result) : RenderDescription{};
  }
  std::string error_of(const std::string& text) {
    const Result<RenderDescription> result = describe(text);
    return result.ok() ? "" : result.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(Weather, DripsFromTheEdgesOfARoofAsMuchAsFallsOnIt) {
  const auto flow_of = [this](const std::string& text) {
    double flow = 0;
    for (const DripEdge& edge : described(text).weather.drips)
      if (edge.from.z > 3) flow += static_cast<double>(edge.flow);
    return flow;
  };
  const double rain = 36e-3 / 3600 * 16;  // on four by four metres
  EXPECT_NEAR(flow_of("[weather]\nrain = 36\n"), rain, 0.05 * rain);
  EXPECT_EQ(flow_of("[weather]\nsnow = 3\n"), 0) << "snow does not";
}

TEST_F(Weather, FallsWhereTheSkyIsOpen) {
  const RenderDescription d = described("[weather]\nrain = 10\n");
  ASSERT_NE(d.weather.shelter, nullptr);
  const ShelterView sky = d.weather.shelter->view();
  EXPECT_EQ(sky.open_above({0, 0, 0.5f}, 0), 1) << "on open ground";
  EXPECT_EQ(sky.open_above({5, 1, 1}, 0), 0) << "under the roof";
  EXPECT_EQ(sky.open_above({5, 1, 3.5f}, 0), 1) << "over the roof";
  EXPECT_EQ(sky.open_above({-3, 0, 0.5f}, 0), 1) << "what moves is no roof";
  EXPECT_EQ(sky.open_above({500, 0, -3}, 0), 1) << "beyond all that stands there";
  const double rain = static_cast<double>(rain_particles(10).water);
  EXPECT_EQ(density_at(d, {5, 1, 1}), 0) << "a roof keeps rain off what is under it";
  EXPECT_NEAR(density_at(d, {5, 1, 4.5f}) / rain, 1, 1e-5) << "not what is above it";
  EXPECT_NEAR(density_at(d, {0.2f, 0.3f, 0.6f}) / rain, 1, 1e-5);
}

/// Floors and buildings, of which what is in the air must not know.
const char* const kPlaces[] = {
    R"(<geom type="plane" size="0 0 1"/>)",
    R"(<geom type="plane" size="20 20 1"/>)",
    R"(<geom type="plane" size="300 300 1"/>)",
    R"(<geom type="plane" size="0 0 1"/><geom type="box" size="1 1 1.5" pos="-8 3 1.5"/>)",
    R"(<geom type="plane" size="50 50 1"/><geom type="box" size="5 5 30" pos="-30 9 30"/>)",
    R"(<geom type="box" size="100 100 .1" pos="0 0 -.1"/>)",
    R"(<geom type="box" size="2 2 0.1" pos="-9 0 -4"/>)"};

TEST_F(Weather, ReachesAsFarWhateverStandsInThePlace) {
  const auto describe_in = [&](const char* place, const std::string& text) {
    folder_.write("yard.xml", std::string("<mujoco><worldbody>") + place + "</worldbody></mujoco>");
    return described(text);
  };
  const Vec3f points[] = {{0, 0, 1},     {67, 0, 2},    {-60, 45, 0.3f}, {3, 3, 14},
                          {200, -90, 9}, {700, 650, 5}, {40, 2, -3}};
  for (const char* place : kPlaces) {
    SCOPED_TRACE(place);
    const RenderDescription rain = describe_in(place, "[weather]\nrain = 25\n");
    const RenderDescription snow = describe_in(place, "[weather]\nsnow = 2\n");
    const RenderDescription fog = describe_in(place, "[weather]\nvisibility = 100\n");
    for (const Vec3f& p : points) {
      EXPECT_NEAR(density_at(rain, p) / static_cast<double>(rain_particles(25).water), 1, 1e-5);
      EXPECT_NEAR(density_at(snow, p) / static_cast<double>(snow_particles(2).water), 1, 1e-5);
      EXPECT_NEAR(density_at(fog, p) / static_cast<double>(fog.volumes[0].even_density), 1, 1e-5);
    }
    EXPECT_GT(density_at(rain, {5, 5, 190}), 0);
    EXPECT_EQ(density_at(rain, {5, 5, 201}), 0) << "it falls from 200 m";
    EXPECT_EQ(density_at(fog, {5, 5, 15.1f}), 0) << "15 m deep";
  }
}

TEST_F(Weather, HazeThinsWithTheHeightAboveItsBase) {
  for (const char* place : kPlaces) {
    SCOPED_TRACE(place);
    folder_.write("yard.xml", std::string("<mujoco><worldbody>") + place + "</worldbody></mujoco>");
    for (const double scale : {3.0, 20.0, 800.0}) {
      for (const double base : {0.0, 30.0, -12.0}) {
        const RenderDescription d =
            described("[weather]\nmedium = \"haze\"\nvisibility = 500\nscale_height = " +
                      std::to_string(scale) + "\nbase = " + std::to_string(base) + "\n");
        const auto even = static_cast<double>(d.volumes[0].even_density);
        for (const double height : {-5.0, 0.1, 2.0, 10.0, 40.0}) {
          if (height > 6 * scale) continue;
          const double law = std::exp(-std::max(height, 0.0) / scale);
          const Vec3f p{7, 9, static_cast<float>(base + height)};
          EXPECT_NEAR(density_at(d, p) / even / law, 1, 0.04)
              << scale << " " << base << " " << height;
        }
      }
    }
  }
}

TEST_F(Weather, FogHasTheHeightThatItIsGiven) {
  const RenderDescription d = described("[weather]\nvisibility = 100\nheight = 40\nbase = 5\n");
  EXPECT_GT(density_at(d, {5, 5, 44}), 0);
  EXPECT_EQ(density_at(d, {5, 5, 46}), 0);
}

TEST_F(Weather, OfFogOneSeesAsFarAsIsAskedFor) {
  const RenderDescription d = described("[weather]\nvisibility = 50\n");
  ASSERT_EQ(d.volumes.size(), 1u);
  const auto green = static_cast<size_t>(MediumBand::kGreen);
  EXPECT_NEAR(kKoschmieder / static_cast<double>(d.volumes[0].even_density *
                                                 d.media[0].mass_extinction[green]),
              50, 1e-3);
  EXPECT_TRUE(d.weather.particles.empty());
  EXPECT_FALSE(d.weather.covers_surfaces());
}

TEST_F(Weather, SmokeOfAdversityIsInTheRoomsAlone) {
  const auto volumes = [&](const std::string& text) {
    const Result<Scene> loaded =
        load_scene(folder_.write("b.toml", "[environment.bedroom]\nseed = 1\n" + text));
    EXPECT_TRUE(loaded.ok());
    const Result<World> world = World::compile(*loaded);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    const Extent rooms = extent_of(world->compiled()->regions, 0);
    const auto d = describe_for_rendering(*world->compiled());
    EXPECT_TRUE(d.ok());
    EXPECT_EQ(d->volumes.size(), 1u);
    return std::pair(rooms, d->volumes.at(0));
  };
  const auto expect_in_room = [&](const std::string& text) {
    const auto [rooms, smoke] = volumes(text);
    for (int a = 0; a < 3; ++a) {
      const double low = a == 0 ? rooms.low.x : (a == 1 ? rooms.low.y : rooms.low.z);
      const double high = a == 0 ? rooms.high.x : (a == 1 ? rooms.high.y : rooms.high.z);
      const double middle = static_cast<double>(smoke.X_WV.p[a]);
      const double half = static_cast<double>(smoke.size[a]) / 2;
      EXPECT_NEAR(middle - half, low, 0.15) << "axis " << a << " of\n" << text;
      EXPECT_NEAR(middle + half, high, 0.15) << "axis " << a << " of\n" << text;
    }
  };
  expect_in_room("[adversity]\nlevel = \"minor\"\npeople = 0\n");
  expect_in_room("[weather]\nwind = 3\n[adversity]\nlevel = \"major\"\npeople = 0\n");
  expect_in_room("[weather]\nvisibility = 10\nwhere = \"rooms\"\nscale_height = 1\n");
  const auto [rooms, fog] = volumes("[weather]\nvisibility = 10\n");
  EXPECT_GT(fog.size.x, 100) << "what nobody confines is everywhere";
}

TEST_F(Weather, FogInBillowsHasTheMeanAndTheSpreadAskedFor) {
  const RenderDescription d =
      described("[weather]\nvisibility = 50\nturbulence = 0.5\nscale_height = 10\n");
  const auto billows = std::ranges::max_element(d.volumes, {}, &VolumeDescription::nx);
  const VolumeDescription& fog = *billows;
  ASSERT_NE(fog.density, nullptr);
  const auto layer = static_cast<size_t>(fog.nx * fog.ny);
  double mean = 0, square = 0;
  const auto at = [&](size_t i) {  // over the ground, of the layer from one metre up
    const size_t k = 2;
    return static_cast<double>((*fog.density)[k * layer + i]);
  };
  for (size_t i = 0; i < layer; ++i) mean += at(i) / static_cast<double>(layer);
  for (size_t i = 0; i < layer; ++i)
    square += (at(i) - mean) * (at(i) - mean) / static_cast<double>(layer);
  const double step = static_cast<double>(fog.size.z) / fog.nz;
  const double ground = static_cast<double>(fog.even_density);
  EXPECT_NEAR(mean / (ground * std::exp(-2.5 * step / 10)), 1, 0.1);
  EXPECT_NEAR(std::sqrt(square) / mean, 0.5, 0.1);
}

TEST_F(Weather, WetsAndDriesInTime) {
  const WeatherDescription wet = described("[weather]\nrain = 10\nwetness = 0\n").weather;
  EXPECT_EQ(wet.wetness_at(0), 0);
  EXPECT_NEAR(wet.wetness_at(360), 0.625 * (1 - std::exp(-1)), 1e-3) << "a millimetre takes 360 s";
  EXPECT_NEAR(wet.wetness_at(1e5), 0.625, 1e-3);
  const WeatherDescription dry = described("[weather]\nwetness = 0.8\n").weather;
  EXPECT_NEAR(dry.wetness_at(0), 0.8, 1e-6);
  EXPECT_LT(dry.wetness_at(7200), 0.4);
  EXPECT_EQ(described("[weather]\nrain = 10\n").weather.wetness_at(0), 0.625f)
      << "it has rained before";
}

TEST_F(Weather, SnowGrowsAtTenTimesItsWater) {
  const WeatherDescription snow = described("[weather]\nsnow = 3.6\nsnow_cover = 0.01\n").weather;
  EXPECT_NEAR(snow.snow_rate, 1e-5, 1e-9) << "[m/s]";
  EXPECT_NEAR(snow.snow_at(2000), 1 - std::exp(-0.03 / 0.015), 1e-5);
}

TEST_F(Weather, RefusesWhatThereIsNot) {
  EXPECT_THAT(error_of("[weather]\nvisibility = 0\n"), HasSubstr("visibility"));
  EXPECT_THAT(error_of("[weather]\nrain = -1\n"), HasSubstr("rain"));
  EXPECT_THAT(error_of("[weather]\nvisibility = 10\nmedium = \"fogg\"\n"),
              ::testing::AllOf(HasSubstr("s.toml:"), HasSubstr("fogg"), HasSubstr("fog")));
  EXPECT_THAT(error_of("[weather]\nvisibility = 10\nwhere = \"rooms\"\n"),
              ::testing::AllOf(HasSubstr("s.toml:"), HasSubstr("needs a generated building")));
  EXPECT_THAT(error_of("[adversity]\nlevel = \"huge\"\n"), HasSubstr("minor"));
}

TEST_F(Weather, ALevelOfAdversityFillsWhatIsLeftOpen) {
  const RenderDescription minor = described("[adversity]\nlevel = \"minor\"\npeople = 0\n");
  const RenderDescription major =
      described("[weather]\nrain = 3\n[adversity]\nlevel = \"major\"\npeople = 0\n");
  ASSERT_EQ(minor.weather.particles.size(), 1u);
  ASSERT_EQ(major.weather.particles.size(), 1u);
  EXPECT_EQ(major.weather.particles[0].water, rain_particles(3).water) << "given beats the level";
  EXPECT_GT(major.weather.lens_drops, minor.weather.lens_drops);
  EXPECT_TRUE(described("[adversity]\n").weather.particles.empty()) << "level none is fair";
}

TEST_F(Weather, ALevelDimsAndBreaksThePlacesLampsAlone) {
  const auto lamps = [&](const std::string& text) {
    const std::string scene = R"(
[environment.house]
seed = 1
[[light]]
name = "mine"
type = "point"
flux = 100
position = [0, 0, 2]
)";
    const Result<Scene> loaded = load_scene(folder_.write("h.toml", scene + text));
    EXPECT_TRUE(loaded.ok());
    const Result<World> world = World::compile(*loaded);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return world->compiled()->scene.lights;
  };
  const std::vector<LightOptions> fair = lamps("");
  const std::vector<LightOptions> dark = lamps("[adversity]\nlight = 0.25\nfailing = 0.5\n");
  ASSERT_EQ(fair.size(), dark.size());
  ASSERT_GT(fair.size(), 3u);
  size_t failing = 0;
  for (size_t i = 0; i < fair.size(); ++i) {
    const bool mine = fair[i].name == "mine";
    const auto strength = [](const LightOptions& l) {
      return l.flux.value_or(0) + l.luminance.value_or(0) + l.intensity.value_or(0);
    };
    EXPECT_NEAR(strength(dark[i]), (mine ? 1 : 0.25) * strength(fair[i]), 1e-9) << fair[i].name;
    failing += dark[i].schedule.has_value() && !fair[i].schedule.has_value() ? 1 : 0;
    EXPECT_FALSE(mine && dark[i].schedule.has_value());
  }
  EXPECT_GT(failing, 0u);
  EXPECT_LT(failing, fair.size() - 1);
}

TEST(RainSplash, CrownsWidenByTheRootOfTimeAndGo) {
  const ParticleClass kind{3e-3f, 300, 8};
  const Crown early = crown_at(kind, 2e-3f), late = crown_at(kind, 8e-3f);
  EXPECT_NEAR(late.radius / early.radius, 2, 1e-4);
  // (2/3)^(1/4) sqrt(D V t).
  EXPECT_NEAR(late.radius, 0.9036f * std::sqrt(3e-3f * 8 * 8e-3f), 1e-5f);
  EXPECT_GT(late.height, early.height);
  EXPECT_LT(late.height, 5 * kind.diameter);
  EXPECT_GT(early.cover, late.cover);
  EXPECT_EQ(crown_at(kind, 0.03f).cover, 0);
  EXPECT_EQ(crown_at(kind, -1e-3f).cover, 0);
  EXPECT_LT(0.03, splash_life(kind)) << "it is looked for as long as it stands";
}

TEST(RainSplash, AsManyAsFallAndTheSameWheneverTheyAreLookedAt) {
  ParticleSet set = rain_particles(30);
  set.seed = 5;
  for (uint32_t row = 0; row < set.classes.size(); ++row) {
    const ParticleClass& kind = set.classes[row];
    std::vector<Splash> all, parts;
    constexpr int kEdge = 20;  // 25 m²
    for (int i = -kEdge / 2; i < kEdge / 2; ++i) {
      for (int j = 0; j < kEdge; ++j) {
        find_splashes(set, row, i, j, 3.0, 4.0, &all);
        find_splashes(set, row, i, j, 3.31, 4.0, &parts);
        find_splashes(set, row, i, j, 3.0, 3.31, &parts);
      }
    }
    const double mean = static_cast<double>(kind.number * kind.fall_speed) * 25;
    EXPECT_NEAR(static_cast<double>(all.size()), mean, 4 * std::sqrt(mean) + 1) << "class " << row;
    EXPECT_EQ(all.size(), parts.size());
    for (const Splash& s : all) EXPECT_TRUE(s.time >= 3 && s.time < 4);
    for (int n = 0; n < kSplashDroplets && !all.empty(); ++n) {
      const float up = splash_droplet(kind, all[0], n).velocity.z;
      EXPECT_LE(static_cast<double>(2 * up) / 9.81, splash_life(kind));
    }
  }
  // Drizzle lies down quietly, drops of a shower do not (Mundo et al. 1995).
  EXPECT_FALSE(splashes({0.2e-3f, 1, 0.8f}));
  EXPECT_TRUE(splashes({2e-3f, 1, 6.5f}));
}

}  // namespace
}  // namespace gloam

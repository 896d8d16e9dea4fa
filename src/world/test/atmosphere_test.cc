// The clear sky and the sun against measured and published figures.

#include "world/sky/atmosphere.h"
#include "base/angle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/parallel.h"
#include "world/sky/air.h"
#include "world/sky/air_profile.h"

namespace gloam {
namespace {

AtmosphereOptions sun_at(double elevation, double turbidity = 2, double azimuth = 0) {
  AtmosphereOptions options;
  const double e = elevation * kDegree, a = azimuth * kDegree;
  options.to_sun = {static_cast<float>(std::cos(e) * std::cos(a)),
                    static_cast<float>(std::cos(e) * std::sin(a)), static_cast<float>(std::sin(e))};
  options.turbidity = turbidity;
  options.width = 128;
  options.height = 64;
  return options;
}
SkyLight sky_of(const AtmosphereOptions& options) {
  Result<SkyLight> sky = make_sky(options);
  EXPECT_TRUE(sky.ok()) << sky.error().to_string();
  return std::move(*sky);
}
SkyLight sky_of(double elevation, double turbidity) { return sky_of(sun_at(elevation, turbidity)); }
/// Nearest texel; azimuth counter-clockwise from +X [deg].
Vec3f at(const SkyLight& sky, double elevation, double azimuth) {
  const int row =
      std::clamp(static_cast<int>((90 - elevation) / 180 * sky.height), 0, sky.height - 1);
  const int column = static_cast<int>((0.5 - azimuth / 360) * sky.width) % sky.width;
  return sky.texels[static_cast<size_t>(row) * sky.width + (column + sky.width) % sky.width];
}

TEST(Spectrum, MoleculesScatterAsPublished) {
  // Bodhaine et al. 1999, table 3 (360 ppm CO2): 4.513e-27 cm² at 550 nm, 1.66e-26 at 400 nm.
  EXPECT_NEAR(rayleigh_cross_section(550), 4.513e-31, 0.005e-31);
  EXPECT_NEAR(rayleigh_cross_section(400), 1.674e-30, 0.02e-30);
  // Air of the standard atmosphere weighs 1013.25 hPa: 10332 kg/m² of 1.225 kg/m³.
  double column = 0;
  for (double h = 50; h < 100e3; h += 100) column += densities(kEarthRadius + h).molecules * 100;
  EXPECT_NEAR(column, 8434.5, 60);
  // Over the sphere phase functions integrate to one.
  double rayleigh = 0, aerosol = 0;
  for (int i = 0; i < 2000; ++i) {
    const double cosine = (i + 0.5) / 1000 - 1;
    rayleigh += rayleigh_phase(cosine) * 2 * M_PI / 1000;
    aerosol += aerosol_phase(cosine) * 2 * M_PI / 1000;
  }
  EXPECT_NEAR(rayleigh, 1, 1e-4);
  EXPECT_NEAR(aerosol, 1, 1e-4);
}

TEST(Spectrum, SunAboveTheAirHasItsIlluminanceAndColour) {
  Bands all;
  all.fill(1);
  const Vec3f sun = color_of_sunlight(all);
  // Darula, Kittler and Gueymard 2005, "Reference luminous solar constant": 133.3 klx.
  EXPECT_NEAR(luminance(sun), 133.3e3, 1.0e3);
  // Correlated colour temperature about 5,900 K: redder than D65.
  EXPECT_GT(sun.x, sun.y);
  EXPECT_GT(sun.y, sun.z);
  EXPECT_LT(sun.x / sun.z, 1.3f);
  // Light of one band is outside of Rec. 709, and keeps its luminance.
  for (int b = 0; b < kBandCount; ++b) {
    Bands one{};
    one[b] = 1;
    const Vec3f rgb = color_of_sunlight(one);
    EXPECT_GE(std::min({rgb.x, rgb.y, rgb.z}), 0) << b;
    EXPECT_GT(luminance(rgb), 0) << b;
  }
  EXPECT_EQ(luminance(color_of_sunlight({})), 0);
}

TEST(Atmosphere, BeamFollowsBeersLaw) {
  const Air air(2.5, 0.2, 0);
  // Relative air masses of Kasten and Young 1989, table 2 (of the whole air; they include
  // refraction, which is small down to 10 degrees). Aerosol and ozone lie lower and higher: their
  // own are 1 % and more off at low sun.
  struct Mass {
    double elevation, mass, slack;
  };
  for (const Mass m :
       {Mass{90, 1, 0.002}, Mass{60, 1.154, 0.005}, Mass{30, 1.994, 0.01}, Mass{10, 5.586, 0.03}}) {
    const Bands sun = air.beam(air.ground(), (90 - m.elevation) * kDegree);
    for (int b = 0; b < kBandCount; ++b) {
      const double nm = kFirstBand + kBandWidth * b;
      const double molecules = rayleigh_cross_section(nm) * kMolecules * kMoleculeColumn;
      const double aerosol = 1.5 * rayleigh_cross_section(550) * kMolecules * kMoleculeColumn *
                             std::pow(nm / 550, -1.3);
      const double ozone = ozone_cross_section(b) * 300 * 2.687e20;
      const double depth = (molecules + aerosol + ozone) * m.mass;
      EXPECT_NEAR(-std::log(sun[b]), depth, m.slack * depth + 2e-3) << nm << " at " << m.elevation;
    }
  }
}

TEST(Atmosphere, IlluminancesAreThoseOfAClearDay) {
  // On clear days with a high sun the beam gives 100 klx within a fifth, the sky 8 to 20 klx on
  // level ground.
  for (const double elevation : {45.0, 60.0, 75.0}) {
    const SkyLight sky = sky_of(elevation, 2);
    EXPECT_GT(luminance(sky.sun_illuminance), 90e3) << elevation;
    EXPECT_LT(luminance(sky.sun_illuminance), 120e3) << elevation;
    EXPECT_GT(luminance(sky.sky_illuminance), 8e3) << elevation;
    EXPECT_LT(luminance(sky.sky_illuminance), 20e3) << elevation;
  }
  // The zenith of clear skies, the sun at 45 degrees: a few kcd/m².
  for (const double turbidity : {2.0, 3.0}) {
    const double zenith = luminance(at(sky_of(45, turbidity), 89, 0));
    EXPECT_GT(zenith, 1.8e3);
    EXPECT_LT(zenith, 6e3);
  }
}

TEST(Atmosphere, SkyIlluminanceIsTheIntegralOfTheMap) {
  for (const double elevation : {50.0, 8.0, -3.0}) {
    const SkyLight sky = sky_of(elevation, 3);
    double sum = 0;
    for (int row = 0; row < sky.height / 2; ++row) {
      const double top = M_PI * row / sky.height, low = M_PI * (row + 1) / sky.height;
      const double weight = (std::cos(top) - std::cos(low)) * std::cos((top + low) / 2);
      for (int column = 0; column < sky.width; ++column) {
        sum += luminance(sky.texels[static_cast<size_t>(row) * sky.width + column]) * weight * 2 *
               M_PI / sky.width;
      }
    }
    EXPECT_NEAR(sum, luminance(sky.sky_illuminance), 0.01 * sum) << elevation;
  }
}

TEST(Atmosphere, GroundReflectsWhatFallsOnIt) {
  AtmosphereOptions options = sun_at(40);
  options.ground_albedo = 0.5;
  const SkyLight sky = sky_of(options);
  const double falls =
      luminance(sky.sun_illuminance) * std::sin(40 * kDegree) + luminance(sky.sky_illuminance);
  EXPECT_NEAR(luminance(at(sky, -60, 120)), 0.5 / M_PI * falls, 0.01 * falls / M_PI);
  // A bright ground lights the sky.
  options.ground_albedo = 0;
  const SkyLight dark = sky_of(options);
  EXPECT_GT(luminance(sky.sky_illuminance), 1.04f * luminance(dark.sky_illuminance));
  EXPECT_LT(luminance(at(dark, -60, 0)), 0.01 * luminance(at(sky, -60, 0)));
}

TEST(Atmosphere, ZenithIsBluerThanTheHorizon) {
  for (const double elevation : {70.0, 40.0, 15.0}) {
    for (const double turbidity : {1.0, 2.0, 4.0}) {
      const SkyLight sky = sky_of(elevation, turbidity);
      // Ninety degrees from the sun's azimuth, away from its aureole.
      const Vec3f high = at(sky, elevation > 60 ? 40 : 88, 180), low = at(sky, 2, 90);
      EXPECT_GT(high.z / high.x, 1.15f * low.z / low.x) << elevation << " " << turbidity;
    }
  }
  // Blue sky is 10,000 K and more, where Rec. 709 blue is 1.3 times red.
  const Vec3f blue = at(sky_of(45, 2), 60, 180);
  EXPECT_GT(blue.z, 1.3f * blue.x);
}

TEST(Atmosphere, SunReddensAndFadesAsItSets) {
  float red = 0, before = std::numeric_limits<float>::infinity();
  for (double elevation = 60; elevation >= 0; elevation -= 5) {
    const Vec3f sun = sky_of(elevation, 2).sun_illuminance;
    EXPECT_GT(sun.x / sun.y, red) << elevation;
    EXPECT_LT(luminance(sun), before) << elevation;
    red = sun.x / sun.y;
    before = luminance(sun);
  }
  EXPECT_GT(red, 3);
  EXPECT_EQ(luminance(sky_of(-0.6, 2).sun_illuminance), 0);
}

TEST(Atmosphere, HazeTakesFromTheBeam) {
  float beam = std::numeric_limits<float>::infinity(), sky_light = 0;
  for (const double turbidity : {1.0, 2.0, 3.0, 6.0, 10.0}) {
    const SkyLight sky = sky_of(50, turbidity);
    EXPECT_LT(luminance(sky.sun_illuminance), beam);
    EXPECT_GT(luminance(sky.sky_illuminance), sky_light);
    beam = luminance(sky.sun_illuminance);
    sky_light = luminance(sky.sky_illuminance);
    // No more light comes down than the sun sends.
    EXPECT_LT(beam * std::sin(50 * kDegree) + sky_light, 133.3e3 * std::sin(50 * kDegree));
  }
}

TEST(Atmosphere, TwilightFadesAndNightStays) {
  double before = std::numeric_limits<double>::infinity();
  for (double elevation = 4; elevation >= -90; elevation -= elevation > -18 ? 2 : 18) {
    const SkyLight sky = sky_of(elevation, 2);
    for (const Vec3f& texel : sky.texels) {
      ASSERT_TRUE(texel.x > 0 && texel.y > 0 && texel.z > 0 && std::isfinite(luminance(texel)))
          << elevation;
    }
    EXPECT_LE(luminance(sky.sky_illuminance), before) << elevation;
    before = luminance(sky.sky_illuminance);
  }
  // Level illuminance without clouds, as published for navigators (Seidelmann 1992, "Explanatory
  // Supplement to the Astronomical Almanac"): about 700 lx with the sun on the horizon, 3.4 lx at
  // -6, 8e-3 lx at -12 degrees.
  EXPECT_NEAR(std::log(luminance(sky_of(0, 2).sky_illuminance)), std::log(700.0), std::log(1.6));
  EXPECT_NEAR(std::log(luminance(sky_of(-6, 2).sky_illuminance)), std::log(3.4), std::log(2.0));
  EXPECT_NEAR(std::log(luminance(sky_of(-12, 2).sky_illuminance)), std::log(8e-3), std::log(3.0));
  EXPECT_NEAR(luminance(sky_of(-60, 2).sky_illuminance), M_PI * 2e-4, 1e-6);
}

/// CIE S 011/E:2003, type 12 (clear, low turbidity), relative to the zenith.
double cie_clear(double zenith_angle, double sun_zenith, double from_sun) {
  const auto indicatrix = [](double x) {
    return 1 + 10 * (std::exp(-3 * x) - std::exp(-3 * M_PI / 2)) + 0.45 * std::cos(x) * std::cos(x);
  };
  const auto gradation = [](double z) { return 1 - std::exp(-0.32 / std::max(std::cos(z), 1e-3)); };
  return indicatrix(from_sun) * gradation(zenith_angle) / (indicatrix(sun_zenith) * gradation(0));
}

TEST(Atmosphere, LuminanceIsDistributedAsTheStandardClearSky) {
  for (const double elevation : {30.0, 45.0, 60.0}) {
    const SkyLight sky = sky_of(elevation, 2.5);
    const double zenith = luminance(at(sky, 89, 0));
    double squares = 0, worst = 0;
    int count = 0;
    for (double view = 10; view < 89; view += 10) {
      for (double azimuth = 0; azimuth < 360; azimuth += 15) {
        const double cosine =
            std::sin(view * kDegree) * std::sin(elevation * kDegree) +
            std::cos(view * kDegree) * std::cos(elevation * kDegree) * std::cos(azimuth * kDegree);
        if (cosine > std::cos(10 * kDegree)) continue;  // the aureole
        const double expected =
            cie_clear((90 - view) * kDegree, (90 - elevation) * kDegree, std::acos(cosine));
        const double gap = std::log(luminance(at(sky, view, azimuth)) / zenith / expected);
        squares += gap * gap;
        worst = std::max(worst, std::abs(gap));
        ++count;
      }
    }
    RecordProperty("rms", std::to_string(std::sqrt(squares / count)));
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(std::sqrt(squares / count), 0.25) << elevation;
    EXPECT_LT(worst, 0.75) << elevation;
  }
}

TEST(Atmosphere, TurnsWithTheSunAndHasNoSeams) {
  const SkyLight sky = sky_of(sun_at(20, 3, 0)), turned = sky_of(sun_at(20, 3, 90));
  for (int row = 0; row < sky.height; ++row) {
    for (int column = 0; column < sky.width; ++column) {
      // By +90 degrees is a quarter of the columns to the left.
      const float a = luminance(sky.texels[static_cast<size_t>(row) * sky.width + column]);
      const float b = luminance(turned.texels[static_cast<size_t>(row) * sky.width +
                                              (column + sky.width - sky.width / 4) % sky.width]);
      ASSERT_NEAR(a, b, 1e-3 * a);
      const float beside =
          luminance(sky.texels[static_cast<size_t>(row) * sky.width + (column + 1) % sky.width]);
      ASSERT_NEAR(beside / a, 1, 0.2) << row << " " << column;
    }
  }
  // From row to row above the horizon, in the finest picture that is usual.
  for (const double elevation : {50.0, 5.0, 0.0, -4.0}) {
    AtmosphereOptions fine = sun_at(elevation, 2);
    fine.width = 16;
    fine.height = 256;
    const SkyLight tall = sky_of(fine);
    for (int column = 0; column < 16; ++column) {
      double slope = 0;
      for (int row = 1; row < 120; ++row) {
        const auto log_at = [&](int r) {
          return std::log(luminance(tall.texels[static_cast<size_t>(r) * 16 + column]));
        };
        const double next = log_at(row) - log_at(row - 1);
        // Bands would be jumps of the slope.
        if (row > 1) {
          EXPECT_NEAR(next, slope, 0.03) << elevation << " row " << row;
        }
        slope = next;
      }
    }
  }
}

TEST(Atmosphere, HighPlacesHaveADarkerSkyAndABrighterSun) {
  AtmosphereOptions low = sun_at(45), high = sun_at(45);
  high.altitude = 4000;
  const SkyLight sea = sky_of(low), mountain = sky_of(high);
  EXPECT_GT(luminance(mountain.sun_illuminance), 1.08f * luminance(sea.sun_illuminance));
  EXPECT_LT(luminance(at(mountain, 88, 0)), 0.6f * luminance(at(sea, 88, 0)));
  EXPECT_GT(at(mountain, 88, 0).z / at(mountain, 88, 0).x, at(sea, 88, 0).z / at(sea, 88, 0).x);
}

TEST(Atmosphere, IsTheSameWithAnyNumberOfThreads) {
  set_thread_count(1);
  const SkyLight one = sky_of(10, 4);
  set_thread_count(3);
  const SkyLight three = sky_of(10, 4);
  set_thread_count(0);
  EXPECT_EQ(std::memcmp(one.texels.data(), three.texels.data(), one.texels.size() * sizeof(Vec3f)),
            0);
}

TEST(Atmosphere, WrongOptionsAreNamed) {
  const auto message = [](auto change) {
    AtmosphereOptions options = sun_at(45);
    change(options);
    const Result<SkyLight> sky = make_sky(options);
    return sky.ok() ? std::string() : sky.error().to_string();
  };
  using testing::HasSubstr;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.5, 10.5, nan}) {
    EXPECT_THAT(message([&](auto& o) { o.turbidity = bad; }), HasSubstr("turbidity"));
  }
  for (const double bad : {-0.1, 1.1, nan}) {
    EXPECT_THAT(message([&](auto& o) { o.ground_albedo = bad; }), HasSubstr("albedo"));
  }
  for (const double bad : {-1.0, 9001.0, nan}) {
    EXPECT_THAT(message([&](auto& o) { o.altitude = bad; }), HasSubstr("altitude"));
  }
  EXPECT_THAT(message([&](auto& o) { o.to_sun = {0, 0, 0}; }), HasSubstr("unit vector"));
  EXPECT_THAT(message([&](auto& o) { o.to_sun.x = static_cast<float>(nan); }),
              HasSubstr("unit vector"));
  EXPECT_THAT(message([&](auto& o) { o.height = 33; }), HasSubstr("even number"));
  EXPECT_THAT(message([&](auto& o) { o.width = 1 << 30; }), HasSubstr("texels"));
}

}  // namespace
}  // namespace gloam

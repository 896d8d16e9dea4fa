// Probes of air, gas, water, ground and contacts, against closed forms and the fields themselves.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "instant/medium_field.h"
#include "runtime/test/probe_rig.h"
#include "sim/effects/water/water_surface.h"
#include "sim/effects/wind/wind.h"
#include "sim/snapshots/snapshot.h"
#include "world/effects/soil_description.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr double kGravity = 9.81;  // MuJoCo's [m/s²]

TEST(Probes, WindIsTheFieldsOwnWithItsGusts) {
  const TempFolder folder;
  const World world = probe_world(folder, R"(
[sky]
sun_elevation = 40
[weather]
wind = 8
gusts = 0.2
wind_from = 180
[[probe]]
name = "mast"
quantity = "wind"
position = [3, 1, 2]
rate = 50
)");
  const auto samples = read_probe(world, "mast", 1);
  ASSERT_EQ(samples.size(), 51u);
  const Wind wind(world.compiled()->wind);
  for (const SensorMessage& sample : samples) {
    EXPECT_EQ(sample.step, sample.index * 10);
    EXPECT_NEAR(sample.time, 0.002 * static_cast<double>(sample.step), 1e-9) << "its own state's";
    const Vec3 truth = wind.at(sample.time, 2);
    EXPECT_EQ(sample.values, (std::vector<double>{truth.x, truth.y, truth.z}));
  }
  EXPECT_NE(samples[0].values, samples[40].values);
}

// The logarithmic law at the height of a body that falls.
TEST(Probes, WindOnABodyIsThatOfItsHeight) {
  const TempFolder folder;
  const World world = probe_world(folder, R"(
[sky]
sun_elevation = 40
[weather]
wind = 8
gusts = 0
[[probe]]
name = "falls"
quantity = "wind"
body = "ball"
position = [0, 0, 0.5]
)",
                                  "<body name='ball' pos='0 0 9'><joint type='slide' "
                                  "axis='0 0 1'/><geom size='.1' mass='900'/></body>");
  const auto samples = read_probe(world, "falls", 1);
  ASSERT_EQ(samples.size(), 11u);
  for (const SensorMessage& sample : samples) {
    const double z = 9.5 - kGravity / 2 * sample.time * sample.time;
    const double law = 8 * std::log(z / 0.03) / std::log(10 / 0.03);
    EXPECT_NEAR(sample.values[0], law, 0.01) << "from the west";
    EXPECT_NEAR(sample.values[1], 0, 1e-9);
  }
}

TEST(Probes, WaterIsAtItsLevelAndOnItsWaves) {
  const TempFolder folder;
  const World still = probe_world(folder, R"(
[[water]]
name = "pool"
position = [1, 2, 0.7]
[[probe]]
name = "gauge"
quantity = "water_height"
position = [1.5, 2.5, 9]
)");
  for (const SensorMessage& sample : read_probe(still, "gauge", 0.5))
    EXPECT_EQ(sample.values[0], 0.7);
  const World waves = probe_world(folder, R"(
[[water]]
name = "pool"
position = [1, 2, 0.7]
wave_height = 0.2
[[probe]]
name = "gauge"
quantity = "water_height"
position = [1.5, 2.5, 0]
)");
  const WaterDescription& water = waves.compiled()->waters[0];
  double highest = 0;
  for (const SensorMessage& sample : read_probe(waves, "gauge", 2)) {
    double airy = 0;  // linear theory by hand
    for (const WaveDescription& wave : water.waves)
      airy += wave.amplitude *
              std::cos(wave.kx * 1.5 + wave.ky * 2.5 - wave.omega * sample.time + wave.phase);
    EXPECT_NEAR(sample.values[0], 0.7 + airy, 1e-9);
    highest = std::max(highest, std::abs(airy));
  }
  EXPECT_GT(highest, 0.02);
}

// A round plate under a dashpot, which lets it down slowly.
TEST(Probes, SinkageIsBekkersAndTheWorkThatOfItsCurve) {
  const TempFolder folder;
  constexpr double kRadius = 0.1, kPressure = 100e3;
  const double area = std::numbers::pi * kRadius * kRadius, weight = kPressure * area;
  const World world = probe_world(
      folder, R"(
[[soil]]
name = "bed"
size = [1, 1]
depth = 0.5
[[probe]]
name = "plate_sinks"
quantity = "sinkage"
body = "pla*"
[[probe]]
name = "print"
quantity = "sinkage"
position = [0.01, 0.01, 0]
[[probe]]
name = "beside"
quantity = "sinkage"
position = [0.45, 0.45, 0]
[[probe]]
name = "work"
quantity = "soil_work"
body = "plate"
[[probe]]
name = "load"
quantity = "contact_force"
body = "plate"
)",
      fmt::format("<body name='plate' pos='0 0 .02'><joint type='slide' axis='0 0 1' damping='{}'/>"
                  "<geom type='cylinder' size='{} .02' mass='{}'/></body>",
                  weight / 0.1, kRadius, weight / kGravity));
  const SoilStrength& s = world.compiled()->soils[0].strength;
  const double z = std::pow(kPressure / (s.k_c / kRadius + s.k_phi), 1 / s.n);
  const auto read = read_probes(world, {"plate_sinks", "print", "beside", "work", "load"}, 5);
  const auto last = [&](size_t i, size_t n = 0) { return read[i].back().values[n]; };
  EXPECT_EQ(read[0].front().values[0], 0);
  EXPECT_NEAR(last(0), z, 0.05 * z);
  EXPECT_NEAR(last(1), last(0), 0.05 * z) << "the print that it stands in";
  EXPECT_EQ(last(2), 0);
  const double work = weight * z / (s.n + 1);  // area times the integral of the curve
  EXPECT_NEAR(last(3), work, 0.1 * work);
  EXPECT_NEAR(last(4, 2), weight, 0.02 * weight);
  EXPECT_NEAR(last(4, 0), 0, 0.01 * weight);
}

// A block on rails leans on someone who stands: a spring presses it by k (x0 - x).
TEST(Probes, APersonFeelsTheKnownForceOfABlock) {
  const TempFolder folder;
  const World world = probe_world(
      folder, R"(
[[agent]]
name = "ada"
behavior = "stand"
yields = false
height = 1.7
position = [1, 0, 0]
heading = 180
[[probe]]
name = "shove"
quantity = "contact_force"
agent = "ada"
[[probe]]
name = "shove_on_parts"
quantity = "contact_force"
body = "ada*"
[[probe]]
name = "head"
quantity = "contact_force"
body = "ada/head"
)",
      "<geom type='plane' size='9 9 .1'/>"
      "<body name='block' pos='.5 0 1.1' gravcomp='1'><joint name='rail' type='slide' axis='1 0 0' "
      "stiffness='2' springref='30' damping='40'/>"
      "<geom type='box' size='.1 .3 .3' mass='5'/></body>");
  const auto read = read_probes(world, {"shove", "shove_on_parts", "head"}, 4);
  auto simulation = simulate(world);
  ASSERT_TRUE(simulation->run_until(2000).ok());
  const double x = simulation->latest()[*world.find_joint("rail")].position();
  EXPECT_GT(x, 0.05) << "it has come to the person";
  EXPECT_LT(x, 0.45);
  const std::vector<double>& force = read[0].back().values;
  const double spring = 2 * (30 - x);
  EXPECT_NEAR(force[0], spring, 0.02 * spring);
  EXPECT_EQ(read[0].front().values[0], 0);
  EXPECT_EQ(force, read[1].back().values);
  EXPECT_EQ(read[2].back().values[0], 0) << "the block is lower";
}

const char* const kPlume = R"(
[[gas]]
name = "air"
position = [0, 0, 1]
size = [1.6, 1.6, 2]
[[smoke]]
name = "pot"
position = [0, 0, 0.3]
rate = 1e-4
heat = 2000
)";

std::string gas_probe(const std::string& quantity, const std::string& name, double x, double z) {
  return fmt::format("[[probe]]\nname = \"{}\"\nquantity = \"{}\"\nposition = [{}, 0.05, {}]\n",
                     name, quantity, x, z);
}

TEST(Probes, AGasIsReadBetweenItsCellsAndTicks) {
  const TempFolder folder;
  const World world = probe_world(folder, kPlume + gas_probe("gas_temperature", "hot", 0.05, 0.75) +
                                              gas_probe("gas_temperature", "next", 0.15, 0.75) +
                                              gas_probe("gas_temperature", "between", 0.10, 0.75) +
                                              gas_probe("gas_density", "soot", 0.05, 0.75) +
                                              gas_probe("gas_velocity", "rise", 0.05, 0.75) +
                                              gas_probe("visibility", "sight", 0.05, 0.75) +
                                              gas_probe("gas_temperature", "corner", 0.75, 0.05));
  const auto read =
      read_probes(world, {"hot", "next", "between", "soot", "rise", "sight", "corner"}, 3);
  const auto last = [&](size_t i, size_t n = 0) { return read[i].back().values[n]; };
  EXPECT_EQ(read[0].front().values[0], 293) << "clear air at first";
  EXPECT_GT(last(0), 300) << "over 2 kW";
  EXPECT_NEAR(last(6), 293, 1) << "far from it";
  EXPECT_NEAR(last(2), (last(0) + last(1)) / 2, 1e-3) << "linear between the centres of cells";
  EXPECT_GT(last(4, 2), 0.1) << "it rises";
  EXPECT_GT(last(3), 0);
  // Koschmieder: 3.912 over the extinction of soot.
  EXPECT_NEAR(last(5) * last(3),
              kKoschmieder / double{world.compiled()->gases.gases[0].medium.mass_extinction[1]},
              1e-3 * last(5) * last(3));
  // The field itself, in the cell.
  auto simulation = simulate(world);
  ASSERT_TRUE(simulation->run_until(1500).ok());
  const Snapshot now = simulation->latest();
  const FieldWindow& window = now.data().effects.media.at(0);
  window.before->wait();
  const GasDescription& gas = world.compiled()->gases.gases[0];
  const auto cell_of = [&](double p, float low) {
    return static_cast<size_t>((p - double{low}) / double{gas.voxel});
  };
  const size_t cell =
      (cell_of(0.75, gas.low.z) * static_cast<size_t>(gas.ny) + cell_of(0.05, gas.low.y)) *
          static_cast<size_t>(gas.nx) +
      cell_of(0.05, gas.low.x);
  ASSERT_EQ(window.share, 0) << "3 s are a tick";
  EXPECT_NEAR(last(0), double{(*window.before->temperature())[cell]}, 1e-3);
  EXPECT_NEAR(last(3), double{(*window.before->density())[cell]}, 1e-9);
  EXPECT_NEAR(last(4, 2), double{(*window.before->velocity())[3 * cell + 2]}, 1e-5);
}

TEST(Probes, ChangeNothing) {
  const TempFolder folder;
  const std::string bodies =
      "<geom type='plane' size='9 9 .1' pos='0 0 -.5'/>"
      "<body name='ball' pos='0 0 .3'><freejoint/><geom size='.1' mass='3'/></body>";
  const std::string scene = std::string(kPlume) + R"(
[[soil]]
name = "bed"
size = [1, 1]
depth = 0.3
[[agent]]
name = "ada"
behavior = "wander"
position = [3, 0, -0.5]
)";
  const std::string probes = gas_probe("gas_velocity", "v", 0, 1) + R"(
[[probe]]
name = "work"
quantity = "soil_work"
body = "ball"
[[probe]]
name = "push"
quantity = "contact_force"
agent = "ada"
[[probe]]
name = "lux"
quantity = "illuminance"
body = "ball"
)";
  const auto hash_of = [](const World& world, const std::vector<std::string>& names) {
    auto simulation = simulate(world);
    std::vector<std::unique_ptr<SensorStream>> streams;
    for (const std::string& name : names) {
      auto opened = simulation->open_sensor({name, true}, [](const SensorMessage&) {});
      EXPECT_TRUE(opened.ok()) << opened.error().to_string();
      streams.push_back(std::move(*opened));
    }
    EXPECT_TRUE(simulation->run_until(300).ok());
    return simulation->latest().hash();
  };
  const uint64_t without = hash_of(probe_world(folder, scene, bodies), {});
  const World world = probe_world(folder, scene + probes, bodies);
  EXPECT_EQ(hash_of(world, {}), without);
  EXPECT_EQ(hash_of(world, {"v", "work", "push", "lux"}), without);
  EXPECT_EQ(read_probe(world, "lux", 0.3).back().values,
            read_probe(world, "lux", 0.3).back().values);
}

TEST(Probes, MayHaveErrorsAsSensorsHave) {
  const TempFolder folder;
  const World world = probe_world(folder, R"(
[[water]]
name = "pool"
[[probe]]
name = "gauge"
quantity = "water_height"
position = [0, 0, 0]
rate = 500
[[sensor]]
match = "gau*"
noise = 0.01
offset = 0.5
)");
  const auto samples = read_probe(world, "gauge", 4);
  ASSERT_EQ(samples.size(), 2001u) << "the probe's own rate";
  double mean = 0, square = 0;
  for (const SensorMessage& sample : samples) mean += sample.values[0] / 2001;
  for (const SensorMessage& sample : samples)
    square += (sample.values[0] - mean) * (sample.values[0] - mean) / 2000;
  EXPECT_NEAR(mean, 0.5, 3 * 0.01 / std::sqrt(2001.0));
  EXPECT_NEAR(std::sqrt(square), 0.01, 3 * 0.01 / std::sqrt(2 * 2001.0));
}

}  // namespace
}  // namespace gloam

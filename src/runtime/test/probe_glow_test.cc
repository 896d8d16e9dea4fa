// Illuminance by things that glow: E d² is their luminous intensity at any distance.

#include <fmt/format.h>

#include <cmath>

#include "runtime/test/probe_rig.h"
#include "world/lights/black_body.h"

namespace gloam {
namespace {

/// A probe that faces the origin's z axis from `distance` m along -y, at the height z.
std::string facing_probe(const std::string& name, double distance, double z) {
  return fmt::format(R"(
[[probe]]
name = "{}"
quantity = "illuminance"
position = [0, {}, {}]
normal = [0, 1, 0]
)",
                     name, -distance, z);
}

double luminance_at(double temperature) {
  return static_cast<double>(luminance(black_body_luminance(temperature)));
}

/// Last readings of probes named after their distances.
std::vector<double> read_at(const std::string& scene, const std::vector<double>& distances,
                            double z, double seconds, const std::string& bodies = "") {
  std::string text = scene;
  std::vector<std::string> names;
  for (const double d : distances) {
    names.push_back(fmt::format("at{}", names.size()));
    text += facing_probe(names.back(), d, z);
  }
  const TempFolder folder;
  std::vector<double> out;
  for (const auto& read : read_probes(probe_world(folder, text, bodies), names, seconds))
    out.push_back(read.empty() ? -1 : read.back().values[0]);
  return out;
}

std::string hot_box(double edge, double extinction) {
  return fmt::format(R"(
[[volume]]
name = "hot"
position = [0, 0, 1]
size = [{0}, {0}, {0}]
mass_extinction = [1]
albedo = [0]
g = [0]
density = {1}
temperature = 1500
emission = 1
)",
                     edge, extinction);
}

// Thick: L A / d² of its front face. The sides are edge-on from the axis.
TEST(ProbeGlow, AThickHotCubeIsABlackBody) {
  const std::vector<double> distances = {2, 5, 20};
  const auto read = read_at(hot_box(0.4, 200), distances, 1, 0.1);
  for (size_t i = 0; i < distances.size(); ++i) {
    // From the front face: the solid angle's projection on the axis of a centred square.
    const double d = distances[i] - 0.2, a = 0.2;
    const double r = a / std::sqrt(a * a + d * d);
    const double expected = luminance_at(1500) * 4 * r * std::atan(r);
    EXPECT_NEAR(read[i] / expected, 1, 0.03) << distances[i] << " m";
  }
}

// Thin: every part of it is seen: I = L k V.
TEST(ProbeGlow, AThinHotCubeShinesByItsVolume) {
  const double k = 0.02, intensity = luminance_at(1500) * k * std::pow(0.4, 3);
  const std::vector<double> distances = {3, 10, 30};
  const auto read = read_at(hot_box(0.4, k), distances, 1, 0.1);
  for (size_t i = 0; i < distances.size(); ++i)
    EXPECT_NEAR(read[i] * distances[i] * distances[i] / intensity, 1, 0.03) << distances[i];
}

// Fog of albedo 0 between them dims by Beer and Lambert's law.
TEST(ProbeGlow, MediaBetweenDimIt) {
  const std::string fog = R"(
[[volume]]
name = "soot"
position = [0, -3, 1]
size = [4, 2, 4]
mass_extinction = [1]
albedo = [0]
g = [0]
density = 0.5
)";
  const auto clear = read_at(hot_box(0.4, 200), {5}, 1, 0.1);
  const auto dim = read_at(hot_box(0.4, 200) + fog, {5}, 1, 0.1);
  EXPECT_NEAR(dim[0] / clear[0], std::exp(-1.0), 0.02);
}

// A surface behind the probe's back and one that hides it give nothing.
TEST(ProbeGlow, SurfacesHideIt) {
  const auto hidden = read_at(hot_box(0.4, 200), {5}, 1, 0.1,
                              "<geom type='box' size='3 .1 3' pos='0 -2 1' rgba='0 0 0 1'/>");
  EXPECT_NEAR(hidden[0], 0, 1e-6);
}

// A plate of 0.4 m that gives off 100 cd/m².
TEST(ProbeGlow, SurfacesThatGlowAreLampsToo) {
  const TempFolder folder;
  folder.write("plate.xml",
               "<mujoco><visual><headlight active='0'/></visual>"
               "<asset><material name='glow' rgba='1 1 1 1' emission='1'/></asset><worldbody>"
               "<geom type='box' size='.2 .001 .2' pos='0 0 1' material='glow'/>"
               "</worldbody></mujoco>");
  std::string text = "[environment]\nfile = \"plate.xml\"\n";
  for (const double d : {2.0, 10.0}) text += facing_probe(fmt::format("at{}", d), d, 1);
  const auto read = read_probes(compile_text(folder, "scene.toml", text), {"at2", "at10"}, 0.1);
  EXPECT_NEAR(read[0].back().values[0] * 4 / 16, 1, 0.03);
  EXPECT_NEAR(read[1].back().values[0] * 100 / 16, 1, 0.02);
}

// A fire seen from four distances and two sides at one instant.
TEST(ProbeGlow, TheIntensityOfAFireDoesNotDependOnTheDistance) {
  const std::string fire = R"(
[[gas]]
name = "air"
position = [0, 0, 1.5]
size = [2, 2, 3]
voxel = 0.1
fuel = "propane"
closed = ["-z"]
[[fire]]
name = "burner"
position = [0, 0, 0.15]
size = [0.3, 0.3, 0.2]
power = 40e3
)";
  const std::vector<double> distances = {4, 6, 10, 20};
  const auto read = read_at(fire, distances, 0.5, 1.5);
  double intensity[4], mean = 0;
  for (size_t i = 0; i < 4; ++i) {
    intensity[i] = read[i] * distances[i] * distances[i];
    mean += intensity[i] / 4;
    std::printf("%.0f m: %.2f lx m2\n", distances[i], intensity[i]);
  }
  EXPECT_GT(mean, 20);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(intensity[i] / mean, 1, 0.08) << distances[i] << " m";
}

}  // namespace
}  // namespace gloam

// Black bodies in 8 … 14 µm, and a thermal camera's noise.
#include "sensors/thermal/thermal_camera.h"

#include "base/parallel.h"
#include "sensors/test/statistics.h"
#include "sensors/thermal/thermal_band.h"
#include "world/media/authored_volume.h"
#include "world/media/flame.h"

namespace gloam {
namespace {

// Planck's law by the midpoint rule.
double planck(double temperature) {
  const double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  double sum = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double l = (8 + 6 * (i + 0.5) / kSteps) * 1e-6;
    sum +=
        2 * h * c * c / std::pow(l, 5) / std::expm1(h * c / (l * k * temperature)) * 6e-6 / kSteps;
  }
  return sum;
}

TEST(Thermal, RadianceIsPlancksLaw) {
  for (const double t : {150.0, 250.0, 293.15, 310.0, 600.0, 1500.0, 4000.0})
    EXPECT_NEAR(thermal_radiance(t) / planck(t), 1, 1e-5) << t;
  EXPECT_EQ(thermal_radiance(0), 0);
  for (const double t : {20.0, 120.3, 273.15, 300.01, 999.7, 4999.0})
    EXPECT_NEAR(apparent_temperature(thermal_radiance(t)), t, 2e-4) << t;
  EXPECT_EQ(apparent_temperature(-1), 0);
  EXPECT_EQ(apparent_temperature(1e300), 6000);
}

constexpr int kSide = 360;

RenderDescription two_things() {
  RenderDescription description;
  description.instances.resize(2);
  description.instances[0].label.body = "robot/motor";
  description.instances[1].label.body = "wall";
  description.instances[1].label.material = "steel";
  return description;
}

Film film_of(uint32_t part, float distance = 2) {
  Film film;
  film.width = film.height = kSide;
  film.part.assign(film.pixel_count(), part);
  film.depth.assign(film.pixel_count(), distance);
  film.distance = film.depth;
  return film;
}

CameraView view() {
  CameraView view;
  view.intrinsics.width = view.intrinsics.height = kSide;
  view.intrinsics.fx = view.intrinsics.fy = 1e6;  // all rays along the axis
  view.intrinsics.cx = view.intrinsics.cy = kSide / 2.0;
  return view;
}

ThermalCamera make(const ThermalOptions& options, const RenderDescription& description,
                   const std::vector<TemperatureOptions>& temperatures = {}) {
  auto camera = ThermalCamera::make(options, temperatures, description, 3);
  if (!camera.ok()) {
    ADD_FAILURE() << camera.error().to_string();
    abort();
  }
  return std::move(*camera);
}

TEST(Thermal, ThingsHaveTheirTemperatureAndEmissivity) {
  const std::vector<TemperatureOptions> temperatures = {
      {.body = "robot/*", .temperature = 330, .emissivity = 1},
      {.material = "steel", .temperature = 400, .emissivity = 0.2, .ambient = 290},
      {.body = "sky", .temperature = 250, .emissivity = 1}};
  const ThermalCamera camera = make({}, two_things(), temperatures);
  EXPECT_NEAR(camera.see(film_of(1), view(), 0, {})[5], 330, 1e-3);
  const double steel = 0.2 * planck(400) + 0.8 * planck(290);
  EXPECT_NEAR(camera.see(film_of(2), view(), 0, {})[5], apparent_temperature(steel), 0.01);
  EXPECT_NEAR(camera.see(film_of(0), view(), 0, {})[5], 250, 1e-3);
  EXPECT_NEAR(make({}, two_things()).see(film_of(1), view(), 0, {})[5], 293.15, 1e-3);
  EXPECT_NEAR(make({.step = 0.5}, two_things()).see(film_of(1), view(), 0, {})[5], 293, 1e-3);
  EXPECT_EQ(make({.max = 280}, two_things()).see(film_of(1), view(), 0, {})[5], 280);
  const auto wrong = ThermalCamera::make({}, {{.body = "robot/moter"}}, two_things(), 1);
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().to_string().find("moter"), std::string::npos);
}

TEST(Thermal, NoiseHasItsTemperatureDifference) {
  const ThermalCamera camera =
      make({.netd = 0.05}, two_things(), {{.temperature = 300, .emissivity = 1}});
  const auto a = camera.see(film_of(1), view(), 0, {}), b = camera.see(film_of(1), view(), 1, {});
  std::vector<double> t(a.begin(), a.end());
  // Floats of 300 are 3e-5 apart.
  expect_moments(t, 300, 0.0025, "NETD");
  EXPECT_NE(a, b);
  const ThermalCamera fixed =
      make({.fixed_pattern = 0.2}, two_things(), {{.temperature = 300, .emissivity = 1}});
  const auto pattern = fixed.see(film_of(1), view(), 0, {});
  t.assign(pattern.begin(), pattern.end());
  const Moments m = moments(t);
  expect_within(m.variance, 0.04, m.variance_error, "fixed pattern");
  EXPECT_EQ(fixed.see(film_of(1), view(), 7, {}), pattern);
  set_thread_count(1);
  EXPECT_EQ(camera.see(film_of(1), view(), 0, {}), a) << "threads";
  set_thread_count(0);
}

/// A slab of 0.5 m at 280 K before the things, which takes 2 * 0.8 of the heat per metre.
RenderDescription behind_a_slab(float width) {
  RenderDescription description = two_things();
  MediumDescription medium;
  medium.mass_extinction.fill(1000);  // opaque in every other band
  medium.mass_extinction[static_cast<size_t>(MediumBand::k8to14um)] = 2;
  medium.albedo.fill(0);
  description.media.push_back(medium);
  VolumeDescription slab;
  slab.X_WV.p = {0, 0, -1};
  slab.size = {width, width, 0.5f};
  slab.even_density = 0.8f;
  slab.even_temperature = 280;
  description.volumes.push_back(slab);
  return description;
}

// A slab before a warm thing: Beer and Lambert's law, and what the slab itself gives off.
TEST(Thermal, MediaDimInTheirOwnBandAndGlow) {
  const RenderDescription description = behind_a_slab(4);
  const SensorAir air = std::move(SensorAir::make(description)).value();
  const ThermalCamera camera = make({}, description, {{.temperature = 350, .emissivity = 1}});
  const double kept = std::exp(-2 * 0.8 * 0.5);
  const double expected = kept * planck(350) + (1 - kept) * planck(280);
  EXPECT_NEAR(camera.see(film_of(1), view(), 0, air.view())[5], apparent_temperature(expected),
              0.02);
  const double before = std::exp(-2 * 0.8 * 0.25);  // a thing inside, half way
  EXPECT_NEAR(camera.see(film_of(1, 1), view(), 0, air.view())[5],
              apparent_temperature(before * planck(350) + (1 - before) * planck(280)), 0.02);
}

// A slab full of flame: what it radiates of its heat, thick enough a black body.
TEST(Thermal, FlamesReadTheirBrightnessTemperature) {
  for (const float thick : {0.3f, 1.0f, 8.0f}) {
    GasDescription gas;
    gas.nx = gas.ny = gas.nz = 4;
    gas.voxel = thick / 4;
    gas.low = {-0.5f * thick, -0.5f * thick, -1 - thick};
    gas.temperature = 300;
    gas.flame_absorption = flame_absorption_per_heat(0.3f);
    RenderDescription description = two_things();
    author_gases({gas}, &description);
    PoseFrame frame;
    const float absorption = gas.flame_absorption * kFlameHeatRelease;  // [1/m]
    frame.fields.push_back({std::make_shared<const std::vector<float>>(64, 0.0f),
                            std::make_shared<const std::vector<float>>(64, 700.0f),
                            std::make_shared<const std::vector<float>>(64, absorption)});
    SensorAir air = std::move(SensorAir::make(description)).value();
    air.follow(description, frame);
    const ThermalCamera camera = make({}, description, {{.temperature = 300, .emissivity = 1}});
    const double seen = camera.see(film_of(1, 20), view(), 0, air.view())[5];
    const double kept = std::exp(-0.3 * 1.2e6 / (4 * 5.670374e-8 * std::pow(1500, 4)) * thick);
    EXPECT_NEAR(seen, apparent_temperature(kept * planck(300) + (1 - kept) * planck(1500)), 0.05);
    printf("%.1f m of flame: %.0f K\n", thick, seen);
    if (thick > 5) {
      EXPECT_GT(seen, 1300);
    }
  }
}

// 60 degrees off the axis of a fisheye the way through a slab is twice as long.
TEST(Thermal, MediaDimAlongTheLenssRays) {
  const RenderDescription description = behind_a_slab(20);
  CameraView fisheye = view();
  fisheye.intrinsics.lens = LensModel::kEquidistant;
  fisheye.intrinsics.fx = fisheye.intrinsics.fy = 100;
  fisheye.intrinsics.cx = 0.5 - 100 * M_PI / 3;  // of the first pixel
  fisheye.intrinsics.cy = 0.5;
  const SensorAir air = std::move(SensorAir::make(description)).value();
  const ThermalCamera camera = make({}, description, {{.temperature = 350, .emissivity = 1}});
  const double kept = std::exp(-2 * 0.8 * 0.5 * 2);
  EXPECT_NEAR(camera.see(film_of(1, 9), fisheye, 0, air.view())[0],
              apparent_temperature(kept * planck(350) + (1 - kept) * planck(280)), 0.02);
  // Parallel rays all cross it straight.
  CameraView parallel = view();
  parallel.intrinsics.orthographic = true;
  parallel.intrinsics.fx = parallel.intrinsics.fy = 100;
  const double straight = std::exp(-2 * 0.8 * 0.5);
  EXPECT_NEAR(camera.see(film_of(1, 9), parallel, 0, air.view())[0],
              apparent_temperature(straight * planck(350) + (1 - straight) * planck(280)), 0.02);
}

}  // namespace
}  // namespace gloam

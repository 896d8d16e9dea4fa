// Depth of an active stereo camera against its parameters.
#include "sensors/depth/stereo_depth.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "sensors/test/statistics.h"

namespace gloam {
namespace {

constexpr int kStereoWidth = 500, kStereoHeight = 240;
constexpr size_t kStereoPixels = size_t{kStereoWidth} * kStereoHeight;

Intrinsics stereo_intrinsics() {
  return {kStereoWidth, kStereoHeight, 400, 400, kStereoWidth / 2.0, kStereoHeight / 2.0};
}

std::vector<float> wall(float depth) { return std::vector<float>(kStereoPixels, depth); }

std::vector<float> measure(const StereoDepthModel& model, const std::vector<float>& depth,
                           const std::vector<float>& signal = {}, int64_t frame = 0,
                           uint64_t seed = 5) {
  return measure_stereo_depth(model, stereo_intrinsics(), depth, signal, seed, frame);
}

TEST(StereoDepth, WithNothingOnItIsTheTruth) {
  const auto out = measure({}, wall(2.5f));
  for (const float z : out) EXPECT_NEAR(z, 2.5f, 1e-6f);
  EXPECT_EQ(measure({}, wall(std::numeric_limits<float>::infinity()))[7], 0) << "nothing there";
}

TEST(StereoDepth, DisparityHasItsNoise) {
  const StereoDepthModel model{.baseline = 0.05, .noise = 0.08};
  std::vector<double> disparity, depth;
  for (const float z : measure(model, wall(2))) {
    disparity.push_back(400 * 0.05 / double{z});
    depth.push_back(double{z});
  }
  expect_moments(disparity, 10, 0.0064, "disparity");
  // Z² / (f B) sigma, to first order.
  const Moments m = moments(depth);
  EXPECT_NEAR(m.deviation(), 4 / 20.0 * 0.08, 3 * m.deviation_error() + 1e-4);
}

TEST(StereoDepth, StepsOfTheDisparity) {
  const StereoDepthModel model{.baseline = 0.05, .subpixel = 0.125};
  for (const float truth : {0.61f, 1.3f, 2.77f}) {
    const double d = 20 / double{measure(model, wall(truth))[0]};
    EXPECT_NEAR(d / 0.125, std::round(d / 0.125), 1e-4);
    EXPECT_LE(std::abs(d - 20 / double{truth}), 0.0625 + 1e-4);
  }
  // With noise well above the steps, rounding adds a twelfth of their square.
  std::vector<double> disparity;
  for (const float z : measure({.baseline = 0.05, .subpixel = 0.125, .noise = 0.25}, wall(2)))
    disparity.push_back(20 / double{z});
  expect_moments(disparity, 10, 0.0625 + 0.125 * 0.125 / 12, "noise and steps");
}

TEST(StereoDepth, EndsAtItsRanges) {
  const StereoDepthModel model{
      .baseline = 0.05, .min_range = 0.3, .max_range = 6, .max_disparity = 40};
  EXPECT_EQ(measure(model, wall(0.29f))[0], 0);
  EXPECT_EQ(measure(model, wall(0.45f))[0], 0) << "a disparity of 44 px";
  EXPECT_GT(measure(model, wall(0.55f))[0], 0);
  EXPECT_GT(measure(model, wall(5.9f))[0], 0);
  EXPECT_EQ(measure(model, wall(6.1f))[0], 0);
}

// A box 1 m away before a wall at 2 m: disparities 20 and 10 px.
std::vector<float> box() {
  std::vector<float> depth = wall(2);
  for (int y = 0; y < kStereoHeight; ++y)
    std::fill_n(depth.begin() + y * kStereoWidth + 200, 100, 1.0f);
  return depth;
}

TEST(StereoDepth, HidesWhatTheSecondEyeDoesNotSee) {
  const auto lost_columns = [](double baseline) {
    const auto out = measure({.baseline = baseline, .occlusion = true}, box());
    std::vector<int> columns;
    for (int x = 0; x < kStereoWidth; ++x) {
      if (out[static_cast<size_t>(100 * kStereoWidth + x)] == 0) columns.push_back(x);
    }
    return columns;
  };
  // The right eye sees the box shifted left by 10 px against the wall: it covers as much beside
  // it, and the left 10 px of the wall are outside its picture.
  std::vector<int> expected;
  for (int x = 0; x < 10; ++x) expected.push_back(x);
  for (int x = 190; x < 200; ++x) expected.push_back(x);
  EXPECT_EQ(lost_columns(0.05), expected);
  expected.clear();
  for (int x = 300; x < 310; ++x) expected.push_back(x);
  for (int x = 490; x < 500; ++x) expected.push_back(x);
  EXPECT_EQ(lost_columns(-0.05), expected) << "an eye to the left";
}

TEST(StereoDepth, ASlantedWallHidesNothingOfItself) {
  std::vector<float> depth(kStereoPixels);
  for (size_t i = 0; i < kStereoPixels; ++i)
    depth[i] = 1 / (0.4f + 0.001f * static_cast<float>(i % kStereoWidth));
  const auto out = measure({.baseline = 0.05, .occlusion = true}, depth);
  for (size_t x = 20; x < kStereoWidth; ++x) EXPECT_GT(out[100 * kStereoWidth + x], 0) << x;
}

TEST(StereoDepth, LosesTheEdges) {
  for (const int reach : {1, 3}) {
    const auto out = measure({.baseline = 0.05, .edge_loss = reach}, box());
    for (int x = 150; x < 350; ++x) {
      const int edge = std::min({std::abs(2 * x + 1 - 400), std::abs(2 * x + 1 - 600)});
      EXPECT_EQ(out[static_cast<size_t>(100 * kStereoWidth + x)] == 0, edge < 2 * reach) << x;
    }
  }
}

TEST(StereoDepth, WeakSignalsAreLostByChance) {
  const StereoDepthModel model{.baseline = 0.05, .half_signal = 0.01};
  for (const float signal : {0.002f, 0.01f, 0.03f, 1.0f}) {
    const auto out = measure(model, wall(1), std::vector<float>(kStereoPixels, signal));
    const double kept =
        static_cast<double>(std::count_if(out.begin(), out.end(), [](float z) { return z > 0; })) /
        kStereoPixels;
    const double s = double{signal} / 0.01, p = s * s / (1 + s * s);
    expect_within(kept, p, std::sqrt(p * (1 - p) / kStereoPixels), "kept");
  }
  for (const float z : measure(model, wall(1), wall(0))) EXPECT_EQ(z, 0) << "black";
}

// A wall that faces the ray of a pixel sends back its albedo over Z², whatever the lens.
TEST(StereoDepth, TheProjectorsLightComesBackAlongTheLenssRays) {
  RenderDescription description;
  description.instances.resize(1);
  description.materials.resize(1);
  description.materials[0].roughness = 1;
  const double a = 0.6, b = 0.4, factor = 1 - 0.25 * (a * a + b * b);  // of plumb_bob
  CameraView view;
  view.intrinsics = {.width = 1, .height = 1, .fx = 100, .fy = 100};
  view.intrinsics.lens = LensModel::kPlumbBob;
  view.intrinsics.distortion = {-0.25};
  view.intrinsics.cx = 0.5 - 100 * a * factor;
  view.intrinsics.cy = 0.5 - 100 * b * factor;
  Film film;
  film.width = film.height = 1;
  film.part = {1};
  film.depth = {2};
  film.center_albedo = {{0.5f, 0.5f, 0.5f}};
  film.center_normal = {
      normalize(Vec3f{static_cast<float>(-a), static_cast<float>(b), 1})};  // back along the ray
  EXPECT_NEAR(projector_signal(description, {}, film, view)[0], 0.5 / 4, 1e-6);
}

/// The signal of a matt wall 3 m off with an albedo of a half, 2 m of air before it.
double signal_through(float extinction, float albedo, float g) {
  RenderDescription description;
  description.instances.resize(1);
  description.materials.resize(1);
  description.materials[0].roughness = 1;
  if (extinction > 0) {
    MediumDescription medium;
    medium.mass_extinction.fill(extinction);
    medium.albedo.fill(albedo);
    medium.g.fill(g);
    description.media.push_back(medium);
    VolumeDescription slab;
    slab.X_WV.p = {0, 0, -2};
    slab.size = {4, 4, 2};
    slab.even_density = 1;
    description.volumes.push_back(slab);
  }
  const SensorAir air = std::move(SensorAir::make(description)).value();
  CameraView view;
  view.intrinsics = {.width = 1, .height = 1, .fx = 100, .fy = 100, .cx = 0.5, .cy = 0.5};
  Film film;
  film.width = film.height = 1;
  film.part = {1};
  film.depth = film.distance = {3};
  film.center_albedo = {{0.5f, 0.5f, 0.5f}};
  film.center_normal = {{0, 0, 1}};
  return double{projector_signal(description, air.view(), film, view)[0]};
}

// The slab is from 1 m to 3 m: its centre 2 m away, half of its 2 m on both sides.
TEST(StereoDepth, MediaTakeOfTheProjectorsLightAndVeilIt) {
  const double clear = 0.5 / 9;
  EXPECT_NEAR(signal_through(0, 0, 0), clear, 1e-6);
  // What absorbs dims on both ways, by Beer and Lambert's law.
  EXPECT_NEAR(signal_through(0.2f, 0, 0), clear * std::exp(-2 * 0.2 * 2), 1e-5);
  // What scatters sends back pi Int beta e^(-2 k (r - 1)) / r² dr besides.
  const double k = 0.2, beta = k / (4 * M_PI), left = clear * std::exp(-2 * k * 2);
  double back = 0;
  for (double r = 1.0005; r < 3; r += 0.001)
    back += M_PI * beta * std::exp(-2 * k * (r - 1)) / (r * r) * 0.001;
  EXPECT_NEAR(signal_through(0.2f, 1, 0), left * left / (left + back), 1e-3 * left);
  EXPECT_GT(signal_through(0.2f, 1, 0.8f), signal_through(0.2f, 1, 0)) << "drops send little back";
}

TEST(StereoDepth, DrawsAreKeyedAndThreadsDoNotMatter) {
  StereoDepthOptions options;
  options.preset = "d435";
  const StereoDepthModel model = stereo_depth_model(options);
  const std::vector<float> signal(kStereoPixels, 0.01f);
  const auto reference = measure(model, box(), signal);
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    EXPECT_EQ(measure(model, box(), signal), reference);
  }
  set_thread_count(0);
  EXPECT_NE(measure(model, box(), signal, 1), reference);
  EXPECT_NE(measure(model, box(), signal, 0, 6), reference);
}

TEST(StereoDepth, ThePresetsAreTheirPapers) {
  StereoDepthOptions options;
  options.preset = "kinect";
  const StereoDepthModel kinect = stereo_depth_model(options);
  // Khoshelham and Elberink: 1.425e-5 Z² cm with Z in cm, f = 586 px.
  const double sigma = 500.0 * 500 / (586 * kinect.baseline * 100) * kinect.noise;
  EXPECT_NEAR(sigma, 1.425e-5 * 500 * 500, 0.05);
  options.preset = "d435";
  options.noise = 0.5;
  options.edge_loss = 0;
  const StereoDepthModel d435 = stereo_depth_model(options);
  EXPECT_EQ(d435.noise, 0.5) << "the table wins";
  EXPECT_EQ(d435.edge_loss, 0);
  EXPECT_EQ(d435.max_disparity, 126);
}

}  // namespace
}  // namespace gloam

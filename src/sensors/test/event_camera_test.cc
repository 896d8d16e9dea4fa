// Events of known ramps of light.
#include "sensors/event/event_track.h"

#include <algorithm>
#include <map>

#include "base/parallel.h"
#include "sensors/test/statistics.h"

namespace gloam {
namespace {

constexpr int kEventWidth = 400, kEventHeight = 300;
constexpr size_t kEventPixels = size_t{kEventWidth} * kEventHeight;

std::vector<Vec3f> even(double light) {
  const auto l = static_cast<float>(light);
  return std::vector<Vec3f>(kEventPixels, {l, l, l});
}

// Light whose logarithm, with the dark's share, is `level`.
double light_of(double level) { return std::exp(level) - 0.001; }

TEST(Events, ARampMakesAnEventPerThresholdAtItsTime) {
  EventCamera camera({.threshold = 0.25}, kEventWidth, kEventHeight, 1);
  EXPECT_TRUE(camera.see(even(light_of(-2)), 1, 0, 0).empty()) << "the first frame";
  // One unit of log light in 10 ms, seen in four frames: four events per pixel.
  std::map<size_t, std::vector<double>> times;
  double last = 0;
  for (int k = 1; k <= 4; ++k) {
    for (const Event& e : camera.see(even(light_of(-2 + 0.26 * k)), 1, 0.0025 * k, k)) {
      EXPECT_TRUE(e.brighter);
      EXPECT_GE(e.time, last) << "in order of time";
      last = e.time;
      times[e.x + size_t{kEventWidth} * e.y].push_back(e.time);
    }
  }
  ASSERT_EQ(times.size(), kEventPixels);
  for (size_t j = 0; j < 4; ++j)
    EXPECT_NEAR(times[4321].at(j), 0.0025 * 0.25 * static_cast<double>(j + 1) / 0.26, 1e-6);
  const auto down = camera.see(even(light_of(-2)), 1, 0.02, 5);
  EXPECT_EQ(down.size(), 4 * kEventPixels);
  EXPECT_FALSE(down.front().brighter);
}

TEST(Events, ASlowChangeAddsUpOverFrames) {
  EventCamera camera({.threshold = 0.25}, kEventWidth, kEventHeight, 1);
  size_t count = 0;
  for (int k = 0; k <= 100; ++k)
    count += camera.see(even(light_of(-2 + 0.0051 * k)), 1, k, k).size();
  EXPECT_EQ(count, 2 * kEventPixels);
}

// The rate of a ramp of r per second is r / C; over pixels whose thresholds differ each has its
// own.
TEST(Events, ThresholdsAreThePixelsOwn) {
  const EventOptions options{.threshold = 0.3, .mismatch = 0.03};
  EventCamera camera(options, kEventWidth, kEventHeight, 1);
  std::vector<double> up, down, product;
  for (size_t i = 0; i < kEventPixels; ++i) {
    up.push_back(camera.threshold(i, true));
    down.push_back(camera.threshold(i, false));
    product.push_back((up.back() - 0.3) * (down.back() - 0.3));
  }
  expect_moments(up, 0.3, 0.0009, "brighter");
  expect_moments(down, 0.3, 0.0009, "darker");
  const Moments common = moments(product);
  expect_within(common.mean, 0, common.mean_error, "independent of each other");
  camera.see(even(light_of(-4)), 1, 0, 0);
  std::vector<double> counts(kEventPixels, 0);
  for (const Event& e : camera.see(even(light_of(-1.01)), 1, 1, 1))
    ++counts[e.x + size_t{kEventWidth} * e.y];
  for (size_t i = 0; i < kEventPixels; i += 97)
    EXPECT_NEAR(counts[i], std::floor(2.99 / up[i]),
                std::abs(std::remainder(2.99 / up[i], 1)) < 1e-3 ? 1 : 0);
  double expected = 0, total = 0;
  for (size_t i = 0; i < kEventPixels; ++i) {
    expected += std::floor(2.99 / up[i]);
    total += counts[i];
  }
  EXPECT_NEAR(total / expected, 1, 1e-4) << "event rate of the ramp";
}

TEST(Events, APixelIsDeafAfterAnEvent) {
  // Four thresholds in 1 ms, a dead time of 0.6 ms: the first, and the first after that time.
  EventCamera camera({.threshold = 0.25, .refractory = 0.0006}, kEventWidth, kEventHeight, 1);
  camera.see(even(light_of(-2)), 1, 0, 0);
  const auto events = camera.see(even(light_of(-0.99)), 1, 0.001, 1);
  EXPECT_EQ(events.size(), 2 * kEventPixels);
}

TEST(Events, NoiseComesAtItsRateWithoutAChange) {
  EventCamera camera({.threshold = 0.25, .noise_rate = 3}, kEventWidth, kEventHeight, 1);
  camera.see(even(0.2), 1, 0, 0);
  std::vector<double> times, per_pixel(kEventPixels, 0);
  double brighter = 0;
  for (const Event& e : camera.see(even(0.2), 1, 0.5, 1)) {
    times.push_back(e.time);
    brighter += e.brighter ? 1 : 0;
    ++per_pixel[e.x + size_t{kEventWidth} * e.y];
  }
  expect_moments(per_pixel, 1.5, 1.5, "Poisson's");
  expect_moments(times, 0.25, 0.25 / 12, "spread evenly");
  const auto n = static_cast<double>(times.size());
  expect_within(brighter / n, 0.5, 0.5 / std::sqrt(n), "of both signs");
}

TEST(Events, ThreadsDoNotMatterAndBadLightIsNoCrash) {
  const auto run = [](int threads) {
    set_thread_count(threads);
    EventCamera camera({.threshold = 0.2, .mismatch = 0.05, .noise_rate = 5}, kEventWidth,
                       kEventHeight, 1);
    camera.see(even(0.2), 1, 0, 0);
    std::vector<Event> events = camera.see(even(0.5), 1, 0.1, 1);
    set_thread_count(0);
    std::vector<double> flat;
    for (const Event& e : events) flat.insert(flat.end(), {double(e.x), double(e.y), e.time});
    return flat;
  };
  EXPECT_EQ(run(1), run(3));
  EventCamera camera({}, kEventWidth, kEventHeight, 1);
  camera.see(even(NAN), 1, 0, 0);
  EXPECT_LT(camera.see(even(INFINITY), 1, 0.1, 1).size(), 200 * kEventPixels);
  EXPECT_TRUE(camera.see(even(0.2), 1, 0.05, 0).empty()) << "a simulation that began anew";
}

TEST(EventTrack, AFrameHasItsEventsOnceAndForAll) {
  EventTrack track(EventCamera({.threshold = 0.25}, kEventWidth, kEventHeight, 1));
  const auto see = [&](EventTrack::Frame frame, double level) {
    const auto time = 0.01 * static_cast<double>(frame.index);
    return track.see(frame, time, even(light_of(level)), 1, false).size();
  };
  EXPECT_EQ(see({0, 0}, -2), 0u);
  EXPECT_EQ(see({0, 3}, -1.74), kEventPixels);
  EXPECT_EQ(see({0, 3}, -1), kEventPixels) << "another stream's picture of the same frame";
  EXPECT_EQ(see({0, 2}, -1), 0u) << "a frame that was left behind";
  EXPECT_EQ(see({0, 4}, -1.48), kEventPixels);
  EXPECT_EQ(see({1, 5}, -1), 0u) << "the first frame after a reset";
  EXPECT_EQ(see({1, 6}, -0.74), kEventPixels);
}

}  // namespace
}  // namespace gloam

// Visibility at a point: that which media are written with, and that of smoke that is solved for.
#include "sensors/probe/visibility_probe.h"

#include <algorithm>
#include <map>

#include "metrics/metrics.h"
#include "scenes.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

constexpr const char* kHaze = R"(
[[volume]]
name = "haze"
medium = "haze"
position = [0, 0, 0]
size = [4, 4, 4]
visibility = 40
[[volume]]
name = "fog"
medium = "fog"
position = [1, 0, 0]
size = [2, 4, 4]
visibility = 10
)";

double seen_at(const World& world, const Snapshot& snapshot, Vec3f p_W) {
  const Result<VisibilityProbe> probe = VisibilityProbe::make(*world.compiled());
  EXPECT_TRUE(probe.ok()) << probe.error().to_string();
  return probe->visibility(snapshot.data(), p_W);
}

TEST(VisibilityProbe, IsWhatTheMediumIsWrittenWithAndExtinctionsAddUp) {
  const TempFolder folder;
  const World world = flight(folder, kHaze);
  const auto simulation = simulate(world);
  const Snapshot snapshot = simulation->latest();
  EXPECT_NEAR(seen_at(world, snapshot, {-1, 0, 0}), 40, 0.01);
  EXPECT_NEAR(seen_at(world, snapshot, {1, 0, 0}), 1 / (1 / 40.0 + 1 / 10.0), 0.01);
  EXPECT_EQ(seen_at(world, snapshot, {5, 0, 0}), VisibilityProbe::kMaxVisibility);
}

TEST(VisibilityProbe, OfSmokeIsThatOfItsConcentrationAndInTheMetrics) {
  const TempFolder folder;
  const World world = flight(folder, R"(
[[gas]]
name = "air"
position = [0.5, 0, 0]
size = [2, 2, 2]
voxel = 0.1
closed = ["-x", "+x", "-y", "+y", "-z", "+z"]
[[smoke]]
name = "machine"
position = [0.5, 0, 0]
size = [1.6, 1.6, 0.8]
rate = 1e-3
)");
  const VisibilityProbe probe = VisibilityProbe::make(*world.compiled()).value();
  const auto metrics = std::move(
      *Metrics::make(*world.compiled(), {.visibility = [&](const SnapshotData& at, Vec3f p_W) {
        return probe.visibility(at, p_W);
      }}));
  const auto visibility = [&](const Snapshot& at) {
    const std::vector<double>& row = metrics->sample(at);
    const auto column = std::ranges::find(metrics->columns(), "a.visibility_m");
    return column != metrics->columns().end() ? row[size_t(column - metrics->columns().begin())]
                                              : -1;
  };
  const auto simulation = simulate(world);
  EXPECT_EQ(visibility(simulation->latest()), VisibilityProbe::kMaxVisibility);
  ASSERT_TRUE(simulation->step(225).ok());  // 0.45 s: between two ticks
  const Snapshot snapshot = simulation->latest();
  const auto solver = PoseSolver::create(world.compiled()).value();
  PoseFrame frame;
  ASSERT_TRUE(solver->solve(snapshot, frame).ok());
  const std::vector<float>& density = *frame.fields[0].density;
  constexpr double kSmoke = 10000;  // [m²/kg] in green (medium_presets.cc)
  const auto expected = [&](int i, int j, int k) {
    return 3.912 / (kSmoke * double(density[size_t((k * 20 + j) * 20 + i)]));
  };
  ASSERT_LT(expected(14, 10, 10), 1e4);
  EXPECT_NEAR(seen_at(world, snapshot, {0.95f, 0.05f, 0.05f}), expected(14, 10, 10),
              1e-3 * expected(14, 10, 10));
  EXPECT_EQ(seen_at(world, snapshot, {0.45f, 0.05f, 0.05f}), VisibilityProbe::kMaxVisibility)
      << "inside of the ball there is no smoke";
  // The ball of 0.2 m is at 0.45 m: what its robot sees is that of the air around it.
  const double seen = visibility(snapshot);
  EXPECT_GT(seen, 0.5 * expected(14, 10, 10));
  EXPECT_LT(seen, 2 * expected(14, 10, 10));
  const auto numbers = metrics->summary();
  const std::map<std::string, double> summary(numbers.begin(), numbers.end());
  EXPECT_EQ(summary.at("a.visibility_min_m"), seen);
  EXPECT_NEAR(summary.at("a.visibility_mean_m"), 2 * seen, 0.01 * seen);
}

TEST(VisibilityProbe, ScenesWithoutMediaHaveNone) {
  const TempFolder folder;
  const World world = flight(folder);
  EXPECT_FALSE(VisibilityProbe::make(*world.compiled())->has_media());
}

}  // namespace
}  // namespace gloam

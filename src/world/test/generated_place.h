#pragma once
// What tests of generators share: a place from options, with a probe in it, and what must hold of
// it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/files.h"
#include "scene/test/temp_folder.h"
#include "world/test/place_check.h"

namespace gloam {

// Of the grid that is walked [m]: doors leave 8 cm beside the probe, aisles half a metre.
inline constexpr double kFine = 0.05, kCoarse = 0.1, kWide = 0.2;

class GeneratedPlace : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    ::setenv("GLOAM_CACHE_SIZE", "0", 1);  // a sweep's places would fill the disk
  }
  void TearDown() override { ::unsetenv("GLOAM_CACHE_SIZE"); }
  Scene with_probe(const EnvironmentOptions& environment, double radius = 0.3) const {
    Scene scene;
    scene.environment = environment;
    RobotOptions probe;
    probe.name = "probe";
    probe.file = folder_.path() / fmt::format("probe_{:.0f}.xml", 1e3 * radius);
    EXPECT_TRUE(write_text_file_atomic(probe.file, probe_model(radius)).ok());
    scene.robots = {probe};
    return scene;
  }
  template <class Options>
  Scene scene_of(std::optional<Options> EnvironmentOptions::* generator,
                 const Options& options) const {
    EnvironmentOptions environment;
    environment.*generator = options;
    if constexpr (requires { options.passage; })
      return with_probe(environment, options.passage / 2);
    return with_probe(environment);
  }
  Scene scene_of(const HouseOptions& o) const { return scene_of(&EnvironmentOptions::house, o); }
  Scene scene_of(const WarehouseOptions& o) const {
    return scene_of(&EnvironmentOptions::warehouse, o);
  }
  Scene scene_of(const OfficeOptions& o) const { return scene_of(&EnvironmentOptions::office, o); }
  Scene scene_of(const HallwayOptions& o) const {
    return scene_of(&EnvironmentOptions::hallway, o);
  }
  Scene scene_of(const BedroomOptions& o) const {
    return scene_of(&EnvironmentOptions::bedroom, o);
  }
  Scene scene_of(const TunnelOptions& o) const { return scene_of(&EnvironmentOptions::tunnel, o); }
  Scene scene_of(const MineOptions& o) const { return scene_of(&EnvironmentOptions::mine, o); }
  Scene scene_of(const TerrainOptions& o) const {
    return scene_of(&EnvironmentOptions::terrain, o);
  }
  template <class Options>
  void expect_sound(const Options& options, double cell, const std::string& which = {}) {
    SCOPED_TRACE("seed " + std::to_string(options.seed) + which);
    const Result<World> world = World::compile(scene_of(options));
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    const PlaceReport report = check_place(*world->compiled(), cell);
    EXPECT_LE(report.deepest_contact, 0.002) << report.deepest << " overlap";
    EXPECT_LE(report.furthest, 0.02) << report.furthest_body << " moves of itself";
    EXPECT_LE(report.most_turned, 3 * M_PI / 180) << report.most_turned_body << " turns of itself";
    EXPECT_TRUE(report.unreached.empty())
        << "no way to " << report.unreached[0] << " of " << report.unreached.size();
    EXPECT_TRUE(report.blocked_doors.empty()) << report.blocked_doors[0];
  }
  template <class Options>
  void expect_sound_seeds(uint64_t first, uint64_t last, double cell, Options options = {}) {
    for (options.seed = first; options.seed <= last; ++options.seed) expect_sound(options, cell);
  }
  TempFolder folder_;
};

}  // namespace gloam

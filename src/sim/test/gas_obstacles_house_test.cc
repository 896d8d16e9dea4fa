// Air in a generated house: doors let it through or do not; and how long it takes to find out.

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>

#include "gas_rig.h"
#include "gloam/scene.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class GasObstaclesOfHouses : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }

  std::shared_ptr<CompiledWorld> house(int rooms, const std::string& doors) {
    Scene scene;
    EnvironmentOptions environment;
    environment.house = HouseOptions{.seed = 3, .rooms = rooms, .doors = doors};
    scene.environment = environment;
    const Result<World> world = World::compile(scene);
    if (!world.ok()) {
      ADD_FAILURE() << world.error().to_string();
      abort();
    }
    return std::const_pointer_cast<CompiledWorld>(world->compiled());
  }

  // Around all regions and a metre more, its voxels' faces on the floor.
  static GasGrid around(const CompiledWorld& world, float voxel) {
    Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
    for (const Region& r : world.regions) {
      low = {std::min(low.x, r.low.x), std::min(low.y, r.low.y), std::min(low.z, r.low.z)};
      high = {std::max(high.x, r.high.x), std::max(high.y, r.high.y), std::max(high.z, r.high.z)};
    }
    const auto cells = [&](double length) {
      return static_cast<int>(std::ceil(length / double{voxel}));
    };
    return {cells(high.x - low.x + 2),
            cells(high.y - low.y + 2),
            cells(high.z - low.z + 1),
            voxel,
            {float(low.x - 1), float(low.y - 1), float(low.z) - 2 * voxel}};
  }

  // Shares of each region's air that air of the hall, where the origin is, gets to; "": of the air
  // at the border of the grid.
  static std::map<std::string, double> reached_from_hall(const GasRig& rig) {
    const GasGrid& g = rig.walls.grid;
    std::vector<uint8_t> reached(rig.walls.solid.size());
    const auto cell = [&](float low) { return static_cast<int>(-low / g.voxel); };
    reached[gas_index(g, 3, cell(g.low.x), cell(g.low.y), cell(g.low.z) + 12)] = 1;
    flood(rig.walls, &reached);
    std::map<std::string, double> all, got;
    for_cells(g, [&](int i, int j, int k, size_t at) {
      if (rig.walls.solid[at]) return;
      const auto p = gas_centre(g, 3, i, j, k);
      if (i == 0 || j == 0 || i == g.nx - 1 || j == g.ny - 1) ++all[""], got[""] += reached[at];
      for (const Region& r : rig.world->regions)
        if (p[0] > r.low.x && p[0] < r.high.x && p[1] > r.low.y && p[1] < r.high.y &&
            p[2] > r.low.z && p[2] < r.high.z)
          ++all[r.name], got[r.name] += reached[at];
    });
    for (auto& [name, n] : got) n /= all[name];
    return got;
  }

  TempFolder folder_;
};

TEST_F(GasObstaclesOfHouses, AirGetsFromTheHallToEveryRoomThroughOpenDoorsOnly) {
  for (const float voxel : {.1f, .08f}) {
    SCOPED_TRACE(voxel);
    GasRig open(house(4, "open"), around(*house(4, "open"), voxel), GasObstacles::kSealedGap);
    open.solve();
    const auto shares = reached_from_hall(open);
    EXPECT_EQ(shares.size(), 5u);
    for (const auto& [name, share] : shares) {
      if (name.empty()) {
        EXPECT_EQ(share, 0) << "air gets out of the house";
      } else {
        EXPECT_GT(share, .9) << name;
      }
    }
    GasRig shut(house(4, "closed"), open.walls.grid, GasObstacles::kSealedGap);
    shut.solve();
    for (const auto& [name, share] : reached_from_hall(shut))
      EXPECT_TRUE(name == "hall" ? share > .9 : share == 0) << name << " " << share;
  }
}

// What a quadruped has, and twenty doors that swing.
std::string robot_and_doors() {
  std::string xml =
      "<geom type='plane' size='9 9 1'/><body pos='0 0 .4'><freejoint/>"
      "<geom type='box' size='.19 .05 .06'/><geom type='cylinder' size='.05 .05'/>";
  for (int leg = 0; leg < 4; ++leg) {
    const double x = leg < 2 ? .19 : -.19, y = leg % 2 ? .13 : -.13;
    xml += fmt::format(
        "<body pos='{} {} 0'><joint axis='1 0 0'/><geom type='cylinder' size='.05 .04'/>"
        "<geom type='box' size='.03 .03 .03'/><body><joint axis='0 1 0'/>"
        "<geom type='box' size='.1 .02 .02' pos='0 0 -.1' euler='0 90 0'/>"
        "<geom type='capsule' size='.03 .1' pos='0 0 -.1'/><body pos='0 0 -.21'><joint axis='0 1 "
        "0'/><geom type='capsule' size='.015 .1' pos='0 0 -.1'/><geom type='capsule' size='.01 .1' "
        "pos='.01 0 -.1'/><geom type='sphere' size='.02' pos='0 0 -.21'/></body></body></body>",
        x, y);
  }
  xml += "</body>";
  for (int door = 0; door < 20; ++door)
    xml += fmt::format(
        "<body pos='{} {} 1.05' euler='0 0 {}'><joint axis='0 0 1'/><geom type='box' "
        "size='.45 .02 1.03' pos='.45 0 0'/></body>",
        -4 + 2 * (door % 5), -3 + 2 * (door / 5), 17 * door);
  return xml;
}

TEST_F(GasObstaclesOfHouses, TakesMillisecondsForARobotAndTwentyDoors) {
  GasRig rig(robot_and_doors(), {100, 80, 26, .1f, {-5, -4, -.1f}}, .01);
  mjModel& m = *rig.world->model;
  ASSERT_EQ(m.ngeom, 51);
  double walls = 1e9, least = 1e9;
  for (int call = 0; call < 50; ++call) {
    for (int i = 0; i < m.nv; ++i) rig.d->qvel[i] = random_control(call, i);
    mj_integratePos(&m, rig.d->qpos, rig.d->qvel, .1);
    const Snapshot s = rig.snapshot();
    const double start = seconds();
    ASSERT_TRUE(rig.obstacles->solve(s, &rig.walls).ok());
    walls = std::min(walls, call > 0 ? seconds() - start : 1e9);
    const double again = seconds();
    ASSERT_TRUE(rig.obstacles->solve(s, &rig.walls).ok());
    least = std::min(least, seconds() - again);
    ASSERT_FALSE(rig.obstacles->changed());
  }
  expect_equal(rig.walls, rig.fresh());
  fmt::print("robot and doors: {:.3f} ms a call, {:.3f} ms where nothing moved\n", 1e3 * walls,
             1e3 * least);
  EXPECT_LT(walls, .003);
}

TEST_F(GasObstaclesOfHouses, TakesLessThanHalfASecondForWhatStandsStill) {
  const auto world = house(6, "open");
  for (const float voxel : {.1f, .05f}) {
    const GasGrid grid = around(*world, voxel);
    const double start = seconds();
    GasRig rig(world, grid, .01);
    const double made = seconds() - start;
    const Snapshot s = rig.snapshot();
    ASSERT_TRUE(rig.obstacles->solve(s, &rig.walls).ok());
    rig.d->qpos[0] += .1;
    const Snapshot t = rig.snapshot();
    const double again = seconds();
    ASSERT_TRUE(rig.obstacles->solve(t, &rig.walls).ok());
    fmt::print("house of {} geoms, {} x {} x {}: {:.1f} ms, then {:.3f} ms a call\n",
               rig.world->model->ngeom, grid.nx, grid.ny, grid.nz, 1e3 * made,
               1e3 * (seconds() - again));
    EXPECT_LT(made, .5);
  }
}

}  // namespace
}  // namespace gloam

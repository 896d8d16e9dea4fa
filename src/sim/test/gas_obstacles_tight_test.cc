// What is tight for air and what is not: sheets, boards that touch, gaps.

#include <fmt/format.h>

#include <cmath>

#include "gas_rig.h"

namespace gloam {
namespace {

std::string pose_text(int seed) {
  const auto draw = [seed](int i) { return random_control(seed, i); };
  return fmt::format("pos='{} {} {}' quat='{} {} {} {}'", .5 * draw(0), .5 * draw(1), .5 * draw(2),
                     draw(3), draw(4), draw(5), draw(6));
}

// Of a point of the world, along the third axis of geom 0.
double height_over(const GasRig& rig, const std::array<double, 3>& p) {
  const mjtNum *at = rig.d->geom_xpos, *R = rig.d->geom_xmat;
  return R[2] * (p[0] - at[0]) + R[5] * (p[1] - at[1]) + R[8] * (p[2] - at[2]);
}

TEST(GasObstacles, NothingGetsThroughASheetHoweverThinAndTurned) {
  for (const double thickness : {.01, .04, .0001}) {
    for (int seed = 30; seed < 50; ++seed) {
      SCOPED_TRACE(fmt::format("{} m, seed {}", thickness, seed));
      GasRig rig(fmt::format("<geom type='box' size='5 5 {}' {}/>", thickness / 2, pose_text(seed)),
                 cube_grid(24, .1f));
      mj_kinematics(rig.world->model.get(), rig.d.get());
      rig.solve();
      const GasGrid& g = rig.walls.grid;
      const auto height = [&](int i, int j, int k) {
        return height_over(rig, gas_centre(g, 3, i, j, k));
      };
      std::vector<uint8_t> reached(rig.walls.solid.size());
      int through = 0, above = 0, below = 0;
      for_cells(g, [&](int i, int j, int k, size_t at) {
        above += reached[at] = height(i, j, k) > thickness / 2;
      });
      flood(rig.walls, &reached);
      for_cells(g, [&](int i, int j, int k, size_t at) {
        const bool beyond = height(i, j, k) < -thickness / 2;
        below += beyond;
        through += beyond && reached[at];
      });
      EXPECT_GT(std::min(above, below), 100);
      EXPECT_EQ(through, 0);
      // And it is a sheet, not a block: air is free on either side of it.
      EXPECT_LT(count(rig.walls.solid), 24 * 24 * 24 * thickness / .1 * 2 + 50);
    }
  }
}

// Six thin boards that just touch, along the grid's own lines and beside them.
TEST(GasObstacles, ABoxOfBoardsThatTouchIsTight) {
  for (const double turn : {0., 33.}) {
    for (const double s : {.45, .5, .512}) {
      std::string boards;
      const double half = .005, out = s + half;
      for (const double sign : {-1., 1.}) {
        boards += fmt::format(
            "<geom type='box' size='{0} {0} {1}' pos='0 0 {2}'/>"
            "<geom type='box' size='{1} {0} {0}' pos='{2} 0 0'/>"
            "<geom type='box' size='{0} {1} {0}' pos='0 {2} 0'/>",
            s, half, sign * out);
      }
      GasRig rig(fmt::format("<body euler='{0} {0} {0}'>{1}</body>", turn, boards),
                 cube_grid(20, .1f));
      rig.solve();
      std::vector<uint8_t> reached(rig.walls.solid.size());
      reached[gas_index(rig.walls.grid, 3, 10, 10, 10)] = 1;
      flood(rig.walls, &reached);
      EXPECT_NEAR(count(reached), std::pow(20 * s, 3), 250) << "turned " << turn << " side " << s;
    }
  }
}

// A seam that a line of cells' centres runs along, to the last bit.
TEST(GasObstacles, NothingGetsThroughTheSeamOfBoardsThatTouch) {
  for (const int turn : {0, 90, 180, 270}) {
    for (const double seam : {.0625, .1875, -.3125}) {
      GasRig rig(fmt::format("<body euler='0 0 {}'><geom type='box' size='1 .02 1' pos='{} .01 0'/>"
                             "<geom type='box' size='1 .02 1' pos='{} .01 0'/></body>",
                             turn, seam - 1, seam + 1),
                 cube_grid(8, .125f));
      rig.solve();
      std::vector<uint8_t> reached(rig.walls.solid.size());
      reached[0] = 1;
      flood(rig.walls, &reached);
      EXPECT_FALSE(reached.back()) << "turned " << turn << ", seam at " << seam;
    }
  }
}

// A wall of two boards, wherever the gap between them lies: lines of the grid would find it.
TEST(GasObstacles, GapsThatAreNarrowAreSealed) {
  int open_unsealed = 0;
  for (int i = 0; i < 20; ++i) {
    const double at = .2 + .005 * i;
    for (const double sealed : {0., .01}) {
      for (const double gap : {.008, .15}) {
        GasRig rig(fmt::format("<geom type='box' size='2 .02 2' pos='{} .01 0'/>"
                               "<geom type='box' size='2 .02 2' pos='{} .01 0'/>",
                               at - 2 - gap / 2, at + 2 + gap / 2),
                   cube_grid(10, .1f), sealed);
        rig.solve();
        std::vector<uint8_t> reached(rig.walls.solid.size());
        reached[0] = 1;
        flood(rig.walls, &reached);
        const bool open = reached.back() != 0;
        const bool expected = gap > .1 || (sealed == 0 && open);
        EXPECT_EQ(open, expected) << at;
        open_unsealed += gap < .1 && sealed == 0 && open;
      }
    }
  }
  EXPECT_GT(open_unsealed, 0);
}

}  // namespace
}  // namespace gloam

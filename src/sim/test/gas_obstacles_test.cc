// Which faces and cells of a gas colliders of every kind close, against closed forms.

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "gas_rig.h"

namespace gloam {
namespace {

using Point = std::array<double, 3>;
constexpr double kPi64 = std::numbers::pi;

// Uniform in [-1, 1], the same wherever it is drawn.
double draw(int seed, int i) { return random_control(seed, i); }

std::string pose_text(int seed, double reach) {
  return fmt::format("pos='{} {} {}' quat='{} {} {} {}'", reach * draw(seed, 0),
                     reach * draw(seed, 1), reach * draw(seed, 2), draw(seed, 3), draw(seed, 4),
                     draw(seed, 5), draw(seed, 6));
}

// A point of the world in the frame of geom 0.
Point in_geom(const GasRig& rig, const Point& p) {
  mjtNum local[3], from[3];
  mju_sub3(from, p.data(), rig.d->geom_xpos);
  mju_mulMatTVec3(local, rig.d->geom_xmat, from);
  return {local[0], local[1], local[2]};
}

// `distance`: below 0 inside geom 0, in its frame; grows by at most 1 per metre.
void expect_walls_of(GasRig& rig, const std::function<double(const Point&)>& distance) {
  mj_kinematics(rig.world->model.get(), rig.d.get());
  rig.solve();
  const GasGrid& g = rig.walls.grid;
  int wrong_cells = 0, missing_faces = 0, needless_faces = 0;
  for_cells(g, [&](int i, int j, int k, size_t at) {
    const double d = distance(in_geom(rig, gas_centre(g, 3, i, j, k)));
    wrong_cells += std::abs(d) > 1e-5 && (d < 0) != (rig.walls.solid[at] != 0);
  });
  constexpr int kSamples = 40;  // of the segment between two cells
  for_faces(g, [&](int axis, int i, int j, int k, size_t at) {
    double nearest = 1e9;
    for (int s = 0; s <= kSamples; ++s) {
      Point p = gas_centre(g, axis, i, j, k);
      p[static_cast<size_t>(axis)] += double{g.voxel} * (double(s) / kSamples - 0.5);
      nearest = std::min(nearest, distance(in_geom(rig, p)));
    }
    missing_faces += nearest < -1e-5 && !rig.walls.closed[axis][at];
    needless_faces +=
        nearest > 0.5 * double{g.voxel} / kSamples + 1e-5 && rig.walls.closed[axis][at];
  });
  EXPECT_EQ(wrong_cells, 0);
  EXPECT_EQ(missing_faces, 0);
  EXPECT_EQ(needless_faces, 0);
}

TEST(GasObstacles, SolidsTakeTheirVolume) {
  struct Shape {
    const char* geom;
    double volume;
  };
  const Shape shapes[] = {
      {"type='sphere' size='.5'", 4 * kPi64 / 3 * .125},
      {"type='capsule' size='.3 .3'", kPi64 * .09 * .6 + 4 * kPi64 / 3 * .027},
      {"type='ellipsoid' size='.6 .4 .3'", 4 * kPi64 / 3 * .072},
      {"type='cylinder' size='.4 .4'", kPi64 * .16 * .8},
      {"type='box' size='.5 .35 .3'", 8 * .0525},
  };
  for (const Shape& shape : shapes) {
    for (int seed = 0; seed < 6; ++seed) {
      GasRig rig(fmt::format("<geom {} {}/>", shape.geom, pose_text(seed, .05)),
                 cube_grid(50, .03f));
      rig.solve();
      const double volume = count(rig.walls.solid) * std::pow(.03, 3);
      EXPECT_NEAR(volume / shape.volume, 1, 0.03) << shape.geom << " seed " << seed;
    }
  }
}

TEST(GasObstacles, ClosesWhatPrimitivesMeetAndNothingElse) {
  const auto round = [](double x, double y) { return std::hypot(x, y); };
  struct Shape {
    const char* geom;
    std::function<double(const Point&)> distance;  // or less, outside
  };
  const Shape shapes[] = {
      {"type='sphere' size='.5'", [](const Point& p) { return std::hypot(p[0], p[1], p[2]) - .5; }},
      {"type='capsule' size='.2 .4'",
       [](const Point& p) {
         return std::hypot(p[0], p[1], std::max(std::abs(p[2]) - .4, 0.)) - .2;
       }},
      {"type='ellipsoid' size='.6 .2 .3'",
       [](const Point& p) { return .2 * (std::hypot(p[0] / .6, p[1] / .2, p[2] / .3) - 1); }},
      {"type='cylinder' size='.3 .4'",
       [&](const Point& p) { return std::max(round(p[0], p[1]) - .3, std::abs(p[2]) - .4); }},
      {"type='box' size='.5 .3 .02'",
       [](const Point& p) {
         return std::max({std::abs(p[0]) - .5, std::abs(p[1]) - .3, std::abs(p[2]) - .02});
       }},
      {"type='plane' size='.1 .1 .1'", [](const Point& p) { return p[2]; }},
  };
  for (const Shape& shape : shapes) {
    for (int seed = 10; seed < 15; ++seed) {
      SCOPED_TRACE(fmt::format("{} seed {}", shape.geom, seed));
      // Seed 10: along the axes.
      const std::string pose = seed == 10 ? "pos='.013 -.004 .05'" : pose_text(seed, .3);
      GasRig rig(fmt::format("<geom {} {}/>", shape.geom, pose), cube_grid(16, .1f));
      expect_walls_of(rig, shape.distance);
    }
  }
}

// A hull is that of all vertices: the notch of an arrow head is solid.
TEST(GasObstacles, MeshesAreTheHullsThatMuJoCoCollides) {
  const std::string octahedron = "vertex='.5 0 0 -.5 0 0 0 .5 0 0 -.5 0 0 0 .5 0 0 -.5'";
  const std::string notched =
      "vertex='.5 0 0 -.5 0 0 0 .5 0 0 -.5 0 0 0 .5 0 0 -.5 .05 .05 .05' "
      "face='0 2 6 2 4 6 4 0 6 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5'";
  for (const std::string& mesh : {octahedron, notched}) {
    for (int seed = 20; seed < 24; ++seed) {
      SCOPED_TRACE(fmt::format("{} seed {}", mesh, seed));
      GasRig rig(world_from_mjcf(fmt::format("<mujoco><asset><mesh name='m' {}/></asset><worldbody>"
                                             "<body {}><freejoint/><geom type='mesh' mesh='m'/>"
                                             "</body></worldbody></mujoco>",
                                             mesh, pose_text(seed, .2))),
                 cube_grid(16, .1f));
      // MuJoCo moves a mesh to its centre of mass and main axes: say where the tips are in its
      // frame.
      const mjModel& m = *rig.world->model;
      std::array<double, 3> p[6];
      for (size_t v = 0; v < 6; ++v)
        for (size_t axis = 0; axis < 3; ++axis) p[v][axis] = double{m.mesh_vert[3 * v + axis]};
      expect_walls_of(rig, [&](const Point& x) {
        double sum = 0;
        for (size_t axis = 0; axis < 3; ++axis) {
          double along = 0, middle = 0, length = 0;
          for (size_t i = 0; i < 3; ++i) {
            const double tip = (p[2 * axis][i] - p[2 * axis + 1][i]) / 2;
            middle = (p[2 * axis][i] + p[2 * axis + 1][i]) / 2;
            along += (x[i] - middle) * tip, length += tip * tip;
          }
          sum += std::abs(along) / std::sqrt(length);
        }
        return (sum - .5) / std::sqrt(3.);
      });
    }
  }
}

TEST(GasObstacles, GridsAndGeomsOfAbsurdSizes) {
  const std::string ball = "<geom type='sphere' size='.3'/>";
  GasRig one(ball, cube_grid(1, .1f));
  one.solve();
  EXPECT_EQ(count(one.walls.solid), 1);
  GasRig inside("<geom type='box' size='1e4 1e4 1e4'/>", cube_grid(5, .1f));
  inside.solve();
  EXPECT_EQ(count(inside.walls.solid), 125);
  GasRig beside("<geom type='sphere' size='.3' pos='1e6 0 0'/>", cube_grid(5, .1f));
  beside.solve();
  for (const auto& closed : beside.walls.closed) EXPECT_EQ(count(closed), 0);
  // Half in: what is inside is as in a larger grid.
  GasRig whole("<geom type='sphere' size='.8' pos='1 .03 0'/>", cube_grid(20, .1f));
  GasRig half("<geom type='sphere' size='.8' pos='1 .03 0'/>", cube_grid(10, .1f));
  whole.solve(), half.solve();
  int differ = 0;
  for_faces(half.walls.grid, [&](int axis, int i, int j, int k, size_t at) {
    const size_t there = gas_index(whole.walls.grid, axis, i + 5, j + 5, k + 5);
    differ += half.walls.closed[axis][at] != whole.walls.closed[axis][there];
  });
  EXPECT_EQ(differ, 0);
  EXPECT_GT(count(half.walls.closed[0]), 0);

  auto world = world_from_mjcf(
      "<mujoco><worldbody><body pos='.01 .02 .03'><freejoint/><geom type='sphere' size='.3'/><geom "
      "type='ellipsoid' size='.3 .3 .3'/><geom type='capsule' size='.3 .3'/><geom type='cylinder' "
      "size='.3 .3'/><geom type='box' size='.3 .3 .3'/></body></worldbody></mujoco>");
  for (int i = 0; i < 15; ++i) world->model->geom_size[i] = 0;
  GasRig points(world, cube_grid(6, .1f));
  points.solve();
  EXPECT_EQ(count(points.walls.solid), 0);
  points.d->qpos[0] = NAN;
  points.solve();
  EXPECT_EQ(count(points.walls.solid), 0);

  for (GasGrid bad : {GasGrid{}, cube_grid(-1, .1f), cube_grid(4, 0), cube_grid(4, NAN),
                      cube_grid(1 << 30, .1f)}) {
    EXPECT_FALSE(GasObstacles::create(world, bad).ok());
  }
  for (const double gap : {-1., double{NAN}, double{INFINITY}})
    EXPECT_FALSE(GasObstacles::create(world, cube_grid(4, .1f), gap).ok());
}

}  // namespace
}  // namespace gloam

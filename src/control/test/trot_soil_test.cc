// The trot on beds of soil, which no contact of MuJoCo's tells it of.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "control/trot.h"
#include "control/trot_options.h"
#include "scene/files/mujoco_guard.h"
#include "sim/loop/simulator.h"
#include "trot_robots.h"

namespace gloam {
namespace {

struct Walk {
  bool fell = false;
  double speed = 0;              // mean, from the second second on [m/s]
  double tilt_deg = 0;           // the most
  double low = 1, high = 0;      // of the base, from the second second on [m]
  double x = 0, y = 0, yaw = 0;  // at the end
  int prints = 0;                // pieces of the bed that are trodden down
  double deepest = 0;            // [m]
};

/// Ground at z = 0: rigid up to `from`, a bed of soil to `to`, rigid beyond [m].
std::shared_ptr<CompiledWorld> world_with_bed(const std::string& kind, double from, double to,
                                              VelocityTarget goal) {
  install_mujoco_handler();
  constexpr double depth = 0.15, far = 8, half_width = 0.8;
  auto world = std::make_shared<CompiledWorld>();
  world->model = load_quadruped(0.8, [&](mjSpec* spec) {
    mjsBody* ground = mjs_findBody(spec, "world");
    mjsGeom* plane = mjs_asGeom(mjs_firstElement(spec, mjOBJ_GEOM));
    for (mjsElement* e = mjs_firstElement(spec, mjOBJ_GEOM); e != nullptr;
         e = mjs_nextElement(spec, e)) {
      if (mjs_asGeom(e)->type == mjGEOM_PLANE) plane = mjs_asGeom(e);
    }
    plane->pos[2] = -depth;
    const auto box = [&](double x0, double x1, double y0, double y1) {
      mjsGeom* geom = mjs_addGeom(ground, nullptr);
      geom->type = mjGEOM_BOX;
      geom->pos[0] = (x0 + x1) / 2, geom->pos[1] = (y0 + y1) / 2, geom->pos[2] = -depth / 2;
      geom->size[0] = (x1 - x0) / 2, geom->size[1] = (y1 - y0) / 2, geom->size[2] = depth / 2;
    };
    box(-far, from, -far, far);
    box(to, far, -far, far);
    box(from, to, half_width, far);
    box(from, to, -far, -half_width);
  });
  world->initial_key = 0;
  world->robots.push_back(robot_instance(*world->model));
  world->robots[0].options.controller.goals = {
      {.time = 0.3, .vx = goal.vx, .vy = goal.vy, .yaw_rate = goal.yaw_rate}};
  Scene scene;
  SoilOptions bed;
  bed.name = "bed", bed.kind = kind, bed.depth = depth, bed.cell = 0.0125;
  bed.position = {(from + to) / 2, 0, 0}, bed.size = {to - from, 2 * half_width};
  scene.soils = {bed};
  auto soils = describe_soils(scene, *world->model);
  EXPECT_TRUE(soils.ok()) << soils.error().to_string();
  world->soils = *soils;
  return world;
}

/// Pieces of the bed that lie deeper than `depth`, and the deepest.
int count_prints(const Snapshot& now, double depth, double* deepest) {
  const SoilDescription& soil = now.data().world->soils[0];
  const auto& field = now.data().effects.surfaces[0].field;
  if (field == nullptr) return 0;
  std::vector<bool> low(soil.cells());
  for (size_t i = 0; i < low.size(); ++i) {
    const double height = double{field->height[i]};
    low[i] = height < -depth;
    *deepest = std::max(*deepest, -height);
  }
  int pieces = 0;
  std::vector<int> todo;
  for (size_t i = 0; i < low.size(); ++i) {
    if (!low[i]) continue;
    ++pieces;
    todo.push_back(static_cast<int>(i));
    while (!todo.empty()) {
      const int at = todo.back(), x = at % soil.nx, y = at / soil.nx;
      todo.pop_back();
      if (!low[static_cast<size_t>(at)]) continue;
      low[static_cast<size_t>(at)] = false;
      if (x > 0) todo.push_back(at - 1);
      if (x + 1 < soil.nx) todo.push_back(at + 1);
      if (y > 0) todo.push_back(at - soil.nx);
      if (y + 1 < soil.ny) todo.push_back(at + soil.nx);
    }
  }
  return pieces;
}

struct Trotting {
  std::unique_ptr<Simulator> sim;
  TrotController* trot = nullptr;

  explicit Trotting(const std::shared_ptr<CompiledWorld>& world) {
    auto created = Simulator::create(world, {.pace = Pace::kLockstep});
    EXPECT_TRUE(created.ok());
    sim = std::move(*created);
    auto made = make_trot_controller(*world->model, world->robots[0], TrotOptions{});
    EXPECT_TRUE(made.ok());
    trot = made->get();
    EXPECT_TRUE(sim->add_controller(0, std::move(*made), {500, 1}).ok());
    sim->start();
  }
};

Walk walk(const std::shared_ptr<CompiledWorld>& world, double duration) {
  Walk out;
  Trotting rig(world);
  double begin = 0;
  for (int i = 1; i <= std::lround(duration / 0.02); ++i) {
    EXPECT_TRUE(rig.sim->step(10).ok());
    const Snapshot now = rig.sim->latest();
    const auto q = now[Joint{0}].qpos;
    out.tilt_deg =
        std::max(out.tilt_deg, std::acos(1 - 2 * (q[4] * q[4] + q[5] * q[5])) * 180 / M_PI);
    if (i == 50) begin = q[0];
    if (i >= 50) out.low = std::min(out.low, q[2]), out.high = std::max(out.high, q[2]);
    if (rig.trot->fallen()) {
      out.fell = true;
      return out;
    }
    out.x = q[0], out.y = q[1];
    out.yaw = 2 * std::atan2(q[6], q[3]);
  }
  out.speed = (out.x - begin) / (duration - 1);
  out.prints = count_prints(rig.sim->latest(), 0.008, &out.deepest);
  return out;
}

// Snow that lies on the robot is gone within a second of trotting; one that stands keeps it.
TEST(TrotInSnow, ShedsWhatLiesOnIt) {
  const auto left_after = [](double speed, double seconds) {
    auto world = world_with_bed("snow", 6, 7, {.vx = speed});
    world->scene.weather = WeatherOptions{.snow_cover = 0.08};
    Trotting rig(world);
    EXPECT_TRUE(rig.sim->step(std::lround(seconds / 0.002)).ok());
    const Snapshot now = rig.sim->latest();
    const auto& left = now.data().effects.snow_left;
    std::vector<float> out(static_cast<size_t>(world->model->nbody), 1.0f);
    return left == nullptr ? out : *left;
  };
  const std::vector<float> trots = left_after(0.6, 1.6), stands = left_after(0, 1.6);
  for (size_t body = 1; body < trots.size(); ++body) {
    EXPECT_LT(trots[body], 0.1f) << "body " << body << ", 1.3 s of trotting";
    EXPECT_GT(stands[body], 0.9f) << "body " << body << ", which stands";
  }
}

void print(const std::string& name, const Walk& w) {
  fmt::print(
      "{:<12} {:>4} {:.3f} m/s, tilt {:4.1f} deg, height {:.3f} to {:.3f} m, {:2} prints, {:.3f} m "
      "deep\n",
      name, w.fell ? "FELL" : "-", w.speed, w.tilt_deg, w.low, w.high, w.prints, w.deepest);
}

TEST(TrotSoil, WalksOverDrySandAtItsSpeedAndLeavesSeparatePrints) {
  for (const double speed : {0.3, 0.5}) {
    const Walk w = walk(world_with_bed("dry_sand", -1, 4, {speed, 0, 0}), 6);
    print(fmt::format("sand, {}", speed), w);
    EXPECT_FALSE(w.fell);
    EXPECT_NEAR(w.speed, speed, 0.05 * speed);
    EXPECT_LT(w.tilt_deg, 6);
    EXPECT_LT(w.high - w.low, 0.015);
    EXPECT_NEAR(w.y, 0, 0.05);
    EXPECT_NEAR(w.yaw, 0, 0.05);
    // Some 14 strides of four feet, the hind ones in part where the fore ones were.
    EXPECT_GT(w.prints, 28);
    EXPECT_GT(w.deepest, 0.03);
  }
}

TEST(TrotSoil, StandsAndWalksOnGroundOfEveryKind) {
  for (const std::string kind :
       {"sandy_loam", "clayey_soil", "lean_clay", "snow", "mud", "lunar"}) {
    for (const double speed : {0.0, 0.4}) {
      const Walk w = walk(world_with_bed(kind, -1, 4, {speed, 0, 0}), 3);
      print(kind, w);
      EXPECT_FALSE(w.fell) << kind;
      EXPECT_NEAR(w.speed, speed, 0.03) << kind;
      EXPECT_LT(w.tilt_deg, 15) << kind;
    }
  }
}

TEST(TrotSoil, WalksFromRigidGroundOntoSandAndOffAgain) {
  const Walk w = walk(world_with_bed("dry_sand", 0.5, 2, {0.4, 0, 0}), 8);
  print("edges", w);
  EXPECT_FALSE(w.fell);
  EXPECT_GT(w.x, 2.6);
  EXPECT_NEAR(w.speed, 0.4, 0.02);
  EXPECT_LT(w.tilt_deg, 10);
  EXPECT_GT(w.prints, 10);
  const Walk back = walk(world_with_bed("dry_sand", -2, -0.5, {-0.3, 0, 0}), 9);
  print("backwards", back);
  EXPECT_FALSE(back.fell);
  EXPECT_LT(back.x, -2.4);
}

TEST(TrotSoil, RunsTheSameAfterAReset) {
  Trotting rig(world_with_bed("dry_sand", -1, 4, {0.4, 0.1, 0.3}));
  ASSERT_TRUE(rig.sim->step(700).ok());
  const uint64_t first = rig.sim->latest().hash();
  ASSERT_TRUE(rig.sim->reset().ok());
  ASSERT_TRUE(rig.sim->step(700).ok());
  EXPECT_EQ(rig.sim->latest().hash(), first);
}

}  // namespace
}  // namespace gloam

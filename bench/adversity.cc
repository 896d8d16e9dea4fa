// Effect of each level of adversity on sensors: visibility, illuminance, contrast of a camera and
// returns of a LiDAR at one place of each kind of environment (the table of docs/weather.md).
//
//   adversity [--seed N] [--spp N] [--json]

#include <fmt/format.h>

#include "bench/command_line.h"
#include "gloam/scene.h"
#include "runtime/live/live_simulation.h"
#include "runtime/recording/sensing_quality.h"
#include "sensors/lidar/lidar_sensor.h"
#include "sensors/probe/visibility_probe.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

struct Options {
  int seed = 1, spp = 64;
  bool json = false;
};

constexpr double kHeight = 0.6;  // of the sensors over the floor [m]

/// A camera and a LiDAR stand at `eye` and look along the longer side of where they are.
Scene equip(Scene scene, Vec3 eye, Vec3 target) {
  CameraOptions camera;
  camera.name = "camera";
  camera.position = eye;
  camera.look_at = target;
  camera.fovy = 60;
  camera.width = 320, camera.height = 240;
  camera.exposure_time = 0.01;
  scene.cameras = {camera};
  LidarOptions lidar;
  lidar.name = "lidar";
  lidar.position = eye;
  lidar.noise = true;
  lidar.truth = true;
  scene.lidars = {lidar};
  return scene;
}

struct Row {
  double visibility = 0, illuminance = 0, contrast = 0;
  double returns = 0, false_returns = 0;  ///< of all beams: of surfaces, of media
};

Result<Row> measure(const Scene& scene, Vec3 eye, const Options& options) {
  Row row;
  GLOAM_TRY(const World world, World::compile(scene));
  GLOAM_TRY(auto simulation, LiveSimulation::create(world, {.pace = Pace::kLockstep}));
  GLOAM_TRY_STATUS(simulation->step(100));
  GLOAM_TRY(auto solver, PoseSolver::create(world.compiled()));
  GLOAM_TRY(const auto shared, simulation->renderer());
  PoseFrame now;
  const Snapshot snapshot = simulation->latest();
  GLOAM_TRY_STATUS(solver->solve(snapshot, now));
  const Vec3f p{static_cast<float>(eye.x), static_cast<float>(eye.y), static_cast<float>(eye.z)};

  GLOAM_TRY(const VisibilityProbe probe, VisibilityProbe::make(*world.compiled()));
  row.visibility = probe.visibility(snapshot.data(), p);

  CameraRequest request;
  request.camera = "camera";
  request.outputs = {"radiance"};
  request.render.spp = options.spp;
  GLOAM_TRY(auto camera, CameraSensor::create(shared->description, request, 1));
  const auto frame = camera->capture(*shared->renderer, shared->turns, now, now, 0);
  row.contrast = contrast_of(frame->radiance, frame->intrinsics.width);
  row.illuminance = static_cast<double>(shared->renderer->illuminance(p, {0, 0, 1}));

  GLOAM_TRY(const auto lidars, describe_lidars(*world.compiled()));
  GLOAM_TRY(auto lidar, LidarSensor::create(shared->description, lidars.front(), 1));
  const std::vector<PoseFrame> keys{now, now};
  const auto scan = lidar->scan(*shared->renderer, shared->turns, keys, 0);
  const ReturnShares returns = returns_of(*scan);
  row.returns = returns.surfaces, row.false_returns = returns.media;
  return row;
}

/// A place, and where its sensors stand: in the middle of the largest floor of its first kind.
struct Place {
  const char* name;
  Scene scene;
  Vec3 eye, target;
};

Result<Place> make_place(const char* name, Scene scene) {
  GLOAM_TRY(const World world, World::compile(scene));
  Place place{name, std::move(scene), {0, 0, kHeight}, {1, 0, kHeight}};
  double largest = 0;
  for (const Region& region : world.compiled()->regions) {
    const double x = region.high.x - region.low.x, y = region.high.y - region.low.y;
    if (!(x * y > largest)) continue;
    largest = x * y;
    const double z = region.low.z + kHeight;
    const Vec3 c{(region.low.x + region.high.x) / 2, (region.low.y + region.high.y) / 2, z};
    place.eye = x > y ? Vec3{region.low.x + 0.3 * x, c.y, z} : Vec3{c.x, region.low.y + 0.3 * y, z};
    place.target = x > y ? Vec3{region.high.x, c.y, z} : Vec3{c.x, region.high.y, z};
  }
  return place;
}

Status run(const Options& options) {
  std::vector<Place> places;
  const auto seed = static_cast<uint64_t>(options.seed);
  Scene house, warehouse, terrain;
  house.environment.house.emplace().seed = seed;
  warehouse.environment.warehouse.emplace().seed = seed;
  terrain.environment.terrain.emplace().seed = seed;
  const auto add = [&](const char* name, Scene scene) -> Status {
    GLOAM_TRY(Place place, make_place(name, std::move(scene)));
    places.push_back(std::move(place));
    return {};
  };
  GLOAM_TRY_STATUS(add("house", std::move(house)));
  GLOAM_TRY_STATUS(add("warehouse", std::move(warehouse)));
  GLOAM_TRY_STATUS(add("terrain", std::move(terrain)));
  for (const Place& place : places) {
    Row fair;
    for (const char* level : {"none", "minor", "major"}) {
      Scene scene = equip(place.scene, place.eye, place.target);
      scene.adversity.emplace().level = level;
      GLOAM_TRY(const Row row, measure(scene, place.eye, options));
      if (std::string_view(level) == "none") fair = row;
      const char* text =
          options.json
              ? "{{\"name\": \"{} {}\", \"visibility_m\": {:.1f}, \"illuminance_lx\": {:.1f}, "
                "\"contrast\": {:.3f}, \"returns\": {:.3f}, \"false_returns\": {:.4f}}}\n"
              : "{:<10} {:<6} visibility {:>8.1f} m   illuminance {:>8.1f} lx   contrast {:>5.2f}  "
                " "
                "LiDAR returns {:>5.2f}, of media {:.3f} of beams\n";
      fmt::print(fmt::runtime(text), place.name, level, row.visibility, row.illuminance,
                 row.contrast / fair.contrast, row.returns / fair.returns, row.false_returns);
      std::fflush(stdout);
    }
  }
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::Options options;
  gloam::CommandLine line(argc, argv);
  options.json = line.flag("--json");
  line.value("--seed", &options.seed);
  line.value("--spp", &options.spp);
  if (!line.words().empty()) {
    fmt::print(stderr, "usage: adversity [--seed N] [--spp N] [--json]\n");
    return 2;
  }
  return gloam::exit_code(gloam::run(options));
}

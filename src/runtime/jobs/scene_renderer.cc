// gloam::SceneRenderer: cameras and LiDARs on given Snapshots.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/text.h"
#include "gloam/render.h"
#include "runtime/rendering/shared_renderer.h"
#include "runtime/streams/live_lidar.h"
#include "sensors/camera/camera_sensor.h"
#include "sensors/lidar/lidar_sensor.h"
#include "sim/snapshots/pose_solver.h"
#include "world/sensors/camera_rate.h"

namespace gloam {
namespace {

// Requests of which this is equal are taken by one CameraSensor: it keeps what it needs from
// picture to picture.
std::string key_of(const CameraRequest& request) {
  const RenderOptions& r = request.render;
  std::string key =
      fmt::format("{} {}x{} {} {} {} {} {} {} {}", request.camera, request.width, request.height,
                  to_string(r.tier), r.samples(), r.error.value_or(0), r.max_depth.value_or(0),
                  r.denoise, r.ev100.has_value(), r.ev100.value_or(0));
  for (const std::string& output : request.outputs) key += " " + output;
  return key;
}

}  // namespace

struct SceneRenderer::State {
  struct OpenCamera {
    std::unique_ptr<CameraSensor> sensor;
    PoseFrame previous;
    bool has_previous = false;
  };

  std::shared_ptr<SharedRenderer> shared;
  std::unique_ptr<PoseSolver> solver;
  std::map<std::string, OpenCamera> cameras;
  std::map<std::string, std::unique_ptr<LidarSensor>> lidars;
  std::vector<PoseFrame> keys;

  const CompiledWorld& world() const { return *shared->world; }
  Status solve(std::span<const Snapshot> snapshots);
  Result<OpenCamera*> camera(const CameraRequest& request);
  Result<LidarSensor*> lidar(const std::string& name);
};

Status SceneRenderer::State::solve(std::span<const Snapshot> snapshots) {
  keys.resize(snapshots.size());
  for (size_t i = 0; i < snapshots.size(); ++i) {
    if (!snapshots[i]) return Error{ErrorKind::kUsage, "the Snapshot is empty"};
    if (snapshots[i].data().world != shared->world)
      return Error{ErrorKind::kUsage,
                   "the Snapshot belongs to another World than the renderer",
                   {},
                   "create a SceneRenderer for Snapshot::world()"};
    GLOAM_TRY_STATUS(solver->solve(snapshots[i], keys[i]));
  }
  return {};
}

Result<SceneRenderer::State::OpenCamera*> SceneRenderer::State::camera(
    const CameraRequest& request) {
  if (std::ranges::count(request.outputs, "events") > 0)
    return Error{ErrorKind::kInput, fmt::format("camera '{}': events need all frames up to a time "
                                                "and are not available for single images",
                                                request.camera)};
  OpenCamera& open = cameras[key_of(request)];
  if (open.sensor != nullptr) return &open;
  CameraRequest own = request;
  if (own.rate.num == 0) own.rate = own_camera_rate(world().scene, own.camera);
  auto sensor = CameraSensor::create(shared->description, own, world().scene.sim.seed);
  Status status = sensor.ok() ? (*sensor)->set_temperatures(world().scene.temperatures)
                              : Status(sensor.error());
  if (!status.ok()) {
    cameras.erase(key_of(request));
    return status.error();
  }
  open.sensor = std::move(*sensor);
  return &open;
}

Result<LidarSensor*> SceneRenderer::State::lidar(const std::string& name) {
  const auto known = lidars.find(name);
  if (known != lidars.end()) return known->second.get();
  GLOAM_TRY(const LidarDescription description, find_lidar(world(), name));
  GLOAM_TRY(auto sensor,
            LidarSensor::create(shared->description, description, world().scene.sim.seed));
  return (lidars[name] = std::move(sensor)).get();
}

SceneRenderer::SceneRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;
SceneRenderer::~SceneRenderer() = default;

Result<SceneRenderer> SceneRenderer::create(const World& world) {
  auto state = std::make_unique<State>();
  GLOAM_TRY(state->shared, SharedRenderer::create(world.compiled()));
  GLOAM_TRY(state->solver, PoseSolver::create(world.compiled()));
  return SceneRenderer(std::move(state));
}

Result<std::shared_ptr<const CameraFrame>> SceneRenderer::render(std::span<const Snapshot> exposure,
                                                                 const CameraRequest& request,
                                                                 int64_t frame_index) {
  State& s = *state_;
  if (exposure.empty()) return Error{ErrorKind::kUsage, "rendering an image requires a Snapshot"};
  GLOAM_TRY_STATUS(s.solve(exposure));
  GLOAM_TRY(State::OpenCamera* const camera, s.camera(request));
  std::vector<const PoseFrame*> keys;
  for (const PoseFrame& key : s.keys) keys.push_back(&key);
  PoseFrame& now = s.keys.front();
  const bool follows =
      camera->has_previous && camera->previous.run == now.run && camera->previous.step <= now.step;
  auto frame = camera->sensor->capture(*s.shared->renderer, s.shared->turns, keys,
                                       follows ? camera->previous : now, frame_index);
  camera->previous = now;
  camera->has_previous = true;
  return frame;
}

Result<std::shared_ptr<const LidarScan>> SceneRenderer::scan(std::span<const Snapshot> sweep,
                                                             const LidarRequest& request,
                                                             int64_t scan_index) {
  State& s = *state_;
  if (sweep.size() < 2)
    return Error{ErrorKind::kUsage, "a scan requires the Snapshots of its start and its end"};
  GLOAM_TRY_STATUS(s.solve(sweep));
  GLOAM_TRY(LidarSensor* const lidar, s.lidar(request.lidar));
  return lidar->scan(*s.shared->renderer, s.shared->turns, s.keys, scan_index);
}

}  // namespace gloam

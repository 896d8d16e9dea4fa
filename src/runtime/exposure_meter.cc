#include "runtime/exposure_meter.h"

#include <algorithm>
#include <chrono>

#include "base/log.h"

namespace gloam {
namespace {

constexpr int kProbeWidth = 32;  // [px]
constexpr int kProbeSamples = 4;
constexpr size_t kRemembered = 256;

CameraRequest probe_request(const CameraOptions& camera, int max_depth) {
  CameraRequest request;
  request.camera = camera.name;
  request.rate = camera.rate;
  request.width = kProbeWidth;
  request.height = std::max(1, kProbeWidth * camera.height / camera.width);
  request.outputs = {"radiance"};
  request.render = {.tier = "path", .spp = kProbeSamples, .max_depth = max_depth, .denoise = false};
  return request;
}

}  // namespace

Result<std::unique_ptr<ExposureMeter>> ExposureMeter::open(Simulator& simulator,
                                                           SharedRenderers& renderers,
                                                           const CameraOptions& camera,
                                                           uint64_t seed, bool required) {
  std::unique_ptr<ExposureMeter> meter(new ExposureMeter(simulator, renderers, camera, seed));
  meter->required_ = required;
  GLOAM_TRY_STATUS(meter->follow(simulator.world()));
  GLOAM_TRY(meter->queue_, simulator.subscribe({.rate = camera.rate,
                                                .due = due_steps(meter->timing_),
                                                .required = required,
                                                .capacity = 2}));
  meter->thread_ = std::thread([raw = meter.get()] { raw->run(); });
  return meter;
}

// Makes what meters a World: at first, and when a Snapshot of another one comes. The exposure goes
// on from where it was.
Status ExposureMeter::follow(const std::shared_ptr<const CompiledWorld>& world) {
  const auto& cameras = world->scene.cameras;
  const auto camera = std::find_if(cameras.begin(), cameras.end(), [this](const CameraOptions& c) {
    return c.name == camera_ && c.sensing.imager && c.sensing.imager->auto_exposure;
  });
  if (camera == cameras.end())
    return Error{ErrorKind::kInput, "camera '" + camera_ + "' has no automatic exposure any more"};
  GLOAM_TRY(auto shared, renderers_.of(world));
  GLOAM_TRY(auto probe,
            CameraSensor::create(shared->description,
                                 probe_request(*camera, world->scene.render.max_depth), seed_));
  GLOAM_TRY(auto solver, PoseSolver::create(world));
  GLOAM_TRY(SensorTiming timing,
            SensorTiming::make(camera->rate, camera->sensing.timing.value_or(TimingOptions{}),
                               simulator_.timestep(), sensor_seed(seed_, camera_)));
  const std::lock_guard lock(mutex_);
  if (probe_ != nullptr && !timing.same_steps(timing_))
    return other_schedule("camera '" + camera_ + "'");
  timing_ = timing;
  probe_ = std::move(probe);
  shared_ = std::move(shared);
  solver_ = std::move(solver);
  return {};
}

ExposureMeter::~ExposureMeter() {
  if (queue_ != nullptr) queue_->close();
  if (thread_.joinable()) thread_.join();
}

void ExposureMeter::run() {
  PoseFrame poses;
  int64_t last_step = -1;
  while (const Snapshot snapshot = queue_->next()) {
    const auto& world = snapshot.data().world;
    if (world != shared_->world) {
      if (const Status status = follow(world); !status.ok()) {
        log_warning("an exposure meter stopped: {}", status.error().to_string());
        break;
      }
    }
    if (const Status status = solver_->solve(snapshot, poses); !status.ok()) {
      log_error("an exposure meter lost its poses: {}", status.error().to_string());
      break;
    }
    const auto picture = probe_->capture(*shared_->renderer, shared_->mutex, poses, poses,
                                         timing_.last_at_or_before(snapshot.step()));
    const Intrinsics& k = picture->intrinsics;
    automatic_.meter(metered_luminance(picture->radiance.data(), k.width, k.height,
                                       options_.metering == "center"),
                     snapshot.time());
    {
      const std::lock_guard lock(mutex_);
      if (snapshot.step() <= last_step) values_.clear();  // the simulation began anew
      values_[snapshot.step()] = newest_ = automatic_.ev100();
      if (values_.size() > kRemembered) values_.erase(values_.begin());
    }
    last_step = snapshot.step();
    changed_.notify_all();
  }
  queue_->close();  // the simulation must not wait for it
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

bool ExposureMeter::ended() {
  const std::lock_guard lock(mutex_);
  return ended_;
}

double ExposureMeter::ev100_at(int64_t step) {
  std::unique_lock lock(mutex_);
  const int64_t due = timing_.step_of(std::max<int64_t>(0, timing_.last_at_or_before(step)));
  const auto known = [&] {
    return ended_ || values_.contains(due) || (!values_.empty() && values_.begin()->first > due);
  };
  if (required_) {
    changed_.wait(lock, known);
  } else {
    constexpr auto kPatience = std::chrono::milliseconds(50);
    changed_.wait_for(lock, kPatience, known);
  }
  const auto found = values_.find(due);
  return found != values_.end() ? found->second : newest_;
}

}  // namespace gloam

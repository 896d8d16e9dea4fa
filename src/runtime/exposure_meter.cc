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
                                                           std::shared_ptr<SharedRenderer> shared,
                                                           const CameraOptions& camera,
                                                           int max_depth, uint64_t seed,
                                                           bool required) {
  std::unique_ptr<ExposureMeter> meter(
      new ExposureMeter(std::move(shared), *camera.sensing.imager->auto_exposure));
  meter->required_ = required;
  GLOAM_TRY(meter->probe_, CameraSensor::create(meter->shared_->description,
                                                probe_request(camera, max_depth), seed));
  const std::shared_ptr<const CompiledWorld> world(std::shared_ptr<void>(), &simulator.world());
  GLOAM_TRY(meter->solver_, PoseSolver::create(world));
  GLOAM_TRY(meter->timing_,
            SensorTiming::make(camera.rate, camera.sensing.timing.value_or(TimingOptions{}),
                               simulator.timestep(), sensor_seed(seed, camera.name)));
  GLOAM_TRY(meter->queue_, simulator.subscribe({.rate = camera.rate,
                                                .due = due_steps(meter->timing_),
                                                .required = required,
                                                .capacity = 2}));
  meter->thread_ = std::thread([raw = meter.get()] { raw->run(); });
  return meter;
}

ExposureMeter::~ExposureMeter() {
  if (queue_ != nullptr) queue_->close();
  if (thread_.joinable()) thread_.join();
}

void ExposureMeter::run() {
  PoseFrame poses;
  int64_t last_step = -1;
  while (const Snapshot snapshot = queue_->next()) {
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
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

double ExposureMeter::ev100_at(int64_t step) {
  const int64_t due = timing_.step_of(std::max<int64_t>(0, timing_.last_at_or_before(step)));
  std::unique_lock lock(mutex_);
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

#include "runtime/live_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <utility>

#include "base/log.h"
#include "base/memory.h"

namespace gloam {
namespace {

// Streams of which this is equal draw the same pictures of a camera.
std::string pictures_of(const CameraRequest& request, const Intrinsics& k) {
  const RenderOptions& render = request.render;
  return fmt::format("{} {} {}x{} {} {} {} {} {} {}", request.camera, request.rate.value(), k.width,
                     k.height, render.tier, render.samples(), render.error.value_or(0),
                     render.max_depth, render.denoise, render.ev100.value_or(NAN));
}

}  // namespace

LiveCamera::LiveCamera(Simulator& simulator, std::shared_ptr<SharedRenderer> shared,
                       FrameCallback on_frame)
    : simulator_(simulator), shared_(std::move(shared)), on_frame_(std::move(on_frame)) {}

Result<std::unique_ptr<LiveCamera>> LiveCamera::open(Simulator& simulator,
                                                     std::shared_ptr<SharedRenderer> shared,
                                                     const CameraRequest& request, uint64_t seed,
                                                     FrameCallback on_frame,
                                                     std::shared_ptr<ExposureMeter> meter) {
  std::unique_ptr<LiveCamera> camera(
      new LiveCamera(simulator, std::move(shared), std::move(on_frame)));
  GLOAM_TRY(camera->sensor_, CameraSensor::create(camera->shared_->description, request, seed));
  GLOAM_TRY_STATUS(camera->sensor_->set_temperatures(simulator.world().scene.temperatures));
  const Intrinsics& k = camera->sensor_->intrinsics();
  if (const auto own = camera->sensor_->events()) {
    auto events = camera->shared_->events.share(pictures_of(request, k), own);
    if (request.required) camera->lead_.emplace(events);
    camera->sensor_->share_events(std::move(events), request.required);
  }
  const PictureMemory memory = camera->sensor_->memory();
  constexpr uint64_t kInFlight = 2;  // frames that are made and looked at
  GLOAM_TRY_STATUS(check_memory(
      memory.working + kInFlight * memory.frame,
      fmt::format("camera '{}': pictures of {} x {} pixels", request.camera, k.width, k.height),
      "lower the resolution"));
  const std::shared_ptr<const CompiledWorld> world(std::shared_ptr<void>(), &simulator.world());
  GLOAM_TRY(camera->solver_, PoseSolver::create(world));
  const std::optional<TimingOptions>& timing = camera->sensor_->sensing().timing;
  GLOAM_TRY(camera->timing_,
            SensorTiming::make(request.rate, timing.value_or(TimingOptions{}), simulator.timestep(),
                               sensor_seed(seed, request.camera)));
  camera->meter_ = std::move(meter);
  // Two in the queue keep the camera busy; more would only make a live picture older.
  const int capacity = request.required ? 2 : 1;
  GLOAM_TRY(camera->queue_,
            simulator.subscribe({.rate = request.rate,
                                 .due = timing ? due_steps(camera->timing_) : nullptr,
                                 .required = request.required,
                                 .capacity = capacity,
                                 .window = camera->sensor_->window()}));
  camera->required_ = request.required;
  camera->thread_ = std::thread([raw = camera.get()] { raw->run(); });
  return camera;
}

LiveCamera::~LiveCamera() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  if (queue_ != nullptr) queue_->close();  // null when open() failed
  if (thread_.joinable()) thread_.join();
}

void LiveCamera::drain() {
  if (thread_.joinable()) thread_.join();
}

void LiveCamera::set_pose(const Pose& X_WC) { sensor_->set_free_pose(X_WC); }

void LiveCamera::refresh() {
  {
    const std::lock_guard lock(mutex_);
    refresh_wanted_ = true;
  }
  changed_.notify_all();
}

SnapshotWindow LiveCamera::wait_for_work() {
  if (required_) return queue_->next_window();
  // A live camera also answers refresh() while the simulation is paused, so it looks at both.
  constexpr auto kLook = std::chrono::milliseconds(4);
  std::unique_lock lock(mutex_);
  for (;;) {
    if (closing_) return {};
    if (SnapshotWindow window = queue_->try_next_window()) return window;
    if (queue_->closed()) return {};
    if (std::exchange(refresh_wanted_, false)) {  // an instant: nothing moves
      SnapshotWindow window;
      window.add(simulator_.latest());
      return window;
    }
    changed_.wait_for(lock, kLook);
  }
}

void LiveCamera::run() {
  try {
    while (const SnapshotWindow window = wait_for_work()) capture(window);
  } catch (const std::bad_alloc&) {
    const Intrinsics& k = sensor_->intrinsics();
    const std::lock_guard lock(mutex_);
    status_ = Error{ErrorKind::kPartial,
                    fmt::format("out of memory for pictures of {} x {} pixels", k.width, k.height),
                    {},
                    "lower the resolution"};
    if (!required_) log_error("a camera stopped: {}", status_.error().to_string());
    queue_->close();  // the simulation must not wait for it
  }
  lead_.reset();
}

Status LiveCamera::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void LiveCamera::capture(const SnapshotWindow& window) {
  const int64_t step = window.all().front().step();
  const int64_t index = std::max<int64_t>(0, timing_.last_at_or_before(step));
  if (timing_.step_of(index) == step && timing_.dropped(index)) return;
  keys_.resize(std::max(keys_.size(), static_cast<size_t>(window.count)));
  std::vector<const PoseFrame*> keys;
  for (const Snapshot& snapshot : window.all()) {
    PoseFrame& key = keys_[keys.size()];
    if (const Status status = solver_->solve(snapshot, key); !status.ok()) {
      log_error("a camera lost its poses: {}", status.error().to_string());
      return;
    }
    keys.push_back(&key);
  }
  if (meter_ != nullptr) sensor_->set_ev100(meter_->ev100_at(step));
  PoseFrame& now = keys_.front();
  const bool continuous = has_previous_ && previous_.step <= now.step;
  auto frame = sensor_->capture(*shared_->renderer, shared_->mutex, keys,
                                continuous ? previous_ : now, index);
  on_frame_(std::move(frame));
  std::swap(now, previous_);
  has_previous_ = true;
}

}  // namespace gloam

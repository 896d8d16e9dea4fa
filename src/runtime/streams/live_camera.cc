#include "runtime/streams/live_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/log.h"
#include "base/memory.h"
#include "world/sensors/camera_rate.h"

namespace gloam {
namespace {

// Streams of which this is equal draw the same pictures of a camera.
std::string pictures_of(const CameraRequest& request, const Intrinsics& k) {
  const RenderOptions& render = request.render;
  return fmt::format("{} {} {}x{} {} {} {} {} {} {}", request.camera, request.rate.value(), k.width,
                     k.height, to_string(render.tier), render.samples(), render.error.value_or(0),
                     render.max_depth.value_or(0), render.denoise, render.ev100.value_or(NAN));
}

}  // namespace

LiveCamera::LiveCamera(const StreamContext& context, const CameraRequest& request,
                       FrameCallback on_frame, const ExposureMeters& meters)
    : simulator_(context.simulator),
      renderers_(context.renderers),
      request_(request),
      seed_(context.seed),
      on_frame_(std::move(on_frame)),
      meters_(meters) {}

Result<std::unique_ptr<LiveCamera>> LiveCamera::open(const StreamContext& context,
                                                     const CameraRequest& request,
                                                     FrameCallback on_frame,
                                                     const ExposureMeters& meters) {
  Simulator& simulator = context.simulator;
  CameraRequest wanted = request;
  if (wanted.rate.num == 0) wanted.rate = own_camera_rate(simulator.world()->scene, wanted.camera);
  std::unique_ptr<LiveCamera> camera(new LiveCamera(context, wanted, std::move(on_frame), meters));
  GLOAM_TRY_STATUS(camera->follow(simulator.world()));
  // Two in the queue keep the camera busy; more would only make a live picture older.
  const int capacity = request.required ? 2 : 1;
  const bool timed = camera->sensor_->sensing().timing.has_value();
  GLOAM_TRY(auto queue, simulator.subscribe({.rate = wanted.rate,
                                             .due = timed ? due_steps(camera->timing_) : nullptr,
                                             .required = request.required,
                                             .sensor = !request.is_view,
                                             .capacity = capacity,
                                             .window = camera->sensor_->window()}));
  camera->queue_ = queue;
  camera->account_ = context.costs.open(
      fmt::format("{} '{}'", request.is_view ? "view of" : "camera", wanted.camera),
      wanted.rate.value());
  LiveCamera* const raw = camera.get();
  camera->thread_.start(std::move(queue),
                        {.what = fmt::format("camera '{}'", wanted.camera),
                         .memory_hint = "lower the resolution",
                         .take = [raw](const SnapshotWindow& window) { return raw->take(window); },
                         .next = [raw] { return raw->next_window(); },
                         .finish = [raw] { raw->lead_.reset(); },
                         .on_end = wanted.on_end,
                         .account = camera->account_,
                         .waited = [raw] { return raw->sensor_->waited(); }});
  return camera;
}

// Creates the camera of a World: at first, and when a Snapshot of another World arrives.
Status LiveCamera::follow(const std::shared_ptr<const CompiledWorld>& world) {
  GLOAM_TRY(auto shared, renderers_.of(world));
  GLOAM_TRY(auto sensor, CameraSensor::create(shared->description, request_, seed_));
  GLOAM_TRY_STATUS(sensor->set_temperatures(world->scene.temperatures));
  sensor->set_progress([this](double part) {
    part_ = part;
    return !thread_.is_abandoned();
  });
  const Intrinsics& k = sensor->intrinsics();
  const PictureMemory memory = sensor->memory();
  constexpr uint64_t kInFlight = 2;  // frames that are made and looked at
  GLOAM_TRY_STATUS(check_memory(
      memory.working + kInFlight * memory.frame,
      fmt::format("camera '{}': images of {} x {} pixels", request_.camera, k.width, k.height),
      "lower the resolution"));
  GLOAM_TRY(auto solver, PoseSolver::create(world));
  GLOAM_TRY(SensorTiming timing,
            SensorTiming::make(request_.rate, sensor->sensing().timing.value_or(TimingOptions{}),
                               simulator_.timestep(), sensor_seed(seed_, request_.camera)));
  if (sensor_ != nullptr) {
    if (!timing.same_steps(timing_) || sensor->window() != sensor_->window())
      return other_schedule(fmt::format("camera '{}'", request_.camera));
    sensor->set_free_pose(sensor_->free_pose());
  }
  lead_.reset();
  if (const auto own = sensor->events()) {
    auto events = shared->events.share(pictures_of(request_, k), own);
    if (request_.required) lead_.emplace(events);
    sensor->share_events(std::move(events), request_.required);
  }
  const std::lock_guard lock(mutex_);
  sensor_ = std::move(sensor);
  shared_ = std::move(shared);
  solver_ = std::move(solver);
  timing_ = timing;
  has_previous_ = false;
  meter_ = nullptr;
  return {};
}

void LiveCamera::set_pose(const Pose& X_WC) {
  const std::lock_guard lock(mutex_);
  sensor_->set_free_pose(X_WC);
}

Pose LiveCamera::pose() const {
  const std::lock_guard lock(mutex_);
  return sensor_->free_pose();
}

void LiveCamera::refresh() {
  refresh_wanted_ = true;
  queue_->wake();
}

void LiveCamera::show(const Snapshot& snapshot) {
  {
    const std::lock_guard lock(mutex_);
    shown_ = snapshot;
  }
  refresh();
}

Snapshot LiveCamera::take_shown() {
  const std::lock_guard lock(mutex_);
  return std::exchange(shown_, {});
}

SnapshotWindow LiveCamera::next_window() {
  if (request_.required) return queue_->next_window();
  for (;;) {
    if (SnapshotWindow window = queue_->next_window_or_wake()) return window;
    if (queue_->closed()) return {};
    if (refresh_wanted_.exchange(false)) {  // an instant: nothing moves
      SnapshotWindow window;
      const Snapshot shown = take_shown();
      window.add(shown ? shown : simulator_.latest());
      queue_->count_own();
      return window;
    }
  }
}

void LiveCamera::set_outputs(std::vector<std::string> outputs) {
  const std::lock_guard lock(mutex_);
  wanted_outputs_ = std::move(outputs);
}

bool LiveCamera::has_made(const std::string& output) const {
  return std::ranges::count(request_.outputs, output) > 0;
}

bool LiveCamera::take_outputs() {
  const std::lock_guard lock(mutex_);
  if (!wanted_outputs_) return false;
  const bool is_change = *wanted_outputs_ != request_.outputs;
  request_.outputs = *std::exchange(wanted_outputs_, {});
  return is_change;
}

Status LiveCamera::take(const SnapshotWindow& window) {
  const auto& world = window.keys[0].data().world;
  if (take_outputs() || world != shared_->world) GLOAM_TRY_STATUS(follow(world));
  return capture(window);
}

Status LiveCamera::capture(const SnapshotWindow& window) {
  const int64_t step = window.all().front().step();
  const int64_t index = std::max<int64_t>(0, timing_.last_at_or_before(step));
  if (timing_.step_of(index) == step && timing_.dropped(index)) return {};
  keys_.resize(std::max(keys_.size(), static_cast<size_t>(window.count)));
  std::vector<const PoseFrame*> keys;
  for (const Snapshot& snapshot : window.all()) {
    PoseFrame& key = keys_[keys.size()];
    if (const Status status = solver_->solve(snapshot, key); !status.ok()) {
      log_error("cannot compute the poses of a camera: {}", status.error().to_string());
      return {};
    }
    keys.push_back(&key);
  }
  if (meter_ == nullptr) meter_ = meters_.of(request_.camera, *shared_->world);
  if (meter_ != nullptr) sensor_->set_ev100(meter_->ev100_at(step));
  PoseFrame& now = keys_.front();
  const bool continuous = has_previous_ && previous_.step <= now.step;
  const bool still = keys.size() == 1;
  sensor_->set_same_instant(!request_.required && still && previous_is_still_ && has_previous_ &&
                            previous_.step == now.step && previous_.run == now.run);
  previous_is_still_ = still;
  auto frame = sensor_->capture(*shared_->renderer, shared_->turns, keys,
                                continuous ? previous_ : now, index);
  part_ = 0;
  if (frame == nullptr || thread_.is_abandoned()) return {};
  const double time = frame->time;
  on_frame_(std::move(frame));
  account_->add_message(time);
  std::swap(now, previous_);
  has_previous_ = true;
  return {};
}

}  // namespace gloam

#include "runtime/streams/exposure_meter.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/log.h"

namespace gloam {
namespace {

constexpr int kProbeWidth = 32;  // [px]
constexpr int kProbeSamples = 8;
constexpr size_t kMaxStoredValues = 256;

CameraRequest probe_request(const CameraOptions& camera, std::optional<int> max_depth) {
  CameraRequest request;
  request.camera = camera.name;
  request.rate = camera.rate;
  request.width = kProbeWidth;
  request.height = std::max(1, kProbeWidth * camera.height / camera.width);
  request.outputs = {"radiance"};
  request.render = {
      .tier = RenderTier::kPath, .spp = kProbeSamples, .max_depth = max_depth, .denoise = false};
  return request;
}

bool is_metered(const CameraOptions& camera) {
  return camera.sensing.imager && camera.sensing.imager->auto_exposure;
}

// Null where it is not metered.
const CameraOptions* find_metered(const CompiledWorld& world, const std::string& name) {
  const auto& cameras = world.scene.cameras;
  const auto camera = std::ranges::find(cameras, name, &CameraOptions::name);
  return camera != cameras.end() && is_metered(*camera) ? &*camera : nullptr;
}

Result<SensorTiming> timing_of(const CameraOptions& camera, Rational timestep, uint64_t seed) {
  return SensorTiming::make(camera.rate, camera.sensing.timing.value_or(TimingOptions{}), timestep,
                            sensor_seed(seed, camera.name));
}

}  // namespace

Result<std::unique_ptr<ExposureMeter>> ExposureMeter::open(const StreamContext& context,
                                                           const CameraOptions& camera,
                                                           bool required) {
  Simulator& simulator = context.simulator;
  GLOAM_TRY(const SensorTiming timing, timing_of(camera, simulator.timestep(), context.seed));
  std::unique_ptr<ExposureMeter> meter(new ExposureMeter(context, camera, timing, required));
  GLOAM_TRY_STATUS(meter->follow(simulator.world()));
  GLOAM_TRY(auto queue, simulator.subscribe({.rate = camera.rate,
                                             .due = due_steps(timing),
                                             .required = required,
                                             .sensor = true,
                                             .capacity = 2}));
  meter->account_ =
      context.costs.open(fmt::format("exposure of camera '{}'", camera.name), camera.rate.value());
  // Between two of its instants it begins with the present one: no picture waits for the next,
  // which the simulation may not reach before that picture is made.
  if (const Snapshot now = simulator.latest(); meter->instant_of(now.step()) < now.step())
    GLOAM_TRY_STATUS(meter->meter(now));
  ExposureMeter* const raw = meter.get();
  meter->thread_.start(std::move(queue),
                       {.what = fmt::format("the exposure meter of camera '{}'", camera.name),
                        .take = [raw](const SnapshotWindow& now) { return raw->take(now.keys[0]); },
                        .finish =
                            [raw] {
                              raw->release_world();
                              const std::lock_guard lock(raw->mutex_);
                              raw->ended_ = true;
                              raw->changed_.notify_all();
                            },
                        .on_end =
                            [name = camera.name](const Error& why) {
                              if (why.kind == ErrorKind::kInterrupted) return;
                              log_error("the exposure meter of camera '{}' stopped: {}", name,
                                        why.to_string());
                            },
                        .account = meter->account_,
                        .waited = [raw] { return raw->probe_->waited(); }});
  return meter;
}

// Makes what meters a World: at first, and when a Snapshot of another one comes. The exposure goes
// on from where it was, as the new World's camera says.
Status ExposureMeter::follow(const std::shared_ptr<const CompiledWorld>& world) {
  const CameraOptions& camera = *find_metered(*world, camera_);
  GLOAM_TRY(auto shared, renderers_.of(world));
  GLOAM_TRY(probe_,
            CameraSensor::create(shared->description,
                                 probe_request(camera, world->scene.render.max_depth), seed_));
  GLOAM_TRY(solver_, PoseSolver::create(world));
  shared_ = std::move(shared);
  automatic_.set_options(*camera.sensing.imager->auto_exposure);
  return {};
}

// Pictures of its World may still ask for its values.
void ExposureMeter::release_world() {
  probe_.reset();
  solver_.reset();
  shared_.reset();
}

bool ExposureMeter::goes_on_in(const CompiledWorld& world) const {
  const CameraOptions* camera = find_metered(world, camera_);
  if (camera == nullptr) return false;
  const auto timing = timing_of(*camera, simulator_.timestep(), seed_);
  return timing.ok() && timing->same_steps(timing_);
}

Status ExposureMeter::take(const Snapshot& snapshot) {
  const auto& world = snapshot.data().world;
  if (world != shared_->world) {
    if (!goes_on_in(*world))
      return Error{ErrorKind::kInterrupted, "another meter is open for this World"};
    GLOAM_TRY_STATUS(follow(world));
  }
  GLOAM_TRY_STATUS(meter(snapshot));
  account_->add_message(snapshot.time());
  return {};
}

int64_t ExposureMeter::instant_of(int64_t step) const {
  return timing_.step_of(std::max<int64_t>(0, timing_.last_at_or_before(step)));
}

Status ExposureMeter::meter(const Snapshot& snapshot) {
  GLOAM_TRY_STATUS(solver_->solve(snapshot, poses_));
  const auto picture = probe_->capture(*shared_->renderer, shared_->turns, poses_, poses_,
                                       timing_.last_at_or_before(snapshot.step()));
  const Intrinsics& k = picture->intrinsics;
  const AutoExposureOptions& options = automatic_.options();
  const MeterImage image{k.width, k.height, options.metering == "center", saturation_of(options)};
  automatic_.meter(metered_luminance(picture->radiance.data(), image), snapshot.time());
  const std::lock_guard lock(mutex_);
  const int64_t instant = instant_of(snapshot.step());
  if (!values_.empty() && instant <= values_.rbegin()->first)
    values_.clear();  // the simulation was reset
  values_[instant] = newest_ = automatic_.ev100();
  if (values_.size() > kMaxStoredValues) values_.erase(values_.begin());
  changed_.notify_all();
  return {};
}

double ExposureMeter::ev100_at(int64_t step) {
  std::unique_lock lock(mutex_);
  const int64_t due = instant_of(step - 1);
  const auto known = [&] {
    return ended_ || values_.contains(due) || (!values_.empty() && values_.begin()->first > due);
  };
  if (required_) {
    changed_.wait(lock, known);
  } else {
    constexpr auto kWaitTimeout = std::chrono::milliseconds(50);
    changed_.wait_for(lock, kWaitTimeout, known);
  }
  if (values_.empty()) return newest_;
  const auto after = values_.upper_bound(due);
  return (after == values_.begin() ? after : std::prev(after))->second;
}

Status ExposureMeters::open(const StreamContext& context) {
  const std::shared_ptr<const CompiledWorld> world = context.simulator.world();
  ByCamera before, meters;
  {
    const std::lock_guard lock(mutex_);
    if (!worlds_.empty()) before = worlds_.back().meters;
  }
  for (const CameraOptions& camera : world->scene.cameras) {
    if (!is_metered(camera)) continue;
    std::shared_ptr<ExposureMeter>& meter = meters[camera.name];
    const auto found = before.find(camera.name);
    if (found != before.end() && found->second->goes_on_in(*world)) {
      meter = found->second;
    } else {
      GLOAM_TRY(meter, ExposureMeter::open(context, camera, required_));
    }
  }
  const std::lock_guard lock(mutex_);
  std::erase_if(worlds_, [&](const OfWorld& entry) {
    return entry.world.expired() || entry.world.lock() == world;
  });
  worlds_.push_back({world, std::move(meters)});
  return {};
}

std::shared_ptr<ExposureMeter> ExposureMeters::of(const std::string& camera,
                                                  const CompiledWorld& world) const {
  const std::lock_guard lock(mutex_);
  for (const OfWorld& entry : worlds_) {
    if (entry.world.lock().get() != &world) continue;
    const auto found = entry.meters.find(camera);
    if (found != entry.meters.end()) return found->second;
  }
  return nullptr;
}

}  // namespace gloam

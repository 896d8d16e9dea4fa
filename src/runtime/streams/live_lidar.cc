#include "runtime/streams/live_lidar.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/log.h"
#include "base/text.h"

namespace gloam {
Result<LidarDescription> find_lidar(const CompiledWorld& world, const std::string& name) {
  GLOAM_TRY(const std::vector<LidarDescription> lidars, describe_lidars(world));
  std::vector<std::string> names;
  for (const LidarDescription& lidar : lidars) {
    if (lidar.options.name == name) return lidar;
    names.push_back(lidar.options.name);
  }
  return Error{ErrorKind::kInput,
               fmt::format("there is no lidar '{}'", name),
               {},
               names.empty() ? "the scene has no [[lidar]]" : suggest_name(name, names)};
}

int motion_stretches(Rational rate, Rational timestep, int wanted) {
  // Steps of a scan: an integer, or divided as requested.
  const __int128 num = static_cast<__int128>(rate.den) * timestep.den;
  const __int128 den = static_cast<__int128>(rate.num) * timestep.num;
  if (num < den) return 1;
  const __int128 steps = num / den;
  const int most = static_cast<int>(std::min<__int128>(steps, 64));
  wanted = std::min(wanted, most);
  if (num % den != 0) return wanted;
  for (int n = wanted; n <= most; ++n) {
    if (steps % n == 0) return n;
  }
  return wanted;
}

LiveLidar::LiveLidar(const StreamContext& context, const LidarRequest& request,
                     ScanCallback on_scan)
    : simulator_(context.simulator),
      renderers_(context.renderers),
      request_(request),
      seed_(context.seed),
      on_scan_(std::move(on_scan)) {}

Result<std::unique_ptr<LiveLidar>> LiveLidar::open(const StreamContext& context,
                                                   const LidarRequest& request,
                                                   ScanCallback on_scan) {
  Simulator& simulator = context.simulator;
  std::unique_ptr<LiveLidar> live(new LiveLidar(context, request, std::move(on_scan)));
  GLOAM_TRY_STATUS(live->follow(simulator.world()));
  // Room for the keys of a scan, which come while the one before is traced.
  const int capacity = live->stretches_ + 1;
  GLOAM_TRY(auto queue, simulator.subscribe({.rate = live->key_rate_,
                                             .required = request.required,
                                             .sensor = true,
                                             .capacity = capacity}));
  live->account_ = context.costs.open(fmt::format("lidar '{}'", request.lidar),
                                      live->sensor_->model().rate.value());
  live->thread_.start(
      std::move(queue),
      {.what = fmt::format("lidar '{}'", request.lidar),
       .memory_hint = "reduce the number of its beams",
       .take = [raw = live.get()](const SnapshotWindow& now) { return raw->take(now.keys[0]); },
       .on_end = request.on_end,
       .account = live->account_,
       .waited = [raw = live.get()] { return raw->sensor_->waited(); }});
  return live;
}

// Creates the LiDAR of a World: at first, and when a Snapshot of another World arrives.
Status LiveLidar::follow(const std::shared_ptr<const CompiledWorld>& world) {
  GLOAM_TRY(const LidarDescription lidar, find_lidar(*world, request_.lidar));
  GLOAM_TRY(auto shared, renderers_.of(world));
  GLOAM_TRY(auto sensor, LidarSensor::create(shared->description, lidar, seed_));
  GLOAM_TRY(auto solver, PoseSolver::create(world));
  const Rational rate = sensor->model().rate;
  const int stretches =
      motion_stretches(rate, simulator_.timestep(), sensor->options().motion_keys);
  const Rational key_rate{rate.num * stretches, rate.den};
  if (sensor_ != nullptr && (stretches != stretches_ || key_rate != key_rate_))
    return other_schedule(fmt::format("lidar '{}'", request_.lidar));
  if (sensor_ == nullptr) {
    GLOAM_TRY(schedule_, StepSchedule::make(key_rate, {0, 1}, simulator_.timestep()));
    stretches_ = stretches;
    key_rate_ = key_rate;
  }
  keys_.resize(static_cast<size_t>(stretches) + 1);
  gathered_ = 0;
  sensor_ = std::move(sensor);
  shared_ = std::move(shared);
  solver_ = std::move(solver);
  return {};
}

int64_t LiveLidar::complete_at(int64_t from) const {
  const int64_t key = schedule_.first_at_or_after(from);
  const int64_t scan = (key + stretches_ - 1) / stretches_;
  return schedule_.step_of((scan + 1) * stretches_);
}

// Key k is the instant of step schedule_.step_of(k); scan s lies between the keys s * stretches_
// and (s + 1) * stretches_. After a gap or a reset, scans begin anew where the next one can.
Status LiveLidar::take(const Snapshot& snapshot) {
  const auto& world = snapshot.data().world;
  if (world != shared_->world) GLOAM_TRY_STATUS(follow(world));
  const int64_t key = schedule_.first_at_or_after(snapshot.step());
  if (schedule_.step_of(key) != snapshot.step()) return {};
  if (key != next_key_) gathered_ = 0;
  next_key_ = key + 1;
  if (gathered_ == 0 && key % stretches_ != 0) return {};
  if (const Status status = solver_->solve(snapshot, keys_[gathered_]); !status.ok()) {
    log_error("cannot compute the poses of a lidar: {}", status.error().to_string());
    gathered_ = 0;
    return {};
  }
  if (++gathered_ < keys_.size()) return {};
  const double end = keys_.back().time;
  on_scan_(sensor_->scan(*shared_->renderer, shared_->turns, keys_, key / stretches_ - 1));
  account_->add_message(end);
  std::swap(keys_.front(), keys_.back());  // the end of one scan begins the next
  gathered_ = 1;
  return {};
}

}  // namespace gloam

#include "runtime/live/live_simulation.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <thread>

#include "base/log.h"
#include "control/actuators/actuators.h"
#include "control/controllers.h"
#include "geometry/mesh/single.h"
#include "runtime/live/topic_feed.h"
#include "runtime/rendering/label_table.h"
#include "runtime/rendering/pick.h"

namespace gloam {
namespace {

constexpr std::chrono::milliseconds kStopPollPeriod{5};  // after which a wish to stop is seen
constexpr int kPollsPerKeepWaiting = 10;                 // after which keep_waiting is called

// Worlds are compiled on the threads of many callers, each of which has a heap of its own: glibc
// keeps their free pages, some MB a recompile, unless it is asked to return them.
void return_free_memory() { malloc_trim(0); }

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::create(const World& world,
                                                       const SimulationOptions& options) {
  GLOAM_TRY(auto live, LiveSimulation::create(world, options));
  return std::unique_ptr<Simulation>(std::move(live));
}

Result<std::unique_ptr<LiveSimulation>> LiveSimulation::create(const World& world,
                                                               const SimulationOptions& options,
                                                               LiveOptions how) {
  std::unique_ptr<LiveSimulation> live(new LiveSimulation(options, how.metering));
  SimulatorOptions core;
  core.seed = options.seed;
  if (options.timestep != 0) core.timestep = options.timestep;
  core.pace = live->pace_ = options.pace;
  core.speed = options.speed;
  core.make_data = options.make_data;
  core.makers = robot_makers();
  core.command_capacity += static_cast<int>(std::min(how.commands, size_t{1} << 19));
  GLOAM_TRY(live->simulator_, Simulator::create(world.compiled(), core));
  if (how.motion != nullptr) {
    GLOAM_TRY_STATUS(live->simulator_->follow(std::move(how.motion), how.end));
  } else {
    GLOAM_TRY(auto controllers, make_controllers(world.compiled(), robot_makers()));
    for (RobotController& c : controllers)
      GLOAM_TRY_STATUS(live->simulator_->add_robot(std::move(c)));
  }
  // Exposure runs from step 0, whether or not anyone opens the camera.
  if (how.metering == Metering::kAlways)
    GLOAM_TRY_STATUS(live->meters_.open(live->stream_context()));
  // The thread starts with the first call that moves time: hooks, controllers and cameras come
  // before.
  live->simulator_->start(0);
  return live;
}

// Slow parts, the renderer of the new World too, are made while the old one runs on. Streams find
// it when the first Snapshot of the new World comes to them.
Status LiveSimulation::recompile(const World& world) {
  const std::lock_guard one_at_a_time(recompile_mutex_);
  GLOAM_TRY(auto controllers, make_controllers(world.compiled(), robot_makers()));
  if (renderers_.any()) GLOAM_TRY_STATUS(renderers_.of(world.compiled()));
  const Status status = simulator_->recompile(world.compiled(), std::move(controllers));
  forget_other_worlds();
  GLOAM_TRY_STATUS(status);
  send_latched();
  return metering_ == Metering::kAlways ? meters_.open(stream_context()) : Status();
}

// Releases everything that belongs to a World which no longer runs: it may have 100 MB.
void LiveSimulation::forget_other_worlds() {
  const std::shared_ptr<const CompiledWorld> world = simulator_->world();
  renderers_.keep_only(world);
  topics_.keep_only(world);
  {
    const std::lock_guard lock(solver_mutex_);
    if (solver_ != nullptr && solver_->world() != world) solver_.reset();
  }
  return_free_memory();
}

Result<Checkpoint> LiveSimulation::checkpoint() {
  GLOAM_TRY(auto data, simulator_->checkpoint());
  return Checkpoint(std::move(data));
}

Status LiveSimulation::restore(const Checkpoint& checkpoint) {
  const std::lock_guard one_at_a_time(recompile_mutex_);
  const auto& world = checkpoint.data().record.chapters.back().world;
  const bool is_other = world != simulator_->world();
  if (renderers_.any()) GLOAM_TRY_STATUS(renderers_.of(world));
  const Status status = simulator_->restore(checkpoint.data());
  forget_other_worlds();
  GLOAM_TRY_STATUS(status);
  restart_speed_clock();
  if (is_other) send_latched();
  return metering_ == Metering::kAlways ? meters_.open(stream_context()) : Status();
}

void LiveSimulation::add_latched(std::weak_ptr<LatchedTopics> topics) {
  const std::lock_guard lock(latched_mutex_);
  std::erase_if(latched_, [](const auto& one) { return one.expired(); });
  latched_.push_back(std::move(topics));
}

void LiveSimulation::send_latched() {
  std::vector<std::weak_ptr<LatchedTopics>> readers;
  {
    const std::lock_guard lock(latched_mutex_);
    readers = latched_;
  }
  const Snapshot now = simulator_->latest();
  for (const auto& reader : readers) {
    const std::shared_ptr<LatchedTopics> open = reader.lock();
    if (open == nullptr) continue;
    if (const Status sent = open->send(now); !sent.ok())
      log_warning("latched topics: {}", sent.error().to_string());
  }
}

Result<std::unique_ptr<ControlLease>> LiveSimulation::claim(Robot robot) {
  const auto post = [this](std::span<const Command> commands, const std::string& holder) -> Status {
    GLOAM_TRY_STATUS(claims_.check(*simulator_->world(), commands, holder));
    return simulator_->post(commands);
  };
  return claims_.claim(simulator_->world(), robot, post);
}

void LiveSimulation::restart_speed_clock() {
  const std::lock_guard lock(clock_mutex_);
  clock_wall_ = wall_seconds();
  clock_steps_ = simulator_->counters().steps;
}

bool LiveSimulation::has_to_stop(int look) {
  if (look % kPollsPerKeepWaiting == 0 && keep_waiting_ && !keep_waiting_()) stop_requested_ = true;
  return stop_requested_;
}

Status LiveSimulation::stopped_by_the_user() {
  paused_ = true;
  simulator_->halt();  // not pause(): a step hook may never return
  return Error{ErrorKind::kInterrupted, "stopped by the user"};
}

Status LiveSimulation::run_until(int64_t step) {
  if (simulator_->is_on_sim_thread()) return simulator_->wait();  // returns the error
  restart_speed_clock();
  paused_ = false;
  step = std::min(step, simulator_->end());
  simulator_->run_until(step);
  for (int look = 1; !has_to_stop(look); ++look) {
    if (!simulator_->wait_for(kStopPollPeriod)) continue;
    // Somebody may have paused it on the way.
    if (simulator_->step_count() >= step || !simulator_->status().ok()) break;
    std::this_thread::sleep_for(kStopPollPeriod);
  }
  if (stop_requested_.exchange(false)) return stopped_by_the_user();
  const Status status = simulator_->wait();
  pause();  // so that a reset does not set out for `step` again
  return status;
}

void LiveSimulation::resume() {
  restart_speed_clock();
  paused_ = false;
  simulator_->resume();
}

void LiveSimulation::pause() {
  paused_ = true;
  simulator_->pause();
}

Status LiveSimulation::step(int64_t n) {
  paused_ = true;
  const std::optional<Status> taken = simulator_->begin_steps(n);
  for (int look = 1; !taken && !simulator_->wait_for(kStopPollPeriod); ++look)
    if (has_to_stop(look)) break;
  if (stop_requested_.exchange(false)) return stopped_by_the_user();
  return taken ? *taken : simulator_->wait();
}

void LiveSimulation::set_pace(Pace pace, double speed) {
  pace_ = pace;
  restart_speed_clock();
  simulator_->set_pace(pace, speed);
}

Status LiveSimulation::post(std::span<const Command> commands) {
  GLOAM_TRY_STATUS(claims_.check(*simulator_->world(), commands));
  return simulator_->post(commands);
}

// While it runs in real time, clients that reset without end would have it do nothing else: what
// comes within a moment of a reset is the same one.
bool LiveSimulation::repeats_a_reset() {
  constexpr double kMoment = 0.01;  // [s]
  const std::lock_guard lock(clock_mutex_);
  const double now = wall_seconds();
  const bool paced = pace_ == Pace::kRealTime || pace_ == Pace::kSensors;
  if (paced && !paused_ && now - last_reset_ < kMoment) return true;
  last_reset_ = now;
  return false;
}

Status LiveSimulation::post(const Command& command) {
  if (std::holds_alternative<ResetSim>(command.what) && !simulator_->is_on_sim_thread()) {
    if (simulator_->status().ok() && repeats_a_reset()) return {};
    return simulator_->reset();  // works after a failure, too
  }
  return post(std::span<const Command>(&command, 1));
}

SimulationStats LiveSimulation::stats() const {
  const Snapshot snapshot = simulator_->latest();
  const SimCounters counters = simulator_->counters();
  SimulationStats stats;
  stats.step = snapshot.step();
  stats.time = snapshot.time();
  stats.hash = snapshot.hash();
  stats.commands_applied = counters.commands_applied;
  stats.dropped_snapshots = counters.snapshots_dropped;
  stats.pace = pace_;
  stats.sensors = costs_.list();
  stats.warnings = std::accumulate(counters.warnings.begin(), counters.warnings.end(), int64_t{0});
  const std::lock_guard lock(clock_mutex_);
  const double wall = wall_seconds() - clock_wall_;
  // Steps are counted, since a reset takes the time back.
  const auto steps = static_cast<double>(counters.steps - clock_steps_);
  if (!paused_ && wall > 0)
    stats.realtime_factor = std::max(steps, 0.0) * simulator_->timestep().value() / wall;
  return stats;
}

Status LiveSimulation::set_step_hook(std::function<void(const mjModel_*, mjData_*)> hook) {
  return simulator_->set_step_hook(std::move(hook));
}

Result<std::unique_ptr<LiveCamera>> LiveSimulation::open_live_camera(const CameraRequest& request,
                                                                     FrameCallback on_frame) {
  CameraRequest wanted = request;
  wanted.render.tier = request.render.tier_or_default(pace_ == Pace::kRealTime);
  return LiveCamera::open(stream_context(), wanted, std::move(on_frame), meters_);
}

Result<std::unique_ptr<SensorStream>> LiveSimulation::open_sensor(const SensorRequest& request,
                                                                  SensorCallback on_message) {
  GLOAM_TRY(auto live, open_live_sensors({.sensors = {request.sensor},
                                          .required = request.required,
                                          .on_end = request.on_end},
                                         std::move(on_message)));
  return std::unique_ptr<SensorStream>(std::move(live));
}

Result<std::unique_ptr<LiveSensors>> LiveSimulation::open_all_sensors(bool required,
                                                                      SensorCallback on_message) {
  std::vector<std::string> names;
  for (const SensorDescription& sensor : describe_sensors(*simulator_->world()))
    names.push_back(sensor.name);
  return open_live_sensors({.sensors = std::move(names), .required = required},
                           std::move(on_message));
}

Result<std::unique_ptr<LiveSensors>> LiveSimulation::open_live_sensors(LiveSensorsRequest request,
                                                                       SensorCallback on_message) {
  return LiveSensors::open(stream_context(), probe_sources(), std::move(request),
                           std::move(on_message));
}

ProbeSources LiveSimulation::probe_sources() {
  ProbeSources sources;
  sources.renderer =
      [this](const std::shared_ptr<const CompiledWorld>& world) -> Result<ProbeRenderer> {
    GLOAM_TRY(const std::shared_ptr<SharedRenderer> shared, renderers_.of(world));
    return ProbeRenderer{shared, &shared->description, shared->renderer.get(), &shared->turns};
  };
  sources.metered_ev100 = [this](const std::string& camera, const Snapshot& now) -> Result<double> {
    const std::shared_ptr<ExposureMeter> meter = meters_.of(camera, *now.data().world);
    if (meter != nullptr) return meter->ev100_at(now.step());
    return Error{
        ErrorKind::kInput,
        fmt::format("camera '{}' has automatic exposure, but no exposure meter is open", camera)};
  };
  return sources;
}

Result<std::unique_ptr<CameraStream>> LiveSimulation::open_camera(const CameraRequest& request,
                                                                  FrameCallback on_frame) {
  GLOAM_TRY(auto camera, open_live_camera(request, std::move(on_frame)));
  return std::unique_ptr<CameraStream>(std::move(camera));
}

Result<std::unique_ptr<LiveLidar>> LiveSimulation::open_live_lidar(const LidarRequest& request,
                                                                   ScanCallback on_scan) {
  return LiveLidar::open(stream_context(), request, std::move(on_scan));
}

Result<std::unique_ptr<LidarStream>> LiveSimulation::open_lidar(const LidarRequest& request,
                                                                ScanCallback on_scan) {
  GLOAM_TRY(auto lidar, open_live_lidar(request, std::move(on_scan)));
  return std::unique_ptr<LidarStream>(std::move(lidar));
}

Result<std::unique_ptr<SnapshotStream>> LiveSimulation::open_snapshots(
    const SnapshotRequest& request, SnapshotCallback on_snapshot) {
  GLOAM_TRY(auto live, LiveSnapshots::open(stream_context(), request, std::move(on_snapshot)));
  return std::unique_ptr<SnapshotStream>(std::move(live));
}

Result<std::vector<TopicInfo>> LiveSimulation::topics() const {
  GLOAM_TRY(const auto table, topic_table());
  std::vector<TopicInfo> infos;
  for (const Topic& topic : *table) infos.push_back(topic.info);
  return infos;
}

Result<std::unique_ptr<TopicStream>> LiveSimulation::open_topics(const TopicRequest& request,
                                                                 TopicCallback on_message) {
  GLOAM_TRY(auto feed, open_topic_batches(request, 1, std::move(on_message)));
  return std::unique_ptr<TopicStream>(std::move(feed));
}

Result<std::unique_ptr<TopicSubscription>> LiveSimulation::subscribe(TopicSink& sink) {
  {
    const std::lock_guard lock(hub_mutex_);
    if (hub_ == nullptr) hub_ = std::make_unique<TopicHub>(*this);
  }
  return hub_->subscribe(sink);
}

Result<std::unique_ptr<TopicFeed>> LiveSimulation::open_topic_batches(const TopicRequest& request,
                                                                      int batch,
                                                                      TopicCallback on_message) {
  return TopicFeed::open(*this, topics_, request, std::move(on_message), batch);
}

Result<std::vector<Command>> LiveSimulation::decode_input(std::string_view topic,
                                                          std::span<const uint8_t> data) const {
  GLOAM_TRY(const auto table, topic_table());
  GLOAM_TRY(const auto found, find_topics(*table, std::string(topic)));
  const auto* decode = std::get_if<InputDecoder>(&found.front()->code);
  if (decode == nullptr)
    return Error{ErrorKind::kUsage,
                 fmt::format("'{}' is an output topic and cannot be published to", topic)};
  const Snapshot now = simulator_->latest();
  auto commands = (*decode)(data, now, simulator_->timestep().value());
  const std::lock_guard lock(received_mutex_);
  if (commands.ok() && received_ != nullptr && !found.front()->echo)
    received_->add(
        {found.front()->info.name, now.data().run, now.time(), {data.begin(), data.end()}});
  return commands;
}

Status LiveSimulation::publish(std::string_view topic, std::span<const uint8_t> data) {
  GLOAM_TRY(const std::vector<Command> commands, decode_input(topic, data));
  if (commands.size() == 1) return post(commands[0]);
  return post(commands);
}

std::vector<std::string> LiveSimulation::camera_names() const {
  std::vector<std::string> names;
  for (const NamedElement& camera : world().info().cameras) names.push_back(camera.name);
  names.emplace_back("free");
  return names;
}

Result<std::vector<LabelRow>> LiveSimulation::labels() {
  GLOAM_TRY(auto shared, renderer());
  return label_rows(shared->description).rows;
}

// Returns the World of the instant.
Result<std::shared_ptr<const CompiledWorld>> LiveSimulation::solve_latest(Solve solve,
                                                                          PoseFrame& poses) {
  const std::lock_guard lock(solver_mutex_);
  const Snapshot latest = simulator_->latest();
  const auto& world = latest.data().world;
  if (solver_ == nullptr || solver_->world() != world) {
    GLOAM_TRY(solver_, PoseSolver::create(world));
  }
  GLOAM_TRY_STATUS(((*solver_).*solve)(latest, poses));
  return world;
}

Result<Pose> LiveSimulation::body_pose(Body body) {
  PoseFrame poses;
  GLOAM_TRY(const auto world, solve_latest(&PoseSolver::solve_bodies, poses));
  if (body.world != 0 && body.world != world->serial) {
    return Error{ErrorKind::kInput,
                 "the Body handle belongs to another World than the running one",
                 {},
                 "look it up again in Simulation::world()"};
  }
  const auto id = static_cast<size_t>(body.id);
  if (body.id < 0 || 3 * id >= poses.body_p.size()) {
    return Error{ErrorKind::kInput, "invalid Body handle"};
  }
  const double* p = poses.body_p.data() + 3 * id;
  const double* R = poses.body_R.data() + 9 * id;
  const auto column = [&](int i) {
    return Vec3f{static_cast<float>(R[i]), static_cast<float>(R[3 + i]),
                 static_cast<float>(R[6 + i])};
  };
  Pose X_WB = to_pose({column(0), column(1), column(2), {}});
  X_WB.p = in_world(Vec3{p[0], p[1], p[2]}, world->render_origin);
  return X_WB;
}

Result<PickResult> LiveSimulation::pick(const CameraFrame& frame, double u, double v) {
  PoseFrame poses;
  GLOAM_TRY(const auto world, solve_latest(&PoseSolver::solve, poses));
  GLOAM_TRY(const auto shared, renderers_.of(world));
  return pick_at(*shared, poses, frame, u, v);
}

Rational LiveSimulation::step_rate() const {
  const Rational timestep = simulator_->timestep();
  return {timestep.den, timestep.num};
}

}  // namespace gloam

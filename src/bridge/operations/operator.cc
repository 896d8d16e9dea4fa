// Operator: the run: playing, pausing, steps, resets.

#include "bridge/operations/operator.h"

#include <algorithm>

#include "bridge/operations/operator_private.h"

namespace gloam::bridge {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kProgressPeriod = 0.02;  // between two reports of steps that are taken [s]
constexpr double kMinRunSpeed = 1e-3, kMaxRunSpeed = 1e3;

Error wrong_state(std::string message, std::string hint = {}) {
  return Error{ErrorKind::kUsage, std::move(message), {}, std::move(hint)};
}

}  // namespace

const char* to_string(RunState state) {
  static constexpr const char* kNames[] = {"stopped", "playing",  "paused",
                                           "failed",  "no world", "loading"};
  return kNames[static_cast<size_t>(state)];
}

Operator::Operator(Simulation& simulation)
    : private_(std::make_unique<Private>(simulation)), simulation_(simulation) {
  private_->waits_for_sensors = simulation.stats().pace == Pace::kSensors;
}
Operator::~Operator() = default;

Status Operator::Private::need_world() const {
  if (unloaded) return wrong_state("no world is loaded", "load a world first");
  return {};
}

Status Operator::Private::exchange(const Scene& scene, const ProgressCallback& progress) {
  GLOAM_TRY(const World world, World::compile(scene, progress));
  GLOAM_TRY_STATUS(simulation.recompile(world));
  return {};
}

Scene Operator::Private::without_access(Scene scene) const {
  const Scene now = written_scene(simulation.world());
  scene.bridge = now.bridge;
  scene.record = now.record;
  scene.sim.pace = now.sim.pace;
  return scene;
}

void Operator::Private::forget_waiting() {
  const std::lock_guard lock(names_mutex);
  waiting.clear();
}

size_t Operator::Private::spawned_count() const {
  const std::lock_guard lock(names_mutex);
  return spawned.size();
}

RunState Operator::state() const {
  if (private_->loading) return RunState::kLoading;
  if (private_->unloaded) return RunState::kNoWorld;
  if (!simulation_.status().ok()) return RunState::kFailed;
  if (!simulation_.paused() && !private_->stepping) return RunState::kPlaying;
  const bool at_start = private_->rests && simulation_.latest().step() == 0;
  return at_start ? RunState::kStopped : RunState::kPaused;
}

Status Operator::pause() {
  GLOAM_TRY_STATUS(private_->need_world());
  private_->stop_stepping = true;
  private_->rests = false;
  simulation_.pause();
  return {};
}

Status Operator::play() {
  GLOAM_TRY_STATUS(private_->need_world());
  if (private_->stepping) return wrong_state("the simulation is stepping", "pause it first");
  GLOAM_TRY_STATUS(simulation_.status());
  private_->rests = false;
  simulation_.resume();
  return {};
}

Status Operator::stop() {
  GLOAM_TRY_STATUS(pause());
  GLOAM_TRY_STATUS(reset({}));
  private_->rests = true;
  return {};
}

Status Operator::step(int64_t count, const StepProgress& progress) {
  Private& p = *private_;
  GLOAM_TRY_STATUS(p.need_world());
  if (count < 1) return Error{ErrorKind::kInput, "the number of steps must be 1 or more"};
  if (!simulation_.paused()) return wrong_state("the simulation is not paused", "pause it first");
  if (p.stepping.exchange(true)) return wrong_state("another client is stepping the simulation");
  p.stop_stepping = false;
  p.rests = false;
  Status status;
  int64_t done = 0, chunk = 1;
  while (status.ok() && done < count) {
    if (p.stop_stepping) {
      status = Error{ErrorKind::kInterrupted, "cancelled before all steps were executed"};
      break;
    }
    const auto begin = Clock::now();
    const int64_t now = std::min(chunk, count - done);
    {
      const std::lock_guard one_at_a_time(p.change_mutex);
      status = simulation_.step(now);
    }
    if (!status.ok()) break;
    done += now;
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    chunk = std::clamp<int64_t>(seconds < kProgressPeriod / 2 ? 2 * chunk : chunk / 2, 1, 100000);
    if (seconds >= kProgressPeriod / 2 && seconds <= 2 * kProgressPeriod) chunk = now;
    if (progress && !progress(done, count - done) && done < count) p.stop_stepping = true;
  }
  p.stepping = false;
  return status;
}

Status Operator::set_speed(std::optional<double> speed) {
  Private& p = *private_;
  if (speed && !(*speed >= kMinRunSpeed && *speed <= kMaxRunSpeed))
    return Error{ErrorKind::kInput, "the speed must be 0.001 to 1000"};
  if (speed) p.speed = *speed;
  p.is_fast = !speed;
  simulation_.set_pace(pace(), p.speed);
  return {};
}

Status Operator::set_pace(std::string_view name) {
  GLOAM_TRY(const Pace pace, enum_named<Pace>(name));
  if (pace == Pace::kLockstep)
    return Error{ErrorKind::kInput,
                 "the pace 'lockstep' is not available in a live run",
                 {},
                 "pause the run and step it, or use one of: fast, realtime, sensors"};
  Private& p = *private_;
  p.is_fast = pace == Pace::kFast;
  if (!p.is_fast) p.waits_for_sensors = pace == Pace::kSensors;
  simulation_.set_pace(pace, p.speed);
  return {};
}

Pace Operator::pace() const {
  if (private_->is_fast) return Pace::kFast;
  return private_->waits_for_sensors ? Pace::kSensors : Pace::kRealTime;
}

std::optional<double> Operator::speed() const {
  if (private_->is_fast) return std::nullopt;
  return private_->speed;
}

Status Operator::reset(const ResetScope& scope) {
  Private& p = *private_;
  GLOAM_TRY_STATUS(p.need_world());
  const std::lock_guard one_at_a_time(p.change_mutex);
  if (scope.state) {
    GLOAM_TRY_STATUS(simulation_.post({.what = ResetSim{}}));
    p.rests = simulation_.paused();
  }
  if (scope.state) p.forget_waiting();
  if (!scope.spawned) return {};
  const Scene first = p.first_scene();
  Scene scene = written_scene(simulation_.world());
  const auto same = [](const auto& a, const auto& b) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return x.name == y.name; });
  };
  if (same(scene.robots, first.robots) && same(scene.objects, first.objects) &&
      same(scene.props, first.props) && same(scene.agents, first.agents))
    return {};
  scene.robots = first.robots;
  scene.objects = first.objects;
  scene.props = first.props;
  scene.agents = first.agents;
  scene.topics = first.topics;
  GLOAM_TRY_STATUS(p.exchange(scene));
  {
    const std::lock_guard lock(p.names_mutex);
    p.spawned.clear();
  }
  // Entities that came back begin as the scene says, and one that was moved stays where the reset
  // has put it.
  if (scope.state) return simulation_.post({.what = ResetSim{}});
  return {};
}

}  // namespace gloam::bridge

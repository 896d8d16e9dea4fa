#include "sim/loop/simulator.h"

#include <fmt/format.h>
#include <pthread.h>
#include <time.h>

#include <cmath>

#include "base/check.h"
#include "scene/files/mujoco_guard.h"
#include "sim/commands/command_check.h"
#include "sim/loop/scene_schedule.h"

namespace gloam {
namespace {

// By the wall clock.
bool is_paced(Pace pace) { return pace == Pace::kRealTime || pace == Pace::kSensors; }

Error no_call_from_a_step() {
  return {ErrorKind::kUsage,
          "a controller or step hook cannot make its own simulation step, wait or change",
          {},
          "call it from another thread, or post a Command"};
}

}  // namespace

Result<std::unique_ptr<Simulator>> Simulator::create(std::shared_ptr<const CompiledWorld> world,
                                                     SimulatorOptions options) {
  const double dt = options.timestep.value_or(world->model->opt.timestep);
  if (!(dt >= 1e-9 && dt < 1e3)) {
    return Error{ErrorKind::kInput, fmt::format("a timestep of {} s is not in [1e-9, 1e3)", dt)};
  }
  if (!(options.speed > 0 && std::isfinite(options.speed))) {
    return Error{ErrorKind::kUsage, fmt::format("a speed of {} is not positive", options.speed)};
  }
  if (options.command_capacity < 2 || options.command_capacity > 1 << 20) {
    return Error{ErrorKind::kUsage,
                 fmt::format("a command queue of {} is not in 2 … 2^20", options.command_capacity)};
  }
  const Rational timestep = exact_rational(dt);
  GLOAM_TRY(NextWorld first,
            make_next_world(world, options.seed, options.timestep, {}, options.make_data));
  return std::unique_ptr<Simulator>(new Simulator(
      std::move(first.stepper), timestep, std::move(options), std::move(first.scene_commands)));
}

Simulator::Simulator(std::unique_ptr<Stepper> stepper, Rational timestep, SimulatorOptions options,
                     std::vector<Command> scene_commands)
    : seed_(options.seed),
      own_timestep_(options.timestep),
      make_data_(options.make_data),
      replays_(!options.replay.empty()),
      pace_(options.pace),
      commands_(options.command_capacity, options.log_capacity),
      loop_(std::move(stepper), timestep, commands_, std::move(scene_commands),
            std::move(options.replay)),
      pacer_(timestep.value(), options.speed),
      world_(loop_.stepper().shared_world()) {
  loop_.set_waits_for_sensors(pace_ == Pace::kSensors);
}

Simulator::~Simulator() { stop(); }

// ---- the sim thread ----

void Simulator::run_thread() {
  sim_thread_ = std::this_thread::get_id();
  MujocoWarningCapture warnings;  // they are counted by type in mjData
  while (!quit_) {
    const uint32_t ticket = signal_->ticket();
    const bool published = loop_.publish_due();
    if (called_.load(std::memory_order_acquire)) {
      answer_calls();
    } else if (!published) {
      signal_->wait(ticket);
    } else if (loop_.stepper().failed() || !wants_step()) {
      report_idle();
      signal_->wait(ticket);
    } else if (!is_paced(pace_) || pacer_.ready(loop_.stepper().step_count())) {
      take_step();
    }
  }
  const std::lock_guard lock(mutex_);
  for (const std::function<void()>* f : calls_) (*f)();
  calls_answered_ += static_cast<int64_t>(calls_.size());
  calls_.clear();
  loop_.close_queues();
  sim_thread_ = std::thread::id();
  running_ = false;  // from here on, calls run where they are made
  idle_ = true;
  changed_.notify_all();
}

void Simulator::take_step() {
  const int64_t run = loop_.run();
  const bool ok = loop_.advance();
  if (loop_.run() != run) {
    pacer_.restart();
  } else if (ok) {
    ++total_steps_;
    if (remaining_ != kForever) --remaining_;
  } else if (remaining_ != kForever) {
    remaining_ = 0;  // a failed step(n) is over: a reset must not take up the rest of it
  }
  step_count_.store(loop_.stepper().step_count(), std::memory_order_relaxed);
}

void Simulator::answer_calls() {
  const std::lock_guard lock(mutex_);
  called_.store(false, std::memory_order_relaxed);
  for (const std::function<void()>* f : calls_) (*f)();
  calls_answered_ += static_cast<int64_t>(calls_.size());
  calls_.clear();
  idle_ = false;
  step_count_.store(loop_.stepper().step_count(), std::memory_order_relaxed);
  changed_.notify_all();
}

void Simulator::report_idle() {
  loop_.flush_queues();
  const std::lock_guard lock(mutex_);
  if (called_.load(std::memory_order_relaxed)) return;  // not idle: somebody wants something
  idle_ = true;
  changed_.notify_all();
}

// ---- other threads ----

// Runs f between two steps: on the sim thread if it lives, else here.
void Simulator::call(const std::function<void()>& f) {
  if (is_on_sim_thread()) return f();  // in the middle of a step: f only looks, or sets a wish
  std::unique_lock lock(mutex_);
  if (!running_) {
    f();
    step_count_.store(loop_.stepper().step_count(), std::memory_order_relaxed);
    return;
  }
  calls_.push_back(&f);
  const int64_t mine = ++calls_made_;
  called_.store(true, std::memory_order_release);
  signal_->raise();
  changed_.wait(lock, [&] { return calls_answered_ >= mine; });
}

void Simulator::start(int64_t until) {
  const std::lock_guard lock(mutex_);
  GLOAM_CHECK(!running_ && !quit_, "a Simulator starts once");
  until_ = pace_ == Pace::kLockstep ? loop_.stepper().step_count() : until;
  running_ = true;
  idle_ = false;
  thread_ = std::thread([this] { run_thread(); });
}

void Simulator::stop() {
  call([this] {
    quit_ = true;
    loop_.close_queues();
  });
  const std::lock_guard lock(join_mutex_);
  if (thread_.joinable()) thread_.join();
}

void Simulator::pause() {
  call([this] { paused_ = true; });
}

void Simulator::resume() {
  call([this] {
    paused_ = false;
    if (pace_ != Pace::kLockstep) until_ = kForever;
    remaining_ = kForever;
    pacer_.restart();
  });
}

void Simulator::run_until(int64_t step) {
  call([this, step] {
    paused_ = false;
    until_ = step;
    remaining_ = kForever;
    pacer_.restart();
  });
}

Status Simulator::step(int64_t n) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  call([this, n] {
    if (loop_.stepper().failed()) return;  // nothing to take up after a reset
    paused_ = false;
    until_ = kForever;
    remaining_ = n;
    pacer_.restart();
  });
  return wait();
}

Status Simulator::wait() {
  if (is_on_sim_thread()) return no_call_from_a_step();
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return idle_ || !running_; });
  }
  return status();
}

bool Simulator::wait_for(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, time, [this] { return idle_ || !running_; });
}

Status Simulator::reset() {
  if (is_on_sim_thread()) return no_call_from_a_step();
  call([this] {
    loop_.reset();
    pacer_.restart();
  });
  return status();
}

void Simulator::set_pace(Pace pace, double speed) {
  GLOAM_CHECK(speed > 0 && std::isfinite(speed), "the speed is a positive number");
  call([this, pace, speed] {
    pace_ = pace;
    loop_.set_waits_for_sensors(pace == Pace::kSensors);
    pacer_.set_speed(speed);
  });
}

Status Simulator::seek(int64_t step) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  Pace pace = Pace::kFast;
  call([&] {
    loop_.jump(std::clamp(step, int64_t{0}, end_));
    pace = std::exchange(pace_, Pace::kFast);
    paused_ = false;
    until_ = step;
    remaining_ = kForever;
  });
  const Status status = wait();
  call([&] {
    pace_ = pace;
    paused_ = true;
    pacer_.restart();
  });
  return status;
}

Status Simulator::follow(std::unique_ptr<Motion> motion, int64_t end) {
  end_ = end;
  Stepper& stepper = loop_.stepper();
  GLOAM_CHECK(!running_ && stepper.step_count() == 0, "a motion is followed from its beginning");
  return stepper.follow(std::move(motion)) ? Status() : Status(stepper.error());
}

Status Simulator::post(std::span<const Command> commands) {
  const std::lock_guard lock(world_mutex_);
  for (const Command& command : commands) GLOAM_TRY_STATUS(check_command(*world_, command));
  return commands_.post(commands);
}

Status Simulator::check_timestep(const CompiledWorld& world) const {
  const double now = timestep().value(), wanted = own_timestep_.value_or(world.model->opt.timestep);
  if (exact_rational(wanted) == timestep()) return {};
  return Error{
      ErrorKind::kInput,
      fmt::format("a recompile cannot change the timestep from {:g} s to {:g} s", now, wanted),
      world.scene.sim.loc, "give the new scene the timestep of the old one"};
}

// All that takes long happens here, while the old World runs on.
Status Simulator::recompile(std::shared_ptr<const CompiledWorld> world,
                            std::vector<RobotController> controllers) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  const std::lock_guard one_at_a_time(recompile_mutex_);
  GLOAM_TRY_STATUS(check_timestep(*world));
  if (replays_)
    return Error{ErrorKind::kUsage, "a log that is replayed is of one World: no recompile"};
  GLOAM_TRY(NextWorld next,
            make_next_world(world, seed_, own_timestep_, std::move(controllers), make_data_));
  const std::shared_ptr<const CompiledWorld> before = this->world();
  const Correspondence same(*before, *world);
  Status status;
  call([&] {
    const std::lock_guard lock(world_mutex_);
    status = loop_.exchange(next, same);
    if (status.ok()) world_ = world;
  });
  return status;
}

Result<std::shared_ptr<const CheckpointData>> Simulator::checkpoint() {
  if (is_on_sim_thread()) return no_call_from_a_step();
  auto made = std::make_shared<CheckpointData>();
  Status status;
  call([&] {
    Stepper& stepper = loop_.stepper();
    if (stepper.failed()) {
      status = stepper.error();
      return;
    }
    Result<std::vector<Command>> commands = commands_.history(loop_.run());
    if (!commands.ok()) {
      status = commands.error();
      return;
    }
    made->record = {.seed = loop_.run_seed(),
                    .timestep = own_timestep_,
                    .chapters = loop_.chapters(),
                    .commands = std::move(*commands),
                    .inputs = loop_.earlier_inputs(),
                    .step = stepper.step_count(),
                    .hash = stepper.hash(),
                    .first_step = loop_.first_step()};
    made->time = stepper.time();
    made->copy = loop_.save();
  });
  GLOAM_TRY_STATUS(status);
  return std::shared_ptr<const CheckpointData>(std::move(made));
}

Status Simulator::restore(const CheckpointData& checkpoint, const ControllerMaker& controllers) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  const std::lock_guard one_at_a_time(recompile_mutex_);
  const RunRecord& record = checkpoint.record;
  const std::shared_ptr<const CompiledWorld>& world = record.chapters.back().world;
  const double wanted = record.timestep.value_or(double{world->model->opt.timestep});
  if (!(exact_rational(wanted) == timestep()))
    return Error{ErrorKind::kUsage,
                 fmt::format("the checkpoint is of a timestep of {:g} s, this simulation of {:g} s",
                             wanted, timestep().value())};
  std::unique_ptr<Restepper> again;
  if (checkpoint.copy == nullptr || world != this->world()) {
    GLOAM_TRY(again, Restepper::create(record, controllers, make_data_));
    GLOAM_TRY_STATUS(again->run_until(record.step));
    GLOAM_TRY_STATUS(again->begin_chapters());
    if (again->loop().stepper().hash() != record.hash) {
      return Error{ErrorKind::kPartial,
                   fmt::format("the run was stepped again to step {}, where its state hash is "
                               "{:016x} and not {:016x}",
                               record.step, again->loop().stepper().hash(), record.hash),
                   {},
                   "step hooks, and controllers that use anything but their inputs, are not "
                   "repeated"};
    }
  }
  Status status;
  call([&] {
    const std::lock_guard lock(world_mutex_);
    if (again != nullptr) {
      loop_.adopt(again->loop(), record);
    } else {
      status = loop_.restore(*checkpoint.copy, record);
    }
    world_ = world;
    pacer_.restart();
  });
  return status;
}

Status Simulator::add_controller(int robot, std::unique_ptr<Controller> controller, Rational rate) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  Status status;
  call([&] { status = loop_.add_controller(robot, std::move(controller), rate); });
  return status;
}

Status Simulator::set_step_hook(StepHook hook) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  call([&] { loop_.set_step_hook(std::move(hook)); });
  return {};
}

void Simulator::keep_hook_inputs(std::shared_ptr<HookInputs> inputs) {
  call([&] { loop_.keep_hook_inputs(std::move(inputs)); });
}

Result<std::shared_ptr<SnapshotQueue>> Simulator::subscribe(const SubscriptionOptions& options) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  Result<std::shared_ptr<SnapshotQueue>> result = std::shared_ptr<SnapshotQueue>();
  call([&] { result = loop_.subscribe(options, signal_); });
  return result;
}

Snapshot Simulator::latest() {
  Snapshot snapshot;
  call([&] { snapshot = loop_.stepper().snapshot(); });
  return snapshot;
}

PhysicsMemory Simulator::memory() {
  PhysicsMemory memory;
  call([&] { memory = loop_.stepper().memory(); });
  return memory;
}

Status Simulator::status() {
  Status status;
  call([&] {
    if (loop_.stepper().failed()) status = loop_.stepper().error();
  });
  return status;
}

SimCounters Simulator::counters() {
  SimCounters counters;
  call([&] {
    Stepper& stepper = loop_.stepper();
    counters = {.steps = total_steps_,
                .resets = loop_.run(),
                .snapshots_dropped = loop_.dropped(),
                .pool_grown = stepper.pool().grown(),
                .commands_applied = commands_.applied(),
                .commands_discarded = commands_.discarded(),
                .log_lost = commands_.log_lost(),
                .deadlines_missed = pacer_.missed(),
                .most_contacts = stepper.most_contacts(),
                .warnings = stepper.warnings()};
  });
  return counters;
}

double Simulator::cpu_time() {
  clockid_t clock;
  timespec time{};
  const std::lock_guard lock(join_mutex_);
  if (!thread_.joinable() || pthread_getcpuclockid(thread_.native_handle(), &clock) != 0 ||
      clock_gettime(clock, &time) != 0) {
    return 0;
  }
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace gloam

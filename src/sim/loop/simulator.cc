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

Result<std::unique_ptr<Simulator>> Simulator::create(std::shared_ptr<const CompiledWorld> world,
                                                     SimulatorOptions options) {
  const double dt = options.timestep.value_or(world->model->opt.timestep);
  if (!(dt >= 1e-9 && dt < 1e3)) {
    return Error{ErrorKind::kInput, fmt::format("a timestep of {} s is not in [1e-9, 1e3)", dt)};
  }
  if (!(options.speed > 0 && std::isfinite(options.speed))) {
    return Error{ErrorKind::kUsage, fmt::format("speed must be positive, got {}", options.speed)};
  }
  if (options.command_capacity < 2 || options.command_capacity > 1 << 20) {
    return Error{ErrorKind::kUsage,
                 fmt::format("the capacity of the command queue must be in 2 … 2^20, got {}",
                             options.command_capacity)};
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
      makers_(options.makers),
      replays_(!options.replay.empty()),
      pace_(options.pace),
      commands_(options.command_capacity, options.log_capacity),
      loop_(std::move(stepper), timestep, commands_, std::move(scene_commands),
            std::move(options.replay), makers_.controller),
      pacer_(timestep.value(), options.speed),
      world_(loop_.stepper().shared_world()) {
  loop_.set_waits_for_sensors(pace_ == Pace::kSensors);
}

Simulator::~Simulator() { stop(); }

void Simulator::pause() {
  call([this] { paused_ = true; }, is_idle() ? Wake::kNo : Wake::kYes);
}

void Simulator::halt() {
  halted_ = true;
  signal_->raise();
}

void Simulator::resume() {
  call([this] {
    paused_ = halted_ = false;
    if (pace_ != Pace::kLockstep) until_ = kForever;
    remaining_ = kForever;
    pacer_.restart();
  });
}

void Simulator::run_until(int64_t step) {
  call([this, step] {
    paused_ = halted_ = false;
    until_ = step;
    remaining_ = kForever;
    pacer_.restart();
  });
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
  GLOAM_CHECK(speed > 0 && std::isfinite(speed), "the speed must be positive and finite");
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
    paused_ = halted_ = false;
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
  GLOAM_CHECK(!running_ && stepper.step_count() == 0,
              "a motion must be followed from its beginning");
  return stepper.follow(std::move(motion)) ? Status() : Status(stepper.error());
}

Status Simulator::post(std::span<const Command> commands) {
  for (;;) {
    const std::shared_ptr<const CompiledWorld> world = this->world();
    std::vector<QueuedCommand> queued;
    for (const Command& command : commands) {
      GLOAM_TRY_STATUS(check_command(*world, command));
      GLOAM_TRY(auto prepared, prepare_input(world, command, timestep(), makers_.controller));
      queued.push_back({command, std::move(prepared)});
    }
    const std::lock_guard lock(world_mutex_);
    if (world == world_) return commands_.post(std::move(queued));  // else it was recompiled
  }
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
    return Error{ErrorKind::kUsage, "a replayed log has only one World and cannot be recompiled"};
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
  look([&] {
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

Status Simulator::restore(const CheckpointData& checkpoint) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  const std::lock_guard one_at_a_time(recompile_mutex_);
  const RunRecord& record = checkpoint.record;
  const std::shared_ptr<const CompiledWorld>& world = record.chapters.back().world;
  const double wanted = record.timestep.value_or(double{world->model->opt.timestep});
  if (!(exact_rational(wanted) == timestep()))
    return Error{ErrorKind::kUsage,
                 fmt::format("the checkpoint has a timestep of {:g} s, this simulation {:g} s",
                             wanted, timestep().value())};
  std::unique_ptr<Restepper> again;
  if (checkpoint.copy == nullptr || world != this->world()) {
    GLOAM_TRY(again, Restepper::create(record, makers_, make_data_));
    GLOAM_TRY_STATUS(again->run_until(record.step));
    GLOAM_TRY_STATUS(again->begin_chapters());
    if (again->loop().stepper().hash() != record.hash) {
      return Error{
          ErrorKind::kPartial,
          fmt::format("the run was simulated again up to step {}, where its state hash is {:016x} "
                      "instead of {:016x}",
                      record.step, again->loop().stepper().hash(), record.hash),
          {},
          "step hooks, and controllers that use anything but their inputs, are not reproduced"};
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

Status Simulator::add_robot(RobotController robot) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  Status status;
  call([&] { status = loop_.add_robot(std::move(robot)); });
  return status;
}

Status Simulator::read_controller(Robot robot, const std::function<void(const Controller*)>& read) {
  Status status;
  look([&] {
    status = check_command(loop_.stepper().world(), {.what = StopTrajectory{robot}});  // its handle
    if (status.ok()) read(loop_.controller_of(robot.id));
  });
  return status;
}

Status Simulator::set_step_hook(StepHook hook) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  look([&] { loop_.set_step_hook(std::move(hook)); });
  return {};
}

void Simulator::keep_hook_inputs(std::shared_ptr<HookInputs> inputs) {
  look([&] { loop_.keep_hook_inputs(std::move(inputs)); });
}

Result<std::shared_ptr<SnapshotQueue>> Simulator::subscribe(const SubscriptionOptions& options) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  Result<std::shared_ptr<SnapshotQueue>> result = std::shared_ptr<SnapshotQueue>();
  call([&] { result = loop_.subscribe(options, signal_); });
  return result;
}

Snapshot Simulator::latest() {
  Snapshot snapshot;
  look([&] { snapshot = loop_.stepper().snapshot(); });
  return snapshot;
}

PhysicsMemory Simulator::memory() {
  PhysicsMemory memory;
  look([&] { memory = loop_.stepper().memory(); });
  return memory;
}

Status Simulator::status() {
  Status status;
  look([&] {
    if (loop_.stepper().failed()) status = loop_.stepper().error();
  });
  return status;
}

SimCounters Simulator::counters() {
  SimCounters counters;
  look([&] {
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

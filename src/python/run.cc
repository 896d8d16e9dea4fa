#include "run.h"

#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>

namespace gloam::python {
namespace {

constexpr int kState = mjSTATE_INTEGRATION;

void read_state(const PhysicsMemory& memory, std::vector<double>* state) {
  state->resize(static_cast<size_t>(mj_stateSize(memory.model.get(), kState)));
  mj_getState(memory.model.get(), memory.data.get(), state->data(), kState);
}

}  // namespace

Run::Run(std::unique_ptr<Simulation> simulation, Shared shared)
    : simulation_(std::move(simulation)), shared_(std::move(shared)), hook_(nb::none()) {
  check(simulation_->set_step_hook(
      [this](const mjModel_* model, mjData_* data) { call_hook(model, data); }));
}

bool Run::end() {
  try {
    close();
  } catch (nb::python_error& error) {
    error.discard_as_unraisable("closing a gloam.Simulation");
  }
  return simulation_ == nullptr;
}

Simulation& Run::simulation() {
  if (is_closed_) raise("ClosedError", "the simulation is closed");
  if (getpid() != process_)
    raise("ForkedError", "the simulation belongs to the process that this one was forked from",
          "create it in the new process, or start processes with 'spawn'");
  return *simulation_;
}

// Calls that move time, or look at the state after it, come one at a time.
std::unique_lock<std::timed_mutex> Run::turn() {
  simulation();
  if (CallbackScope::is_inside())
    raise("UsageError", "a callback or hook cannot wait for its own simulation",
          "call it from another thread, or use commands");
  {
    const nb::gil_scoped_release released;
    turn_.lock();
  }
  std::unique_lock lock(turn_, std::adopt_lock);
  simulation();  // another thread may have closed it meanwhile
  return lock;
}

void Run::leave_behind(const std::string& what) {
  is_closed_ = true;
  raise("StuckError",
        what + " has not returned within " + std::to_string(kCallbackTimeout.count()) +
            " s: its thread and the simulation's memory are abandoned",
        "callbacks and hooks must return; do long work in a thread of your own");
}

void Run::close() {
  if (is_closed_) return;
  if (getpid() != process_) {  // its threads are in the other process: nothing can be waited for
    is_closed_ = true;
    static_cast<void>(simulation_.release());
    return;
  }
  if (CallbackScope::is_inside())
    raise("UsageError", "a callback or hook cannot wait for its own simulation",
          "call it from another thread, or use commands");
  simulation_->request_stop();  // a thread that steps it ends
  has_hook_ = false;
  if (!wait_patiently([this] { return !is_in_hook_; })) leave_behind("a step hook");
  std::unique_lock lock(turn_, std::defer_lock);
  // A thread that steps has been stopped; a recompile takes the time that it takes.
  wait_patiently([&] { return lock.try_lock(); }, std::chrono::years(1));
  if (is_closed_) return;
  std::string stuck;
  for (const auto& inbox : open_inboxes())
    if (!inbox->try_close()) stuck = "the callback of " + inbox->name();
  if (!stuck.empty()) leave_behind(stuck);
  is_closed_ = true;
  std::unique_ptr<Simulation> simulation = std::move(simulation_);
  const nb::gil_scoped_release released;
  simulation.reset();
}

void Run::add(const std::shared_ptr<Inbox>& inbox) {
  std::erase_if(inboxes_, [](const auto& one) { return one.expired(); });
  inboxes_.push_back(inbox);
}

std::vector<std::shared_ptr<Inbox>> Run::open_inboxes() const {
  std::vector<std::shared_ptr<Inbox>> open;
  for (const auto& weak : inboxes_)
    if (auto inbox = weak.lock(); inbox != nullptr && inbox->is_open()) open.push_back(inbox);
  return open;
}

// Before time jumps: what comes afterwards is of the new run, whose first message comes at once.
void Run::empty_inboxes() {
  for (const auto& inbox : open_inboxes()) {
    without_gil([&] { inbox->stream().flush(); });
    inbox->clear();
  }
}

void Run::restart_inboxes() {
  const int64_t step = latest().step();
  for (const auto& inbox : open_inboxes()) inbox->restart(step);
}

// Numbers that Python wrote between two steps are put back, and the hook gives them to the next
// step: logs keep what hooks write as inputs.
void Run::give_written() {
  give_written_model();
  if (!is_watched_ || seen_.empty()) return;
  read_state(memory_, &now_);
  written_ = {};
  for (size_t i = 0; i < now_.size(); ++i) {
    if (std::memcmp(&now_[i], &seen_[i], sizeof(double)) == 0) continue;
    written_.index.push_back(i);
    written_.value.push_back(now_[i]);
  }
  if (written_.index.empty()) return;
  mj_setState(memory_.model.get(), memory_.data.get(), seen_.data(), kState);
  for (const double value : written_.value) {
    if (std::isfinite(value)) continue;
    written_ = {};
    raise("InputError", "a number that is not finite was written to the state",
          "the state is unchanged");
  }
  has_written_.store(true, std::memory_order_release);
}

// Turns writes into the model into Commands for the next step.
void Run::give_written_model() {
  if (!model_is_watched_ || mirror_ == nullptr) return;
  const auto commands = mirror_->take_written(std::exchange(model_is_given_, false));
  if (!commands.ok()) raise(commands.error());
  if (commands->empty()) return;
  has_commands_ = true;
  const Status posted = without_gil([&] { return simulation_->post(*commands); });
  if (posted.ok()) return;
  mirror_->follow();
  raise(posted.error());
}

void Run::watch_model() {
  memory();
  if (mirror_ == nullptr) return;
  if (!model_is_watched_) mirror_->follow(true);
  model_is_watched_ = model_is_given_ = true;
}

void Run::look_at_memory() {
  PhysicsMemory now = without_gil([&] { return simulation_->memory(); });
  if (now.data == memory_.data && now.model == memory_.model) return;
  memory_ = std::move(now);
  mirror_ = shared_.mirrors->of(memory_.model.get());
  ++generation_;
}

void Run::look_at_state() {
  if (!is_watched_) return;
  read_state(memory_, &seen_);
  if (!model_is_watched_ || mirror_ == nullptr) return;
  without_gil([&] { return simulation_->memory(); });  // brings the model's options up to date
  mirror_->follow(model_is_given_);
}

// After what may have exchanged the memory.
void Run::look_anew() {
  if (is_watched_) look_at_memory();
  look_at_state();
}

void Run::call_hook(const mjModel_* model, mjData_* data) {
  if (has_written_.load(std::memory_order_acquire)) {
    in_hook_.resize(static_cast<size_t>(mj_stateSize(model, kState)));
    mj_getState(model, data, in_hook_.data(), kState);
    for (size_t i = 0; i < written_.index.size(); ++i)
      if (written_.index[i] < in_hook_.size()) in_hook_[written_.index[i]] = written_.value[i];
    mj_setState(model, data, in_hook_.data(), kState);
    has_written_.store(false, std::memory_order_release);
  }
  if (!has_hook_.load(std::memory_order_acquire)) return;
  const nb::gil_scoped_acquire acquired;
  const CallbackScope inside;     // outlives `hook`, whose end may end the simulation
  const nb::object hook = hook_;  // kept for as long as it runs
  if (!has_hook_ || !hook.is_valid() || hook.is_none()) return;
  is_in_hook_ = true;
  try {
    hook();
    give_written_model();
  } catch (nb::python_error& error) {
    hook_error_.keep(std::move(error));
    simulation_->pause();
    simulation_->request_stop();
  }
  is_in_hook_ = false;
}

// A call that moves time: with what was written before it, and with errors of hooks after it.
template <class F>
void Run::guarded_call(F&& job) {
  const auto lock = turn();
  give_written();
  Status status;
  std::exception_ptr thrown;
  try {
    status = job();
  } catch (...) {
    thrown = std::current_exception();  // Ctrl-C
  }
  if (is_in_hook_) {  // stopped, and the hook has not returned: nobody knows how it is
    seen_.clear();
  } else {
    thrown || !status.ok() ? look_anew() : look_at_state();
  }
  shared_.signal->rethrow();
  hook_error_.rethrow();
  for (const auto& inbox : open_inboxes()) inbox->rethrow();
  if (thrown) std::rethrow_exception(thrown);
  check(status);
}

Snapshot Run::latest() {
  Simulation& here = simulation();
  return without_gil([&] { return here.latest(); });
}

RenderOptions Run::scene_render() {
  Simulation& here = simulation();
  return without_gil([&] { return here.world().scene().render; });
}

void Run::step(int64_t n) {
  if (n < 0) raise("UsageError", "the number of steps must not be negative");
  if (n == 0) return;
  guarded_call([&] { return without_gil([&] { return simulation_->step(n); }); });
}

void Run::run_until(int64_t step) {
  guarded_call([&] { return without_gil([&] { return simulation_->run_until(step); }); });
}

void Run::resume() {
  const auto lock = turn();
  give_written();
  seen_.clear();
  without_gil([&] { simulation_->resume(); });
}

void Run::pause() {
  simulation();
  without_gil([&] { simulation_->pause(); });
  const std::unique_lock lock(turn_, std::try_to_lock);
  if (!lock.owns_lock()) return;  // the thread that steps it will look
  give_written_model();
  look_anew();
}

void Run::reset() {
  const auto lock = turn();
  has_written_ = has_commands_ = false;
  without_gil([&] { simulation_->pause(); });
  empty_inboxes();
  const Status status = without_gil([&] { return simulation_->post({.what = ResetSim{}}); });
  check(status);
  look_anew();
  restart_inboxes();
}

// At the initial state, with nothing that waits, it begins anew in the other World: so its log can
// be stepped again from the beginning.
void Run::recompile(const World& world) {
  const auto lock = turn();
  give_written();
  const bool begins_anew = latest().step() == 0 && !has_commands_ && !has_written_;
  if (has_written_.exchange(false))
    mj_setState(memory_.model.get(), memory_.data.get(), now_.data(), kState);
  Status status = interruptible([&] { return simulation_->recompile(world); }, [] {});
  if (status.ok() && begins_anew) {
    empty_inboxes();
    status = without_gil([&] { return simulation_->post({.what = ResetSim{}}); });
    restart_inboxes();
  }
  look_anew();
  check(status);
}

void Run::restore(const Checkpoint& checkpoint) {
  const auto lock = turn();
  has_written_ = false;
  without_gil([&] { simulation_->pause(); });
  empty_inboxes();
  const Status status = interruptible([&] { return simulation_->restore(checkpoint); }, [] {});
  look_anew();
  restart_inboxes();
  check(status);
}

void Run::set_hook(nb::object hook) {
  simulation();
  const bool is_set = !hook.is_none();
  {
    // The physics thread may be in the old one.
    const nb::gil_scoped_release released;
    has_hook_ = false;
    static_cast<void>(simulation_->latest());  // a call between two steps
  }
  hook_ = std::move(hook);
  has_hook_ = is_set;
}

const PhysicsMemory& Run::memory() {
  simulation();
  if (!is_watched_) {
    const auto lock = turn();
    look_at_memory();
    is_watched_ = true;
    if (simulation_->paused()) look_at_state();
  }
  return memory_;
}

int64_t Run::generation() {
  memory();
  return generation_;
}

nb::object Run::step_until(Inbox& inbox) {
  simulation();
  if (!simulation_->paused())
    raise("UsageError", "the simulation is running", "pause() it before step_until()");
  Stream& stream = inbox.stream();
  inbox.check_kept();
  if (stream.complete_at(0) < 0)
    raise("UsageError", "a topic stream has no single next message", "iterate over it");
  const Rational rate = simulation_->step_rate();
  int64_t from = inbox.next_from();
  int64_t complete = stream.complete_at(from);
  const int64_t now = latest().step();
  without_gil([&] { stream.flush(); });
  if (complete < now) {  // time has gone on without it
    inbox.clear();
    from = now;
    complete = stream.complete_at(from);
  }
  for (;;) {
    if (complete > latest().step()) run_until(complete);
    check(interruptible(
        [&] {
          stream.flush();
          return stream.status();
        },
        [&] { simulation_->request_stop(); }));
    inbox.rethrow();
    if (const std::optional<Waiting> message = inbox.pop()) {
      inbox.set_next_from(message->step);
      const auto delivered = static_cast<int64_t>(std::ceil(
          message->delivery * static_cast<double>(rate.num) / static_cast<double>(rate.den) -
          1e-6));
      if (delivered > latest().step()) run_until(delivered);
      return message->make();
    }
    while (stream.complete_at(from) <= complete) ++from;  // its model dropped that one
    inbox.set_next_from(from);
    complete = stream.complete_at(from);
  }
}

}  // namespace gloam::python

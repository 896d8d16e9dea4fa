// gloam::LogPlayer: a simulation that follows a log's states.

#include "gloam/log_player.h"

#include <fmt/format.h>

#include <cmath>

#include "runtime/live/live_simulation.h"
#include "runtime/log/pose_motion.h"
#include "runtime/log/replay_scene.h"

namespace gloam {
namespace {

class Player final : public LogPlayer {
 public:
  explicit Player(McapReader log) : log_(std::move(log)) {}

  Status start(const LogReplay& replay) {
    GLOAM_TRY(const LoggedRuns runs, LoggedRuns::read(log_, replay.folder));
    GLOAM_TRY(const LoggedRuns::Run* run, runs.find(replay.run));
    GLOAM_TRY(const World world, compile_replay(replay, *run));
    GLOAM_TRY(auto motion, PoseMotion::create(log_, *run, world.compiled()));
    SimulationOptions options = replay.request.simulation;
    options.seed = run->record.seed;
    options.timestep = run->record.timestep.value_or(0);
    GLOAM_TRY(simulation_,
              LiveSimulation::create(world, options,
                                     {.motion = std::move(motion), .end = run->last_step}));
    return {};
  }

  Simulation& simulation() override { return *simulation_; }
  double end() const override {
    return static_cast<double>(simulator().end()) * simulator().timestep().value();
  }
  Status seek(double time) override {
    if (!(time >= 0 && time <= end() * (1 + 1e-9)))
      return Error{ErrorKind::kUsage,
                   fmt::format("{} s is outside the log, which covers 0 to {} s", time, end())};
    const bool was_paused = simulation_->paused();
    const Status status = simulator().seek(std::llround(time / simulator().timestep().value()));
    if (!was_paused && status.ok()) simulation_->resume();
    return status;
  }

 private:
  Simulator& simulator() const { return simulation_->simulator(); }

  McapReader log_;
  std::unique_ptr<LiveSimulation> simulation_;
};

}  // namespace

Result<std::unique_ptr<LogPlayer>> LogPlayer::open(const LogReplay& replay) {
  if (replay.motion == ReplayMotion::kNewRun)
    return Error{ErrorKind::kUsage, "a new run cannot be played from a log"};
  GLOAM_TRY(McapReader log, McapReader::open(replay.log));
  auto player = std::make_unique<Player>(std::move(log));
  GLOAM_TRY_STATUS(player->start(replay));
  return std::unique_ptr<LogPlayer>(std::move(player));
}

}  // namespace gloam

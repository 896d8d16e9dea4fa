// Operations on the run: state, pause, steps, resets, checkpoints.

#include <fmt/format.h>

#include <chrono>

#include "bridge/zmq/operations/operation.h"
#include "gloam/log_player.h"

namespace gloam::bridge::zeromq {
namespace {

using enum ArgumentType;
using enum OperationSpeed;

/// As fast as possible while it lives; then the pace that was.
class FastPace {
 public:
  explicit FastPace(Operator& operations) : operations_(operations), speed_(operations.speed()) {
    if (speed_) (void)operations_.set_speed({}).ok();
  }
  ~FastPace() {
    if (speed_) (void)operations_.set_speed(speed_).ok();
  }
  FastPace(const FastPace&) = delete;
  FastPace& operator=(const FastPace&) = delete;

 private:
  Operator& operations_;
  const std::optional<double> speed_;
};

Status ping(const Call&, Packer& out) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  out.pack_map(1);
  pack_pair(out, "monotonic_ns", static_cast<int64_t>(std::chrono::nanoseconds(now).count()));
  return {};
}

void pack_sensors(const std::vector<SensorCost>& sensors, Packer& out) {
  out.pack(std::string_view("sensors"));
  out.pack_array(static_cast<uint32_t>(sensors.size()));
  for (const SensorCost& sensor : sensors) {
    out.pack_map(7);
    pack_pair(out, "name", valid_text(sensor.name));
    pack_pair(out, "rate", sensor.rate);
    pack_pair(out, "achieved", sensor.achieved);
    pack_pair(out, "messages", sensor.messages);
    pack_pair(out, "dropped", sensor.dropped);
    pack_pair(out, "wall_ms", sensor.wall_ms);
    pack_pair(out, "waited_ms", sensor.waited_ms);
  }
}

Status state(const Call& call, Packer& out) {
  const Services& services = call.services;
  const SimulationStats stats = services.simulation().stats();
  const Status physics = services.simulation().status();
  const Snapshot now = services.simulation().latest();
  GLOAM_TRY(const StateLayout layout, services.layouts.of(now));
  out.pack_map(kStatePairs + 10);
  pack_state(out, now, layout);
  pack_pair(out, "run_state", std::string_view(to_string(services.operations().state())));
  pack_pair(out, "paused", services.simulation().paused());
  pack_pair(out, "speed", services.operations().speed().value_or(0));
  pack_pair(out, "pace", std::string_view(to_string(stats.pace)));
  pack_pair(out, "realtime_factor", stats.realtime_factor);
  pack_sensors(stats.sensors, out);
  pack_pair(out, "commands_applied", stats.commands_applied);
  pack_pair(out, "warnings", stats.warnings);
  pack_pair(out, "claims", services.sessions.claims(call.from.client));
  out.pack(std::string_view("error"));
  if (physics.ok())
    out.pack_nil();
  else
    pack_error(out, physics.error());
  return {};
}

Status pause(const Call& call, Packer& out) {
  GLOAM_TRY_STATUS(call.services.operations().pause());
  return pack_latest(call, out);
}

Status resume(const Call& call, Packer& out) {
  GLOAM_TRY_STATUS(call.services.operations().play());
  pack_nothing(out);
  return {};
}

Status pace(const Call& call, Packer& out) {
  Operator& operations = call.services.operations();
  const bool has_pace = call.arguments.has("pace"), has_speed = call.arguments.has("speed");
  if (has_speed) GLOAM_TRY_STATUS(operations.set_speed(call.arguments.number("speed")));
  if (has_pace) GLOAM_TRY_STATUS(operations.set_pace(call.arguments.text("pace")));
  if (!has_pace && !has_speed) GLOAM_TRY_STATUS(operations.set_speed({}));
  pack_nothing(out);
  return {};
}

Status step(const Call& call, Packer& out) {
  Operator& operations = call.services.operations();
  std::optional<FastPace> fast;
  if (!call.arguments.flag("paced")) fast.emplace(operations);
  const std::atomic<bool>& is_stopping = call.services.is_stopping;
  GLOAM_TRY_STATUS(operations.step(call.arguments.integer("n", 1),
                                   [&is_stopping](int64_t, int64_t) { return !is_stopping; }));
  return pack_latest(call, out);
}

Status reset(const Call& call, Packer& out) {
  const ResetScope scope{.state = call.arguments.flag("state", true),
                         .spawned = call.arguments.flag("spawned", true)};
  GLOAM_TRY_STATUS(call.services.operations().reset(scope));
  pack_nothing(out);
  return {};
}

Status checkpoint(const Call& call, Packer& out) {
  GLOAM_TRY(const int64_t id, call.services.operations().save_checkpoint());
  out.pack_map(1);
  pack_pair(out, "id", id);
  return {};
}

Status restore(const Call& call, Packer& out) {
  GLOAM_TRY_STATUS(call.services.operations().restore_checkpoint(call.arguments.integer("id")));
  return pack_latest(call, out);
}

Status forget_checkpoint(const Call& call, Packer& out) {
  GLOAM_TRY_STATUS(call.services.operations().forget_checkpoint(call.arguments.integer("id")));
  pack_nothing(out);
  return {};
}

Status checkpoints(const Call& call, Packer& out) {
  const auto kept = call.services.operations().checkpoints();
  out.pack_array(static_cast<uint32_t>(kept.size()));
  for (const auto& [id, checkpoint] : kept) {
    out.pack_map(4);
    pack_pair(out, "id", id);
    pack_pair(out, "step", checkpoint.step());
    pack_pair(out, "time", checkpoint.time());
    pack_pair(out, "hash", checkpoint.hash());
  }
  return {};
}

Status seek(const Call& call, Packer& out) {
  LogPlayer* const player = call.services.context.player;
  if (player == nullptr)
    return Error{ErrorKind::kUsage,
                 "the run is not a replay",
                 {},
                 "start a replay with gloam replay LOG --zmq"};
  GLOAM_TRY_STATUS(player->seek(call.arguments.number("time")));
  return pack_latest(call, out);
}

Status end(const Call& call, Packer& out) {
  call.services.operations().ask_end();
  pack_nothing(out);
  return {};
}

}  // namespace

std::vector<Operation> run_operations() {
  const Argument id{"id", kInteger, true, "", "number returned by 'checkpoint'"};
  return {
      {"ping", "responds immediately, even during other operations", kAtOnce, {}, ping},
      {"state", "the latest instant and the status of the run", kAtOnce, {}, state},
      {"pause", "pauses after the current step; ends a 'step' in progress", kAtOnce, {}, pause},
      {"resume", "resumes the run until it is paused", kAtOnce, {}, resume},
      {"pace",
       "sets the speed of the run",
       kAtOnce,
       {{"speed", kNumber, false, "simulated seconds per second",
         "0.001 to 1000; without speed and pace: as fast as possible"},
        {"pace", kText, false, "", "fast, realtime or sensors (docs/sensors.md)"}},
       pace},
      {"step",
       "executes steps and returns the state after the last one; the run must be paused",
       kQueued,
       {{"n", kInteger, false, "steps", "1 or more; default: 1"},
        {"paced", kBool, false, "", "at the pace of the run instead of as fast as possible"}},
       step},
      {"reset",
       "returns to the initial state with the initial entities of the scene",
       kQueued,
       {{"state", kBool, false, "", "reset state and time; default: true"},
        {"spawned", kBool, false, "", "reset the entities too; default: true"}},
       reset},
      {"checkpoint", "saves the current instant: {id}; at most 64", kQueued, {}, checkpoint},
      {"restore", "continues from a checkpoint", kQueued, {id}, restore},
      {"forget_checkpoint", "deletes a checkpoint", kQueued, {id}, forget_checkpoint},
      {"checkpoints",
       "lists the saved checkpoints: [{id, step, time, hash}]",
       kQueued,
       {},
       checkpoints},
      {"seek",
       "seeks to an instant of a replay",
       kQueued,
       {{"time", kNumber, true, "s", "from 0 to the end of the log"}},
       seek},
      {"end", "ends the program", kAtOnce, {}, end},
  };
}

}  // namespace gloam::bridge::zeromq

// gloam::World::snapshot: an instant of a given configuration, without a simulation.

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/hash.h"
#include "base/memory.h"
#include "scene/files/mujoco_guard.h"
#include "sim/commands/applied_inputs.h"
#include "sim/commands/command_check.h"
#include "sim/loop/step_schedule.h"
#include "sim/snapshots/snapshot.h"
#include "sim/state/initial_state.h"
#include "sim/state/state_layout.h"
#include "world/model_memory.h"

namespace gloam {
namespace {

constexpr double kEndOfTime = 1e9;  // [s], where exact_rational() ends

Status check_count(const char* what, size_t count, mjtSize wanted) {
  if (count == static_cast<size_t>(wanted)) return {};
  return Error{ErrorKind::kUsage,
               fmt::format("{} must have {} values, got {}", what, wanted, count)};
}

bool is_finite(const Pose& X) {
  const double sum = X.p.x + X.p.y + X.p.z + X.q.w + X.q.x + X.q.y + X.q.z;
  return std::isfinite(sum);
}

Status check_configuration(const mjModel& model, std::span<const double> qpos, double time,
                           std::span<const Pose> mocap) {
  GLOAM_TRY_STATUS(check_count("qpos", qpos.size(), model.nq));
  if (!mocap.empty()) GLOAM_TRY_STATUS(check_count("mocap", mocap.size(), model.nmocap));
  for (size_t i = 0; i < qpos.size(); ++i)
    if (!std::isfinite(qpos[i]))
      return Error{ErrorKind::kUsage, fmt::format("qpos[{}] must be finite, got {}", i, qpos[i])};
  for (size_t i = 0; i < mocap.size(); ++i)
    if (!is_finite(mocap[i]))
      return Error{ErrorKind::kUsage, fmt::format("the pose mocap[{}] must be finite", i)};
  if (!(time >= 0 && time < kEndOfTime))
    return Error{ErrorKind::kUsage,
                 fmt::format("time must be at least 0 and below {:g} s, got {}", kEndOfTime, time)};
  return {};
}

// Each is a run of its own, with a number that no simulation has.
int64_t next_run() {
  static std::atomic<int64_t> last{-1};  // TopicMessage::run: unknown
  return --last;
}

void set_mocap(std::span<const Pose> mocap, mjData* data) {
  for (size_t i = 0; i < mocap.size(); ++i) {
    const Pose& X = mocap[i];
    const double p[] = {X.p.x, X.p.y, X.p.z}, q[] = {X.q.w, X.q.x, X.q.y, X.q.z};
    std::copy_n(p, 3, data->mocap_pos + 3 * i);
    std::copy_n(q, 4, data->mocap_quat + 4 * i);
    mju_normalize4(data->mocap_quat + 4 * i);
  }
}

// The Commands whose effect is in mjData at once.
void apply_to(const mjModel& model, mjData* data, AppliedInputs* inputs, const Command& command) {
  std::visit(
      [&]<class T>(const T& what) {
        if constexpr (std::is_same_v<T, SetControl> || std::is_same_v<T, SetControls> ||
                      std::is_same_v<T, SetJointState> || std::is_same_v<T, SetMocapPose> ||
                      std::is_same_v<T, SetEquality> || std::is_same_v<T, AddVelocity>)
          inputs->apply(model, *data, what);
      },
      command.what);
}

}  // namespace

Result<Snapshot> Snapshot::with(std::span<const Command> commands) const {
  const CompiledWorld& world = *data_->world;
  const mjModel& model = *world.model;
  for (const Command& command : commands) GLOAM_TRY_STATUS(check_command(world, command));
  return or_no_memory("the snapshot", [&]() -> Result<Snapshot> {
    const DataPtr memory = make_data(model);
    mjData* data = memory.get();
    AppliedInputs inputs(world, model);
    const auto out = std::make_shared<SnapshotData>(*data_);
    GLOAM_TRY_STATUS(guarded([&, state = out->state.data()] {
      mj_setState(&model, data, state, mjSTATE_INTEGRATION);
      for (const Command& command : commands) apply_to(model, data, &inputs, command);
      mj_getState(&model, data, state, mjSTATE_INTEGRATION);
    }));
    out->run = next_run();
    return Snapshot(out);
  });
}

Result<Snapshot> World::snapshot(std::span<const double> qpos, double time,
                                 std::span<const Pose> mocap) const {
  const CompiledWorld& world = *compiled_;
  const mjModel& model = *world.model;
  GLOAM_TRY_STATUS(check_configuration(model, qpos, time, mocap));
  return or_no_memory("the snapshot", [&]() -> Result<Snapshot> {
    const DataPtr memory = make_data(model);
    mjData* data = memory.get();
    const auto out = std::make_shared<SnapshotData>();
    out->state.resize(static_cast<size_t>(state_size(model)));
    GLOAM_TRY_STATUS(guarded([&, to = out->state.data()] {
      reset_to_initial_state(world, model, *data);
      std::copy(qpos.begin(), qpos.end(), data->qpos);
      mj_normalizeQuat(&model, data->qpos);
      mju_zero(data->qvel, static_cast<int>(model.nv));
      set_mocap(mocap, data);
      data->time = time;
      mj_getState(&model, data, to, mjSTATE_INTEGRATION);
    }));
    const double timestep = world.scene.sim.timestep.value_or(model.opt.timestep);
    const uint64_t seed = world.scene.sim.seed;
    out->world = compiled_;
    out->run = next_run();
    out->step = step_at_or_after(exact_rational(time), exact_rational(timestep));
    out->time = out->sensor_stamp = time;
    out->timestep = timestep;
    out->hash = hash_span<double>(out->state, hash_bytes(&seed, sizeof(seed)));
    out->sensordata.resize(static_cast<size_t>(model.nsensordata));
    out->effects.fit(world);
    out->trajectories.resize(static_cast<size_t>(model.njnt));
    if (model.nsensordata > 0) {
      Instant instant;
      GLOAM_TRY_STATUS(instant.solve(Snapshot(out)));
      std::copy_n(instant.data()->sensordata, model.nsensordata, out->sensordata.begin());
    }
    return Snapshot(out);
  });
}

}  // namespace gloam

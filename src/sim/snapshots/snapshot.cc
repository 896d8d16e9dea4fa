#include "sim/snapshots/snapshot.h"

#include "base/check.h"
#include "sim/state/state_layout.h"
#include "world/world.h"

namespace gloam {
namespace {

template <class H>
void check_handle(const SnapshotData& data, H handle, mjtSize count) {
  GLOAM_CHECK(handle.world == 0 || handle.world == data.world->serial,
              "the handle belongs to another World, not to that of the Snapshot; look it up again");
  GLOAM_CHECK(handle.id >= 0 && handle.id < count, "the handle is out of range in this World");
}

}  // namespace

int64_t Snapshot::step() const { return data_->step; }
double Snapshot::time() const { return data_->time; }
uint64_t Snapshot::hash() const { return data_->hash; }
World Snapshot::world() const { return World(data_->world); }
std::span<const double> Snapshot::state() const { return data_->state; }

JointState Snapshot::operator[](Joint joint) const {
  const mjModel& model = *data_->world->model;
  check_handle(*data_, joint, model.njnt);
  const JointWidth width = joint_width(model.jnt_type[joint.id]);
  return {state_part(model, state(), mjSTATE_QPOS)
              .subspan(static_cast<size_t>(model.jnt_qposadr[joint.id]),
                       static_cast<size_t>(width.qpos)),
          state_part(model, state(), mjSTATE_QVEL)
              .subspan(static_cast<size_t>(model.jnt_dofadr[joint.id]),
                       static_cast<size_t>(width.qvel))};
}

SensorState Snapshot::operator[](SensorHandle sensor) const {
  const mjModel& model = *data_->world->model;
  check_handle(*data_, sensor, model.nsensor);
  return {std::span<const double>(data_->sensordata)
              .subspan(static_cast<size_t>(model.sensor_adr[sensor.id]),
                       static_cast<size_t>(model.sensor_dim[sensor.id])),
          data_->sensor_stamp};
}

double Snapshot::control(Actuator actuator) const {
  const mjModel& model = *data_->world->model;
  check_handle(*data_, actuator, model.nactuator);
  GLOAM_CHECK(model.actuator_ctrlnum[actuator.id] > 0, "the actuator has no controls");
  return state_part(model, state(),
                    mjSTATE_CTRL)[static_cast<size_t>(model.actuator_ctrladr[actuator.id])];
}

std::shared_ptr<const ActiveTrajectory> Snapshot::trajectory(Robot robot) const {
  check_handle(*data_, robot, static_cast<int>(data_->world->robots.size()));
  const auto i = static_cast<size_t>(robot.id);
  return i < data_->trajectories.size() ? data_->trajectories[i] : nullptr;
}

const ActuatorOutputs* Snapshot::actuators(Robot robot) const {
  check_handle(*data_, robot, static_cast<mjtSize>(data_->world->robots.size()));
  for (const ActuatorOutputs& outputs : data_->actuators)
    if (outputs.robot == robot.id) return &outputs;
  return nullptr;
}

}  // namespace gloam

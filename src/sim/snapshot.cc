#include "sim/snapshot.h"

#include "base/check.h"
#include "sim/state_layout.h"
#include "world/world.h"

namespace gloam {
namespace {

struct JointWidth {
  size_t qpos, qvel;
};

JointWidth joint_width(int type) {
  switch (type) {
    case mjJNT_FREE:
      return {7, 6};
    case mjJNT_BALL:
      return {4, 3};
    default:
      return {1, 1};
  }
}

}  // namespace

int64_t Snapshot::step() const { return data_->step; }
double Snapshot::time() const { return data_->time; }
uint64_t Snapshot::hash() const { return data_->hash; }
std::span<const double> Snapshot::state() const { return data_->state; }

JointState Snapshot::operator[](Joint joint) const {
  const mjModel& model = *data_->world->model;
  GLOAM_CHECK(joint.id >= 0 && joint.id < model.njnt, "not a joint of this world");
  const JointWidth width = joint_width(model.jnt_type[joint.id]);
  return {state_part(model, state(), mjSTATE_QPOS)
              .subspan(static_cast<size_t>(model.jnt_qposadr[joint.id]), width.qpos),
          state_part(model, state(), mjSTATE_QVEL)
              .subspan(static_cast<size_t>(model.jnt_dofadr[joint.id]), width.qvel)};
}

SensorState Snapshot::operator[](SensorHandle sensor) const {
  const mjModel& model = *data_->world->model;
  GLOAM_CHECK(sensor.id >= 0 && sensor.id < model.nsensor, "not a sensor of this world");
  return {std::span<const double>(data_->sensordata)
              .subspan(static_cast<size_t>(model.sensor_adr[sensor.id]),
                       static_cast<size_t>(model.sensor_dim[sensor.id])),
          data_->sensor_stamp};
}

double Snapshot::control(Actuator actuator) const {
  const mjModel& model = *data_->world->model;
  GLOAM_CHECK(actuator.id >= 0 && actuator.id < model.nu, "not an actuator of this world");
  return state_part(model, state(), mjSTATE_CTRL)[static_cast<size_t>(actuator.id)];
}

}  // namespace gloam

#include "sim/snapshots/snapshot.h"

#include "base/check.h"
#include "sim/state/state_layout.h"
#include "world/world.h"
#include "world/world_robots.h"

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

std::vector<Pose> Snapshot::mocap_poses() const {
  const mjModel& model = *data_->world->model;
  const std::span<const double> p = state_part(model, state(), mjSTATE_MOCAP_POS);
  const std::span<const double> q = state_part(model, state(), mjSTATE_MOCAP_QUAT);
  std::vector<Pose> poses(static_cast<size_t>(model.nmocap));
  for (size_t i = 0; i < poses.size(); ++i)
    poses[i] = {{p[3 * i], p[3 * i + 1], p[3 * i + 2]},
                {q[4 * i], q[4 * i + 1], q[4 * i + 2], q[4 * i + 3]}};
  return poses;
}

double Snapshot::control(Actuator actuator) const {
  const mjModel& model = *data_->world->model;
  check_handle(*data_, actuator, model.nactuator);
  GLOAM_CHECK(model.actuator_ctrlnum[actuator.id] > 0, "the actuator has no controls");
  return state_part(model, state(),
                    mjSTATE_CTRL)[static_cast<size_t>(model.actuator_ctrladr[actuator.id])];
}

std::shared_ptr<const ActiveTrajectory> Snapshot::trajectory(Joint joint) const {
  check_handle(*data_, joint, data_->world->model->njnt);
  const auto i = static_cast<size_t>(joint.id);
  return i < data_->trajectories.size() ? data_->trajectories[i] : nullptr;
}

std::shared_ptr<const ActiveTrajectory> Snapshot::trajectory(Robot robot) const {
  check_handle(*data_, robot, static_cast<int>(data_->world->robots.size()));
  const RobotInstance& instance = data_->world->robots[static_cast<size_t>(robot.id)];
  std::shared_ptr<const ActiveTrajectory> newest;
  for (const int joint : robot_joints(*data_->world->model, instance))
    if (auto one = trajectory(Joint{joint, robot.world});
        one != nullptr && (newest == nullptr || one->start_step > newest->start_step))
      newest = std::move(one);
  return newest;
}

const ActuatorOutputs* Snapshot::actuators(Robot robot) const {
  check_handle(*data_, robot, static_cast<mjtSize>(data_->world->robots.size()));
  for (const ActuatorOutputs& outputs : data_->actuators)
    if (outputs.robot == robot.id) return &outputs;
  return nullptr;
}

}  // namespace gloam

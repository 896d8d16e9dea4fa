#include "sim/effects/wind/rotor_thrust.h"

#include "scene/files/mujoco_guard.h"
#include "world/model_memory.h"
#include "world/shapes/visual_pose.h"

namespace gloam {

RotorThrust::RotorThrust(std::shared_ptr<const CompiledWorld> world)
    : world_(std::move(world)), model_(*world_->model) {
  model_.opt.enableflags &= ~mjENBL_SLEEP;  // sleeping bodies would be left out
  model_.opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_CONTACT | mjDSBL_SENSOR;  // not asked for
}

Result<std::unique_ptr<RotorThrust>> RotorThrust::create(
    std::shared_ptr<const CompiledWorld> world) {
  std::unique_ptr<RotorThrust> made(new RotorThrust(std::move(world)));
  made->data_ = make_data(made->model_);
  return made;
}

Status RotorThrust::solve(const Snapshot& snapshot, std::vector<GasRotor>* rotors) {
  const SnapshotData& in = snapshot.data();
  model_.opt.timestep = in.timestep;
  mjData* d = data_.get();
  GLOAM_TRY_STATUS(guarded([&] {
    mj_setState(&model_, d, in.state.data(), mjSTATE_INTEGRATION);
    set_applied_controls(in.actuators, *world_->model, &model_, d);
    mj_fwdPosition(&model_, d);
    mj_fwdVelocity(&model_, d);
    mj_fwdActuation(&model_, d);
  }));
  rotors->clear();
  for (const RotorDescription& rotor : world_->gases.rotors) {
    const Affine3f X_WB = rigid_pose(d->xpos + 3 * rotor.body, d->xquat + 4 * rotor.body);
    GasRotor out;
    out.hub = transform_point(X_WB, rotor.p_B);
    out.axis = transform_vector(X_WB, rotor.axis_B);
    out.radius = rotor.radius;
    out.thrust = rotor.thrust;
    if (rotor.actuator >= 0) out.thrust *= static_cast<float>(d->actuator_force[rotor.actuator]);
    mjtNum twist[6];  // angular, linear at the body's frame
    mj_objectVelocity(&model_, d, mjOBJ_XBODY, rotor.body, twist, 0);
    const auto float3 = [](const mjtNum* v) {
      return Vec3f{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    };
    out.velocity = float3(twist + 3) + cross(float3(twist), out.hub - X_WB.p);
    rotors->push_back(out);
  }
  return {};
}

}  // namespace gloam

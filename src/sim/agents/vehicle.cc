#include "sim/agents/vehicle.h"

namespace gloam {

std::array<PartPose, kVehicleParts> vehicle_pose(const VehicleShape& shape, AgentKind kind, Vec3d p,
                                                 double heading, const VehicleState& state) {
  constexpr double kForkHeight = 0.15;  // carried low [m]
  std::array<PartPose, kVehicleParts> pose;
  const Quat q = turn_z(heading);
  pose[kChassis] = {p, q};
  pose[kFork] = {p + Vec3d{0, 0, kForkHeight}, q};
  // A forklift is steered by its rear wheels, the others by the front ones.
  const bool steers_rear = kind == AgentKind::kForklift;
  for (int i = 0; i < 4; ++i) {
    const bool is_front = i < 2;
    const double side = i % 2 == 0 ? 1 : -1;
    const Vec3d at{(is_front ? 0.5 : -0.5) * shape.wheelbase, side * shape.track / 2,
                   shape.wheel_radius};
    const double steer = is_front != steers_rear ? state.steer * (steers_rear ? -1 : 1) : 0;
    pose[static_cast<size_t>(kWheelFL + i)] = {p + rotated(q, at),
                                               q * turn_z(steer) * turn_y(state.roll)};
  }
  return pose;
}

}  // namespace gloam

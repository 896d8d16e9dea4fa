#pragma once
// Motion of vehicles: a bicycle model (Rajamani 2012, Vehicle Dynamics and Control, 2.2) without
// slip. Its reference point is on the ground in the middle between the axles. A cart, which can
// turn on the spot, has fixed driven wheels behind and castors in front.

#include <array>

#include "sim/agents/agent_math.h"
#include "world/agents/agent_description.h"

namespace gloam {

struct VehicleState {
  double curvature = 0;              ///< curvature that its wheels are set to, to the left [1/m]
  std::array<double, 4> roll = {};   ///< angles by which the wheels have turned [rad]
  std::array<double, 4> angle = {};  ///< steering angles, to the left [rad]
};

/// x of the middle between the axles, in the frame of the prop [m].
inline double axle_middle(const VehicleSize& size) {
  return 0.5 * (static_cast<double>(size.front_axle.x) + static_cast<double>(size.rear_axle.x));
}
/// From the bumper to the reference point, and from there to the end [m].
inline double length_ahead(const VehicleSize& size) {
  return static_cast<double>(size.front) - axle_middle(size);
}
inline double length_behind(const VehicleSize& size) {
  return axle_middle(size) - static_cast<double>(size.rear);
}

/// Deceleration with which drivers plan to slow down [m/s²]: what is left of the brakes is for what
/// they do not foresee.
inline double planned_slowing(const VehicleSize& size) { return 0.55 * size.brakes; }

/// Speed at which a bend of that curvature is taken [m/s].
double bend_speed(double curvature);

/// Speed and heading follow the velocity that is wanted, for `dt` [s].
void drive(const VehicleSize& size, double dt, Vec3d wanted, Vec3d* velocity, double* heading,
           double* yaw_rate, VehicleState* state);

/// Its wheels follow what it did in `dt`: `speed` ahead [m/s].
void roll_wheels(const VehicleSize& size, double dt, double speed, double yaw_rate,
                 VehicleState* state);

/// Poses of all parts; `p` on the ground in the middle between the axles [m].
std::array<PartPose, kVehicleParts> vehicle_pose(const VehicleSize& size, Vec3d p, double heading,
                                                 const VehicleState& state);

}  // namespace gloam

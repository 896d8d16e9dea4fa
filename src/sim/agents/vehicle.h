#pragma once
// How a vehicle stands on the ground: wheels that turn and steer, a fork at rest.

#include <array>

#include "sim/agents/agent_math.h"
#include "world/agent_description.h"

namespace gloam {

struct VehicleState {
  double roll = 0;   ///< angle that the wheels have turned by [rad]
  double steer = 0;  ///< of the steered axle, to the left [rad]
};

/// Of all parts; `p` on the ground in the middle between the wheels [m].
std::array<PartPose, kVehicleParts> vehicle_pose(const VehicleShape& shape, AgentKind kind, Vec3d p,
                                                 double heading, const VehicleState& state);

}  // namespace gloam

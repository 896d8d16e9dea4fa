#pragma once
// Controller "osc": operational-space control of one frame.

#include "gloam/controller.h"
#include "world/world.h"

namespace gloam {

/// Moves the frame of TaskSpaceOptions to the goal of SetPoseGoal as a decoupled mass with spring
/// and damper; without a goal it keeps the pose that it has at the start. O. Khatib, "A unified
/// approach for motion and force control of robot manipulators: the operational space
/// formulation", 1987:
///   τ = Jᵀ Λ (a_d - J̇ v) + (1 - Jᵀ Λ J M⁻¹) τ₀ + h,  Λ = (J M⁻¹ Jᵀ)⁻¹
/// with a_d = k e - 2 ζ √k ẋ for the position and the orientation, τ₀ = M (k₀ (q₀ - q) - 2 ζ √k₀ v)
/// towards the initial posture, and h the Coriolis, centrifugal and gravity torques. Springs and
/// dampers of joints are not compensated. In singular directions Λ is bounded.
/// Errors: those of find_task_frame; a joint between the frame and the world has no motor.
Result<std::unique_ptr<Controller>> make_operational_space_controller(const CompiledWorld& world,
                                                                      const RobotInstance& robot);

}  // namespace gloam

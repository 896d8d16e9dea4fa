#pragma once
// A World with one robot from MJCF text, and a simulation of it with the robot's controllers.

#include <memory>
#include <string>

#include "gloam/snapshot.h"
#include "sim/loop/simulator.h"
#include "world/world.h"

namespace gloam {

/// The robot is the tree of body 1, without a prefix; its name is that of its options, "robot" if
/// they have none.
std::shared_ptr<CompiledWorld> make_robot_world(const std::string& mjcf, RobotOptions options);

/// A lockstep simulation of the World with all controllers of its robot, ready to step.
std::unique_ptr<Simulator> start_robot(const std::shared_ptr<const CompiledWorld>& world);

/// Body 1 at the present instant.
BodyState base_of(Simulator& sim);

/// Force of an actuator, as Instant::force gives it.
double force_of(Simulator& sim, int actuator);

}  // namespace gloam

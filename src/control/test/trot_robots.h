#pragma once
// Robots to try the trot on.

#include <mujoco/mujoco.h>

#include <functional>
#include <memory>
#include <string>

#include "world/world.h"

namespace gloam {

struct DataDelete {
  void operator()(mjData* d) const { mj_deleteData(d); }
};
using TestData = std::unique_ptr<mjData, DataDelete>;

/// The robot of assets/robots/quadruped on a floor with this friction (feet get it too, since
/// MuJoCo takes the larger of the two). `change` edits the spec before it is compiled.
ModelPtr load_quadruped(double friction = 0.8,
                        const std::function<void(mjSpec*)>& change = nullptr);

/// A quadruped that shares nothing with ours but the idea: half as large again, 32 kg, rear knees
/// bent the other way, hip and thigh hinges on one body, feet on welded bodies, turned link frames,
/// legs and motors in another order, geared motors.
ModelPtr load_other_quadruped();
std::string other_quadruped_xml();

/// Compiles MJCF text; a failure fails the test.
ModelPtr compile_text(const std::string& xml);

/// The body "trunk" of a model as a RobotInstance.
RobotInstance robot_instance(const mjModel& model);

}  // namespace gloam

// Branches: two ways on from one instant. A checkpoint can be restored as often as one likes, in
// any simulation of the same scene.

#include "example.h"
#include "gloam/simulation.h"

int main(int argc, char** argv) {
  const gloam::World world = world_of(argc, argv);
  const auto simulation = take(gloam::Simulation::create(world, {.pace = gloam::Pace::kLockstep}));
  check(simulation->step(100));
  const gloam::Checkpoint start = take(simulation->checkpoint());
  const gloam::RobotInfo robot = world.robots()[0];
  for (const double value : {0.5, -0.5}) {
    check(simulation->restore(start));
    // Nobody else drives the robot in the meantime.
    const auto lease = take(simulation->claim(robot.robot));
    check(lease->post(gloam::Command{
        .what = gloam::SetControls{robot.robot, std::vector(robot.actuators.size(), value)}}));
    check(simulation->step(200));
    std::printf("control %+.1f: step %ld, first joint at %+.3f\n", value,
                static_cast<long>(simulation->latest().step()),
                simulation->latest()[robot.joints[0]].position());
  }
}

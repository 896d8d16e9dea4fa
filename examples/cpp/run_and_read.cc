// Runs a scene for a second and reads joints, bodies and contacts of the instant that it comes to.

#include "example.h"

int main(int argc, char** argv) {
  const gloam::World world = world_of(argc, argv);
  const auto simulation = take(gloam::Simulation::create(world, {.pace = gloam::Pace::kLockstep}));
  const gloam::Rational rate = simulation->step_rate();
  check(simulation->step(rate.num / rate.den));
  const gloam::Snapshot now = simulation->latest();
  std::printf("t = %.3f s, state hash %016llx\n", now.time(),
              static_cast<unsigned long long>(now.hash()));
  for (const gloam::RobotInfo& robot : world.robots()) {
    std::printf("robot '%s': %zu joints, %zu actuators\n", robot.name.c_str(), robot.joints.size(),
                robot.actuators.size());
    for (const gloam::Joint joint : robot.joints)
      if (now[joint].qpos.size() == 1)
        std::printf("  joint %d at %.4f\n", joint.id, now[joint].position());
  }
  gloam::Instant instant;
  check(instant.solve(now));
  std::printf("%zu contacts\n", instant.contacts().size());
}

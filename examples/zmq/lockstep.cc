// Keeps a pole upright from another process, in lockstep: it sees each state before the next step
// is taken.
//
//   gloam run examples/zmq/cartpole.toml --paused
//   cmake -S examples/zmq -B /tmp/zmq && cmake --build /tmp/zmq && /tmp/zmq/lockstep

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "client.h"

int main() {
  // Force [N] per m, m/s of the cart, rad, rad/s of the pole: linear-quadratic, weights 1, 1, 10, 1
  // and 0.1.
  constexpr double kGains[] = {3.2, 5.8, 45.9, 9.2};
  try {
    gloam_zmq::Client sim;
    sim.pause();
    sim.set_joint("cartpole/hinge", 0.2);
    gloam_zmq::State state = sim.step(1);
    for (int i = 0; i < 1000; ++i) {
      const double force = kGains[0] * state.qpos.at(0) + kGains[1] * state.qvel.at(0) +
                           kGains[2] * state.qpos.at(1) + kGains[3] * state.qvel.at(1);
      sim.set_controls("cartpole", {std::clamp(force, -20.0, 20.0)});
      state = sim.step(5);
    }
    std::printf("step %" PRId64 ", %.3f s, cart at %.4f m, pole at %.4f rad, hash %016" PRIx64 "\n",
                state.step, state.time, state.qpos[0], state.qpos[1], state.hash);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lockstep: %s\n", error.what());
    return 1;
  }
  return 0;
}

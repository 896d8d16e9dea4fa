// A controller of one's own: registered by a name that scenes may use, with a setting of its own.
// The scene here is a text; its robot is the model that is given.

#include <cmath>
#include <filesystem>

#include <mujoco/mujoco.h>

#include "example.h"
#include "gloam/controller.h"

namespace {

/// Swings every actuator by a sine.
class Sway final : public gloam::Controller {
 public:
  explicit Sway(double amplitude) : amplitude_(amplitude) {}
  void reset(const mjModel*, const mjData*) override {}
  void control(const gloam::ControlInputs& in) override {
    for (int i = 0; i < in.model->nu; ++i)
      in.data->ctrl[i] = amplitude_ * std::sin(6.283 * in.data->time);
  }

 private:
  double amplitude_;
};

gloam::Result<std::unique_ptr<gloam::Controller>> make_sway(
    const gloam::ControllerRequest& request) {
  GLOAM_TRY(const std::vector<double> amplitude,
            gloam::controller_param(request.robot.controller, "amplitude"));
  return std::unique_ptr<gloam::Controller>(
      std::make_unique<Sway>(amplitude.empty() ? 1.0 : amplitude[0]));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  check(gloam::register_controller("sway", make_sway));
  const std::filesystem::path model = std::filesystem::absolute(argv[1]);
  const gloam::Scene scene = take(gloam::parse_scene(
      "[[robot]]\nname = \"arm\"\nfile = \"" + model.filename().string() +
          "\"\n[robot.controller]\ntype = \"sway\"\nparams = { amplitude = 0.5 }\n",
      model.parent_path()));
  const gloam::World world = take(gloam::World::compile(scene));
  const auto simulation = take(gloam::Simulation::create(world, {.pace = gloam::Pace::kLockstep}));
  const gloam::RobotInfo robot = world.robots()[0];
  double most = 0;
  const auto watch =
      take(simulation->open_snapshots({.required = true}, [&](const gloam::Snapshot& now) {
        for (const gloam::Actuator actuator : robot.actuators)
          most = std::max(most, std::abs(now.control(actuator)));
      }));
  check(simulation->step(500));
  std::printf("most control %.2f\n", most);
}

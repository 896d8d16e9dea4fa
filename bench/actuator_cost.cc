// Cost of the actuator models of a robot with 12 motors, a step: every model but the network.
// Prints the median of microseconds.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "control/actuators/actuators.h"
#include "scene/files/mujoco_guard.h"

namespace gloam {
namespace {

constexpr int kMotors = 12, kBlocks = 21, kSteps = 20000;

std::string model_of_motors() {
  std::string bodies, motors;
  for (int i = 0; i < kMotors; ++i) {
    bodies += fmt::format(
        R"(<body pos="{} 0 0"><joint name="j{}" armature=".01"/><geom size=".1"/></body>)", i, i);
    motors += fmt::format(R"(<motor joint="j{}"/>)", i);
  }
  return fmt::format(
      "<mujoco><worldbody><body name=\"base\">{}</body></worldbody><actuator>{}"
      "</actuator></mujoco>",
      bodies, motors);
}

RobotOptions every_model() {
  const ActuatorOptions motor{
      .gear_ratio = 6,
      .stall_torque = 4,
      .no_load_speed = 180,
      .torque_limit = 23.7,
      .torque_constant = 0.1,
      .winding_resistance = 0.2,
      .delay = 0.004,
      .backlash = 0.005,
      .friction = ActuatorFriction{.coulomb = 0.2, .breakaway = 0.3, .viscous = 0.01},
      .thermal = MotorThermal{.thermal_resistance = 2, .heat_capacity = 50}};
  return {.actuators = SharedActuatorOptions{.battery = BatteryOptions{.voltage = 24}},
          .actuator = {motor}};
}

Status run() {
  install_mujoco_handler();
  char message[500] = "";
  const SpecPtr spec(mj_parseXMLString(model_of_motors().c_str(), nullptr, message, 500));
  if (spec == nullptr) return Error{ErrorKind::kInput, message};
  CompiledWorld world;
  world.model.reset(mj_compile(spec.get(), nullptr));
  RobotInstance robot;
  robot.name = "motors";
  robot.root_body = 1;
  robot.options = every_model();
  mjModel& model = *world.model;
  GLOAM_TRY(const std::unique_ptr<ActuatorLayer> layer, make_actuators(world, robot));
  GLOAM_TRY_STATUS(layer->begin(model, {1, 500}));
  const DataPtr data(mj_makeData(&model));
  layer->reset(model, *data);
  std::vector<double> costs;
  uint64_t hash = 0;
  for (int block = 0; block < kBlocks; ++block) {
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < kSteps; ++k) {
      for (int i = 0; i < model.nu; ++i) data->ctrl[i] = (k + i) % 40 - 20;
      if (!layer->apply(model, *data)) return layer->error();
      hash = layer->hash(hash);
    }
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
    costs.push_back(took.count() / kSteps);
  }
  std::ranges::sort(costs);
  fmt::print(
      "{{\"name\": \"actuator_cost\", \"motors\": {}, \"us_per_step\": {:.3f}, \"hash\": "
      "\"{:016x}\"}}\n",
      kMotors, costs[kBlocks / 2], hash);
  return {};
}

}  // namespace
}  // namespace gloam

int main() {
  const gloam::Status status = gloam::run();
  if (status.ok()) return 0;
  fmt::print(stderr, "{}\n", status.error().to_string());
  return 1;
}

#include "policy/policy_controller.h"

#include <fmt/format.h>

#include <cmath>

#include "base/log.h"
#include "policy/opened_policies.h"
#include "policy/policy.h"
#include "scene/files/file_finder.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

class PolicyController final : public Controller {
 public:
  PolicyController(std::unique_ptr<PolicyRunner> runner, std::string robot,
                   const ControllerOptions& options)
      : runner_(std::move(runner)),
        robot_(std::move(robot)),
        network_(options.network),
        settings_(options.settings) {}

  ControllerTraits traits() const override { return {.every_step = true, .is_logged = true}; }

  Status set_period(double period) override {
    GLOAM_TRY(every_, steps_per_action(runner_->policy().spec.rate, period));
    return {};
  }

  void reset(const mjModel*, const mjData*) override {
    runner_->reset();
    step_ = 0;
    fault_ = {};
  }

  // With another network or other joints it starts from the beginning.
  void take_over(const mjModel* model, const mjData* data, const Controller& before) override {
    reset(model, data);
    const auto* old = dynamic_cast<const PolicyController*>(&before);
    if (old == nullptr || old->every_ != every_ || !runner_->take_over(*old->runner_)) return;
    step_ = old->step_;
    fault_ = old->fault_;
  }

  void control(const ControlInputs& in) override {
    if (!is_damping() && step_ % every_ == 0) {
      fault_ =
          runner_->act(*in.model, *in.data, in.loads, {in.goal.vx, in.goal.vy, in.goal.yaw_rate});
      if (is_damping()) report(in.data->time);
    }
    ++step_;
    if (is_damping())
      runner_->robot().damp(in.data);
    else
      runner_->robot().drive(runner_->targets(), in.data);
  }

  std::unique_ptr<Controller> clone() const override {
    std::unique_ptr<PolicyRunner> runner = runner_->clone();
    if (runner == nullptr) return nullptr;
    std::unique_ptr<PolicyController> copy(new PolicyController(*this, std::move(runner)));
    return copy;
  }

  PolicyState state() const {
    const Policy& policy = runner_->policy();
    const auto action = runner_->action(), targets = runner_->targets();
    PolicyState state{
        network_, settings_, {action.begin(), action.end()}, {targets.begin(), targets.end()}};
    for (size_t i = 0; i < policy.networks.size(); ++i) {
      auto& inputs = state.observations.emplace_back();
      for (size_t k = 0; k < policy.networks[i]->inputs().size(); ++k) {
        const auto input = runner_->observation(i, k);
        inputs.emplace_back(input.begin(), input.end());
      }
    }
    state.is_servo = runner_->robot().is_servo();
    state.fault = describe(policy, fault_);
    return state;
  }

 private:
  PolicyController(const PolicyController& other, std::unique_ptr<PolicyRunner> runner)
      : runner_(std::move(runner)),
        robot_(other.robot_),
        network_(other.network_),
        settings_(other.settings_),
        every_(other.every_),
        step_(other.step_),
        fault_(other.fault_) {}

  bool is_damping() const { return fault_.kind != PolicyFault::Kind::kNone; }

  // Once in a run: the message may allocate.
  void report(double time) {
    log_error("robot '{}' at {:.3f} s: {}; its joints are damped from now on", robot_, time,
              describe(runner_->policy(), fault_));
  }

  std::unique_ptr<PolicyRunner> runner_;
  std::string robot_;
  fs::path network_, settings_;  // as in its options
  int64_t every_ = 1, step_ = 0;
  PolicyFault fault_;
};

Result<std::shared_ptr<const Policy>> find_policy(const CompiledWorld& world,
                                                  const ControllerOptions& options,
                                                  NetworkLoader loader) {
  if (options.network.empty() && options.settings.empty())
    return Error{ErrorKind::kInput, "controller 'policy' needs a network", options.loc,
                 "set network = \"policy.onnx\" in [robot.controller]"};
  fs::path network = options.network, settings = options.settings;
  GLOAM_TRY(std::shared_ptr<const Policy> opened, find_opened_policy(network, settings));
  if (opened != nullptr) return opened;
  // Clients of bridges may set these paths: they reach the files that the scene could name.
  GLOAM_TRY(const FileFinder finder, FileFinder::of_scene(world.scene.file, world.scene.access));
  GLOAM_TRY_STATUS(finder.find(&network, options.loc));
  GLOAM_TRY_STATUS(finder.find(&settings, options.loc));
  return Policy::load(network, settings, loader);
}

/// Values of the gait that the scene sets in [robot.controller.params].
Status apply_params(const ControllerOptions& options, GaitOptions* gait) {
  if (options.params.text.empty()) return {};
  Settings settings(options.loc.file);
  GLOAM_TRY(const toml::table document,
            parse_toml("params = " + options.params.text, options.loc.file));
  if (const toml::table* table = settings.table(document, "params"))
    read_gait(*table, &settings, gait);
  if (settings.ok()) return {};
  Error error = settings.status().error();
  error.loc = options.loc;
  return error;
}

}  // namespace

std::optional<PolicyState> state_of_policy(const Controller& controller) {
  const auto* policy = dynamic_cast<const PolicyController*>(&controller);
  if (policy == nullptr) return {};
  return policy->state();
}

Result<int64_t> steps_per_action(double rate, double timestep) {
  const double steps = 1 / (rate * timestep);
  const double whole = std::max(1.0, std::round(steps));
  if (std::abs(steps - whole) <= 1e-6 * steps) return static_cast<int64_t>(whole);
  return Error{ErrorKind::kUsage,
               fmt::format("a policy of {:g} Hz would act every {:g} steps of {:g} s, which is not "
                           "a whole number",
                           rate, steps, timestep),
               {},
               fmt::format("use a timestep of {:g} s", 1 / (rate * whole))};
}

Result<std::unique_ptr<Controller>> make_policy_controller(const CompiledWorld& world,
                                                           const RobotInstance& robot,
                                                           NetworkLoader loader) {
  const ControllerOptions& options = robot.options.controller;
  GLOAM_TRY(std::shared_ptr<const Policy> policy, find_policy(world, options, loader));
  GaitOptions gait = policy->spec.gait;
  GLOAM_TRY_STATUS(apply_params(options, &gait));
  const TermBinding binding{world.model.get(), &robot, &policy->spec};
  auto runner = PolicyRunner::create(policy, binding, gait);
  if (!runner.ok()) {
    Error error = runner.error();
    if (error.loc.file.empty()) error.loc = options.loc;
    return error;
  }
  return std::unique_ptr<Controller>(
      std::make_unique<PolicyController>(std::move(*runner), robot.name, options));
}

Result<std::unique_ptr<Controller>> make_policy_controller(const CompiledWorld& world,
                                                           const RobotInstance& robot) {
  return make_policy_controller(world, robot, load_onnx_network);
}

Result<RobotGoals> policy_goals(const CompiledWorld& world, const RobotInstance& robot) {
  GLOAM_TRY(const auto policy, find_policy(world, robot.options.controller, load_onnx_network));
  const auto range = [&](size_t axis) {
    const auto& [low, high] = policy->spec.command_ranges[axis];
    return VelocityRange{low, high};
  };
  return RobotGoals{.velocity = VelocityRanges{range(0), range(1), range(2)}};
}

}  // namespace gloam

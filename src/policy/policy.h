#pragma once
// A policy: networks, the specification of their training, and the loop that connects both.

#include <filesystem>
#include <memory>
#include <vector>

#include "policy/observer.h"
#include "policy/policy_robot.h"
#include "policy/policy_spec.h"
#include "policy/velocity_feedback.h"

namespace gloam {

/// Networks that fit their specification. Immutable; runners share it.
struct Policy {
  PolicySpec spec;
  std::vector<std::unique_ptr<Network>> networks;
  std::vector<NetworkWiring> wiring;
  size_t action_output = 0;  ///< of the last network

  /// `network`: an ONNX file; may be empty if `settings`, a TOML file, lists [[network]] tables.
  /// `settings` may be empty if the metadata is complete. Errors: those of the files, of the spec
  /// and of wire_networks(); actions that are not one per joint.
  static Result<std::shared_ptr<const Policy>> load(const std::filesystem::path& network,
                                                    const std::filesystem::path& settings,
                                                    NetworkLoader loader = load_onnx_network);
};

/// Reason why a policy stopped.
struct PolicyFault {
  enum class Kind { kNone, kObservation, kAction, kLibrary };
  Kind kind = Kind::kNone;
  size_t network = 0, part = 0;  ///< of an observation
  size_t joint = 0;              ///< of an action
};
std::string describe(const Policy& policy, const PolicyFault& fault);

/// One robot's instance of a policy, with its own past. No allocation after create().
class PolicyRunner {
 public:
  /// Errors: those of PolicyRobot and of terms that do not find their elements.
  static Result<std::unique_ptr<PolicyRunner>> create(std::shared_ptr<const Policy> policy,
                                                      const TermBinding& binding,
                                                      const GaitOptions& gait);
  std::unique_ptr<PolicyRunner> clone() const;

  void reset();
  /// Continues where `other`, of a policy of the same shape, is. False: it has another shape.
  bool take_over(const PolicyRunner& other);

  /// Observes and runs the networks; `command`: vx, vy [m/s], yaw rate [rad/s].
  PolicyFault act(const mjModel& model, const mjData& data, std::span<const ContactLoad> loads,
                  const std::array<double, 3>& command);

  std::span<const double> action() const { return action_; }    ///< after its clip, (n)
  std::span<const double> targets() const { return targets_; }  ///< [rad], (n)
  const PolicyRobot& robot() const { return robot_; }
  const Policy& policy() const { return *policy_; }
  /// Inputs of a network in the last period.
  std::span<const float> observation(size_t network, size_t input = 0) const {
    return networks_[network]->input(input);
  }

 private:
  PolicyRunner(std::shared_ptr<const Policy> policy, PolicyRobot robot, GaitOptions gait);
  bool open_networks();
  bool run(size_t network, const TermInputs& inputs, PolicyFault* fault);
  void fill(size_t network, TermInputs inputs, const mjData& data);
  bool prime(TermInputs inputs, PolicyFault* fault);
  PolicyFault take_action();

  std::shared_ptr<const Policy> policy_;
  PolicyRobot robot_;
  GaitOptions gait_;
  std::vector<std::unique_ptr<Network>> networks_;
  std::vector<std::vector<std::vector<float>>> outputs_;  // by network and output
  std::vector<Observer> observers_;
  RobotState state_;
  GaitClock clock_;
  VelocityFeedback feedback_;
  int64_t period_ = 0;
  std::vector<double> action_, previous_action_, targets_;
};

}  // namespace gloam

#pragma once
// Policies: neural networks that control robots (docs/policies.md). Scenes name them in
// [robot.controller]; programs read them here and start them with SetController.

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gloam/handle.h"
#include "gloam/result.h"
#include "gloam/scene/robot.h"

namespace gloam {

class Simulation;
struct Policy;  // src/policy/policy.h
class Network;  // src/policy/network.h

/// An observation term that a policy's settings may name.
struct PolicyTermInfo {
  std::string name;
  std::vector<std::string> aliases;
  /// Numbers of an observation = fixed + per_joint * joints of the policy; both 0 = the keys of its
  /// [[observation]] determine them.
  size_t fixed = 0, per_joint = 0;
  std::string unit, doc;
};

/// All terms, in the order of docs/policies.md.
std::vector<PolicyTermInfo> policy_terms();

/// An input or output of a network. Multi-dimensional tensors are flattened, the last dimension
/// fastest.
struct NetworkPort {
  std::string name;
  size_t size = 0;  ///< numbers for one observation
};

/// One part of an observation: an [[observation]] table.
struct PolicyPartInfo {
  std::string term;                 ///< its name in policy_terms()
  size_t size = 0;                  ///< numbers, with its history
  std::vector<double> scale;        ///< one number, or one for each value
  std::array<double, 2> clip = {};  ///< in the term's unit, before the scale
  int history = 1;                  ///< observations that are concatenated
  std::string sensor;               ///< gives the values; "" = the true state does
  std::string input;                ///< of the network
  std::string from;                 ///< "NETWORK.OUTPUT" that the term reads; "" = none
};

struct PolicyNetworkInfo {
  std::string name;
  int every = 1;    ///< it runs in each k-th control period
  int history = 1;  ///< whole observations of its first input
  std::vector<PolicyPartInfo> parts;
  std::vector<NetworkPort> inputs, outputs;
};

/// The settings with which a policy was trained. Lists are (n), in the order of `joints`.
struct PolicyInfo {
  double rate = 0;                                                ///< [Hz]
  std::vector<std::string> joints;                                ///< names in the policy
  std::vector<std::pair<std::string, std::string>> model_joints;  ///< other names in the model
  std::vector<double> kp, kd;                                     ///< [N m/rad], [N m s/rad]
  std::vector<double> default_positions;                          ///< [rad]
  std::vector<double> action_scale;  ///< target = default + scale * action [rad]
  std::vector<double> torque_limit;  ///< [N m]; infinite = none
  std::array<double, 2> action_clip = {};
  bool starts_with_zeros = false;  ///< before the first observation: zeros, else repetitions of it
  double gait_period = 0;          ///< of the terms phase, sin_phase, cos_phase [s]
  /// Low and high vx, vy [m/s] and yaw rate [rad/s]; infinite = no limit.
  std::array<std::array<double, 2>, 3> command_ranges = {};
  double velocity_feedback = 0;  ///< integral gain of the velocity's error [1/s]; 0 = none
  std::vector<PolicyNetworkInfo> networks;  ///< the last one gives the actions
};

/// A policy that a program has read. Copies share the networks; one thread at a time.
class LoadedPolicy {
 public:
  /// `network`: an ONNX file; may be empty if `settings`, a TOML file, names all networks.
  /// `settings` may be empty if the network's metadata suffices. From now on controllers of this
  /// process may read these two files and, beside the settings, the networks that they name, also
  /// outside of the scene's root. Errors: a file that does not exist or is malformed, with its
  /// line; terms that do not fill a network's inputs; OpenVINO is not installed.
  static Result<LoadedPolicy> load(const std::filesystem::path& network,
                                   const std::filesystem::path& settings = {});

  const PolicyInfo& info() const { return *info_; }
  const std::filesystem::path& network() const { return network_; }    ///< absolute or empty
  const std::filesystem::path& settings() const { return settings_; }  ///< absolute or empty
  /// Options of the controller that runs it.
  ControllerOptions controller() const;

  /// Runs the network once, without a robot: actions (n) of an observation (m), neither clipped nor
  /// scaled. Errors: the policy has several networks or inputs; another size; an action is not
  /// finite (kDiverged).
  Result<std::vector<double>> infer(std::span<const float> observation) const;

 private:
  std::shared_ptr<const Policy> policy_;
  std::shared_ptr<const PolicyInfo> info_;
  std::shared_ptr<Network> network_for_infer_;
  std::filesystem::path network_, settings_;
};

/// The metadata of an ONNX file by mjlab or holosoma as the text of a policy's TOML; "" = the file
/// has none of them. Errors: as for LoadedPolicy::load().
Result<std::string> policy_metadata(const std::filesystem::path& network);

/// A policy that controls a robot, after its latest control period.
struct PolicyState {
  std::filesystem::path network, settings;                    ///< as in its ControllerOptions
  std::vector<double> action;                                 ///< after its clip, (n)
  std::vector<double> targets;                                ///< [rad], (n)
  std::vector<std::vector<std::vector<float>>> observations;  ///< by network and input
  bool is_servo = false;  ///< position servos of the policy's gains receive the targets
  std::string fault;      ///< reason why the joints are damped; "" = they are not
};

/// Any thread, also in step hooks. Empty: the robot's controller is not a policy. Errors: a handle
/// of another World; `simulation` is a replay.
Result<std::optional<PolicyState>> policy_state(Simulation& simulation, Robot robot);

}  // namespace gloam

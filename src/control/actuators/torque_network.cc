// A learned map from the last position errors and velocities of a joint to its torque: Hwangbo et
// al. 2019 (Learning agile and dynamic motor skills for legged robots, Science Robotics 4,
// eaau5872). Walk-These-Ways and Isaac Lab's ActuatorNetMLP use three samples 5 ms apart.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

class TorqueNetwork final : public ActuatorModel {
 public:
  struct Joint {
    size_t row;
    size_t network;
    int64_t period;  // [steps]
    size_t first;    // of its inputs in numbers_: errors or velocities first
    int64_t wait = 0;
    float torque = 0;  // output of the network
    bool is_new = true;
  };

  TorqueNetwork(std::vector<std::unique_ptr<ActuatorNetwork>> networks, std::vector<Joint> joints,
                size_t numbers)
      : networks_(std::move(networks)), joints_(std::move(joints)), numbers_(numbers) {}
  TorqueNetwork(const TorqueNetwork& other) : joints_(other.joints_), numbers_(other.numbers_) {
    for (const auto& network : other.networks_) networks_.push_back(network->share());
  }

  std::string_view kind() const override { return "network"; }
  void reset(std::span<Drive>) override {
    for (Joint& joint : joints_) {
      joint.wait = 0;
      joint.torque = 0;
      joint.is_new = true;
    }
  }
  void take_over(const ActuatorModel& before, std::span<const int> old_row) override {
    const auto& old = static_cast<const TorqueNetwork&>(before);
    for (Joint& joint : joints_) {
      for (const Joint& from : old.joints_) {
        const bool is_same = static_cast<int>(from.row) == old_row[joint.row];
        if (!is_same || from.period != joint.period || old.inputs(from) != inputs(joint)) continue;
        std::copy_n(&old.numbers_[from.first], inputs(joint), &numbers_[joint.first]);
        joint.wait = from.wait;
        joint.torque = from.torque;
        joint.is_new = from.is_new;
      }
    }
  }
  bool apply(ActuatorStep& step) override {
    for (Joint& joint : joints_) {
      Drive& drive = step.drives[joint.row];
      if (joint.wait == 0 && !evaluate(joint, drive, &step.error)) return false;
      joint.wait = (joint.wait + 1) % joint.period;
      drive.torque = static_cast<double>(joint.torque) * drive.options().network->torque_scale;
    }
    return true;
  }
  uint64_t hash(uint64_t before) const override {
    for (const Joint& joint : joints_) {
      before = hash_bytes(&joint.wait, sizeof(joint.wait), before);
      before = hash_bytes(&joint.torque, sizeof(joint.torque), before);
    }
    return hash_span<float>(numbers_, before);
  }
  std::unique_ptr<ActuatorModel> clone() const override {
    return std::make_unique<TorqueNetwork>(*this);
  }

 private:
  size_t inputs(const Joint& joint) const { return networks_[joint.network]->inputs(); }

  // target − position [rad]: a servo's own, or that of the controller whose torque a motor gets.
  static double position_error(const Drive& drive) {
    const ActuatorNetworkOptions& o = *drive.options().network;
    if (drive.setup->takes_target) return drive.command / drive.gear - drive.position;
    return (drive.demand + o.kd * drive.velocity) / *o.kp;
  }

  // The newest sample of a history is the first.
  void remember(Joint& joint, size_t first, double value, size_t count) {
    const auto begin = numbers_.begin() + static_cast<ptrdiff_t>(first);
    const auto end = begin + static_cast<ptrdiff_t>(count);
    if (joint.is_new)
      std::fill(begin, end, static_cast<float>(value));
    else
      std::shift_right(begin, end, 1);
    *begin = static_cast<float>(value);
  }

  bool evaluate(Joint& joint, const Drive& drive, Error* error) {
    const ActuatorNetworkOptions& o = *drive.options().network;
    const auto count = static_cast<size_t>(o.history);
    const bool positions_first = o.order == "position_velocity";
    remember(joint, joint.first + (positions_first ? 0 : count),
             o.position_scale * position_error(drive), count);
    remember(joint, joint.first + (positions_first ? count : 0), o.velocity_scale * drive.velocity,
             count);
    joint.is_new = false;
    const bool ok =
        networks_[joint.network]->evaluate({&numbers_[joint.first], 2 * count}, {&joint.torque, 1});
    if (ok && std::isfinite(joint.torque)) return true;
    *error = {ErrorKind::kDiverged,
              fmt::format("the actuator network of joint '{}' returned {}", drive.setup->name,
                          ok ? "a torque that is not finite" : "an error"),
              drive.options().loc, "check the scales of its inputs, and that its file is complete"};
    return false;
  }

  std::vector<std::unique_ptr<ActuatorNetwork>> networks_;
  std::vector<Joint> joints_;
  std::vector<float> numbers_;  // inputs of all joints
};

std::string describe(const ActuatorOptions& o, const RobotOptions& robot) {
  return fmt::format("'network' of actuator '{}' of robot '{}'", o.joints, robot.name);
}

Status check_sizes(const ActuatorNetwork& network, const ActuatorOptions& o,
                   const RobotOptions& robot) {
  const auto wanted = static_cast<size_t>(2 * o.network->history);
  if (network.inputs() == wanted && network.outputs() == 1) return {};
  return Error{ErrorKind::kInput,
               fmt::format("{} has {} inputs and {} outputs; {} samples of position error and "
                           "velocity of one joint are {} inputs, its torque is 1 output",
                           describe(o, robot), network.inputs(), network.outputs(),
                           o.network->history, wanted),
               o.loc, "set 'history' to half the number of inputs"};
}

}  // namespace

Result<std::unique_ptr<ActuatorModel>> make_torque_network(const ActuatorParts& parts) {
  std::vector<std::filesystem::path> files;
  std::vector<std::unique_ptr<ActuatorNetwork>> networks;
  std::vector<TorqueNetwork::Joint> joints;
  size_t numbers = 0;
  for (size_t row = 0; row < parts.drives.size(); ++row) {
    const ActuatorOptions& o = parts.drives[row].options;
    if (!o.network) continue;
    size_t network = 0;
    while (network < files.size() && files[network] != o.network->file) ++network;
    if (network == files.size()) {
      Result<std::unique_ptr<ActuatorNetwork>> loaded = parts.load_network(o.network->file);
      if (!loaded) {
        Error error = loaded.error();
        if (error.loc.file.empty()) error.loc = o.loc;
        return error;
      }
      networks.push_back(std::move(*loaded));
      files.push_back(o.network->file);
    }
    GLOAM_TRY_STATUS(check_sizes(*networks[network], o, parts.robot));
    GLOAM_TRY(const int64_t period,
              whole_steps(o.network->period, parts.timestep,
                          fmt::format("'period' of {}", describe(o, parts.robot)), o.loc));
    joints.push_back({row, network, period, numbers});
    numbers += networks[network]->inputs();
  }
  if (joints.empty()) return std::unique_ptr<ActuatorModel>();
  return std::unique_ptr<ActuatorModel>(
      std::make_unique<TorqueNetwork>(std::move(networks), std::move(joints), numbers));
}

}  // namespace gloam

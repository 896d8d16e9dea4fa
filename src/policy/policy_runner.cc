#include <algorithm>
#include <cmath>

#include "policy/policy.h"

namespace gloam {

PolicyRunner::PolicyRunner(std::shared_ptr<const Policy> policy, PolicyRobot robot,
                           GaitOptions gait)
    : policy_(std::move(policy)), robot_(std::move(robot)), gait_(std::move(gait)) {
  const size_t joints = policy_->spec.joints.size();
  state_.q.resize(joints);
  state_.qd.resize(joints);
  action_.resize(joints);
  previous_action_.resize(joints);
  targets_ = policy_->spec.default_positions;
}

Result<std::unique_ptr<PolicyRunner>> PolicyRunner::create(std::shared_ptr<const Policy> policy,
                                                           const TermBinding& binding,
                                                           const GaitOptions& gait) {
  GLOAM_TRY(PolicyRobot robot, PolicyRobot::create(binding));
  std::unique_ptr<PolicyRunner> made(new PolicyRunner(std::move(policy), std::move(robot), gait));
  const Policy& p = *made->policy_;
  made->observers_.reserve(p.networks.size());
  for (size_t i = 0; i < p.networks.size(); ++i) {
    made->observers_.emplace_back(p.spec.networks[i], p.wiring[i]);
    GLOAM_TRY_STATUS(made->observers_.back().bind(binding));
  }
  if (!made->open_networks())
    return Error{
        ErrorKind::kIo, "OpenVINO could not create a request for a network", {p.spec.file, 0, 0}};
  return made;
}

bool PolicyRunner::open_networks() {
  for (const auto& network : policy_->networks) {
    networks_.push_back(network->share());
    if (networks_.back() == nullptr) return false;
    auto& outputs = outputs_.emplace_back();
    for (const NetworkPort& port : network->outputs()) outputs.emplace_back(port.size);
  }
  return true;
}

std::unique_ptr<PolicyRunner> PolicyRunner::clone() const {
  std::unique_ptr<PolicyRunner> copy(new PolicyRunner(policy_, robot_, gait_));
  if (!copy->open_networks()) return nullptr;
  copy->observers_.reserve(observers_.size());
  for (const Observer& observer : observers_) copy->observers_.emplace_back(observer);
  copy->take_over(*this);
  return copy;
}

bool PolicyRunner::take_over(const PolicyRunner& other) {
  const auto shape = [](const PolicyRunner& runner) {
    std::vector<size_t> sizes = {runner.action_.size()};
    for (const auto& network : runner.networks_)
      for (const auto* ports : {&network->inputs(), &network->outputs()})
        for (const NetworkPort& port : *ports) sizes.push_back(port.size);
    for (const NetworkWiring& wiring : runner.policy_->wiring)
      for (const PartWiring& part : wiring.parts) sizes.push_back(part.size);
    return sizes;
  };
  if (shape(*this) != shape(other) || policy_->spec.joints != other.policy_->spec.joints)
    return false;
  for (size_t i = 0; i < observers_.size(); ++i) observers_[i].take_over(other.observers_[i]);
  for (size_t i = 0; i < networks_.size(); ++i)
    for (size_t k = 0; k < networks_[i]->inputs().size(); ++k)
      std::ranges::copy(other.observation(i, k), networks_[i]->input(k).begin());
  outputs_ = other.outputs_;
  clock_ = other.clock_;
  feedback_ = other.feedback_;
  period_ = other.period_;
  action_ = other.action_;
  previous_action_ = other.previous_action_;
  targets_ = other.targets_;
  return true;
}

void PolicyRunner::reset() {
  for (Observer& observer : observers_) observer.reset();
  for (auto& network : outputs_)
    for (auto& output : network) std::ranges::fill(output, 0.0f);
  clock_ = {};
  feedback_.reset();
  period_ = 0;
  std::ranges::fill(action_, 0.0);
  std::ranges::fill(previous_action_, 0.0);
  targets_ = policy_->spec.default_positions;
}

void PolicyRunner::fill(size_t network, TermInputs inputs, const mjData& data) {
  const NetworkSpec& spec = policy_->spec.networks[network];
  for (size_t i = 0; i < spec.parts.size(); ++i) {
    const PartWiring& wiring = policy_->wiring[network].parts[i];
    inputs.source = {};
    if (wiring.count != 0)
      inputs.source = std::span<const float>(outputs_[wiring.source_network][wiring.source_output])
                          .subspan(wiring.first, wiring.count);
    observers_[network].observe(i, inputs, robot_.reading(data, spec.parts[i]));
  }
}

bool PolicyRunner::run(size_t network, const TermInputs& inputs, PolicyFault* fault) {
  fill(network, inputs, *inputs.data);
  const int bad =
      observers_[network].write(policy_->spec.starts_with_zeros, networks_[network].get());
  if (bad >= 0) {
    *fault = {PolicyFault::Kind::kObservation, network, static_cast<size_t>(bad), 0};
    return false;
  }
  if (!networks_[network]->run()) {
    *fault = {PolicyFault::Kind::kLibrary, network, 0, 0};
    return false;
  }
  for (size_t i = 0; i < outputs_[network].size(); ++i)
    std::ranges::copy(networks_[network]->output(i), outputs_[network][i].begin());
  return true;
}

// References of a motion are outputs of the network that tracks it: they are known before the first
// observation only after a run at the first frame, whose observation does not matter.
bool PolicyRunner::prime(TermInputs inputs, PolicyFault* fault) {
  for (size_t i = 0; i < networks_.size(); ++i) {
    if (!policy_->spec.networks[i].prime) continue;
    if (!run(i, inputs, fault)) return false;
    observers_[i].reset();
  }
  return true;
}

PolicyFault PolicyRunner::act(const mjModel& model, const mjData& data,
                              std::span<const ContactLoad> loads,
                              const std::array<double, 3>& command) {
  const PolicySpec& spec = policy_->spec;
  robot_.measure(data, &state_);
  std::array<double, 3> clipped;
  for (size_t i = 0; i < 3; ++i)
    clipped[i] = std::clamp(command[i], spec.command_ranges[i][0], spec.command_ranges[i][1]);
  clock_.tick(gait_, clipped, spec.rate);
  const std::array<double, 3> corrected = feedback_.correct(clipped, state_, spec);
  TermInputs inputs;
  inputs.model = &model;
  inputs.data = &data;
  inputs.loads = loads;
  inputs.spec = &spec;
  inputs.gait = &gait_;
  inputs.robot = &state_;
  inputs.command = corrected;
  inputs.action = action_;
  inputs.previous_action = previous_action_;
  inputs.clock = &clock_;
  inputs.period = period_;
  PolicyFault fault;
  if (period_ == 0 && !prime(inputs, &fault)) return fault;
  for (size_t i = 0; i < networks_.size(); ++i)
    if (period_ % spec.networks[i].every == 0 && !run(i, inputs, &fault)) return fault;
  ++period_;
  return take_action();
}

PolicyFault PolicyRunner::take_action() {
  const PolicySpec& spec = policy_->spec;
  std::swap(action_, previous_action_);
  const std::vector<float>& output = outputs_.back()[policy_->action_output];
  for (size_t i = 0; i < action_.size(); ++i) {
    const auto value = static_cast<double>(output[i]);
    action_[i] = std::clamp(value, spec.action_clip[0], spec.action_clip[1]);
    targets_[i] = spec.default_positions[i] + spec.action_scale[i] * action_[i];
    if (!std::isfinite(value) || !std::isfinite(targets_[i]))
      return {PolicyFault::Kind::kAction, networks_.size() - 1, 0, i};
  }
  return {};
}

}  // namespace gloam

// gloam/joints/policy.h, without running simulations: runtime/live/policy_state.cc.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <system_error>

#include "gloam/joints/policy.h"
#include "policy/opened_policies.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

std::string text_of(const OutputName& from) {
  return from.output.empty() ? from.network : from.network + "." + from.output;
}

PolicyNetworkInfo describe_network(const Policy& policy, size_t i) {
  const NetworkSpec& spec = policy.spec.networks[i];
  const Network& network = *policy.networks[i];
  PolicyNetworkInfo info{spec.name, spec.every,       spec.history,
                         {},        network.inputs(), network.outputs()};
  for (size_t k = 0; k < spec.parts.size(); ++k) {
    const ObservationPart& part = spec.parts[k];
    const PartWiring& wiring = policy.wiring[i].parts[k];
    info.parts.push_back({std::string(part.kind->name), wiring.size, part.scale, part.clip,
                          part.history, part.sensor, network.inputs()[wiring.input].name,
                          text_of(part.from)});
  }
  return info;
}

PolicyInfo describe_policy(const Policy& policy) {
  const PolicySpec& spec = policy.spec;
  PolicyInfo info;
  info.rate = spec.rate;
  info.joints = spec.joints;
  info.model_joints.assign(spec.model_joints.begin(), spec.model_joints.end());
  info.kp = spec.kp;
  info.kd = spec.kd;
  info.default_positions = spec.default_positions;
  info.action_scale = spec.action_scale;
  info.torque_limit = spec.torque_limit;
  info.action_clip = spec.action_clip;
  info.starts_with_zeros = spec.starts_with_zeros;
  info.gait_period = spec.gait.period;
  info.command_ranges = spec.command_ranges;
  info.velocity_feedback = spec.velocity_feedback;
  for (size_t i = 0; i < policy.networks.size(); ++i)
    info.networks.push_back(describe_network(policy, i));
  return info;
}

std::vector<std::string> words_of(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

fs::path full_path(const fs::path& path) {
  std::error_code code;
  const fs::path full = path.empty() ? path : fs::absolute(path, code);
  return (code ? path : full).lexically_normal();
}

}  // namespace

std::vector<PolicyTermInfo> policy_terms() {
  std::vector<PolicyTermInfo> terms;
  for (const TermKind& kind : term_kinds())
    terms.push_back({std::string(kind.name), words_of(kind.aliases), kind.fixed, kind.per_joint,
                     std::string(kind.unit), std::string(kind.doc)});
  return terms;
}

Result<LoadedPolicy> LoadedPolicy::load(const fs::path& network, const fs::path& settings) {
  if (network.empty() && settings.empty())
    return Error{ErrorKind::kUsage, "a policy needs a network or settings that name its networks"};
  LoadedPolicy loaded;
  loaded.network_ = full_path(network);
  loaded.settings_ = full_path(settings);
  GLOAM_TRY(loaded.policy_, open_policy(loaded.network_, loaded.settings_));
  loaded.info_ = std::make_shared<PolicyInfo>(describe_policy(*loaded.policy_));
  loaded.network_for_infer_ = loaded.policy_->networks.back()->share();
  if (loaded.network_for_infer_ != nullptr) return loaded;
  return Error{ErrorKind::kIo,
               "OpenVINO could not create a request for a network",
               {loaded.policy_->spec.file, 0, 0}};
}

ControllerOptions LoadedPolicy::controller() const {
  ControllerOptions options;
  options.type = "policy";
  options.network = network_;
  options.settings = settings_;
  return options;
}

Result<std::vector<double>> LoadedPolicy::infer(std::span<const float> observation) const {
  Network& network = *network_for_infer_;
  if (policy_->networks.size() != 1 || network.inputs().size() != 1)
    return Error{ErrorKind::kUsage,
                 "this policy has several networks or inputs, which run only in a simulation"};
  const std::span<float> input = network.input(0);
  if (observation.size() != input.size())
    return Error{ErrorKind::kUsage, fmt::format("expected an observation of {} numbers, got {}",
                                                input.size(), observation.size())};
  std::ranges::copy(observation, input.begin());
  if (!network.run())
    return Error{ErrorKind::kIo, "OpenVINO could not run the network", {network_.string(), 0, 0}};
  const std::span<const float> output = network.output(policy_->action_output);
  for (size_t i = 0; i < output.size(); ++i) {
    if (std::isfinite(output[i])) continue;
    const bool is_finite =
        std::ranges::all_of(observation, [](float value) { return std::isfinite(value); });
    return Error{ErrorKind::kDiverged,
                 fmt::format("the network's action for '{}' is not finite, its observation is {}",
                             policy_->spec.joints[i], is_finite ? "finite" : "not finite either"),
                 {network_.string(), 0, 0}};
  }
  return std::vector<double>(output.begin(), output.end());
}

Result<std::string> policy_metadata(const fs::path& network) {
  GLOAM_TRY(const LoadedNetwork loaded, load_onnx_network(network));
  GLOAM_TRY(const toml::table settings, settings_of_metadata(loaded.metadata, network.string()));
  std::ostringstream text;
  text << settings;
  return text.str();
}

}  // namespace gloam

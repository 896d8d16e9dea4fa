#include "policy/policy.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/files.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr uint64_t kLargestSettings = uint64_t{4} << 20;                    // [B]
constexpr std::string_view kActionNames[] = {"actions", "action", "mean"};  // preferred outputs

Result<toml::table> read_settings(const fs::path& path) {
  GLOAM_TRY(const std::string text, read_text_file(path, kLargestSettings));
  return parse_toml(text, path.string());
}

size_t find_actions(const Network& network) {
  for (const std::string_view name : kActionNames)
    for (size_t i = 0; i < network.outputs().size(); ++i)
      if (network.outputs()[i].name == name) return i;
  return 0;
}

Status check_actions(const Policy& policy, const std::string& file) {
  const Network& last = *policy.networks.back();
  for (const auto& network : policy.networks)
    if (network->inputs().empty() || network->outputs().empty())
      return Error{ErrorKind::kInput, "a network has no inputs or no outputs", {file, 0, 0}};
  const NetworkPort& actions = last.outputs()[policy.action_output];
  if (actions.size == policy.spec.joints.size()) return {};
  return Error{ErrorKind::kInput,
               fmt::format("there are {} joints, but the network outputs {} numbers as '{:.80}'",
                           policy.spec.joints.size(), actions.size, actions.name),
               {file, 0, 0}};
}

// Settings from elsewhere must not choose files outside of their folder.
Result<fs::path> network_file(const NetworkSpec& spec, const fs::path& settings) {
  const fs::path folder = settings.has_parent_path() ? settings.parent_path() : fs::path(".");
  std::error_code code, other;
  const fs::path root = fs::weakly_canonical(folder, code);
  const fs::path path = fs::weakly_canonical(folder / spec.file, other);
  const fs::path inside = path.lexically_relative(root);
  if (!code && !other && !inside.empty() && *inside.begin() != "..") return path;
  return Error{
      ErrorKind::kInput,
      fmt::format("'{:.200}' lies outside of the folder of the settings", spec.file.string()),
      {settings.string(), spec.loc.line, spec.loc.column},
      "put the network next to the settings"};
}

}  // namespace

Result<std::shared_ptr<const Policy>> Policy::load(const fs::path& network,
                                                   const fs::path& settings, NetworkLoader loader) {
  const std::string file = (settings.empty() ? network : settings).string();
  auto policy = std::make_shared<Policy>();
  toml::table merged;
  std::vector<LoadedNetwork> loaded;
  if (!network.empty()) {
    GLOAM_TRY(LoadedNetwork own, loader(network));
    GLOAM_TRY(merged, settings_of_metadata(own.metadata, network.string()));
    loaded.push_back(std::move(own));
  }
  if (!settings.empty()) {
    GLOAM_TRY(toml::table over, read_settings(settings));
    GLOAM_TRY(merged, merge_settings(merged, std::move(over), file));
  }
  GLOAM_TRY(policy->spec, build_policy_spec(merged, file));
  for (const NetworkSpec& spec : policy->spec.networks) {
    if (spec.file.empty()) {
      if (loaded.empty() || loaded[0].network == nullptr)
        return Error{
            ErrorKind::kInput,
            fmt::format("network '{}' has no file", spec.name),
            {file, spec.loc.line, spec.loc.column},
            "set file in its [[network]], or network = \"policy.onnx\" in the scene for one "
            "of them"};
      policy->networks.push_back(std::move(loaded[0].network));
      continue;
    }
    GLOAM_TRY(const fs::path path, network_file(spec, settings));
    GLOAM_TRY(LoadedNetwork other, loader(path));
    policy->networks.push_back(std::move(other.network));
  }
  policy->action_output = find_actions(*policy->networks.back());
  GLOAM_TRY_STATUS(check_actions(*policy, file));
  GLOAM_TRY(policy->wiring, wire_networks(policy->spec, policy->networks));
  return std::shared_ptr<const Policy>(std::move(policy));
}

std::string describe(const Policy& policy, const PolicyFault& fault) {
  switch (fault.kind) {
    case PolicyFault::Kind::kObservation:
      return fmt::format("observation term '{}' of the policy is not finite",
                         policy.spec.networks[fault.network].parts[fault.part].kind->name);
    case PolicyFault::Kind::kAction:
      return fmt::format("the network's action for '{}' is not finite, its observation is finite",
                         policy.spec.joints[fault.joint]);
    case PolicyFault::Kind::kLibrary:
      return fmt::format("OpenVINO could not run network '{}'",
                         policy.spec.networks[fault.network].name);
    case PolicyFault::Kind::kNone:
      break;
  }
  return {};
}

}  // namespace gloam

#include "policy/policy_spec.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/toml/toml_reader.h"

namespace gloam {
namespace {

constexpr std::string_view kPolicyKeys[] = {"rate",
                                            "joints",
                                            "model_joints",
                                            "kp",
                                            "kd",
                                            "default_positions",
                                            "action_scale",
                                            "action_clip",
                                            "torque_limit",
                                            "history_start",
                                            "gait_period",
                                            "command_ranges",
                                            "gait",
                                            "feet",
                                            "history",
                                            "history_order",
                                            "velocity_feedback"};
constexpr std::string_view kNetworkKeys[] = {"name",          "file",  "every",      "history",
                                             "history_order", "prime", "observation"};
constexpr int kLongestHistory = 1000, kLongestPeriod = 10'000;
constexpr double kStrongestFeedback = 10;  // [1/s]; beyond it a stride is the faster process
constexpr size_t kMostNetworks = 16, kMostJoints = 1000;

constexpr std::string_view kOrders[] = {"oldest_first", "newest_first"};
constexpr std::string_view kStarts[] = {"repeat", "zeros"};

bool is_missing(const toml::table& policy, std::string_view key) {
  const toml::node* node = policy.get(key);
  return node == nullptr || (node->is_array() && node->as_array()->empty());
}

/// The keys without which no policy works.
void require(const toml::table& policy, bool has_observation, Settings* settings) {
  std::string missing;
  for (const char* key : {"joints", "kp", "kd", "action_scale", "default_positions"})
    if (is_missing(policy, key)) missing += std::string(missing.empty() ? "[policy] " : ", ") + key;
  if (!has_observation)
    missing += std::string(missing.empty() ? "" : " and ") + "[[observation]] terms";
  if (!missing.empty())
    settings->fail(nullptr, "the network's metadata does not contain " + missing,
                   "write them to a TOML file, the policy's settings: docs/policies.md");
}

void read_joint_values(const toml::table& policy, Settings* s, PolicySpec* spec) {
  spec->kp = s->per_joint(*policy.get("kp"), spec->joints, "kp");
  spec->kd = s->per_joint(*policy.get("kd"), spec->joints, "kd");
  spec->action_scale = s->per_joint(*policy.get("action_scale"), spec->joints, "action_scale");
  spec->default_positions =
      s->per_joint(*policy.get("default_positions"), spec->joints, "default_positions", 0.0);
  spec->torque_limit.assign(spec->joints.size(), kUnlimited);
  if (const toml::node* node = policy.get("torque_limit"))
    spec->torque_limit = s->per_joint(*node, spec->joints, "torque_limit", kUnlimited);
  for (size_t i = 0; s->ok() && i < spec->joints.size(); ++i)
    for (const auto& [name, values] :
         {std::pair{"kp", &spec->kp}, {"kd", &spec->kd}, {"torque_limit", &spec->torque_limit}})
      if ((*values)[i] < 0)
        s->fail(policy.get(name), fmt::format("{} of {} is negative", name, spec->joints[i]));
}

void read_command_ranges(const toml::table& policy, Settings* s, PolicySpec* spec) {
  const toml::table* table = s->table(policy, "command_ranges");
  if (table == nullptr) return;
  s->check_keys(*table, kCommandAxes, "command_ranges");
  for (size_t axis = 0; axis < kCommandAxes.size(); ++axis)
    if (const toml::node* node = table->get(kCommandAxes[axis]))
      spec->command_ranges[axis] =
          s->range(*node, fmt::format("command_ranges.{}", kCommandAxes[axis]));
}

void read_model_joints(const toml::table& policy, Settings* s, PolicySpec* spec) {
  const toml::table* table = s->table(policy, "model_joints");
  if (table == nullptr) return;
  const std::vector<std::string_view> known(spec->joints.begin(), spec->joints.end());
  s->check_keys(*table, known, "model_joints");
  for (const auto& [key, node] : *table)
    spec->model_joints[std::string(key.str())] = s->text(*table, key.str());
}

void read_policy(const toml::table& policy, Settings* s, PolicySpec* spec) {
  s->check_keys(policy, kPolicyKeys, "[policy]");
  spec->joints = s->names(policy, "joints");
  if (spec->joints.size() > kMostJoints)
    s->fail(policy.get("joints"), fmt::format("a policy has at most {} joints", kMostJoints));
  if (!s->ok()) return;
  read_joint_values(policy, s, spec);
  if (const toml::node* node = policy.get("action_clip"))
    spec->action_clip = s->range(*node, "action_clip");
  spec->rate = s->number(policy, "rate", spec->rate, {.min = 0, .max = 1e5, .open = true});
  spec->starts_with_zeros = s->choice(policy, "history_start", kStarts) == 1;
  read_command_ranges(policy, s, spec);
  spec->velocity_feedback =
      s->number(policy, "velocity_feedback", 0, {.min = 0, .max = kStrongestFeedback});
  read_model_joints(policy, s, spec);
  spec->feet = s->names(policy, "feet");
  if (const toml::table* gait = s->table(policy, "gait")) read_gait(*gait, s, &spec->gait);
  if (spec->gait.parameters.empty())
    for (size_t i = 0; i < kGaitValues; ++i) spec->gait.parameters.push_back(i);
  spec->gait.period = s->number(policy, "gait_period", 1, {.min = 0, .max = 1e6, .open = true});
}

/// The keys that [policy] and [[network]] share.
void read_histories(const toml::table& table, Settings* s, NetworkSpec* network) {
  network->history = s->whole(table, "history", 1, 1, kLongestHistory);
  network->newest_first = s->choice(table, "history_order", kOrders) == 1;
}

void read_network(const toml::node& node, Settings* s, PolicySpec* spec) {
  const toml::table* table = node.as_table();
  if (table == nullptr || !table->contains("name") || !table->contains("observation"))
    return s->fail(&node, "a [[network]] needs a name and [[network.observation]] tables");
  s->check_keys(*table, kNetworkKeys, "[[network]]");
  NetworkSpec network;
  network.loc = loc_of(node, s->file());
  network.name = s->text(*table, "name");
  network.file = s->text(*table, "file");
  for (const NetworkSpec& other : spec->networks)
    if (other.name == network.name)
      s->fail(&node, fmt::format("two networks are named '{:.80}'", network.name));
  if (network.name.empty() || network.name.find('.') != std::string::npos)
    s->fail(&node, "the name of a network must not be empty or contain a point");
  network.every = s->whole(*table, "every", 1, 1, kLongestPeriod);
  network.prime = s->flag(*table, "prime", false);
  read_histories(*table, s, &network);
  if (s->ok()) read_observations(*table->get("observation"), s, *spec, &network);
  spec->networks.push_back(std::move(network));
}

}  // namespace

void read_gait(const toml::table& table, Settings* s, GaitOptions* gait) {
  std::vector<std::string_view> keys(kGaitValueNames.begin(), kGaitValueNames.end());
  keys.insert(keys.end(), {"pacing_offset", "still_speed", "parameters"});
  s->check_keys(table, keys, "[policy.gait]");
  for (size_t i = 0; i < kGaitValues; ++i) {
    NumberRule rule{.min = -1e3, .max = 1e3};
    if (static_cast<GaitValue>(i) == GaitValue::kDuration)
      rule = {.min = 0, .max = 1, .open = true};
    gait->values[i] = s->number(table, kGaitValueNames[i], gait->values[i], rule);
  }
  gait->pacing_offset = s->flag(table, "pacing_offset", gait->pacing_offset);
  gait->still_speed = s->number(table, "still_speed", gait->still_speed, {.min = 0, .max = 1e3});
  if (!table.contains("parameters")) return;
  gait->parameters.clear();
  for (const std::string& name : s->names(table, "parameters")) {
    const auto found = std::ranges::find(kGaitValueNames, name);
    if (found == kGaitValueNames.end())
      s->fail(table.get("parameters"), fmt::format("there is no gait parameter '{:.80}'", name));
    else
      gait->parameters.push_back(static_cast<size_t>(found - kGaitValueNames.begin()));
  }
}

Result<toml::table> merge_settings(const toml::table& base, toml::table over,
                                   const std::string& file) {
  Settings s(file);
  constexpr std::string_view kKeys[] = {"policy", "observation", "network"};
  s.check_keys(over, kKeys, "a policy's TOML");
  if (const toml::table* known = base["policy"].as_table()) {
    s.table(over, "policy");
    if (!s.ok()) return s.status().error();
    if (!over.contains("policy")) over.insert("policy", toml::table());
    toml::table& policy = *over["policy"].as_table();
    for (const auto& [key, node] : *known)
      if (!policy.contains(key.str())) policy.insert(key, node);
  }
  if (const toml::node* known = base.get("observation"))
    if (!over.contains("observation") && !over.contains("network"))
      over.insert("observation", *known);
  if (!s.ok()) return s.status().error();
  return over;
}

Result<PolicySpec> build_policy_spec(const toml::table& settings, const std::string& file) {
  Settings s(file);
  PolicySpec spec;
  spec.file = file;
  const toml::table empty;
  const toml::table* policy = s.table(settings, "policy");
  if (policy == nullptr) policy = &empty;
  const toml::node* observation = settings.get("observation");
  const toml::node* networks = settings.get("network");
  const toml::array* list = networks != nullptr ? networks->as_array() : nullptr;
  if (networks != nullptr && (list == nullptr || list->empty() || observation != nullptr))
    s.fail(networks,
           "write either [[network]] tables with their [[network.observation]], or "
           "[[observation]] tables for one network");
  const bool has_terms =
      observation != nullptr && !(observation->is_array() && observation->as_array()->empty());
  if (s.ok()) require(*policy, has_terms || list != nullptr, &s);
  if (s.ok()) read_policy(*policy, &s, &spec);
  if (!s.ok()) return s.status().error();
  if (list != nullptr) {
    if (list->size() > kMostNetworks)
      s.fail(networks, fmt::format("a policy has at most {} networks", kMostNetworks));
    for (size_t i = 0; s.ok() && i < list->size(); ++i) read_network((*list)[i], &s, &spec);
  } else {
    NetworkSpec network;
    read_histories(*policy, &s, &network);
    if (s.ok() && has_terms) read_observations(*observation, &s, spec, &network);
    spec.networks.push_back(std::move(network));
  }
  if (!s.ok()) return s.status().error();
  return spec;
}

}  // namespace gloam

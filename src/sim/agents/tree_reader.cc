// BehaviorTree.CPP's XML -> BehaviorTree.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

#include "base/files.h"
#include "base/plain_text.h"
#include "base/text.h"
#include "scene/files/xml_text.h"
#include "sim/agents/behavior_tree.h"

namespace gloam {
namespace {

constexpr int kDeepestTree = 64;
constexpr size_t kMostNodes = 4096;
constexpr uint64_t kLargestTree = 1 << 20;  // bytes
constexpr double kLongest = 1e9;

enum class Port : uint8_t { kGoal, kMsec, kSeconds, kDistance, kSpeed, kCount, kFailures, kTarget };

struct PortRule {
  const char* name;
  Port port;
  bool required;
};
struct NodeRule {
  const char* name;
  TreeNodeKind kind;
  int least_children, most_children;
  std::vector<PortRule> ports;
};

const std::vector<NodeRule>& node_rules() {
  using K = TreeNodeKind;
  constexpr int kUnlimited = 1 << 20;
  static const std::vector<NodeRule> rules = {
      {"Sequence", K::kSequence, 1, kUnlimited, {}},
      {"SequenceWithMemory", K::kSequenceWithMemory, 1, kUnlimited, {}},
      {"ReactiveSequence", K::kReactiveSequence, 1, kUnlimited, {}},
      {"Fallback", K::kFallback, 1, kUnlimited, {}},
      {"ReactiveFallback", K::kReactiveFallback, 1, kUnlimited, {}},
      {"Parallel",
       K::kParallel,
       1,
       kUnlimited,
       {{"success_count", Port::kCount, false}, {"failure_count", Port::kFailures, false}}},
      {"Inverter", K::kInverter, 1, 1, {}},
      {"Repeat", K::kRepeat, 1, 1, {{"num_cycles", Port::kCount, true}}},
      {"RetryUntilSuccessful",
       K::kRetryUntilSuccessful,
       1,
       1,
       {{"num_attempts", Port::kCount, true}}},
      {"KeepRunningUntilFailure", K::kKeepRunningUntilFailure, 1, 1, {}},
      {"Timeout", K::kTimeout, 1, 1, {{"msec", Port::kMsec, true}}},
      {"Delay", K::kDelay, 1, 1, {{"delay_msec", Port::kMsec, true}}},
      {"ForceSuccess", K::kForceSuccess, 1, 1, {}},
      {"ForceFailure", K::kForceFailure, 1, 1, {}},
      {"AlwaysSuccess", K::kAlwaysSuccess, 0, 0, {}},
      {"AlwaysFailure", K::kAlwaysFailure, 0, 0, {}},
      {"Sleep", K::kWait, 0, 0, {{"msec", Port::kMsec, true}}},
      {"Wait", K::kWait, 0, 0, {{"msec", Port::kMsec, true}}},
      {"GoTo", K::kGoTo, 0, 0, {{"goal", Port::kGoal, true}, {"speed", Port::kSpeed, false}}},
      {"Wander", K::kWander, 0, 0, {{"speed", Port::kSpeed, false}}},
      {"Follow",
       K::kFollow,
       0,
       0,
       {{"target", Port::kTarget, false},
        {"distance", Port::kDistance, true},
        {"speed", Port::kSpeed, false}}},
      {"StopFor", K::kStopFor, 0, 0, {{"distance", Port::kDistance, true}}},
      {"Stand", K::kStand, 0, 0, {}},
      {"Face", K::kFace, 0, 0, {{"target", Port::kTarget, false}}},
      {"RobotNear", K::kRobotNear, 0, 0, {{"distance", Port::kDistance, true}}},
      {"AgentNear", K::kAgentNear, 0, 0, {{"distance", Port::kDistance, true}}},
      {"AtGoal",
       K::kAtGoal,
       0,
       0,
       {{"goal", Port::kGoal, true}, {"distance", Port::kDistance, true}}},
      {"Touched", K::kTouched, 0, 0, {}},
      {"TimeReached", K::kTimeReached, 0, 0, {{"seconds", Port::kSeconds, true}}},
  };
  return rules;
}

std::vector<std::string> node_names() {
  std::vector<std::string> names{"SubTree"};
  for (const NodeRule& rule : node_rules()) names.emplace_back(rule.name);
  return names;
}

std::optional<double> number_in(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

// "1;2;0", as BehaviorTree.CPP writes points.
std::optional<Vec3d> point_in(std::string_view text) {
  double p[3] = {};
  for (int i = 0; i < 3; ++i) {
    const size_t end = text.find(';');
    if ((i < 2) == (end == std::string_view::npos)) return {};
    const std::optional<double> number = number_in(text.substr(0, end));
    if (!number || std::abs(*number) > kLongest) return {};
    p[i] = *number;
    if (i < 2) text.remove_prefix(end + 1);
  }
  return Vec3d{p[0], p[1], p[2]};
}

using Ports = std::map<std::string, std::string>;  // values of a SubTree's keys

class TreeReader {
 public:
  TreeReader(const std::string& text, std::string file) : file_(std::move(file)), lines_(text) {}

  Result<std::shared_ptr<const BehaviorTree>> read(const pugi::xml_document& document) {
    const pugi::xml_node root = document.child("root");
    if (!root)
      return fail(document.first_child(), "has no <root>",
                  "use the XML format of BehaviorTree.CPP");
    const std::string format = root.attribute("BTCPP_format").value();
    if (format != "4")
      return fail(root, fmt::format("has BTCPP_format '{}' instead of 4", format),
                  "only format 4 is supported");
    for (const pugi::xml_node node : root.children()) {
      if (node.type() != pugi::node_element) continue;
      const std::string name = node.name();
      if (name == "TreeNodesModel") continue;
      if (name != "BehaviorTree")
        return fail(node, fmt::format("has a <{}> below <root>", name),
                    "use a <BehaviorTree> there");
      const std::string id = node.attribute("ID").value();
      if (id.empty()) return fail(node, "has a <BehaviorTree> without an ID", "give it an ID");
      if (!trees_.emplace(id, node).second)
        return fail(node, fmt::format("has two trees '{}'", id), "rename one of them");
    }
    if (trees_.empty()) return fail(root, "has no <BehaviorTree>", "add one");
    std::string main = root.attribute("main_tree_to_execute").value();
    if (main.empty() && trees_.size() == 1) main = trees_.begin()->first;
    if (main.empty())
      return fail(root, "does not specify which of its trees to run", "set main_tree_to_execute");
    tree_ = std::make_shared<BehaviorTree>();
    GLOAM_TRY_STATUS(add_tree(root, main, {}, 1, nullptr));
    return std::shared_ptr<const BehaviorTree>(tree_);
  }

 private:
  Error fail(const pugi::xml_node& node, std::string what, std::string hint) const {
    return {ErrorKind::kInput, "the behaviour tree " + std::move(what), at(node), std::move(hint)};
  }
  SourceLoc at(const pugi::xml_node& node) const {
    return {file_, node ? lines_.at(node.offset_debug()) : 1, 0};
  }

  std::vector<std::string> tree_names() const {
    std::vector<std::string> names;
    for (const auto& [id, node] : trees_) names.push_back(id);
    return names;
  }

  Status add_tree(const pugi::xml_node& from, const std::string& id, const Ports& ports, int depth,
                  int* number) {
    const auto found = trees_.find(id);
    if (found == trees_.end())
      return fail(from, fmt::format("has no tree '{}'", id), suggest_name(id, tree_names()));
    if (std::find(open_.begin(), open_.end(), id) != open_.end())
      return fail(from, fmt::format("has a SubTree '{}' that contains itself", id),
                  "to run a tree forever, use a Repeat with num_cycles=\"-1\"");
    pugi::xml_node child;
    for (const pugi::xml_node node : found->second.children()) {
      if (node.type() != pugi::node_element) continue;
      if (child)
        return fail(node, fmt::format("'{}' has two roots", id), "put them into a Sequence");
      child = node;
    }
    if (!child) return fail(found->second, fmt::format("'{}' is empty", id), "add a node");
    open_.push_back(id);
    int first = 0;
    GLOAM_TRY_STATUS(add_node(child, ports, depth, &first));
    open_.pop_back();
    if (number != nullptr) *number = first;
    return {};
  }

  // A value, with "{key}" replaced by what the SubTree's caller says.
  Result<std::string> value_of(const pugi::xml_node& node, const std::string& text,
                               const Ports& ports) const {
    if (text.size() < 3 || text.front() != '{' || text.back() != '}') return text;
    const std::string key = text.substr(1, text.size() - 2);
    const auto found = ports.find(key);
    if (found != ports.end()) return found->second;
    std::vector<std::string> keys;
    for (const auto& [name, value] : ports) keys.push_back(name);
    return fail(node, fmt::format("refers to '{{{}}}', which is not set", key),
                keys.empty() ? "write the value itself, or pass it to the SubTree"
                             : suggest_name(key, keys));
  }

  Status add_subtree(const pugi::xml_node& node, const Ports& ports, int depth, int* number) {
    Ports inner;
    for (const pugi::xml_attribute a : node.attributes()) {
      const std::string name = a.name();
      if (name == "ID" || name == "name" || name == "_description") continue;
      if (name == "_autoremap") {
        if (a.as_bool()) inner.insert(ports.begin(), ports.end());
        continue;
      }
      GLOAM_TRY(inner[name], value_of(node, a.value(), ports));
    }
    if (node.first_child())
      return fail(node, "has a SubTree with child nodes", "move them into its tree");
    return add_tree(node, node.attribute("ID").value(), inner, depth, number);
  }

  Status add_node(const pugi::xml_node& node, const Ports& ports, int depth, int* number) {
    if (depth > kDeepestTree)
      return fail(node, fmt::format("is nested more than {} levels deep", kDeepestTree),
                  "reduce the nesting");
    std::string name = node.name();
    const bool has_id =
        name == "Action" || name == "Condition" || name == "Control" || name == "Decorator";
    if (has_id) name = node.attribute("ID").value();
    if (name == "SubTree") return add_subtree(node, ports, depth + 1, number);
    const auto& rules = node_rules();
    const auto rule =
        std::find_if(rules.begin(), rules.end(), [&](const NodeRule& r) { return name == r.name; });
    if (rule == rules.end())
      return fail(node, fmt::format("has an unknown node '{}'", name),
                  suggest_name(name, node_names()));
    if (tree_->nodes.size() >= kMostNodes)
      return fail(node, fmt::format("has more than {} nodes", kMostNodes),
                  "reduce the number of nodes");
    const int own = static_cast<int>(tree_->nodes.size());
    tree_->nodes.emplace_back();
    GLOAM_TRY(TreeNode made, read_ports(node, *rule, has_id, ports));
    int children = 0;
    for (const pugi::xml_node child : node.children()) {
      if (child.type() != pugi::node_element) continue;
      if (++children > rule->most_children) break;
      int at_child = 0;
      GLOAM_TRY_STATUS(add_node(child, ports, depth + 1, &at_child));
      made.children.push_back(at_child);
    }
    if (children < rule->least_children || children > rule->most_children) {
      return fail(node,
                  rule->most_children == 0
                      ? fmt::format("has a {} with child nodes", name)
                      : fmt::format("has a {} with {}", name,
                                    children == 0 ? "no child nodes" : "more than one child node"),
                  rule->most_children == 0   ? "it is a leaf node"
                  : rule->most_children == 1 ? "it must have exactly one"
                                             : "add at least one");
    }
    tree_->nodes[static_cast<size_t>(own)] = std::move(made);
    *number = own;
    return {};
  }

  Result<TreeNode> read_ports(const pugi::xml_node& node, const NodeRule& rule, bool has_id,
                              const Ports& ports) const {
    TreeNode made;
    made.kind = rule.kind;
    made.loc = at(node);
    if (rule.kind == TreeNodeKind::kParallel) made.count = -1;
    for (const pugi::xml_attribute a : node.attributes()) {
      const std::string name = a.name();
      if (name == "name" || name == "_description" || (has_id && name == "ID")) continue;
      const auto port = std::find_if(rule.ports.begin(), rule.ports.end(),
                                     [&](const PortRule& p) { return name == p.name; });
      if (port == rule.ports.end()) {
        std::vector<std::string> names;
        for (const PortRule& p : rule.ports) names.emplace_back(p.name);
        return fail(node, fmt::format("has a {} with an unknown port '{}'", rule.name, name),
                    name.starts_with("_") ? "scripts and conditions on nodes are not supported"
                    : names.empty()       ? "it has no ports"
                                          : suggest_name(name, names));
      }
      GLOAM_TRY(const std::string text, value_of(node, a.value(), ports));
      if (!set_port(port->port, text, &made))
        return fail(node, fmt::format("has a {} whose {} is '{}'", rule.name, name, text),
                    port->port == Port::kGoal ? "expected a point, x;y;z in metres"
                    : port->port == Port::kCount || port->port == Port::kFailures
                        ? "expected an integer; -1 = without limit, or all"
                        : "expected a number that is not negative");
    }
    for (const PortRule& port : rule.ports) {
      if (port.required && !node.attribute(port.name))
        return fail(node, fmt::format("has a {} without '{}'", rule.name, port.name), "add it");
    }
    return made;
  }

  static bool set_port(Port port, const std::string& text, TreeNode* node) {
    if (port == Port::kTarget) {
      node->target = text;
      return true;
    }
    if (port == Port::kGoal) {
      const std::optional<Vec3d> point = point_in(text);
      if (point) node->goal = *point;
      return point.has_value();
    }
    const std::optional<double> number = number_in(text);
    if (!number || *number > kLongest) return false;
    if (port == Port::kCount || port == Port::kFailures) {
      if (*number != std::floor(*number) || *number < -1 || *number == 0) return false;
      (port == Port::kCount ? node->count : node->failures) = static_cast<int>(*number);
      return true;
    }
    if (*number < 0) return false;
    if (port == Port::kMsec) node->seconds = *number / 1000;
    if (port == Port::kSeconds) node->seconds = *number;
    if (port == Port::kDistance) node->distance = *number;
    if (port == Port::kSpeed) node->speed = *number;
    return true;
  }

  std::string file_;
  XmlLines lines_;
  std::map<std::string, pugi::xml_node> trees_;
  std::vector<std::string> open_;  // those that are being put in place
  std::shared_ptr<BehaviorTree> tree_;
};

}  // namespace

Result<std::shared_ptr<const BehaviorTree>> read_behavior_tree(const std::string& text,
                                                               const std::string& file) {
  pugi::xml_document document;
  GLOAM_TRY_STATUS(parse_xml(text, file, pugi::parse_default, &document));
  return TreeReader(text, file).read(document);
}

Result<std::shared_ptr<const BehaviorTree>> read_behavior_tree_file(
    const std::filesystem::path& file) {
  GLOAM_TRY(const std::string text, read_plain_text(file, kLargestTree));
  return read_behavior_tree(text, file.string());
}

}  // namespace gloam

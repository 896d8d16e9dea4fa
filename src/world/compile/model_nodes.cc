#include "world/compile/model_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/text.h"

namespace gloam {
namespace {

bool are_at_one_place(const Affine3f& a, const Affine3f& b) {
  return (a.x == b.x) & (a.y == b.y) & (a.z == b.z) & (a.p == b.p);
}

}  // namespace

std::vector<ModelNode> nodes_of(const ModelFile& model) {
  std::vector<ModelNode> nodes;
  std::map<std::string, std::vector<size_t>> same_name;
  const auto& instances = model.instances;
  for (size_t i = 0; i < instances.size(); ++i) {
    const ImportedInstance& in = instances[i];
    if (model.meshes[static_cast<size_t>(in.mesh)].indices.empty()) continue;
    const std::string own = in.name.empty() ? fmt::format("node_{}", i + 1) : in.name;
    std::vector<size_t>& known = same_name[own];
    const auto node = std::find_if(known.begin(), known.end(), [&](size_t n) {
      const auto first = static_cast<size_t>(nodes[n].instances[0]);
      return are_at_one_place(instances[first].X_FI, in.X_FI);
    });
    if (node != known.end()) {
      nodes[*node].instances.push_back(static_cast<int>(i));
    } else {
      known.push_back(nodes.size());
      nodes.push_back({own, {}, {static_cast<int>(i)}});
    }
  }
  std::set<std::string> taken;
  for (const auto& [own, known] : same_name) taken.insert(own);
  for (ModelNode& node : nodes) {
    const bool is_first = &node == &nodes[same_name[node.own][0]];
    node.name = node.own;
    for (int i = 2; !is_first && !taken.insert(node.name).second; ++i)
      node.name = fmt::format("{}_{}", node.own, i);
  }
  return nodes;
}

Result<ModelNode> find_node(const std::vector<ModelNode>& nodes, const std::string& file,
                            const std::string& name) {
  std::vector<std::string> names;
  for (const ModelNode& node : nodes) {
    if (node.name == name) return node;
    names.push_back(node.name);
  }
  return Error{ErrorKind::kInput,
               fmt::format("'{}' has no node '{}' with a mesh", file, name),
               {},
               suggest_name(name, names)};
}

}  // namespace gloam

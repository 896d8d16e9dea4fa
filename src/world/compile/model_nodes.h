#pragma once
// Nodes of a model file by their names.

#include <string>
#include <vector>

#include "geometry/mesh/model_file.h"

namespace gloam {

/// A node that has a mesh. One of several materials is several instances at one place.
struct ModelNode {
  std::string own;             ///< name in the file, "node_NUMBER" where it has none
  std::string name;            ///< no other's: the second of a name is "NAME_2"
  std::vector<int> instances;  ///< of the file
};

/// In the order of the file.
std::vector<ModelNode> nodes_of(const ModelFile& model);

/// By its name. Error, said of no one yet: `file` has none of that name.
Result<ModelNode> find_node(const std::vector<ModelNode>& nodes, const std::string& file,
                            const std::string& name);

}  // namespace gloam

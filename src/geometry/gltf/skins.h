#pragma once
// Skins of glTF in the pose of the file's nodes ("glTF 2.0 Specification", 3.7.3). For the readers
// of gltf/ alone.

#include <span>
#include <vector>

#include "geometry/gltf/document.h"

namespace gloam {

/// Joints that bend a mesh, with the inverse bind matrices X_JM: the mesh's frame M in the frame J
/// of each joint when it was bound.
struct GltfSkin {
  std::vector<int> joints;  ///< nodes
  std::vector<Affine3f> X_JM;
};

std::vector<GltfSkin> read_gltf_skins(GltfDocument* document);

/// Reads JOINTS_n and WEIGHTS_n of a primitive of `count` vertices; empty when it has none.
GltfVertexWeights read_gltf_weights(GltfDocument* document, const JsonNode& attributes,
                                    size_t count);

/// Adds the part's mesh with each vertex moved by the weighted sum of `X_FM`, the joints' matrices
/// in the file's frame. Its index; -1 after an error of `node`: a joint that is not there, a limit.
int add_bent_mesh(GltfDocument* document, const JsonNode& node, const GltfMeshTable::Part& part,
                  std::span<const Affine3f> X_FM, ModelFile* model);

}  // namespace gloam

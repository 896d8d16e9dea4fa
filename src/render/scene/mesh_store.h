#pragma once
// Meshes as the kernel reads them, with per-triangle shading data.

#include <optional>
#include <span>
#include <vector>

#include "instant/pose_frame.h"
#include "render/kernel/scene_view.h"

namespace gloam {

/// Buffers of one mesh. Rigid meshes refer to the description's positions and indices.
struct MeshBuffers {
  std::vector<Vec3f> corner_normals;
  std::vector<TriangleUv> uvs;
  std::vector<float> area_cdf;
  float area = 0;                       ///< [m²]
  Vec3f half_extents;                   ///< of the bounding box of the rest positions [m]
  std::vector<Vec3f> open, previous;    ///< deformables: world positions [m]
  std::vector<Vec3f> keys;              ///< and at all keys, one after the other
  std::optional<TriangleMesh> rebuilt;  ///< height fields: instead of the description's
  uint32_t key_count = 0;               ///< deformables: 0 = none moves
};

class MeshStore {
 public:
  /// Errors: an index out of range, attributes of the wrong length, values that are not finite.
  static Result<MeshStore> make(const RenderDescription& description);

  /// Takes the deformables' vertices from the frames and recomputes their normals.
  void update(const RenderDescription& description, std::span<const PoseFrame* const> keys,
              const PoseFrame& previous);
  /// Makes the mesh of a height field anew from the frame's data, or as described where the frame
  /// has none. False when it stays as it was.
  bool rebuild(const RenderDescription& description, const HeightFieldDescription& field,
               const PoseFrame& frame);
  /// Builds what sampling points on mesh `mesh` needs.
  void make_samplable(const RenderDescription& description, uint32_t mesh);

  /// Rows: all meshes, then all deformables.
  std::vector<MeshView> views(const RenderDescription& description) const;
  const MeshBuffers& buffers(size_t row) const { return meshes_[row]; }

 private:
  const TriangleMesh& mesh_at(const RenderDescription& description, size_t row) const;

  std::vector<MeshBuffers> meshes_;
};

}  // namespace gloam

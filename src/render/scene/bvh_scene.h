#pragma once
// A RenderScene in our own BVH: a tree of each mesh, and above them one of all instances.

#include <optional>
#include <vector>

#include "geometry/bvh/bvh_build.h"
#include "render/kernel/trace/bvh_tracer.h"
#include "render/scene/scan_table.h"

namespace gloam {

class BvhScene {
 public:
  /// Builds what is missing, moves what moves. `scene` must be updated before and stay the same
  /// object.
  void update(const RenderScene& scene);

  /// Valid until the next update.
  BvhTracer tracer(const RenderScene& scene) const;
  /// Tracer of the bodies that never move, without infinite planes.
  BvhTracer static_tracer(const RenderScene& scene) const;

  const std::vector<BvhNode>& nodes() const { return nodes_; }
  const std::vector<BvhTriangle>& triangles() const { return triangles_; }
  const std::vector<BvhInstance>& instances() const { return instances_; }
  const std::vector<Affine3f>& motion() const { return motion_; }
  /// Instances that never move.
  const std::vector<uint32_t>& still() const { return still_; }
  /// Changes whenever anything but the first nodes and triangles may have.
  uint64_t version() const { return version_; }
  /// Number of the first nodes and triangles that are new after each update.
  size_t fresh_nodes() const { return fresh_nodes_; }
  size_t fresh_triangles() const { return fresh_triangles_; }

 private:
  /// The tree of one mesh, and where it lies in nodes_ and triangles_.
  struct MeshTree {
    BvhTree tree;
    uint32_t first_node = 0, first_triangle = 0;
    BvhRef root = bvh::kNothing;  ///< in nodes_
    BvhBox box;                   ///< frame G; deformables: world, over the shutter
    bool deforms = false;
  };
  struct TopTree {
    BvhTree tree;
    float cost = 0;  ///< when it was built
    uint32_t first_node = 0;
    BvhRef root = bvh::kNothing;
  };

  void build(const RenderScene& scene);
  void lay_out(const RenderScene& scene);
  void place_mesh(const RenderScene& scene, uint32_t mesh);
  void place_triangles(const MeshView& mesh, const MeshTree& tree);
  void follow_deformables(const RenderScene& scene);
  void place_instances(const RenderScene& scene);
  void place_top(const std::vector<BvhBox>& boxes, bool anew, TopTree* top);
  BvhBox box_of(const RenderScene& scene, const BvhInstance& instance) const;

  std::vector<MeshTree>
      meshes_;  ///< by row of SceneView::meshes; empty trees of meshes that are not rendered
  std::vector<BvhNode> nodes_;  ///< of top_, of static_top_, of deformables, of rigid meshes
  std::vector<BvhTriangle> triangles_;  ///< of deformables, of rigid meshes
  std::vector<BvhInstance> instances_;
  std::vector<Affine3f> motion_;  ///< key_count_ of each that moves
  uint32_t key_count_ = 1;        ///< of all that moves
  uint32_t key_capacity_ = 2;     ///< of deformables, in triangles_
  TopTree top_, static_top_;
  ScanTable scanned_;
  std::vector<uint32_t> still_;
  size_t fresh_nodes_ = 0, fresh_triangles_ = 0;
  uint64_t version_ = 0;
  std::optional<uint64_t> drawn_version_;  ///< of the scene that is built
};

}  // namespace gloam

#include "render/scene/bvh_scene.h"

#include <algorithm>

#include "base/parallel.h"
#include "geometry/bvh/bvh_cache.h"
#include "render/scene/scan_table.h"

namespace gloam {
namespace {

/// Solids that every ray is tested against, at most: beyond a few that span the scene the tree is
/// faster where no lanes share the test.
constexpr size_t kMaxUnboundedSolids = 12;
constexpr float kLeastArea = 0.125f;
/// A tree over instances is rebuilt when moving them has made it worse by this factor.
constexpr float kRebuildRatio = 1.3f;

/// Boxes of the triangles, over the shutter.
std::vector<BvhBox> triangle_boxes(const MeshView& mesh) {
  std::vector<BvhBox> boxes(mesh.indices.size / 3);
  parallel_for_range("triangle boxes", static_cast<int64_t>(boxes.size()), 16384,
                     [&](int64_t begin, int64_t end) {
                       for (int64_t i = begin; i < end; ++i) {
                         BvhBox& box = boxes[static_cast<size_t>(i)];
                         for (int k = 0; k < 3; ++k) {
                           const uint32_t v = mesh.indices[static_cast<uint32_t>(3 * i + k)];
                           box.add(mesh.positions[v]);
                           for (uint32_t key = 1; key < mesh.key_count; ++key) {
                             box.add(mesh.position_keys[key * mesh.positions.size + v]);
                           }
                         }
                       }
                     });
  return boxes;
}

BvhBox box_of_all(const std::vector<BvhBox>& boxes) {
  BvhBox all;
  for (const BvhBox& b : boxes) all.add(b);
  return all;
}

/// World bounds of a box in frame G.
BvhBox moved(const BvhBox& b, const Affine3f& X_WG) {
  BvhBox out;
  for (int i = 0; i < 8; ++i) {
    out.add(
        transform_point(X_WG, {(i & 1) != 0 ? b.high.x : b.low.x, (i & 2) != 0 ? b.high.y : b.low.y,
                               (i & 4) != 0 ? b.high.z : b.low.z}));
  }
  return out;
}

}  // namespace

void BvhScene::build(const RenderScene& scene) {
  drawn_version_ = scene.drawn_version();
  scanned_ = ScanTable::choose(scene, kMaxUnboundedSolids, kLeastArea);
  instances_.clear();
  still_.clear();
  const std::vector<InstanceView>& instances = scene.instances();
  meshes_.resize(scene.meshes().size());
  for (size_t i = 0; i < instances.size(); ++i) {
    const InstanceView& in = instances[i];
    if (stands_still(scene, i)) still_.push_back(static_cast<uint32_t>(i));
    if (!scene.is_drawn(i) || is_infinite_plane(in) || scanned_.holds(i)) continue;
    BvhInstance out;
    out.id = static_cast<uint32_t>(i);
    out.root = bvh::kNothing;
    instances_.push_back(out);
    if (!is_mesh(in.shape)) continue;
    MeshTree& mesh = meshes_[in.mesh];
    mesh.deforms = in.shape == ShapeType::kDeformable;
    if (!mesh.tree.order.empty()) continue;
    const std::vector<BvhBox> boxes = triangle_boxes(scene.meshes()[in.mesh]);
    mesh.tree = build_bvh_cached(boxes, {4, bvh::kMeshDepth});
    mesh.box = box_of_all(boxes);
  }
  lay_out(scene);
}

void BvhScene::lay_out(const RenderScene& scene) {
  ++version_;
  const size_t top = instances_.empty() ? 0 : instances_.size() - 1;
  top_.first_node = 0;
  static_top_.first_node = static_cast<uint32_t>(top);
  nodes_.assign(2 * top, {});
  triangles_.clear();
  for (const bool deforms : {true, false}) {
    for (uint32_t i = 0; i < meshes_.size(); ++i) {
      if (meshes_[i].deforms == deforms) place_mesh(scene, i);
    }
    if (deforms) {
      fresh_nodes_ = nodes_.size();
      fresh_triangles_ = triangles_.size();
    }
  }
}

/// Appends the mesh's tree and space for its triangles.
void BvhScene::place_mesh(const RenderScene& scene, uint32_t row) {
  MeshTree& mesh = meshes_[row];
  if (mesh.tree.order.empty()) return;
  mesh.first_node = static_cast<uint32_t>(nodes_.size());
  mesh.first_triangle = static_cast<uint32_t>(triangles_.size());
  const auto in_all = [&mesh](BvhRef ref) {
    if ((ref & bvh::kKind) == 0) return ref + mesh.first_node;
    return bvh::triangles_ref(bvh::first_triangle(ref) + mesh.first_triangle,
                              bvh::triangle_count(ref));
  };
  for (BvhNode node : mesh.tree.nodes) {
    for (BvhRef& child : node.child) child = in_all(child);
    nodes_.push_back(node);
  }
  mesh.root = in_all(mesh.tree.root);
  triangles_.resize(triangles_.size() +
                    mesh.tree.order.size() * (mesh.deforms ? key_capacity_ : 1));
  place_triangles(scene.meshes()[row], mesh);
}

/// Places triangles: those at the shutter's opening, then of deformables those at the other keys.
void BvhScene::place_triangles(const MeshView& mesh, const MeshTree& tree) {
  const size_t count = tree.tree.order.size();
  const auto place = [&](const Vec3f* positions, size_t first) {
    for (size_t i = 0; i < count; ++i) {
      const uint32_t primitive = tree.tree.order[i];
      BvhTriangle& t = triangles_[first + i];
      t.a = positions[mesh.indices[3 * primitive]];
      t.b = positions[mesh.indices[3 * primitive + 1]];
      t.c = positions[mesh.indices[3 * primitive + 2]];
      t.primitive = primitive;
    }
  };
  place(mesh.positions.data, tree.first_triangle);
  for (uint32_t key = 1; key < mesh.key_count; ++key) {
    place(mesh.position_keys.data + size_t{key} * mesh.positions.size,
          tree.first_triangle + key * count);
  }
}

void BvhScene::follow_deformables(const RenderScene& scene) {
  parallel_for("deforming trees", static_cast<int64_t>(meshes_.size()), [&](int64_t row) {
    const auto i = static_cast<size_t>(row);
    MeshTree& mesh = meshes_[i];
    if (!mesh.deforms || mesh.tree.order.empty()) return;
    const MeshView& view = scene.meshes()[i];
    const std::vector<BvhBox> boxes = triangle_boxes(view);
    refit_bvh(boxes, &mesh.tree);
    mesh.box = box_of_all(boxes);
    for (size_t n = 0; n < mesh.tree.nodes.size(); ++n) {
      for (int side = 0; side < 2; ++side) {
        nodes_[mesh.first_node + n].center[side] = mesh.tree.nodes[n].center[side];
        nodes_[mesh.first_node + n].half[side] = mesh.tree.nodes[n].half[side];
      }
    }
    place_triangles(view, mesh);
  });
}

BvhBox BvhScene::box_of(const RenderScene& scene, const BvhInstance& instance) const {
  const InstanceView& in = scene.instances()[instance.id];
  if (in.shape == ShapeType::kDeformable) return meshes_[in.mesh].box;
  const auto at = [&](const Affine3f& X_WG) {
    return is_mesh(in.shape) ? moved(meshes_[in.mesh].box, X_WG)
                             : as_box(wider(shape_bounds(in.shape, in.size, X_WG)));
  };
  BvhBox box = at(in.X_WG);
  // Every point moves along a line between two keys: the box over all holds its way.
  for (uint32_t key = 1; key < in.keys.size; ++key) box.add(at(in.keys[key]));
  return box;
}

void BvhScene::place_instances(const RenderScene& scene) {
  motion_.clear();
  key_count_ = 1;
  for (BvhInstance& out : instances_) {
    const InstanceView& in = scene.instances()[out.id];
    const Affine3f& X = in.shape == ShapeType::kDeformable ? Affine3f{} : in.X_WG;
    const Vec3f rows[3] = {X.x, X.y, X.z};
    float shift[3];
    for (int k = 0; k < 3; ++k) {
      out.row[k] = rows[k];
      shift[k] = static_cast<float>(
          -(double{rows[k].x} * X.p.x + double{rows[k].y} * X.p.y + double{rows[k].z} * X.p.z));
    }
    out.shift = {shift[0], shift[1], shift[2]};
    out.motion = -1;
    out.key_step = 0;
    out.is_clear = scene.lets_light_through(out.id) ? 1 : 0;
    if (in.moving && in.shape != ShapeType::kDeformable) {
      out.motion = static_cast<int32_t>(motion_.size());
      key_count_ = in.keys.size;
      motion_.insert(motion_.end(), in.keys.data, in.keys.data + in.keys.size);
    }
    if (!is_mesh(in.shape)) continue;
    const MeshTree& mesh = meshes_[in.mesh];
    out.root = mesh.root;
    if (mesh.deforms && scene.meshes()[in.mesh].key_count > 1) {
      key_count_ = scene.meshes()[in.mesh].key_count;
      out.key_step = static_cast<uint32_t>(mesh.tree.order.size()) & 0x7FFFFFFFu;
    }
  }
}

void BvhScene::place_top(const std::vector<BvhBox>& boxes, bool anew, TopTree* top) {
  const auto build = [&] {
    top->tree = build_bvh(boxes, {1, bvh::kTopDepth});
    top->cost = refit_bvh(boxes, &top->tree);
  };
  if (anew) {
    build();
  } else if (refit_bvh(boxes, &top->tree) > kRebuildRatio * top->cost) {
    build();
  }
  const auto in_all = [&](BvhRef ref) {
    if (ref == bvh::kNothing) return ref;
    if ((ref & bvh::kKind) == 0) return ref + top->first_node;
    return bvh::kInstance | top->tree.order[bvh::first_triangle(ref)];
  };
  for (size_t n = 0; n < top->tree.nodes.size(); ++n) {
    BvhNode node = top->tree.nodes[n];
    for (BvhRef& child : node.child) child = in_all(child);
    nodes_[top->first_node + n] = node;
  }
  top->root = in_all(top->tree.root);
}

void BvhScene::update(const RenderScene& scene) {
  bool anew = drawn_version_ != scene.drawn_version();
  for (const MeshView& mesh : scene.meshes()) {
    if (mesh.key_count <= key_capacity_) continue;
    key_capacity_ = mesh.key_count;
    anew = true;
  }
  for (const uint32_t mesh : scene.rebuilt_meshes()) {
    if (mesh >= meshes_.size()) continue;
    anew |= !meshes_[mesh].tree.order.empty();
    meshes_[mesh].tree = {};
  }
  if (anew) build(scene);
  follow_deformables(scene);
  place_instances(scene);
  std::vector<BvhBox> boxes(instances_.size()), still(instances_.size());
  for (size_t i = 0; i < instances_.size(); ++i) {
    boxes[i] = box_of(scene, instances_[i]);
    // A box that is not finite is left out.
    if (stands_still(scene, instances_[i].id)) {
      still[i] = boxes[i];
    } else {
      still[i] = {{INFINITY, INFINITY, INFINITY}, {INFINITY, INFINITY, INFINITY}};
    }
  }
  place_top(boxes, anew, &top_);
  if (anew) place_top(still, true, &static_top_);
}

BvhTracer BvhScene::tracer(const RenderScene& scene) const {
  return {
      {nodes_.data(), triangles_.data(), instances_.data(), motion_.data(), key_count_, top_.root},
      scanned_.list(scene)};
}

BvhTracer BvhScene::static_tracer(const RenderScene& scene) const {
  BvhTracer tracer = this->tracer(scene);
  tracer.bvh.root = static_top_.root;
  tracer.scanned.planes = {};
  return tracer;
}

}  // namespace gloam

#include "sensors/camera/object_boxes.h"

#include <algorithm>
#include <map>

#include "render/kernel/surface/shapes.h"
#include "render/scene/pose.h"
#include "sensors/camera/camera_sensor.h"

namespace gloam {
namespace {

struct Bounds3 {
  Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  void add(Vec3f p) {
    low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
    high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
  }
};

/// Half the size, along O's axes, of a shape in the pose X_OG.
Vec3f half_extent(const InstanceDescription& in, const Affine3f& X_OG) {
  const Vec3f rows[3] = {{X_OG.x.x, X_OG.y.x, X_OG.z.x},
                         {X_OG.x.y, X_OG.y.y, X_OG.z.y},
                         {X_OG.x.z, X_OG.y.z, X_OG.z.z}};
  const Vec3f h = shape_half_size(in.shape, in.size);
  const auto reach = [&](Vec3f row) {
    const Vec3f a{std::fabs(row.x) * h.x, std::fabs(row.y) * h.y, std::fabs(row.z) * h.z};
    switch (in.shape) {
      case ShapeType::kSphere:
        return h.x;
      case ShapeType::kEllipsoid:
        return length(a);
      case ShapeType::kCylinder:
        return h.x * safe_sqrt(1.0f - row.z * row.z) + a.z;
      case ShapeType::kCapsule:  // its half size is that of the cylinder
        return in.size.x + a.z;
      case ShapeType::kPlane:
        return a.x + a.y;
      default:
        return a.x + a.y + a.z;
    }
  };
  return {reach(rows[0]), reach(rows[1]), reach(rows[2])};
}

bool is_endless(const InstanceDescription& in) {
  return in.shape == ShapeType::kPlane && (in.size.x <= 0 || in.size.y <= 0);
}

void add_instance(const RenderDescription& description, const PoseFrame& frame,
                  const InstanceDescription& in, const Affine3f& X_OW, Bounds3* box) {
  if (in.shape == ShapeType::kDeformable) {
    const DeformableDescription& soft = description.deformables[static_cast<size_t>(in.mesh)];
    const float* v = frame.vertices.data() + 3 * soft.first_vertex;
    for (size_t i = 0; i < soft.rest.positions.size(); ++i)
      box->add(transform_point(X_OW, {v[3 * i], v[3 * i + 1], v[3 * i + 2]}));
    return;
  }
  const Affine3f X_OG = X_OW * pose_in_world(description, frame, in);
  if (in.shape == ShapeType::kMesh) {
    for (const Vec3f& p : description.meshes[static_cast<size_t>(in.mesh)].positions)
      box->add(transform_point(X_OG, p));
    return;
  }
  const Vec3f h = half_extent(in, X_OG);
  box->add(X_OG.p - h);
  box->add(X_OG.p + h);
}

}  // namespace

std::vector<ObjectView> view_objects(const RenderDescription& description, const PoseFrame& frame,
                                     const std::map<uint32_t, ObjectCover>& cover) {
  std::map<uint32_t, std::vector<const InstanceDescription*>> objects;
  for (const InstanceDescription& in : description.instances) {
    const uint32_t id = in.label.instance;
    if (in.shown && cover.contains(id)) objects[id].push_back(&in);
  }
  std::vector<ObjectView> out;
  for (const auto& [id, parts] : objects) {
    ObjectView object;
    object.instance = id;
    object.name = parts.front()->label.instance_name;
    object.semantic = parts.front()->label.semantic;
    object.seen = cover.at(id).seen;
    object.all = cover.at(id).all;
    const InstanceDescription& root = **std::min_element(
        parts.begin(), parts.end(), [](const auto* a, const auto* b) { return a->body < b->body; });
    const Affine3f X_WO = pose_in_world(frame, root.body, {}), X_OW = inverse(X_WO);
    object.X_WO = in_world(X_WO, description.origin);
    Bounds3 box;
    object.endless =
        std::any_of(parts.begin(), parts.end(), [](const auto* in) { return is_endless(*in); });
    for (const InstanceDescription* in : parts) {
      if (!is_endless(*in)) add_instance(description, frame, *in, X_OW, &box);
    }
    if (!object.endless && box.low.x <= box.high.x) {
      const Vec3f center = (box.low + box.high) * 0.5f, size = box.high - box.low;
      object.center = {center.x, center.y, center.z};
      object.size = {size.x, size.y, size.z};
    }
    out.push_back(std::move(object));
  }
  return out;
}

}  // namespace gloam

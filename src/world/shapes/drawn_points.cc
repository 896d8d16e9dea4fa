#include "world/shapes/drawn_points.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace gloam {
namespace {

constexpr size_t kMostPoints = 2000;  // points of a mesh

/// Points of the unit sphere, evenly spread (a Fibonacci lattice).
std::vector<Vec3f> unit_sphere(int count) {
  std::vector<Vec3f> out;
  for (int i = 0; i < count; ++i) {
    const float z = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(count);
    const float a = 2.39996323f * static_cast<float>(i), r = std::sqrt(1 - z * z);
    out.push_back({r * std::cos(a), r * std::sin(a), z});
  }
  return out;
}

std::vector<Vec3f> box_points(Vec3f h) {
  constexpr int kSide = 15;
  std::vector<Vec3f> out;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const float u = 2 * static_cast<float>(i) / (kSide - 1) - 1;
      const float v = 2 * static_cast<float>(j) / (kSide - 1) - 1;
      for (const float side : {-1.0f, 1.0f}) {
        out.push_back({h.x * side, h.y * u, h.z * v});
        out.push_back({h.x * u, h.y * side, h.z * v});
        out.push_back({h.x * u, h.y * v, h.z * side});
      }
    }
  }
  return out;
}

std::vector<Vec3f> cylinder_points(float radius, float half_length) {
  constexpr int kAround = 24, kAlong = 15;
  std::vector<Vec3f> out;
  for (int i = 0; i < kAround; ++i) {
    const float a = 2 * kPi * static_cast<float>(i) / kAround;
    for (int j = 0; j < kAlong; ++j) {
      const float z = half_length * (2 * static_cast<float>(j) / (kAlong - 1) - 1);
      out.push_back({radius * std::cos(a), radius * std::sin(a), z});
    }
    for (const float z : {-half_length, half_length})
      out.push_back({0.5f * radius * std::cos(a), 0.5f * radius * std::sin(a), z});
  }
  return out;
}

template <class Transform>
std::vector<Vec3f> mesh_points(const std::vector<Vec3f>& positions, const Transform& to_world) {
  std::vector<Vec3f> out;
  const size_t step = positions.size() / kMostPoints + 1;
  for (size_t i = 0; i < positions.size(); i += step) out.push_back(to_world(positions[i]));
  return out;
}

/// In the frame of the shape; meshes and what is infinite give none.
std::vector<Vec3f> shape_points(const InstanceDescription& in) {
  std::vector<Vec3f> out;
  switch (in.shape) {
    case ShapeType::kPlane:
      if (in.size.x > 0 && in.size.y > 0) return box_points({in.size.x, in.size.y, 0});
      break;
    case ShapeType::kBox:
      return box_points(in.size);
    case ShapeType::kSphere:
      for (const Vec3f& n : unit_sphere(400)) out.push_back(n * in.size.x);
      break;
    case ShapeType::kEllipsoid:
      for (const Vec3f& n : unit_sphere(400)) out.push_back(n * in.size);
      break;
    case ShapeType::kCapsule:
      for (const Vec3f& n : unit_sphere(400)) {
        const float end = n.z > 0 ? in.size.y : -in.size.y;
        out.push_back(n * in.size.x + Vec3f{0, 0, end});
      }
      for (const Vec3f& p : cylinder_points(in.size.x, in.size.y)) out.push_back(p);
      break;
    case ShapeType::kCylinder:
      return cylinder_points(in.size.x, in.size.y);
    case ShapeType::kMesh:
    case ShapeType::kDeformable:
      break;
  }
  return out;
}

struct PartBox {
  Vec3f low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};

  void add(Vec3f a, Vec3f b) {
    low = {min(low.x, a.x), min(low.y, a.y), min(low.z, a.z)};
    high = {max(high.x, b.x), max(high.y, b.y), max(high.z, b.z)};
  }
  float diagonal() const { return length(high - low); }
  /// 0 where they touch [m].
  float distance(const PartBox& other) const {
    const auto gap = [](float a_low, float a_high, float b_low, float b_high) {
      return max(max(b_low - a_high, a_low - b_high), 0);
    };
    return length(Vec3f{gap(low.x, high.x, other.low.x, other.high.x),
                        gap(low.y, high.y, other.low.y, other.high.y),
                        gap(low.z, high.z, other.low.z, other.high.z)});
  }
};

/// True if a geom of the world is the base that the tree of bodies at `tree` hangs on, as the first
/// link of a URDF robot: a mesh that touches it and is no place around it.
bool is_base(const InstanceDescription& in, const PartBox& own, const PartBox& tree) {
  constexpr float kLargest = 4;  // in diagonals of the tree
  return in.shape == ShapeType::kMesh && own.diagonal() <= kLargest * tree.diagonal() &&
         own.distance(tree) <= 0;
}

}  // namespace

std::vector<DrawnPart> drawn_parts(const RenderDescription& scene, std::span<const Affine3f> X_WB) {
  std::vector<DrawnPart> out;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const InstanceDescription& in = scene.instances[i];
    if (!in.shown || in.color_only) continue;
    const MaterialDescription& material = scene.materials[static_cast<size_t>(in.material)];
    if (material.opacity < 0.05f) continue;
    DrawnPart part;
    part.instance = i;
    if (in.shape == ShapeType::kDeformable) {
      part.points = mesh_points(scene.deformables[static_cast<size_t>(in.mesh)].rest.positions,
                                [](Vec3f p) { return p; });
    } else {
      const Affine3f X_WG = X_WB[static_cast<size_t>(in.body)] * in.X_BG;
      const auto to_world = [&](Vec3f p) { return transform_point(X_WG, p); };
      part.points =
          in.shape == ShapeType::kMesh
              ? mesh_points(scene.meshes[static_cast<size_t>(in.mesh)].positions, to_world)
              : mesh_points(shape_points(in), to_world);
    }
    if (part.points.empty()) continue;
    PartBox box;
    for (const Vec3f& p : part.points) box.add(p, p);
    if (!std::isfinite(box.diagonal())) continue;
    part.low = box.low;
    part.high = box.high;
    out.push_back(std::move(part));
  }
  return out;
}

std::vector<DrawnPart> subject_of(std::vector<DrawnPart> parts, const RenderDescription& scene,
                                  std::span<const int> root_of) {
  struct Tree {
    PartBox box;
    size_t parts = 0;
  };
  std::map<int, Tree> trees;  // trees by root body; the world's own are 0
  const auto root = [&](const DrawnPart& part) {
    return root_of[static_cast<size_t>(scene.instances[part.instance].body)];
  };
  for (const DrawnPart& part : parts) {
    Tree& tree = trees[root(part)];
    tree.box.add(part.low, part.high);
    ++tree.parts;
  }
  const Tree* main = nullptr;
  int main_root = 0;
  for (const auto& [body, tree] : trees) {
    if (body == 0 && trees.size() > 1) continue;
    if (main == nullptr || tree.parts > main->parts) {
      main = &tree;
      main_root = body;
    }
  }
  if (main == nullptr) return parts;
  constexpr float kMaxRelativeSize = 2, kFar = 1;  // in diagonals of the main tree
  const float size = main->box.diagonal();
  const auto belongs = [&](const DrawnPart& part) {
    if (root(part) == main_root) return true;
    PartBox own;
    own.add(part.low, part.high);
    const PartBox& tree = root(part) == 0 ? own : trees[root(part)].box;
    if (root(part) == 0) return is_base(scene.instances[part.instance], own, main->box);
    return tree.diagonal() <= kMaxRelativeSize * size && tree.distance(main->box) <= kFar * size;
  };
  std::vector<DrawnPart> out;
  for (DrawnPart& part : parts)
    if (belongs(part)) out.push_back(std::move(part));
  if (main_root != 0 || out.size() < 3) return out;
  // The world's geoms alone: one that is many times as large as the median is a floor or a prop.
  std::vector<float> sizes;
  for (const DrawnPart& part : out) sizes.push_back(length(part.high - part.low));
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2),
                   sizes.end());
  const float median = sizes[sizes.size() / 2];
  std::erase_if(out, [&](const DrawnPart& part) {
    return length(part.high - part.low) > 20 * max(median, 1e-6f);
  });
  return out;
}

}  // namespace gloam

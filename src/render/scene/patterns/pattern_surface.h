#pragma once
// Surfaces that wear procedural materials.

#include <deque>
#include <vector>

#include "base/vec.h"
#include "geometry/mesh/mesh.h"
#include "instant/pose_frame.h"
#include "world/render_description.h"

namespace gloam {

/// A procedural material on the triangles of a shape; instances of equal shape share it.
struct PatternSurface {
  const TriangleMesh* mesh = nullptr;
  const ProceduralDescription* pattern = nullptr;
  ShapeType shape = ShapeType::kMesh;
  Vec3f size;              ///< of an analytic shape
  bool is_sheet = false;   ///< as in BakedPattern
  bool has_place = false;  ///< it stands at X_WG, and its pattern depends on that
  Affine3f X_WG;
  Vec3f low, high;  ///< corners of its bounding box in G [m]
  float area = 0;   ///< [m²]
  float texel = 0;  ///< width [m]: choose_texels()
  uint32_t first_table = 0;
  int tables = 0;
  float lost = 0;  ///< visible_difference() between its texels and the finest

  /// Its triangles stand for a curved shape.
  bool is_round() const {
    return shape == ShapeType::kSphere || shape == ShapeType::kEllipsoid ||
           shape == ShapeType::kCapsule || shape == ShapeType::kCylinder;
  }
};

/// Rows of the surfaces of an instance's pattern and wear; -1 = none.
struct InstancePatterns {
  int pattern = -1, wear = -1;
};

struct PatternSurfaces {
  std::vector<PatternSurface> surfaces;
  std::vector<InstancePatterns> instances;  ///< by instance
  std::deque<TriangleMesh> shapes;          ///< triangles of analytic shapes
};

/// `frame` places what never moves: the dirt there depends on the height over the floor; the dirt
/// of what moves does not.
PatternSurfaces collect_pattern_surfaces(const RenderDescription& description,
                                         const PoseFrame& frame);

}  // namespace gloam

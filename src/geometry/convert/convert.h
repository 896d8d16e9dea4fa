#pragma once
// QuickConvert: what a mesh is in physics. Colliders, volume, mass.

#include <atomic>
#include <string>

#include "geometry/convert/collider.h"
#include "gloam/result.h"

namespace gloam {

struct ConvertOptions {
  std::string colliders = "auto";  ///< as ObjectOptions::colliders
  double concavity = 0.05;         ///< as ObjectOptions
  int max_hulls = 32;
  /// A shell that looks inwards and that one can stand in is a room: its faces collide, what they
  /// enclose is free. Otherwise it is turned round.
  bool may_be_room = false;
  const std::atomic<bool>* is_cancelled = nullptr;  ///< looked at now and then
};

struct Converted {
  std::vector<MeshCollider> colliders;
  MassProperties mass;  ///< mass of the mesh where it is closed, else of its hull
  TriangleMesh mesh;    ///< the mesh, welded, looking outwards
  bool is_closed = false;
  bool is_room = false;
  std::vector<std::string> notes;  ///< for people: what is odd about it
};

/// Errors: no triangles, not finite, no extent, farther than 1e9 m, CoACD is missing, it was
/// cancelled.
/// A flat mesh becomes a plate as thick as a thousandth of its longest side.
Result<Converted> convert_mesh(const TriangleMesh& mesh, const ConvertOptions& options);

/// Comparison of the colliders with the mesh, by sampled points.
struct Overlap {
  double mean_distance = 0, max_distance = 0;  ///< between the surfaces, of both ways [m]
  /// Volumes of closed meshes and of all colliders [m^3]
  double mesh_volume = 0, collider_volume = 0;
  double shared = 0;  ///< intersection over union, for closed meshes, 0 … 1
};
Overlap overlap_of(const Converted& converted);

}  // namespace gloam

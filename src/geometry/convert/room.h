#pragma once
// Rooms: shells seen from inside, which collide by their faces.

#include "geometry/convert/collider.h"

namespace gloam {

/// Can one stand in the shell, by its bounding box?
bool is_room_sized(const TriangleMesh& shell);

/// Volume of triangles that need not close, about the middle of their bounding box; below 0: they
/// look inwards [m^3].
double enclosed_volume(const TriangleMesh& shell);

/// Convex slabs behind the faces of a shell that looks inwards. Faces are joined while they are
/// nearly of a plane and the hull of their outline takes no air: of a `closed` shell that is tried
/// every 15 cm, of others the hull may be larger by 0.3 m^2. Slabs are 10 cm thick at most, less
/// where a `closed` shell has air behind a face again (a partition).
std::vector<MeshCollider> slabs_behind(const TriangleMesh& shell, bool closed);

}  // namespace gloam

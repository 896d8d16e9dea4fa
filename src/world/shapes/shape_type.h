#pragma once
// Closed lists that both the render description and device code read; device-safe.

#include "base/device.h"

namespace gloam {

/// Closed list of shapes. Analytic ones are exact and use `size` as MuJoCo does (half extents,
/// radii [m]).
enum class ShapeType : uint8_t {
  kMesh,        ///< triangles; also height fields, SDFs (by their mesh)
  kPlane,       ///< z = 0; half extents size.x, size.y; 0 = infinite
  kBox,         ///< half extents
  kSphere,      ///< radius size.x
  kEllipsoid,   ///< semi-axes
  kCapsule,     ///< radius size.x, half length of the cylinder size.y, along z
  kCylinder,    ///< radius size.x, half length size.y, along z
  kDeformable,  ///< triangles whose vertices come with every PoseFrame (skins, flexes)
};

enum class TextureMapping : uint8_t {
  kNone,
  kUv,    ///< mesh uv, or MuJoCo's generated coordinates of primitives (2d textures)
  kCube,  ///< cube texture by object-space direction
};

}  // namespace gloam

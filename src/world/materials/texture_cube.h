#pragma once
// Lookup of cube textures: direction of a shape or of the sky, face and texel. Device-safe.
// world/materials/texture_coordinates.h states the conventions.

#include "base/vec.h"
#include "world/shapes/shape_type.h"

namespace gloam {

/// Texel of a cube texture: face in the order of TextureDescription, uv on that face.
struct CubeTexel {
  int face = 0;
  Vec2f uv;  ///< v upwards, 0..1
};

/// Direction in which a cube texture is looked up (any length > 0).
GLOAM_HD Vec3f texture_cube_direction(ShapeType shape, Vec3f p, Vec3f size, bool uniform) {
  Vec3f a = size;  // half extents of the shape along its axes
  switch (shape) {
    case ShapeType::kMesh:
    case ShapeType::kDeformable:
    case ShapeType::kPlane:
      return uniform ? p * size : p;
    case ShapeType::kSphere:
      a = {size.x, size.x, size.x};
      break;
    case ShapeType::kCapsule:
    case ShapeType::kCylinder:
      a = {size.x, size.x, size.y};
      break;
    case ShapeType::kBox:
    case ShapeType::kEllipsoid:
      break;
  }
  Vec3f q{p.x / a.x, p.y / a.y, p.z / a.z};
  if (shape == ShapeType::kCapsule && fabsf(p.z) > size.y)
    q.z = copysignf(1 + (fabsf(p.z) - size.y) / size.x, p.z);
  return uniform ? q * a : q;
}

/// The cube map of OpenGL: faces right, left, up, down, front, back = +X, -X, +Y, -Y, +Z, -Z.
GLOAM_HD CubeTexel cube_texel(Vec3f d) {
  const float ax = fabsf(d.x), ay = fabsf(d.y), az = fabsf(d.z);
  float s = 0, t = 0, major = ax;
  CubeTexel texel;
  if (ax >= ay && ax >= az) {
    texel.face = d.x >= 0 ? 0 : 1;
    s = d.x >= 0 ? -d.z : d.z;
    t = -d.y;
  } else if (ay >= az) {
    texel.face = d.y >= 0 ? 2 : 3;
    s = d.x;
    t = d.y >= 0 ? d.z : -d.z;
    major = ay;
  } else {
    texel.face = d.z >= 0 ? 4 : 5;
    s = d.z >= 0 ? d.x : -d.x;
    t = -d.y;
    major = az;
  }
  const float half = 0.5f / max(major, 1e-30f);
  texel.uv = {0.5f + s * half, 0.5f - t * half};
  return texel;
}

/// World direction to direction in the skybox: MuJoCo draws it turned by 90 degrees about +X, so
/// that images made for +Y up stand upright.
GLOAM_HD Vec3f sky_cube_direction(Vec3f d_W) { return {d_W.x, d_W.z, -d_W.y}; }

}  // namespace gloam

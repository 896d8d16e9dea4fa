#pragma once
// Texture coordinates of shapes: the conventions of MuJoCo's classic renderer, measured on MuJoCo
// 4.0.0 with a texture whose texels name their row and column. Device-safe.
//
// p is the hit in the shape's own frame [m], n the unit geometric normal there, size that of
// InstanceDescription. With s to the right and t DOWN the image (t = 0 is the top of the first
// row), N = texrepeat, c = texuniform ? size : 1 (of capsule and cylinder: radius, radius):
//   plane      s = c.x (1/2 + x / 2 size.x)     t = c.y (1/2 - y / 2 size.y)
//              an infinite side: s = 1/2 + N x / 2, t = 1/2 - N y / 2, whatever texuniform says
//   box        as plane on the two faces across z; across x: s from y, t from z; across y: s from
//   x,
//              t from z; c stays (size.x, size.y)
//   sphere, ellipsoid (q = p / size)
//              s = c.x atan2(q.y, q.x) / 2 pi in [0, 1),  t = c.y acos(q.z) / pi
//   cylinder   side: s as the sphere, t = c.y (1/2 - z / 2 size.y); caps: s = c.x (1/2 + x / 2 r),
//              t = c.y (1/2 + y / 2 r)
//   capsule    side: as the cylinder; caps: s as the sphere, t = c.y times the angle from the pole
//              over pi / 2 (top), one minus that (bottom)
//   mesh       with uv: s = c.x u, t = c.y (1 - v). Without (and height fields):
//              s = 1/2 + N x / 2 size.x, t = 1/2 - N y / 2 size.y; texuniform: size = 1
// and then (s, t) times N, where N is not written above. A cube texture is looked up along
//   q = p / size (mesh, plane: p), times size if texuniform,
// in a capsule's caps q.z = +-(1 + (|z| - size.y) / r); texrepeat does nothing there.

#include "base/vec.h"
#include "world/materials/texture_cube.h"
#include "world/shapes/shape_type.h"

namespace gloam {

/// Angle around z as a fraction of the full turn, [0, 1).
GLOAM_HD float turn_about_z(float x, float y) {
  const float turn = atan2f(y, x) * (0.5f * kInvPi);
  return turn < 0 ? turn + 1 : turn;
}

/// Texture coordinates of a 2-D texture, repetition included: u to the right, v upwards, as in OBJ.
/// `uv` = the mesh's own coordinates at the hit, used if `has_uv`.
GLOAM_HD Vec2f texture_uv(ShapeType shape, Vec3f p, Vec3f n, Vec3f size, Vec2f uv, bool has_uv,
                          Vec2f repeat, bool uniform) {
  float s = 0, t = 0;
  Vec2f scale{1, 1};
  switch (shape) {
    case ShapeType::kMesh:
    case ShapeType::kDeformable:
      if (!has_uv) {
        const float x = uniform ? p.x : p.x / max(size.x, 1e-9f);
        const float y = uniform ? p.y : p.y / max(size.y, 1e-9f);
        return {0.5f + 0.5f * repeat.x * x, 0.5f + 0.5f * repeat.y * y};
      }
      s = uv.x;
      t = 1 - uv.y;
      scale = {size.x, size.y};
      break;
    case ShapeType::kPlane: {
      const float half_x = uniform ? p.x : p.x / size.x, half_y = uniform ? p.y : p.y / size.y;
      const float cx = uniform ? size.x : 1, cy = uniform ? size.y : 1;
      s = size.x > 0 ? repeat.x * 0.5f * (cx + half_x) : 0.5f + 0.5f * repeat.x * p.x;
      t = size.y > 0 ? repeat.y * 0.5f * (cy - half_y) : 0.5f - 0.5f * repeat.y * p.y;
      return {s, 1 - t};
    }
    case ShapeType::kBox: {
      const float ax = fabsf(n.x), ay = fabsf(n.y), az = fabsf(n.z);
      const Vec3f q{p.x / size.x, p.y / size.y, p.z / size.z};
      const bool across_z = az >= ax && az >= ay;
      s = 0.5f + 0.5f * (across_z || ay >= ax ? q.x : q.y);
      t = 0.5f - 0.5f * (across_z ? q.y : q.z);
      scale = {size.x, size.y};
      break;
    }
    case ShapeType::kSphere:
    case ShapeType::kEllipsoid: {
      const Vec3f a = shape == ShapeType::kSphere ? Vec3f{size.x, size.x, size.x} : size;
      s = turn_about_z(p.x / a.x, p.y / a.y);
      t = acosf(clamp(p.z / a.z, -1, 1)) * kInvPi;
      scale = {a.x, a.y};
      break;
    }
    case ShapeType::kCylinder:
      if (fabsf(n.z) > 0.5f) {
        s = 0.5f + 0.5f * p.x / size.x;
        t = 0.5f + 0.5f * p.y / size.x;
      } else {
        s = turn_about_z(p.x, p.y);
        t = 0.5f - 0.5f * p.z / size.y;
      }
      scale = {size.x, size.x};
      break;
    case ShapeType::kCapsule: {
      const float beyond = fabsf(p.z) - size.y;
      s = turn_about_z(p.x, p.y);
      t = 0.5f - 0.5f * p.z / size.y;
      if (beyond > 0) {
        const float from_pole = acosf(clamp(beyond / size.x, -1, 1)) * 2 * kInvPi;
        t = p.z > 0 ? from_pole : 1 - from_pole;
      }
      scale = {size.x, size.x};
      break;
    }
  }
  if (uniform) {
    s *= scale.x;
    t *= scale.y;
  }
  return {s * repeat.x, 1 - t * repeat.y};
}

}  // namespace gloam

#pragma once
// Poses of things fixed to bodies.

#include <cmath>

#include "base/check.h"
#include "base/vec.h"
#include "gloam/types.h"
#include "instant/pose_frame.h"
#include "world/render_description.h"

namespace gloam {

/// X_WB X_BG in double precision, rounded once.
inline Affine3f pose_in_world(const PoseFrame& frame, int body, const Affine3f& X_BG) {
  const size_t b = static_cast<size_t>(body);
  GLOAM_CHECK(frame.body_p.size() >= 3 * (b + 1) && frame.body_R.size() >= 9 * (b + 1),
              "the pose frame lacks a body");
  const double *p = &frame.body_p[3 * b], *R = &frame.body_R[9 * b];
  const auto rotate = [R](Vec3f v, const double* offset) {
    double out[3];
    for (int i = 0; i < 3; ++i) {
      out[i] = R[3 * i] * v.x + R[3 * i + 1] * v.y + R[3 * i + 2] * v.z +
               (offset != nullptr ? offset[i] : 0.0);
    }
    return Vec3f{static_cast<float>(out[0]), static_cast<float>(out[1]),
                 static_cast<float>(out[2])};
  };
  return {rotate(X_BG.x, nullptr), rotate(X_BG.y, nullptr), rotate(X_BG.z, nullptr),
          rotate(X_BG.p, p)};
}

/// X_WG of a rendered thing, X_WL of a lamp that is fixed to a body.
inline Affine3f pose_in_world(const RenderDescription& description, const PoseFrame& frame,
                              const InstanceDescription& in) {
  const auto row = static_cast<size_t>(in.motion);
  return pose_in_world(
      frame, in.body,
      in.motion < 0 ? in.X_BG : moved(description.motions[row], frame.time, in.X_BG));
}
inline Affine3f pose_in_world(const RenderDescription& description, const PoseFrame& frame,
                              const LightDescription& in) {
  const auto row = static_cast<size_t>(in.motion);
  return pose_in_world(
      frame, in.body,
      in.motion < 0 ? in.X_BL : moved(description.motions[row], frame.time, in.X_BL));
}

inline bool is_same(const Affine3f& a, const Affine3f& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.p == b.p;
}

/// The rotation of a rigid pose, w >= 0.
inline Quat quaternion_of(const Affine3f& X) {
  // Shepperd's method: the largest of the four squared components is never near zero.
  const double m00 = X.x.x, m10 = X.x.y, m20 = X.x.z, m01 = X.y.x, m11 = X.y.y, m21 = X.y.z;
  const double m02 = X.z.x, m12 = X.z.y, m22 = X.z.z;
  const double ww = 1 + m00 + m11 + m22, xx = 1 + m00 - m11 - m22, yy = 1 - m00 + m11 - m22,
               zz = 1 - m00 - m11 + m22;
  Quat q;
  if (ww >= xx && ww >= yy && ww >= zz) {
    q = {ww, m21 - m12, m02 - m20, m10 - m01};
  } else if (xx >= yy && xx >= zz) {
    q = {m21 - m12, xx, m10 + m01, m02 + m20};
  } else if (yy >= zz) {
    q = {m02 - m20, m10 + m01, yy, m21 + m12};
  } else {
    q = {m10 - m01, m02 + m20, m21 + m12, zz};
  }
  const double scale =
      (q.w < 0 ? -1.0 : 1.0) / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
}

}  // namespace gloam

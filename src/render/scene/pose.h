#pragma once
// Where things fixed to bodies are.

#include "base/check.h"
#include "base/vec.h"
#include "sim/pose_frame.h"

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

}  // namespace gloam

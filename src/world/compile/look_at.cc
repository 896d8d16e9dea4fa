#include "world/compile/look_at.h"

#include <mujoco/mujoco.h>

namespace gloam {

Quat look_at(const Vec3& from, const Vec3& to) {
  double z[3] = {from.x - to.x, from.y - to.y, from.z - to.z};
  mju_normalize3(z);
  double up[3] = {0, 0, 1}, x[3], y[3];
  mju_cross(x, up, z);
  if (mju_norm3(x) < 1e-6) {  // straight up or down
    const double forward[3] = {0, 1, 0};
    mju_cross(x, forward, z);
  }
  mju_normalize3(x);
  mju_cross(y, z, x);
  const double R[9] = {x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]};
  double q[4];
  mju_mat2Quat(q, R);
  return {q[0], q[1], q[2], q[3]};
}

}  // namespace gloam

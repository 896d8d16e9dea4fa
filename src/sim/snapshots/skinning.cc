#include "sim/snapshots/skinning.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gloam {
namespace {

void to_double(const float* in, int n, double* out) { std::copy(in, in + n, out); }

void blend_bone(const mjModel& model, int bone, const mjtNum* xpos, const mjtNum* xquat,
                const float* rest, float* out) {
  // X_WV = X_WB X_BV, where B is the bone's body and V the frame the rest vertices are given in.
  double p_bind[3], q_bind[4], q_unbind[4], q[4], R[9], p[3];
  to_double(model.skin_bonebindpos + 3 * bone, 3, p_bind);
  to_double(model.skin_bonebindquat + 4 * bone, 4, q_bind);
  const int body = model.skin_bonebodyid[bone];
  mju_negQuat(q_unbind, q_bind);
  mju_mulQuat(q, xquat + 4 * body, q_unbind);
  mju_quat2Mat(R, q);
  mju_mulMatVec3(p, R, p_bind);
  mju_sub3(p, xpos + 3 * body, p);
  const int first = model.skin_bonevertadr[bone];
  for (int i = first; i < first + model.skin_bonevertnum[bone]; ++i) {
    const int vertex = model.skin_bonevertid[i];
    const float weight = model.skin_bonevertweight[i];
    double v[3], v_W[3];
    to_double(rest + 3 * vertex, 3, v);
    mju_mulMatVec3(v_W, R, v);
    for (int axis = 0; axis < 3; ++axis) {
      out[3 * vertex + axis] += weight * static_cast<float>(v_W[axis] + p[axis]);
    }
  }
}

// Vertex normals: sums of the faces' area vectors, made unit.
void inflate_along_normals(const mjModel& model, int skin, float distance, float* vertices) {
  const int vertex_count = model.skin_vertnum[skin];
  std::vector<double> normals(static_cast<size_t>(3 * vertex_count));
  const int* faces = model.skin_face + 3 * model.skin_faceadr[skin];
  for (int face = 0; face < model.skin_facenum[skin]; ++face) {
    const int* corner = faces + 3 * face;
    double p[3][3], edge1[3], edge2[3], area[3];
    for (int i = 0; i < 3; ++i) to_double(vertices + 3 * corner[i], 3, p[i]);
    mju_sub3(edge1, p[1], p[0]);
    mju_sub3(edge2, p[2], p[0]);
    mju_cross(area, edge1, edge2);
    for (int i = 0; i < 3; ++i) mju_addTo3(normals.data() + 3 * corner[i], area);
  }
  for (int vertex = 0; vertex < vertex_count; ++vertex) {
    double* normal = normals.data() + 3 * vertex;
    mju_normalize3(normal);
    for (int axis = 0; axis < 3; ++axis) {
      vertices[3 * vertex + axis] += distance * static_cast<float>(normal[axis]);
    }
  }
}

}  // namespace

void skin_vertices(const mjModel& model, int skin, const mjtNum* xpos, const mjtNum* xquat,
                   float* out) {
  std::fill(out, out + 3 * model.skin_vertnum[skin], 0.0f);
  const float* rest = model.skin_vert + 3 * model.skin_vertadr[skin];
  for (int i = 0; i < model.skin_bonenum[skin]; ++i) {
    blend_bone(model, model.skin_boneadr[skin] + i, xpos, xquat, rest, out);
  }
  const float inflate = model.skin_inflate[skin];
  if (inflate != 0) inflate_along_normals(model, skin, inflate, out);
}

}  // namespace gloam

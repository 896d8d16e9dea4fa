#pragma once
// Layout of fields in memory: cells and faces share one index, with a ghost cell around the box.
// Device-safe.

#include "base/vec.h"

/// Before a loop whose iterations do not depend on each other, which GCC cannot know.
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
#define GLOAM_IVDEP _Pragma("GCC ivdep")
#else
#define GLOAM_IVDEP
#endif

namespace gloam::gas {

/// Cell (i, j, k) of [0, nx) x [0, ny) x [0, nz) lies at at(i, j, k); ghosts at -1 and n. The face
/// across axis a at the same index lies between that cell and the one before it along a.
struct Shape {
  int nx = 0, ny = 0, nz = 0;
  int sy = 0, sz = 0;  ///< strides; that of x is 1

  GLOAM_HD static Shape of(int nx, int ny, int nz) {
    return {nx, ny, nz, nx + 2, (nx + 2) * (ny + 2)};
  }
  GLOAM_HD int at(int i, int j, int k) const { return (i + 1) + (j + 1) * sy + (k + 1) * sz; }
  GLOAM_HD int size() const { return sz * (nz + 2); }  ///< with ghosts
  GLOAM_HD int n(int axis) const { return axis == 0 ? nx : (axis == 1 ? ny : nz); }
  GLOAM_HD int stride(int axis) const { return axis == 0 ? 1 : (axis == 1 ? sy : sz); }
  /// Shape of the faces across `axis`: one more than cells along it, in the same memory.
  GLOAM_HD Shape faces(int axis) const {
    return {nx + (axis == 0), ny + (axis == 1), nz + (axis == 2), sy, sz};
  }
};

/// One value per face, of each axis.
template <class T>
struct Faces {
  T* x = nullptr;
  T* y = nullptr;
  T* z = nullptr;
  GLOAM_HD T* operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
  GLOAM_HD Faces<const T> read() const { return {x, y, z}; }
};

/// Velocity of the centre of the cell at c, twice.
GLOAM_HD Vec3f centre_twice(const Shape& s, const Faces<const float>& u, int c) {
  return {u.x[c] + u.x[c + 1], u.y[c] + u.y[c + s.sy], u.z[c] + u.z[c + s.sz]};
}

/// Square of the speed at the centre of the cell at c.
GLOAM_HD float speed_squared(const Shape& s, const Faces<const float>& u, int c) {
  const Vec3f v = centre_twice(s, u, c) * 0.5f;
  return v.x * v.x + v.y * v.y + v.z * v.z;
}

/// Net outflow of the cell at c through all faces, per area.
GLOAM_HD float outflow(const Shape& s, const Faces<const float>& u, int c) {
  return (u.x[c + 1] - u.x[c]) + (u.y[c + s.sy] - u.y[c]) + (u.z[c + s.sz] - u.z[c]);
}

}  // namespace gloam::gas

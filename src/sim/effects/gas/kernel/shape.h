#pragma once
// How fields lie in memory: cells and faces share one index, with a ghost cell around the box.
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

/// What flows out of the cell at c through all faces less what flows in, per area.
GLOAM_HD float outflow(const Shape& s, const Faces<const float>& u, int c) {
  return (u.x[c + 1] - u.x[c]) + (u.y[c + s.sy] - u.y[c]) + (u.z[c + s.sz] - u.z[c]);
}

}  // namespace gloam::gas

#include "world/shapes/capsule_mesh.h"

#include <mujoco/mujoco.h>

#include <cmath>

namespace gloam {
namespace {

// A pole, two rings, two rings, a pole; half a cap lies between the rings of one end.
constexpr int kSides = 12, kRings = 4;
static_assert(kRings * kSides + 2 == kCapsuleVertices);

}  // namespace

void place_capsule(const double* a, const double* b, double radius, float* vertices) {
  double axis[3], across[3], up[3];
  mju_sub3(axis, b, a);
  if (mju_normalize3(axis) < mjMINVAL || radius <= 0) {
    const double along_z[3] = {0, 0, 1};
    mju_copy3(axis, along_z);
  }
  const double off_axis[3] = {std::fabs(axis[0]) < 0.7 ? 1.0 : 0.0,
                              std::fabs(axis[0]) < 0.7 ? 0.0 : 1.0, 0};
  mju_cross(across, axis, off_axis);
  mju_normalize3(across);
  mju_cross(up, axis, across);

  const double step = 2 * mjPI / kSides;
  const double outer = radius * std::sqrt(step / std::sin(step));
  const auto put = [&](const double* end, double along, double x, double y) {
    for (int i = 0; i < 3; ++i) {
      *vertices++ = static_cast<float>(end[i] + along * axis[i] + x * across[i] + y * up[i]);
    }
  };
  put(a, -radius, 0, 0);
  constexpr double kLatitude[kRings] = {-mjPI / 4, 0, 0, mjPI / 4};
  for (int ring = 0; ring < kRings; ++ring) {
    const double r = outer * std::cos(kLatitude[ring]);
    for (int side = 0; side < kSides; ++side) {
      put(ring < kRings / 2 ? a : b, radius * std::sin(kLatitude[ring]), r * std::cos(step * side),
          r * std::sin(step * side));
    }
  }
  put(b, radius, 0, 0);
}

void append_capsule_triangles(int count, std::vector<uint32_t>* indices) {
  for (int capsule = 0; capsule < count; ++capsule) {
    const auto first = static_cast<uint32_t>(capsule * kCapsuleVertices);
    const uint32_t last = first + kCapsuleVertices - 1;
    const auto at = [first](int ring, int side) {
      return first + 1 + static_cast<uint32_t>(ring * kSides + side % kSides);
    };
    for (int side = 0; side < kSides; ++side) {
      indices->insert(indices->end(), {first, at(0, side + 1), at(0, side)});
      for (int ring = 0; ring + 1 < kRings; ++ring) {
        indices->insert(indices->end(),
                        {at(ring, side), at(ring, side + 1), at(ring + 1, side + 1),  //
                         at(ring, side), at(ring + 1, side + 1), at(ring + 1, side)});
      }
      indices->insert(indices->end(), {last, at(kRings - 1, side), at(kRings - 1, side + 1)});
    }
  }
}

}  // namespace gloam

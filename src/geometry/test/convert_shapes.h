#pragma once
// Meshes to convert.

#include <cmath>

#include "geometry/solid.h"

namespace gloam::test {

/// About z; `segments` around both circles.
inline TriangleMesh torus(float ring, float tube, uint32_t segments = 48) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < segments; ++i) {
    for (uint32_t j = 0; j < segments; ++j) {
      const float u = 2 * kPi * static_cast<float>(i) / static_cast<float>(segments);
      const float v = 2 * kPi * static_cast<float>(j) / static_cast<float>(segments);
      const float r = ring + tube * std::cos(v);
      mesh.positions.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
      const auto at = [&](uint32_t a, uint32_t b) {
        return (i + a) % segments * segments + (j + b) % segments;
      };
      const uint32_t quad[] = {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)};
      mesh.indices.insert(mesh.indices.end(), std::begin(quad), std::end(quad));
    }
  }
  return mesh;
}

inline TriangleMesh mug() {
  Solid body = sharp_lathe(
      {{0, 0}, {0.04f, 0}, {0.04f, 0.1f}, {0.036f, 0.1f}, {0.036f, 0.004f}, {0, 0.004f}}, 48);
  Path handle;
  for (int i = -6; i <= 6; ++i) {
    const float a = static_cast<float>(i) * kPi / 12;
    handle.push_back({0.038f + 0.03f * std::cos(a), 0, 0.05f + 0.03f * std::sin(a)});
  }
  return (body + tube(handle, 0.005f, 12)).mesh();
}

/// Two bars of 1 x 0.2 x 0.2 m, volume 0.072.
inline TriangleMesh l_shape() {
  return extrude({{0, 0}, {1, 0}, {1, 0.2f}, {0.2f, 0.2f}, {0.2f, 1}, {0, 1}}, 0, 0.2f).mesh();
}

/// A seat on four round legs with a back of rounded slats: about 5,000 triangles.
inline TriangleMesh chair() {
  Solid all = rounded_box({0.45f, 0.45f, 0.04f}, 0.01f, 3).moved(0, 0, 0.45f);
  for (const float x : {-0.19f, 0.19f})
    for (const float y : {-0.19f, 0.19f})
      all += cylinder(0.02f, 0, 0.45f, 0.004f, 40).moved(x, y, 0);
  for (const float y : {-0.19f, -0.06f, 0.06f, 0.19f})
    all += rounded_box({0.03f, 0.05f, 0.5f}, 0.01f, 3).moved(-0.2f, y, 0.7f);
  all += rounded_box({0.04f, 0.45f, 0.08f}, 0.01f, 3).moved(-0.2f, 0, 0.95f);
  return all.mesh();
}

}  // namespace gloam::test

#include "geometry/gltf/node_place.h"

#include <cmath>

namespace gloam {

bool normalize_rotation(std::array<float, 4>* q) {
  const auto [x, y, z, w] = *q;
  const float norm = std::sqrt(x * x + y * y + z * z + w * w);
  if (!(norm > 1e-6f && std::isfinite(norm))) return false;
  for (float& v : *q) v /= norm;
  return true;
}

Affine3f place_from(const std::array<float, 4>& q, Vec3f scale) {
  const auto [x, y, z, w] = q;
  Affine3f out;
  out.x = Vec3f{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)} * scale.x;
  out.y = Vec3f{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)} * scale.y;
  out.z = Vec3f{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)} * scale.z;
  return out;
}

namespace {

Affine3f from_matrix(const JsonNode& node) {
  float m[16];
  if (!node.numbers(m, 16)) return {};
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    node.fail("is not an affine transform: its last row must be 0 0 0 1");
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

Affine3f from_parts(const JsonNode& node) {
  std::array<float, 4> q = {0, 0, 0, 1};
  if (node["rotation"].numbers(q.data(), 4) && !normalize_rotation(&q)) {
    node["rotation"].fail("is not a rotation: the quaternion is zero or too large");
    return {};
  }
  Affine3f out = place_from(q, node["scale"].vec3({1, 1, 1}));
  out.p = node["translation"].vec3({0, 0, 0});
  return out;
}

}  // namespace

Affine3f place_in_parent(const JsonNode& node) {
  return node["matrix"].exists() ? from_matrix(node["matrix"]) : from_parts(node);
}

}  // namespace gloam

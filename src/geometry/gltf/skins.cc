#include "geometry/gltf/skins.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr size_t kMostSets = 8;  // of four weights each, per vertex

GltfSkin read_skin(GltfDocument* document, const JsonNode& node) {
  GltfSkin skin;
  const size_t nodes = document->root()["nodes"].size();
  const JsonNode joints = node["joints"];
  for (size_t i = 0; i < joints.size() && document->errors().ok(); ++i)
    skin.joints.push_back(joints.at(i).required_index(nodes, "node"));
  skin.X_JM.assign(skin.joints.size(), Affine3f{});
  const JsonNode matrices = node["inverseBindMatrices"];
  if (!document->errors().ok() || !matrices.exists()) return skin;
  const int accessor = matrices.index(document->root()["accessors"].size(), "accessor");
  std::vector<float> numbers;
  if (accessor < 0 || !document->read_floats(accessor, 16, &numbers)) return skin;
  if (numbers.size() < 16 * skin.joints.size()) {
    matrices.fail(
        fmt::format("has {} matrices for {} joints", numbers.size() / 16, skin.joints.size()));
    return skin;
  }
  for (size_t i = 0; i < skin.joints.size(); ++i) {
    const float* m = &numbers[16 * i];  // column by column; the last row is 0 0 0 1
    skin.X_JM[i] = {
        {m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  }
  return skin;
}

Affine3f weighted_sum(const GltfVertexWeights& weights, size_t vertex,
                      std::span<const Affine3f> X_FM) {
  const size_t first = vertex * weights.per_vertex;
  Affine3f sum{{}, {}, {}, {}};
  float total = 0;
  for (size_t i = first; i < first + weights.per_vertex; ++i) {
    const float w = weights.weights[i];
    if (!(w > 0)) continue;
    const Affine3f& X = X_FM[weights.joints[i]];
    sum.x += X.x * w, sum.y += X.y * w, sum.z += X.z * w, sum.p += X.p * w;
    total += w;
  }
  if (!(total > 0)) return X_FM[weights.joints[first]];
  const float scale = 1 / total;
  return {sum.x * scale, sum.y * scale, sum.z * scale, sum.p * scale};
}

// False where a vertex names a joint beyond them.
bool bend_mesh(const GltfVertexWeights& weights, std::span<const Affine3f> X_FM,
               TriangleMesh* mesh) {
  for (size_t i = 0; i < weights.joints.size(); ++i)
    if (weights.joints[i] >= X_FM.size()) return false;
  float volume = 0;  // of the unit cube after it, all vertices together: below 0 = mirrored
  for (size_t i = 0; i < mesh->positions.size(); ++i) {
    const Affine3f X = weighted_sum(weights, i, X_FM);
    mesh->positions[i] = transform_point(X, mesh->positions[i]);
    const Vec3f yz = cross(X.y, X.z), zx = cross(X.z, X.x), xy = cross(X.x, X.y);
    const float det = dot(X.x, yz);
    volume += det < 0 ? -1.0f : 1.0f;
    if (mesh->normals.empty()) continue;
    const Vec3f n = mesh->normals[i];  // cofactors: the inverse transpose, up to a factor
    const Vec3f turned = (yz * n.x + zx * n.y + xy * n.z) * (det < 0 ? -1.0f : 1.0f);
    const float length = std::sqrt(dot(turned, turned));
    if (length > 0 && std::isfinite(length)) mesh->normals[i] = turned / length;
  }
  if (volume < 0)
    for (size_t t = 0; t + 2 < mesh->indices.size(); t += 3)
      std::swap(mesh->indices[t + 1], mesh->indices[t + 2]);
  return true;
}

}  // namespace

std::vector<GltfSkin> read_gltf_skins(GltfDocument* document) {
  std::vector<GltfSkin> out;
  const JsonNode skins = document->root()["skins"];
  for (size_t i = 0; i < skins.size() && document->errors().ok(); ++i)
    out.push_back(read_skin(document, skins.at(i)));
  return out;
}

GltfVertexWeights read_gltf_weights(GltfDocument* document, const JsonNode& attributes,
                                    size_t count) {
  std::vector<std::vector<float>> joints, weights;
  const size_t accessors = document->root()["accessors"].size();
  for (size_t set = 0; set < kMostSets; ++set) {
    const JsonNode joint = attributes[fmt::format("JOINTS_{}", set)];
    const JsonNode weight = attributes[fmt::format("WEIGHTS_{}", set)];
    if (!joint.exists() || !weight.exists()) break;
    const int j = joint.index(accessors, "accessor"), w = weight.index(accessors, "accessor");
    if (j < 0 || w < 0 || !document->read_floats(j, 4, &joints.emplace_back()) ||
        !document->read_floats(w, 4, &weights.emplace_back()))
      return {};
    if (joints.back().size() != 4 * count || weights.back().size() != 4 * count) {
      joint.fail(fmt::format("has joints for {} and weights for {} vertices, but POSITION has {}",
                             joints.back().size() / 4, weights.back().size() / 4, count));
      return {};
    }
  }
  GltfVertexWeights out;
  out.per_vertex = 4 * joints.size();
  for (size_t vertex = 0; vertex < count; ++vertex)
    for (size_t set = 0; set < joints.size(); ++set)
      for (size_t k = 4 * vertex; k < 4 * vertex + 4; ++k) {
        const float joint = joints[set][k];
        out.joints.push_back(joint >= 0 && joint < 1e9f ? static_cast<uint32_t>(joint)
                                                        : UINT32_MAX);
        out.weights.push_back(weights[set][k]);
      }
  return out;
}

int add_bent_mesh(GltfDocument* document, const JsonNode& node, const GltfMeshTable::Part& part,
                  std::span<const Affine3f> X_FM, ModelFile* model) {
  TriangleMesh mesh = model->meshes[static_cast<size_t>(part.mesh)];
  constexpr size_t kVertexBytes = 2 * sizeof(Vec3f) + 2 * sizeof(Vec2f);
  if (model->meshes.size() >= document->source().options->limits.meshes ||
      !document->budget().take(mesh.positions.size(), kVertexBytes)) {
    node.fail("with its skinned meshes the model exceeds the size limit when decoded");
    return -1;
  }
  if (!bend_mesh(part.weights, X_FM, &mesh)) {
    node["skin"].fail(
        fmt::format("a vertex refers to a joint that is out of range; there are {}", X_FM.size()));
    return -1;
  }
  const Status sound = finish_mesh(&mesh, node.pointer(), document->source().name, model);
  if (!sound.ok()) {
    document->errors().add(sound.error());
    return -1;
  }
  model->meshes.push_back(std::move(mesh));
  return static_cast<int>(model->meshes.size()) - 1;
}

}  // namespace gloam

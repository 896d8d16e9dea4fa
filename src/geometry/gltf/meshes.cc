// Meshes of glTF: every primitive becomes a mesh of triangles of its own.

#include <fmt/format.h>

#include <cmath>

#include "geometry/gltf/document.h"
#include "geometry/gltf/skins.h"
#include "geometry/mesh/vertex_colors.h"

namespace gloam {
namespace {

enum Mode : uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

std::vector<Vec3f> to_vec3(const std::vector<float>& numbers) {
  std::vector<Vec3f> out(numbers.size() / 3);
  for (size_t i = 0; i < out.size(); ++i)
    out[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  return out;
}

// glTF's v grows downwards.
std::vector<Vec2f> to_uv(const std::vector<float>& numbers) {
  std::vector<Vec2f> out(numbers.size() / 2);
  for (size_t i = 0; i < out.size(); ++i) out[i] = {numbers[2 * i], 1 - numbers[2 * i + 1]};
  return out;
}

// Strips and fans as single triangles (3.7.2.1: their order keeps the winding).
std::vector<uint32_t> to_triangles(std::vector<uint32_t> in, uint64_t mode) {
  if (mode == kTriangles) return in;
  std::vector<uint32_t> out;
  if (in.size() < 3) return out;
  out.reserve(3 * (in.size() - 2));
  for (size_t i = 0; i + 2 < in.size(); ++i) {
    if (mode == kFan) {
      out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
    } else {
      const size_t odd = i % 2;
      out.insert(out.end(), {in[i], in[i + 1 + odd], in[i + 2 - odd]});
    }
  }
  return out;
}

class PrimitiveReader {
 public:
  PrimitiveReader(GltfDocument* document, ModelFile* model) : document_(document), model_(model) {}

  // The new mesh with its material, painted where its vertices have colours; mesh -1 = nothing to
  // draw or an error.
  GltfMeshTable::Part read_part(const JsonNode& node, int material) {
    GltfMeshTable::Part out{read(node), material};
    if (out.mesh >= 0 && document_->root()["skins"].size() > 0)
      out.weights = read_gltf_weights(document_, node["attributes"], mesh_of(out).positions.size());
    const JsonNode color = node["attributes"]["COLOR_0"];
    if (out.mesh < 0 || !color.exists()) return out;
    const JsonNode accessors = document_->root()["accessors"];
    const int accessor = color.index(accessors.size(), "accessor");
    if (accessor < 0) return {-1, material, {}};
    const size_t width =
        accessors.at(static_cast<size_t>(accessor))["type"].text() == "VEC4" ? 4 : 3;
    const size_t count = mesh_of(out).positions.size();
    std::vector<float> numbers;
    if (!read_vertices(color, width, count, &numbers)) return {-1, material, {}};
    std::vector<Vec3f> colors(count);
    bool is_clear = false;
    for (size_t i = 0; i < count; ++i) {
      const float* n = &numbers[i * width];
      if (!std::isfinite(n[0] + n[1] + n[2])) {
        color.fail(fmt::format("the colour of vertex {} is not finite", i));
        return {-1, material, {}};
      }
      colors[i] = {n[0], n[1], n[2]};
      is_clear = is_clear || (width == 4 && n[3] < 1);
    }
    if (is_clear) add_note(model_, "the transparency of vertex colours is ignored");
    const int plain = out.mesh;
    out.material = paint_vertices(colors, material, &out.mesh, &painted_, model_);
    if (out.mesh != plain) split_weights(model_->meshes[static_cast<size_t>(plain)], &out.weights);
    return out;
  }

 private:
  const TriangleMesh& mesh_of(const GltfMeshTable::Part& part) const {
    return model_->meshes[static_cast<size_t>(part.mesh)];
  }

  // Painting gives every corner of a triangle a vertex of its own.
  static void split_weights(const TriangleMesh& plain, GltfVertexWeights* weights) {
    GltfVertexWeights out;
    out.per_vertex = weights->per_vertex;
    if (out.per_vertex == 0) return;
    for (const uint32_t vertex : plain.indices)
      for (size_t k = vertex * out.per_vertex; k < (vertex + 1) * out.per_vertex; ++k) {
        out.joints.push_back(weights->joints[k]);
        out.weights.push_back(weights->weights[k]);
      }
    *weights = std::move(out);
  }

  // Index of the new mesh; -1 = nothing to draw or an error.
  int read(const JsonNode& node) const {
    const uint64_t mode = node["mode"].integer(kTriangles, kFan);
    if (mode < kTriangles) {
      add_note(model_, "points and lines are ignored");
      return -1;
    }
    note_what_is_left_out(node);
    TriangleMesh mesh;
    std::vector<float> numbers;
    const JsonNode attributes = node["attributes"];
    const JsonNode position = attributes["POSITION"];
    if (!position.exists()) {
      add_note(model_, "primitives without positions are ignored");
      return -1;
    }
    if (!read_attribute(position, 3, &numbers)) return -1;
    mesh.positions = to_vec3(numbers);
    const ModelLimits& limits = document_->source().options->limits;
    if (mesh.positions.size() > limits.vertices) {
      position.fail(fmt::format("has more than {} vertices", limits.vertices));
      return -1;
    }
    const size_t count = mesh.positions.size();
    if (read_vertices(attributes["NORMAL"], 3, count, &numbers)) mesh.normals = to_vec3(numbers);
    if (read_vertices(attributes["TEXCOORD_0"], 2, count, &numbers)) mesh.uvs = to_uv(numbers);
    if (read_vertices(attributes["TEXCOORD_1"], 2, count, &numbers)) mesh.uvs1 = to_uv(numbers);
    if (!read_corners(node, mode, count, &mesh)) return -1;
    const Status finished = finish_mesh(&mesh, node.pointer(), document_->source().name, model_);
    if (!finished.ok()) {
      document_->errors().add(finished.error());
      return -1;
    }
    model_->meshes.push_back(std::move(mesh));
    return static_cast<int>(model_->meshes.size()) - 1;
  }

  void note_what_is_left_out(const JsonNode& node) const {
    if (node["targets"].exists()) add_note(model_, "morph targets are ignored");
  }

  bool read_attribute(const JsonNode& node, size_t components, std::vector<float>* out) const {
    const int accessor = node.index(document_->root()["accessors"].size(), "accessor");
    return accessor >= 0 && document_->read_floats(accessor, components, out);
  }

  bool read_vertices(const JsonNode& node, size_t components, size_t count,
                     std::vector<float>* out) const {
    if (!node.exists() || !read_attribute(node, components, out)) return false;
    if (out->size() == components * count) return true;
    node.fail(fmt::format("has {} vertices, but POSITION has {}", out->size() / components, count));
    return false;
  }

  bool read_corners(const JsonNode& node, uint64_t mode, size_t vertices,
                    TriangleMesh* mesh) const {
    std::vector<uint32_t> corners;
    const JsonNode indices = node["indices"];
    if (indices.exists()) {
      const int accessor = indices.index(document_->root()["accessors"].size(), "accessor");
      if (accessor < 0 || !document_->read_indices(accessor, &corners)) return false;
    } else {
      if (!document_->budget().take(vertices, sizeof(uint32_t))) return false;
      corners.resize(vertices);
      for (size_t i = 0; i < vertices; ++i) corners[i] = static_cast<uint32_t>(i);
    }
    if (mode == kTriangles && corners.size() % 3 != 0) {
      node.fail(fmt::format("{} corners are not a multiple of 3", corners.size()));
      return false;
    }
    mesh->indices = to_triangles(std::move(corners), mode);
    return document_->errors().ok();
  }

  GltfDocument* document_;
  ModelFile* model_;
  PaintedMeshes painted_;
};

}  // namespace

GltfMeshTable read_gltf_meshes(GltfDocument* document, ModelFile* model) {
  GltfMeshTable out;
  const JsonNode meshes = document->root()["meshes"];
  PrimitiveReader reader(document, model);
  const size_t materials = model->materials.size();  // painting adds more
  uint64_t total = 0;
  for (size_t i = 0; i < meshes.size(); ++i) total += meshes.at(i)["primitives"].size();
  if (total > document->source().options->limits.meshes)
    meshes.fail(fmt::format("{} primitives exceed the limit", total));
  ProgressCount progress(document->source().options->progress, total);
  for (size_t i = 0; i < meshes.size() && document->errors().ok(); ++i) {
    const JsonNode primitives = meshes.at(i)["primitives"];
    out.parts.emplace_back();
    for (size_t k = 0; k < primitives.size() && document->errors().ok(); ++k) {
      const JsonNode primitive = primitives.at(k);
      const int material = primitive["material"].index(materials, "material");
      GltfMeshTable::Part part = reader.read_part(primitive, material);
      if (part.mesh >= 0) out.parts.back().push_back(std::move(part));
      progress.add(1);
    }
  }
  return out;
}

}  // namespace gloam

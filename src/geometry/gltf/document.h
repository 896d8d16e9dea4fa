#pragma once
// A glTF 2.0 document with its buffers (Khronos, "glTF 2.0 Specification", 2021).

#include <string>
#include <string_view>
#include <vector>

#include "geometry/gltf/json_node.h"
#include "geometry/mesh/model_source.h"

namespace gloam {

class GltfDocument {
 public:
  /// `bin`: the binary chunk of a GLB, else empty. Errors: not glTF 2, an extension is required
  /// that Gloam lacks, a buffer is missing or too short.
  static Result<std::unique_ptr<GltfDocument>> open(const ModelSource& source,
                                                    std::span<const uint8_t> json,
                                                    std::span<const uint8_t> bin);

  JsonNode root() { return {&json_, "", &errors_}; }
  JsonErrors& errors() { return errors_; }
  const ModelSource& source() const { return source_; }
  MemoryBudget& budget() { return budget_; }

  /// Bytes of a buffer view; empty after an error.
  std::span<const uint8_t> view(int index);

  /// Numbers of an accessor with `components` numbers per element, normalised where the file says
  /// so: count x components. False after an error.
  bool read_floats(int accessor, size_t components, std::vector<float>* out);
  /// Indices: unsigned whole numbers.
  bool read_indices(int accessor, std::vector<uint32_t>* out);

  /// Content of a URI: the bytes of a data URI or of a file beside the model.
  Result<std::vector<uint8_t>> fetch(const std::string& uri, const std::string& pointer);

 private:
  GltfDocument(const ModelSource& source, nlohmann::json json)
      : source_(source),
        json_(std::move(json)),
        errors_(source.name),
        budget_(source.options->limits.decoded_bytes) {}
  void open_buffers(std::span<const uint8_t> bin);

  ModelSource source_;
  nlohmann::json json_;
  JsonErrors errors_;
  MemoryBudget budget_;
  std::vector<std::vector<uint8_t>> owned_;
  std::vector<std::span<const uint8_t>> buffers_;
};

/// Extensions that the file uses and Gloam lacks, as notes.
void note_unknown_extensions(GltfDocument* document, ModelFile* model);

// gltf/materials.cc: images and materials of the document.
void read_gltf_images(GltfDocument* document, ModelFile* model);
void read_gltf_materials(GltfDocument* document, ModelFile* model);

/// Joints of a skin that move each vertex, with their weights: `per_vertex` of each, 0 = none.
struct GltfVertexWeights {
  size_t per_vertex = 0;
  std::vector<uint32_t> joints;
  std::vector<float> weights;
};
/// Meshes of the primitives of each mesh of the file.
struct GltfMeshTable {
  struct Part {
    int mesh = 0, material = -1;
    GltfVertexWeights weights = {};
  };
  std::vector<std::vector<Part>> parts;  ///< one list per mesh of the file
};
// gltf/meshes.cc
GltfMeshTable read_gltf_meshes(GltfDocument* document, ModelFile* model);
// gltf/lights.cc
ImportedLight read_gltf_light(const JsonNode& node);
// gltf/nodes.cc: the hierarchy, flattened into instances and lights.
void read_gltf_nodes(GltfDocument* document, const GltfMeshTable& meshes, ModelFile* model);

}  // namespace gloam

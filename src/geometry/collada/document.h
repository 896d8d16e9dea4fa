#pragma once
// A COLLADA document (Khronos, "COLLADA 1.4.1 Specification", 2008; 1.5 names the same things) for
// static scenes. Not for others.

#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "geometry/mesh/model_source.h"

namespace gloam {

class ColladaDocument {
 public:
  /// Errors: not well-formed, no COLLADA, nested too deep.
  static Result<std::unique_ptr<ColladaDocument>> open(const ModelSource& source);

  pugi::xml_node root() const { return document_.child("COLLADA"); }
  /// The element that "#id" names in this file; none where it is not there.
  pugi::xml_node find(std::string_view url) const;
  const ModelSource& source() const { return source_; }
  MemoryBudget& budget() { return budget_; }
  SourceLoc loc_of(const pugi::xml_node& node) const;
  /// Error at an element, which says its id.
  Error bad(const pugi::xml_node& node, std::string_view message) const;

  /// All numbers of an element's text; a word that is none is an error.
  Status read_floats(const pugi::xml_node& node, std::vector<float>* out);
  Status read_indices(const pugi::xml_node& node, std::vector<uint32_t>* out);

 private:
  explicit ColladaDocument(const ModelSource& source)
      : source_(source), budget_(source.options->limits.decoded_bytes) {}

  ModelSource source_;
  pugi::xml_document document_;
  std::unordered_map<std::string_view, pugi::xml_node> ids_;
  MemoryBudget budget_;
};

/// A primitive of a <geometry>: one mesh and the name its material is bound by.
struct ColladaPart {
  int mesh = 0;
  std::string symbol;
  std::vector<Vec3f> colors;  ///< linear, by vertex; empty = it has none
};

/// Materials made for "#id" of the file; filled as they are used.
class ColladaMaterials {
 public:
  ColladaMaterials(ColladaDocument* document, ModelFile* model)
      : document_(document), model_(model) {}
  /// Row of ModelFile::materials for a <material>'s url; -1 = there is none.
  Result<int> row(const std::string& url);

 private:
  ColladaDocument* document_;
  ModelFile* model_;
  std::unordered_map<std::string, int> rows_;
};

/// collada/geometry.cc: the meshes of one <geometry>, added to the model.
Result<std::vector<ColladaPart>> read_collada_geometry(ColladaDocument* document,
                                                       const pugi::xml_node& geometry,
                                                       ModelFile* model);
/// collada/nodes.cc: the visual scene, flattened into instances.
Status read_collada_scene(ColladaDocument* document, ModelFile* model);

}  // namespace gloam

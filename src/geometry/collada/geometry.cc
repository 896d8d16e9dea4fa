// Meshes of COLLADA: <triangles>, <polylist>, <polygons>, <trifans>, <tristrips>.

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>

#include "geometry/collada/document.h"
#include "geometry/mesh/triangulate.h"
#include "geometry/mesh/vertex_colors.h"

namespace gloam {
namespace {

constexpr uint32_t kNoIndex = UINT32_MAX;
constexpr uint32_t kMostOffsets = 64;

// Numbers of a <source>, as its accessor hands them out.
struct NumberSource {
  std::vector<float> values;
  size_t count = 0, stride = 1, offset = 0, width = 0;
  float at(size_t element, size_t component) const {
    return values[offset + element * stride + component];
  }
};

// One <input>: which array, and which of the numbers of a corner is its index.
struct CornerInput {
  const NumberSource* source = nullptr;
  uint32_t offset = 0;
};

struct CornerInputs {
  CornerInput position, normal, uv, uv1, color;
  uint32_t stride = 1;  // indices of a corner
};

class GeometryReader {
 public:
  GeometryReader(ColladaDocument* document, const pugi::xml_node& geometry, ModelFile* model)
      : document_(document), geometry_(geometry), model_(model) {}

  Result<std::vector<ColladaPart>> read() {
    const pugi::xml_node mesh = geometry_.child("mesh");
    if (!mesh) {
      add_note(model_, fmt::format("geometry '{:.80}' is not a mesh and is ignored",
                                   geometry_.attribute("id").value()));
      return std::vector<ColladaPart>{};
    }
    for (const pugi::xml_node& node : mesh.children()) {
      const std::string_view kind = node.name();
      if (kind == "triangles" || kind == "polylist" || kind == "polygons" || kind == "trifans" ||
          kind == "tristrips")
        GLOAM_TRY_STATUS(read_primitive(node, kind));
    }
    return std::move(parts_);
  }

 private:
  Result<const NumberSource*> source_of(const pugi::xml_node& input, size_t least) {
    const std::string url = input.attribute("source").value();
    const auto [known, is_new] = sources_.try_emplace(url);
    NumberSource& out = known->second;
    if (is_new) {
      const pugi::xml_node source = document_->find(url);
      const pugi::xml_node accessor = source.child("technique_common").child("accessor");
      const pugi::xml_node array = document_->find(accessor.attribute("source").value());
      if (!source || !accessor || !array)
        return document_->bad(
            input,
            fmt::format("refers to source '{:.80}', which is not defined or contains no numbers",
                        url));
      GLOAM_TRY_STATUS(document_->read_floats(array, &out.values));
      out.count = accessor.attribute("count").as_uint();
      out.stride = std::max(1U, accessor.attribute("stride").as_uint(1));
      out.offset = accessor.attribute("offset").as_uint();
      out.width = out.stride;
      const size_t size = out.values.size();
      if (out.count > 0 && (out.offset > size || out.count > (size - out.offset) / out.stride))
        return document_->bad(
            accessor, fmt::format("requires {} x {} numbers, but the source has {}", out.count,
                                  out.stride, size));
    }
    if (out.width < least)
      return document_->bad(
          input, fmt::format("has {} numbers per vertex, expected at least {}", out.width, least));
    return &out;
  }

  // <vertices> stands for inputs that share one index.
  Status add_inputs(const pugi::xml_node& node, std::optional<uint32_t> offset, CornerInputs* out) {
    for (const pugi::xml_node& input : node.children("input")) {
      const std::string_view semantic = input.attribute("semantic").value();
      const uint32_t at = offset.value_or(input.attribute("offset").as_uint());
      if (at >= kMostOffsets) return document_->bad(input, "has an offset that is too large");
      if (!offset) out->stride = std::max(out->stride, at + 1);
      const auto set = [&](CornerInput* to, size_t least) -> Status {
        if (to->source != nullptr) return {};
        GLOAM_TRY(to->source, source_of(input, least));
        to->offset = at;
        return {};
      };
      if (semantic == "VERTEX" && !offset) {
        const pugi::xml_node vertices = document_->find(input.attribute("source").value());
        GLOAM_TRY_STATUS(add_inputs(vertices, at, out));
      } else if (semantic == "POSITION") {
        GLOAM_TRY_STATUS(set(&out->position, 3));
      } else if (semantic == "NORMAL") {
        GLOAM_TRY_STATUS(set(&out->normal, 3));
      } else if (semantic == "TEXCOORD") {
        GLOAM_TRY_STATUS(set(out->uv.source == nullptr ? &out->uv : &out->uv1, 2));
      } else if (semantic == "COLOR") {
        GLOAM_TRY_STATUS(set(&out->color, 3));
      }
    }
    return {};
  }

  // Numbers of corners of each polygon, and all indices after one another.
  Status read_corners(const pugi::xml_node& node, std::string_view kind, uint32_t stride,
                      std::vector<uint32_t>* sizes, std::vector<uint32_t>* indices) {
    std::vector<uint32_t> numbers;
    if (kind == "polylist") GLOAM_TRY_STATUS(document_->read_indices(node.child("vcount"), sizes));
    const auto add_polygon = [&](const pugi::xml_node& p) -> Status {
      GLOAM_TRY_STATUS(document_->read_indices(p, &numbers));
      if (numbers.size() % stride != 0)
        return document_->bad(p, fmt::format("has {} indices, which is not a multiple of {}",
                                             numbers.size(), stride));
      indices->insert(indices->end(), numbers.begin(), numbers.end());
      return {};
    };
    for (const pugi::xml_node& child : node.children()) {
      pugi::xml_node p = child;
      if (std::string_view(child.name()) == "ph") {
        p = child.child("p");
        add_note(model_, "holes in polygons are filled");
      } else if (std::string_view(child.name()) != "p") {
        continue;
      }
      const size_t before = indices->size();
      GLOAM_TRY_STATUS(add_polygon(p));
      const auto corners = static_cast<uint32_t>((indices->size() - before) / stride);
      if (kind == "polygons") sizes->push_back(corners);
      if (kind == "triangles") sizes->insert(sizes->end(), corners / 3, 3);
      if (kind == "triangles" && corners % 3 != 0)
        return document_->bad(p,
                              fmt::format("has {} corners, which is not a multiple of 3", corners));
      if (kind == "trifans" || kind == "tristrips")
        unroll(kind == "trifans", before, stride, corners, sizes, indices);
    }
    uint64_t total = 0;
    for (const uint32_t size : *sizes) total += size;
    if (total * stride != indices->size())
      return document_->bad(
          node, fmt::format("must have {} indices, but has {}", total * stride, indices->size()));
    return {};
  }

  static void unroll(bool is_fan, size_t from, uint32_t stride, uint32_t corners,
                     std::vector<uint32_t>* sizes, std::vector<uint32_t>* indices) {
    const std::vector<uint32_t> strip(indices->begin() + static_cast<ptrdiff_t>(from),
                                      indices->end());
    indices->resize(from);
    for (uint32_t i = 0; i + 2 < corners; ++i) {
      const uint32_t odd = i % 2;
      const std::array<uint32_t, 3> triangle =
          is_fan ? std::array<uint32_t, 3>{0, i + 1, i + 2}
                 : std::array<uint32_t, 3>{i, i + 1 + odd, i + 2 - odd};
      for (const uint32_t corner : triangle)
        for (uint32_t k = 0; k < stride; ++k)
          indices->push_back(strip[size_t{corner} * stride + k]);
      sizes->push_back(3);
    }
  }

  Status read_primitive(const pugi::xml_node& node, std::string_view kind) {
    CornerInputs in;
    GLOAM_TRY_STATUS(add_inputs(node, {}, &in));
    if (in.position.source == nullptr) return document_->bad(node, "has no positions");
    std::vector<uint32_t> indices;
    PolygonList polygons;
    GLOAM_TRY_STATUS(read_corners(node, kind, in.stride, &polygons.sizes, &indices));
    if (indices.empty()) return {};
    const size_t corners = indices.size() / in.stride;
    if (!document_->budget().take(corners, 20 * sizeof(float)))
      return document_->bad(node, "exceeds the size limit when decoded");
    TriangleMesh mesh;
    ColladaPart part;
    GLOAM_TRY_STATUS(gather(node, in, indices, &polygons, &mesh, &part));
    uint64_t face = 0;
    if (const std::string why =
            triangulate_polygons(mesh.positions, polygons, &mesh.indices, &face);
        !why.empty())
      return document_->bad(node, fmt::format("has an invalid polygon: polygon {} {}", face, why));
    const std::string what = fmt::format("geometry '{:.80}'", geometry_.attribute("id").value());
    GLOAM_TRY_STATUS(finish_mesh(&mesh, what, document_->source().name, model_));
    if (model_->meshes.size() >= document_->source().options->limits.meshes)
      return document_->bad(node, "exceeds the limit on meshes");
    part.mesh = static_cast<int>(model_->meshes.size());
    part.symbol = node.attribute("material").value();
    model_->meshes.push_back(std::move(mesh));
    parts_.push_back(std::move(part));
    return {};
  }

  // Vertices of the mesh: the different combinations of indices.
  Status gather(const pugi::xml_node& node, const CornerInputs& in,
                const std::vector<uint32_t>& indices, PolygonList* polygons, TriangleMesh* mesh,
                ColladaPart* part) {
    std::map<std::array<uint32_t, 5>, uint32_t> known;
    const std::array<const CornerInput*, 5> inputs = {&in.position, &in.normal, &in.uv, &in.uv1,
                                                      &in.color};
    polygons->corners.reserve(indices.size() / in.stride);
    for (size_t at = 0; at < indices.size(); at += in.stride) {
      std::array<uint32_t, 5> key{};
      for (size_t i = 0; i < inputs.size(); ++i) {
        const NumberSource* source = inputs[i]->source;
        key[i] = source == nullptr ? kNoIndex : indices[at + inputs[i]->offset];
        if (source != nullptr && key[i] >= source->count)
          return document_->bad(
              node, fmt::format("refers to element {} of a source with {} elements", key[i],
                                source->count));
      }
      const auto [vertex, is_new] =
          known.try_emplace(key, static_cast<uint32_t>(mesh->positions.size()));
      polygons->corners.push_back(vertex->second);
      if (is_new) add_vertex(in, key, mesh, part);
    }
    return {};
  }

  static void add_vertex(const CornerInputs& in, const std::array<uint32_t, 5>& key,
                         TriangleMesh* mesh, ColladaPart* part) {
    const auto vec3 = [](const NumberSource& s, uint32_t i) {
      return Vec3f{s.at(i, 0), s.at(i, 1), s.at(i, 2)};
    };
    mesh->positions.push_back(vec3(*in.position.source, key[0]));
    if (in.normal.source != nullptr) {
      const Vec3f n = vec3(*in.normal.source, key[1]);
      const float l = length(n);
      mesh->normals.push_back(l > 0 ? n * (1 / l) : n);
    }
    if (const NumberSource* s = in.uv.source)
      mesh->uvs.push_back({s->at(key[2], 0), s->at(key[2], 1)});
    if (const NumberSource* s = in.uv1.source)
      mesh->uvs1.push_back({s->at(key[3], 0), s->at(key[3], 1)});
    if (in.color.source != nullptr)
      part->colors.push_back(color_from_display(vec3(*in.color.source, key[4])));
  }

  ColladaDocument* document_;
  const pugi::xml_node geometry_;
  ModelFile* model_;
  std::map<std::string, NumberSource> sources_;
  std::vector<ColladaPart> parts_;
};

}  // namespace

Result<std::vector<ColladaPart>> read_collada_geometry(ColladaDocument* document,
                                                       const pugi::xml_node& geometry,
                                                       ModelFile* model) {
  return GeometryReader(document, geometry, model).read();
}

}  // namespace gloam

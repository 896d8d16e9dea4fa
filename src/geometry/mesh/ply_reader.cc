// PLY, text and binary of both byte orders: positions, normals, texture coordinates, colours and
// polygons. Elements and properties of other programs are ignored.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/parallel.h"
#include "geometry/mesh/ply_header.h"
#include "geometry/mesh/text_lines.h"
#include "geometry/mesh/triangulate.h"
#include "geometry/mesh/vertex_colors.h"

namespace gloam {
namespace {

constexpr size_t kSlots = 11;

// Slot of a vertex's property: x y z, normal, u v, red green blue; -1 = none.
int slot_of(const std::string& name) {
  constexpr std::string_view kNames[kSlots][4] = {{"x"},
                                                  {"y"},
                                                  {"z"},
                                                  {"nx"},
                                                  {"ny"},
                                                  {"nz"},
                                                  {"u", "s", "texture_u", "s0"},
                                                  {"v", "t", "texture_v", "t0"},
                                                  {"red", "r", "diffuse_red"},
                                                  {"green", "g", "diffuse_green"},
                                                  {"blue", "b", "diffuse_blue"}};
  for (int slot = 0; slot < static_cast<int>(kSlots); ++slot)
    for (const std::string_view known : kNames[slot])
      if (!known.empty() && known == name) return slot;
  return -1;
}

// Largest value of a colour channel.
float full_scale(PlyType type) {
  if (type == PlyType::kUint8) return 255;
  return type == PlyType::kUint16 ? 65535.0f : 1;
}

bool is_face_list(const PlyElement& element, const PlyProperty& property) {
  return element.name == "face" && property.count_type &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

double load_number(const uint8_t* from, PlyType type, bool big) {
  uint8_t b[8] = {};
  const size_t size = size_of(type);
  for (size_t i = 0; i < size; ++i) b[i] = from[big ? size - 1 - i : i];
  const auto as = [&]<class T>(T value) {
    std::memcpy(&value, b, sizeof(T));
    return static_cast<double>(value);
  };
  switch (type) {
    case PlyType::kInt8:
      return as(int8_t{});
    case PlyType::kUint8:
      return as(uint8_t{});
    case PlyType::kInt16:
      return as(int16_t{});
    case PlyType::kUint16:
      return as(uint16_t{});
    case PlyType::kInt32:
      return as(int32_t{});
    case PlyType::kUint32:
      return as(uint32_t{});
    case PlyType::kFloat:
      return as(float{});
    default:
      return as(double{});
  }
}

/// Corners of faces; false when one is no vertex.
bool add_corner(double index, uint64_t vertices, PolygonList* out) {
  if (!(index >= 0 && index < static_cast<double>(vertices) && index == std::floor(index)))
    return false;
  out->corners.push_back(static_cast<uint32_t>(index));
  return true;
}

class PlyReader {
 public:
  PlyReader(const ModelSource& source, PlyHeader header)
      : source_(source),
        header_(std::move(header)),
        body_(source.bytes.subspan(header_.bytes)),
        progress_(source.options->progress, body_.size()) {}

  Result<ModelFile> read() {
    GLOAM_TRY_STATUS(prepare());
    GLOAM_TRY_STATUS(header_.format == PlyFormat::kAscii ? read_ascii() : read_binary());
    ModelFile model;
    for (const uint32_t size : faces_.sizes) model.dropped_triangles += size < 3 ? 1 : 0;
    uint64_t face = 0;
    if (const std::string why =
            triangulate_polygons(mesh_.positions, faces_, &mesh_.indices, &face);
        !why.empty())
      return bad(fmt::format("face {} {}", face, why));
    GLOAM_TRY_STATUS(finish_mesh(&mesh_, "the mesh", source_.name, &model));
    model.meshes.push_back(std::move(mesh_));
    int mesh = 0, material = -1;
    if (!colors_.empty()) {
      PaintedMeshes painted;
      material = paint_vertices(colors_, -1, &mesh, &painted, &model);
    }
    model.instances.push_back({{}, mesh, material, {}});
    return model;
  }

 private:
  Error bad(std::string message, uint64_t line = 0) const {
    return {ErrorKind::kInput,
            std::move(message),
            {source_.name, static_cast<int>(std::min<uint64_t>(line, INT32_MAX)), 0},
            "the file may be truncated; export or copy it again"};
  }

  // Sizes are checked against what the file can hold before memory is asked for.
  Status prepare() {
    bool has_faces = false;
    for (size_t e = 0; e < header_.elements.size(); ++e) {
      const PlyElement& element = header_.elements[e];
      const bool is_text = header_.format == PlyFormat::kAscii;
      const uint64_t least = is_text ? 1 : element.least_bytes();
      if (least > 0 && element.count > body_.size() / least)
        return bad(fmt::format("it declares {} elements '{}', but only {} bytes follow its header",
                               element.count, element.name, body_.size()));
      if (element.name == "vertex") GLOAM_TRY_STATUS(prepare_vertices(e));
      for (const PlyProperty& p : element.properties) has_faces |= is_face_list(element, p);
      if (element.name == "tristrips") return bad("its triangle strips are not supported");
    }
    if (vertex_element_ == SIZE_MAX) return bad("it has no vertices");
    if (!has_faces) return bad("it has no faces: point clouds are not supported");
    return {};
  }

  Status prepare_vertices(size_t e) {
    const PlyElement& element = header_.elements[e];
    if (vertex_element_ != SIZE_MAX) return bad("it has two vertex lists");
    vertex_element_ = e;
    const ModelLimits& limits = source_.options->limits;
    MemoryBudget budget(limits.decoded_bytes);
    if (element.count > limits.vertices || !budget.take(element.count, kSlots * sizeof(float)) ||
        !budget.take(body_.size(), 8))
      return bad(fmt::format("has {} vertices, which exceeds the limit", element.count));
    if (element.has_lists()) return bad("its vertices contain lists");
    std::array<bool, kSlots> has{};
    for (const PlyProperty& p : element.properties) {
      slots_.push_back(slot_of(p.name));
      if (slots_.back() >= 8) full_scale_ = full_scale(p.type);
      if (slots_.back() >= 0) has[static_cast<size_t>(slots_.back())] = true;
    }
    if (!has[0] || !has[1] || !has[2]) return bad("its vertices have no x, y and z");
    mesh_.positions.resize(element.count);
    if (has[3] && has[4] && has[5]) mesh_.normals.resize(element.count);
    if (has[6] && has[7]) mesh_.uvs.resize(element.count);
    if (has[8] && has[9] && has[10]) colors_.resize(element.count);
    return {};
  }

  void put_vertex(uint64_t row, const std::array<float, kSlots>& n) {
    mesh_.positions[row] = {n[0], n[1], n[2]};
    if (!mesh_.normals.empty()) mesh_.normals[row] = {n[3], n[4], n[5]};
    if (!mesh_.uvs.empty()) mesh_.uvs[row] = {n[6], n[7]};
    if (!colors_.empty()) colors_[row] = color_from_display(Vec3f{n[8], n[9], n[10]} / full_scale_);
  }

  // --- binary ---

  Status read_binary() {
    const bool big = header_.format == PlyFormat::kBigEndian;
    size_t at = 0;
    for (size_t e = 0; e < header_.elements.size(); ++e) {
      const PlyElement& element = header_.elements[e];
      const size_t from = at;
      if (element.has_lists()) {
        GLOAM_TRY_STATUS(read_lists(element, big, &at));
      } else {
        const size_t size = element.least_bytes() * element.count;  // below body_.size(): prepare()
        if (size > body_.size() - at) return ends_early(element, at);
        if (e == vertex_element_) read_vertices(element, big, at);
        at += size;
      }
      progress_.add(at - from);
    }
    return {};
  }

  Error ends_early(const PlyElement& element, size_t at) const {
    return bad(fmt::format("it ends in the middle of its elements '{}', after byte {}",
                           element.name, header_.bytes + at));
  }

  void read_vertices(const PlyElement& element, bool big, size_t at) {
    const size_t stride = element.least_bytes();
    parallel_for_range(
        "read PLY", static_cast<int64_t>(element.count), 1 << 14, [&](int64_t begin, int64_t end) {
          for (auto i = static_cast<uint64_t>(begin); i < static_cast<uint64_t>(end); ++i) {
            std::array<float, kSlots> numbers{};
            const uint8_t* from = body_.data() + at + i * stride;
            for (size_t p = 0; p < slots_.size(); ++p) {
              const PlyType type = element.properties[p].type;
              if (slots_[p] >= 0)
                numbers[static_cast<size_t>(slots_[p])] =
                    static_cast<float>(load_number(from, type, big));
              from += size_of(type);
            }
            put_vertex(i, numbers);
          }
        });
  }

  Status read_lists(const PlyElement& element, bool big, size_t* at) {
    for (uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& p : element.properties) {
        double count = 1;
        if (p.count_type) {
          if (size_of(*p.count_type) > body_.size() - *at) return ends_early(element, *at);
          count = load_number(body_.data() + *at, *p.count_type, big);
          *at += size_of(*p.count_type);
        }
        const size_t size = size_of(p.type);
        const size_t room = (body_.size() - *at) / size;
        if (!(count >= 0 && count <= static_cast<double>(room))) return ends_early(element, *at);
        const auto n = static_cast<uint32_t>(count);
        if (is_face_list(element, p)) {
          faces_.sizes.push_back(n);
          for (uint32_t k = 0; k < n; ++k) {
            const double index = load_number(body_.data() + *at + k * size, p.type, big);
            if (!add_corner(index, mesh_.positions.size(), &faces_))
              return bad(fmt::format("face {} uses vertex {}, but there are {}", i, index,
                                     mesh_.positions.size()));
          }
        }
        *at += n * size;
      }
    }
    return {};
  }

  // --- text: one element per line ---

  struct Piece {
    std::string_view text;
    uint64_t rows = 0, lines = 0;
    PolygonList faces;
    std::string error;
    uint64_t error_line = 0;
  };

  Status read_ascii() {
    std::vector<Piece> pieces;
    for (const std::string_view text : split_at_lines(as_text(body_), kPieceBytes))
      pieces.push_back({text});
    parallel_for("count PLY", static_cast<int64_t>(pieces.size()), [&](int64_t i) {
      Piece& piece = pieces[static_cast<size_t>(i)];
      for (std::string_view rest = piece.text; !rest.empty(); ++piece.lines)
        if (!trim(take_line(&rest)).empty()) ++piece.rows;
    });
    std::vector<uint64_t> first_row(pieces.size() + 1, 0);
    for (size_t i = 0; i < pieces.size(); ++i) first_row[i + 1] = first_row[i] + pieces[i].rows;
    uint64_t needed = 0;
    for (const PlyElement& element : header_.elements) needed += element.count;
    if (first_row.back() < needed)
      return bad(fmt::format("it declares {} elements, but only {} lines follow its header", needed,
                             first_row.back()));
    parallel_for("parse PLY", static_cast<int64_t>(pieces.size()), [&](int64_t i) {
      parse_piece(first_row[static_cast<size_t>(i)], &pieces[static_cast<size_t>(i)]);
      progress_.add(pieces[static_cast<size_t>(i)].text.size());
    });
    uint64_t lines = header_.lines;
    for (const Piece& piece : pieces) {
      if (!piece.error.empty()) return bad(piece.error, lines + piece.error_line);
      lines += piece.lines;
      faces_.sizes.insert(faces_.sizes.end(), piece.faces.sizes.begin(), piece.faces.sizes.end());
      faces_.corners.insert(faces_.corners.end(), piece.faces.corners.begin(),
                            piece.faces.corners.end());
    }
    return {};
  }

  void parse_piece(uint64_t row, Piece* piece) {
    size_t e = 0;
    while (e < header_.elements.size() && row >= header_.elements[e].count)
      row -= header_.elements[e++].count;
    std::string_view rest = piece->text;
    while (!rest.empty() && e < header_.elements.size()) {
      std::string_view line = take_line(&rest);
      ++piece->error_line;
      if (trim(line).empty()) continue;
      if (!parse_row(e, row, line, piece)) return;
      ++row;
      while (e < header_.elements.size() && row >= header_.elements[e].count) row = 0, ++e;
    }
  }

  bool parse_row(size_t e, uint64_t row, std::string_view line, Piece* piece) {
    const PlyElement& element = header_.elements[e];
    std::array<float, kSlots> numbers{};
    for (size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.count_type) {
        if (!parse_list(element, property, &line, piece)) return false;
        continue;
      }
      float value;
      const std::string_view word = take_word(&line);
      if (!parse_number(word, &value)) {
        piece->error = word.empty() ? "the line is too short"
                                    : fmt::format("'{}' is not a number", word.substr(0, 40));
        return false;
      }
      if (e == vertex_element_ && slots_[p] >= 0) numbers[static_cast<size_t>(slots_[p])] = value;
    }
    if (e == vertex_element_) put_vertex(row, numbers);
    return true;
  }

  bool parse_list(const PlyElement& element, const PlyProperty& property, std::string_view* line,
                  Piece* piece) {
    uint32_t count = 0;
    if (!parse_integer(take_word(line), &count)) {
      piece->error = "the list has no length";
      return false;
    }
    const bool is_face = is_face_list(element, property);
    if (is_face) piece->faces.sizes.push_back(count);
    for (uint32_t k = 0; k < count; ++k) {
      const std::string_view word = take_word(line);
      int64_t index = 0;
      if (word.empty()) {
        piece->error = fmt::format("the list must have {} numbers, but has {}", count, k);
        return false;
      }
      if (!is_face) continue;
      if (parse_integer(word, &index) &&
          add_corner(static_cast<double>(index), mesh_.positions.size(), &piece->faces))
        continue;
      piece->error = fmt::format("the face uses vertex '{}', but there are {}", word.substr(0, 40),
                                 mesh_.positions.size());
      return false;
    }
    return true;
  }

  const ModelSource& source_;
  PlyHeader header_;
  std::span<const uint8_t> body_;
  ProgressCount progress_;
  size_t vertex_element_ = SIZE_MAX;
  std::vector<int> slots_;  // slots of the vertices' properties
  TriangleMesh mesh_;
  std::vector<Vec3f> colors_;  // linear, by vertex; empty = none
  float full_scale_ = 1;       // full scale of a channel
  PolygonList faces_;
};

}  // namespace

Result<ModelFile> read_ply(const ModelSource& source) {
  GLOAM_TRY(PlyHeader header, read_ply_header(source));
  return PlyReader(source, std::move(header)).read();
}

}  // namespace gloam

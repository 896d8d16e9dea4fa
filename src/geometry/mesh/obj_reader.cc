// Wavefront OBJ (Alias|Wavefront, "Object Files", appendix B1 of the Advanced Visualizer's manual).
// Pieces of the file are parsed side by side; then indices are resolved and meshes put together.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/parallel.h"
#include "base/path_readings.h"
#include "base/text.h"
#include "geometry/mesh/mtl_reader.h"
#include "geometry/mesh/text_lines.h"
#include "geometry/mesh/triangulate.h"
#include "geometry/mesh/vertex_colors.h"

namespace gloam {
namespace {

// An index as written: 0 and up = absolute, kAbsent = not given, else relative to the first element
// of its piece, moved by kRelative.
constexpr int32_t kAbsent = std::numeric_limits<int32_t>::min();
constexpr int32_t kRelative = -(1 << 30);
constexpr int64_t kMostIndex = int64_t{1} << 28;

struct Corner {
  int32_t v = kAbsent, vt = kAbsent, vn = kAbsent;
};

// usemtl, g or o: applies to the faces from `face` of its piece on.
struct Switch {
  size_t face = 0;
  bool is_material = false;
  std::string name;
};

struct Library {
  std::string name;
  uint64_t line = 0;
};

struct ObjPiece {
  std::vector<Vec3f> positions, normals;
  std::vector<Vec3f> colors;  // as written, one per position, or none at all
  std::vector<Vec2f> uvs;
  std::vector<Corner> corners;
  std::vector<uint32_t> sizes;       // corners of each face
  std::vector<uint32_t> face_lines;  // in the piece
  std::vector<Switch> switches;
  std::vector<Library> libraries;
  uint64_t lines = 0;
  std::string error;  // at line `lines`
};

class PieceParser {
 public:
  explicit PieceParser(ObjPiece* out) : out_(*out) {}

  void parse(std::string_view text) {
    while (!text.empty() && out_.error.empty()) {
      std::string_view line = take_line(&text);
      ++out_.lines;
      if (line.ends_with('\\')) line = join(line, &text);
      if (line.size() > kMaxLine) return fail("the line is too long");
      parse_line(line);
    }
  }

 private:
  void fail(std::string message) { out_.error = std::move(message); }

  std::string_view join(std::string_view line, std::string_view* text) {
    joined_.assign(line);
    while (joined_.ends_with('\\') && !text->empty() && joined_.size() <= kMaxLine) {
      joined_.back() = ' ';
      joined_ += take_line(text);
      ++out_.lines;
    }
    return joined_;
  }

  void parse_line(std::string_view line) {
    std::string_view word = take_word(&line);
    if (word.empty() || word[0] == '#') return;
    std::string lower;
    if (word[0] >= 'A' && word[0] <= 'Z') word = lower = lower_case(word);
    if (word == "v") {
      Vec3f p;
      if (!numbers(line, {&p.x, &p.y, &p.z})) return;
      out_.positions.push_back(p);
      add_color(line);
    } else if (word == "vn") {
      Vec3f n;
      if (numbers(line, {&n.x, &n.y, &n.z})) out_.normals.push_back(n);
    } else if (word == "vt") {
      Vec2f uv;
      std::string_view rest = line;
      (void)take_word(&rest);
      const bool has_v = !trim(rest).empty();
      if (has_v ? numbers(line, {&uv.x, &uv.y}) : numbers(line, {&uv.x})) out_.uvs.push_back(uv);
    } else if (word == "f") {
      parse_face(line);
    } else if (word == "usemtl" || word == "g" || word == "o") {
      out_.switches.push_back(
          {out_.sizes.size(), word == "usemtl", std::string(trim(line).substr(0, kMaxName))});
    } else if (word == "mtllib") {
      out_.libraries.push_back({without_foreign_folder(trim(line)), out_.lines});
    }  // s, l, p, curves and what programs add of their own carry no triangles
  }

  // "v x y z r g b", as many programs write it; x y z w has one number more than three.
  void add_color(std::string_view line) {
    for (int i = 0; i < 3; ++i) (void)take_word(&line);
    Vec3f color;
    for (float* value : {&color.x, &color.y, &color.z})
      if (!parse_number(take_word(&line), value) || !std::isfinite(*value)) return;
    out_.colors.resize(out_.positions.size() - 1, {1, 1, 1});
    out_.colors.push_back(color);
  }

  bool numbers(std::string_view line, std::initializer_list<float*> out) {
    for (float* value : out) {
      const std::string_view word = take_word(&line);
      if (parse_number(word, value)) continue;
      fail(word.empty() ? fmt::format("expected {} numbers", out.size())
                        : fmt::format("'{}' is not a number", word.substr(0, 40)));
      return false;
    }
    return true;
  }

  void parse_face(std::string_view line) {
    uint32_t size = 0;
    for (std::string_view word; !(word = take_word(&line)).empty(); ++size) {
      Corner corner;
      if (!parse_corner(word, &corner))
        return fail(fmt::format("'{}' is not a valid face corner", word.substr(0, 40)));
      out_.corners.push_back(corner);
    }
    out_.sizes.push_back(size);
    out_.face_lines.push_back(static_cast<uint32_t>(out_.lines));
  }

  // v, v/vt, v//vn or v/vt/vn
  bool parse_corner(std::string_view word, Corner* out) {
    int32_t* const slots[3] = {&out->v, &out->vt, &out->vn};
    const size_t counts[3] = {out_.positions.size(), out_.uvs.size(), out_.normals.size()};
    for (size_t i = 0; i < 3; ++i) {
      const size_t slash = word.find('/');
      const std::string_view part = word.substr(0, slash);
      if (!part.empty() || i == 0) {
        int64_t index = 0;
        if (!parse_integer(part, &index) || index == 0 || std::abs(index) > kMostIndex)
          return false;
        *slots[i] = static_cast<int32_t>(
            index > 0 ? index - 1 : kRelative + static_cast<int64_t>(counts[i]) + index);
      }
      if (slash == std::string_view::npos) return true;
      word.remove_prefix(slash + 1);
    }
    return false;  // a third slash
  }

  ObjPiece& out_;
  std::string joined_;
};

// A part of the file whose faces go to one mesh.
struct Run {
  size_t piece, begin, end;  // faces
};
struct MeshPlan {
  std::string group, material;
  std::vector<Run> runs;
};

class ObjReader {
 public:
  explicit ObjReader(const ModelSource& source)
      : source_(source), budget_(source.options->limits.decoded_bytes) {}

  Result<ModelFile> read() {
    GLOAM_TRY_STATUS(parse_pieces());
    GLOAM_TRY_STATUS(join_elements());
    GLOAM_TRY_STATUS(resolve_corners());
    for (const ObjPiece& piece : pieces_)
      for (const Library& library : piece.libraries)
        GLOAM_TRY_STATUS(read_mtl_library(source_, library.name, line_of(piece, library.line),
                                          &budget_, &model_));
    GLOAM_TRY(const std::vector<MeshPlan> plans, plan_meshes());
    first_use_.assign(positions_.size(), -1);
    for (const MeshPlan& plan : plans) GLOAM_TRY_STATUS(build_mesh(plan));
    return std::move(model_);
  }

 private:
  SourceLoc line_of(const ObjPiece& piece, uint64_t line) const {
    for (const ObjPiece& before : pieces_) {
      if (&before == &piece) break;
      line += before.lines;
    }
    return {source_.name, static_cast<int>(std::min<uint64_t>(line, INT32_MAX)), 0};
  }
  Error bad(std::string message, SourceLoc loc = {}) const {
    if (loc.file.empty()) loc.file = source_.name;
    return {ErrorKind::kInput, std::move(message), std::move(loc),
            "repair the file or export it again"};
  }

  Status parse_pieces() {
    const std::vector<std::string_view> texts = split_at_lines(as_text(source_.bytes), kPieceBytes);
    pieces_.resize(texts.size());
    ProgressCount progress(source_.options->progress, source_.bytes.size());
    parallel_for("parse OBJ", static_cast<int64_t>(texts.size()), [&](int64_t i) {
      PieceParser(&pieces_[static_cast<size_t>(i)]).parse(texts[static_cast<size_t>(i)]);
      progress.add(texts[static_cast<size_t>(i)].size());
    });
    for (const ObjPiece& piece : pieces_)
      if (!piece.error.empty()) return bad(piece.error, line_of(piece, piece.lines));
    return {};
  }

  template <class T>
  Status join(std::vector<T> ObjPiece::* member, std::vector<T>* out, std::string_view what) {
    uint64_t count = 0;
    for (const ObjPiece& piece : pieces_) count += (piece.*member).size();
    const uint64_t limit =
        std::min<uint64_t>(source_.options->limits.vertices, static_cast<uint64_t>(kMostIndex));
    if (count > limit || !budget_.take(count, sizeof(T)))
      return bad(fmt::format("has {} {}, which exceeds the limit", count, what));
    out->reserve(count);
    for (ObjPiece& piece : pieces_) {
      out->insert(out->end(), (piece.*member).begin(), (piece.*member).end());
      std::vector<T>().swap(piece.*member);
    }
    return {};
  }

  // Channels are 0 … 1, of a few programs 0 … 255.
  Status join_colors() {
    const bool has_colors = std::any_of(pieces_.begin(), pieces_.end(), [](const ObjPiece& piece) {
      return !piece.colors.empty();
    });
    if (!has_colors) return {};
    for (ObjPiece& piece : pieces_) piece.colors.resize(piece.positions.size(), {1, 1, 1});
    GLOAM_TRY_STATUS(join(&ObjPiece::colors, &colors_, "colours"));
    float top = 1;
    for (const Vec3f& color : colors_) top = std::max(top, max_component(color));
    const float full = top > 2 ? 255.0f : 1;
    for (Vec3f& color : colors_) color = color_from_display(color / full);
    return {};
  }

  Status join_elements() {
    // Base of relative indices: the number of elements before each piece.
    bases_.resize(pieces_.size());
    for (size_t i = 1; i < pieces_.size(); ++i) {
      const ObjPiece& before = pieces_[i - 1];
      for (size_t k = 0; k < 3; ++k) bases_[i][k] = bases_[i - 1][k];
      bases_[i][0] += static_cast<int64_t>(before.positions.size());
      bases_[i][1] += static_cast<int64_t>(before.uvs.size());
      bases_[i][2] += static_cast<int64_t>(before.normals.size());
    }
    GLOAM_TRY_STATUS(join_colors());
    GLOAM_TRY_STATUS(join(&ObjPiece::positions, &positions_, "vertices"));
    GLOAM_TRY_STATUS(join(&ObjPiece::uvs, &uvs_, "texture coordinates"));
    return join(&ObjPiece::normals, &normals_, "normals");
  }

  Status resolve_corners() {
    const int64_t counts[3] = {static_cast<int64_t>(positions_.size()),
                               static_cast<int64_t>(uvs_.size()),
                               static_cast<int64_t>(normals_.size())};
    std::vector<size_t> bad_corner(pieces_.size(), SIZE_MAX);
    parallel_for("resolve OBJ", static_cast<int64_t>(pieces_.size()), [&](int64_t p) {
      const auto at = static_cast<size_t>(p);
      std::vector<Corner>& corners = pieces_[at].corners;
      for (size_t i = 0; i < corners.size(); ++i) {
        int32_t* const slots[3] = {&corners[i].v, &corners[i].vt, &corners[i].vn};
        for (size_t k = 0; k < 3; ++k) {
          if (*slots[k] == kAbsent) continue;
          int64_t index = *slots[k];
          if (index < 0) index += bases_[at][k] - kRelative;
          if (index < 0 || index >= counts[k]) {
            bad_corner[at] = std::min(bad_corner[at], i);
            index = 0;
          }
          *slots[k] = static_cast<int32_t>(index);
        }
      }
    });
    for (size_t p = 0; p < pieces_.size(); ++p) {
      if (bad_corner[p] == SIZE_MAX) continue;
      size_t face = 0;
      for (size_t end = 0; (end += pieces_[p].sizes[face]) <= bad_corner[p];) ++face;
      return bad(fmt::format("the face uses a vertex, texture coordinate or normal that does not "
                             "exist; there are {}, {} and {}",
                             counts[0], counts[1], counts[2]),
                 line_of(pieces_[p], pieces_[p].face_lines[face]));
    }
    return {};
  }

  // One mesh per group and material, in the order in which they first appear.
  Result<std::vector<MeshPlan>> plan_meshes() {
    std::vector<MeshPlan> plans;
    std::map<std::pair<std::string, std::string>, size_t> known;
    std::string group, material;
    for (size_t p = 0; p < pieces_.size(); ++p) {
      const ObjPiece& piece = pieces_[p];
      size_t from = 0;
      const auto add_run = [&](size_t to) {
        if (from == to) return;
        const auto [it, is_new] = known.try_emplace({group, material}, plans.size());
        if (is_new) plans.push_back({group, material, {}});
        plans[it->second].runs.push_back({p, from, to});
        from = to;
      };
      for (const Switch& change : piece.switches) {
        add_run(change.face);
        (change.is_material ? material : group) = change.name;
      }
      add_run(piece.sizes.size());
    }
    if (plans.size() > source_.options->limits.meshes)
      return bad(fmt::format("has {} groups, which exceeds the limit", plans.size()));
    return plans;
  }

  // Vertices of a mesh are the different (v, vt, vn) of its corners: those of one v form a chain.
  struct Vertex {
    Corner corner;
    int32_t next = -1;
  };

  uint32_t vertex_of(const Corner& corner) {
    int32_t* link = &first_use_[static_cast<size_t>(corner.v)];
    while (*link >= 0) {
      Vertex& vertex = vertices_[static_cast<size_t>(*link)];
      if (vertex.corner.vt == corner.vt && vertex.corner.vn == corner.vn)
        return static_cast<uint32_t>(*link);
      link = &vertex.next;
    }
    const auto index = static_cast<int32_t>(vertices_.size());
    *link = index;
    vertices_.push_back({corner, -1});
    return static_cast<uint32_t>(index);
  }

  Status build_mesh(const MeshPlan& plan) {
    PolygonList polygons;
    vertices_.clear();
    bool has_uvs = true, has_normals = true;
    SourceLoc first_face;
    for (const Run& run : plan.runs) {
      const ObjPiece& piece = pieces_[run.piece];
      if (first_face.file.empty()) first_face = line_of(piece, piece.face_lines[run.begin]);
      size_t corner = corner_before(run);
      for (size_t face = run.begin; face < run.end; ++face) {
        const uint32_t size = piece.sizes[face];
        if (size < 3) ++model_.dropped_triangles;
        polygons.sizes.push_back(size);
        for (uint32_t k = 0; k < size; ++k, ++corner) {
          const Corner& c = piece.corners[corner];
          has_uvs &= c.vt != kAbsent;
          has_normals &= c.vn != kAbsent;
          if (vertices_.size() == source_.options->limits.vertices)
            return bad(fmt::format("group '{}' has too many vertices", plan.group), first_face);
          polygons.corners.push_back(vertex_of(c));
        }
      }
    }
    if (!budget_.take(vertices_.size() * 8 + polygons.corners.size() * 3, sizeof(float)))
      return bad("exceeds the size limit when decoded", first_face);
    TriangleMesh mesh = take_vertices(has_uvs, has_normals);
    uint64_t face = 0;
    if (const std::string why =
            triangulate_polygons(mesh.positions, polygons, &mesh.indices, &face);
        !why.empty())
      return bad(fmt::format("group '{}': face {} {}", plan.group, face, why), first_face);
    const std::string name = plan.group.empty() ? "the mesh" : "group '" + plan.group + "'";
    GLOAM_TRY_STATUS(finish_mesh(&mesh, name, source_.name, &model_));
    int index = static_cast<int>(model_.meshes.size()), material = material_index(plan.material);
    model_.meshes.push_back(std::move(mesh));
    if (!colors_.empty()) {
      std::vector<Vec3f> colors;
      for (const Vertex& vertex : vertices_)
        colors.push_back(colors_[static_cast<size_t>(vertex.corner.v)]);
      material = paint_vertices(colors, material, &index, &painted_, &model_);
    }
    model_.instances.push_back({plan.group, index, material, {}});
    return {};
  }

  // First corner of a run. Runs of one piece come in order: the search goes on where it ended.
  size_t corner_before(const Run& run) {
    if (run.piece != counted_piece_ || run.begin < counted_faces_) {
      counted_piece_ = run.piece;
      counted_faces_ = counted_corners_ = 0;
    }
    for (; counted_faces_ < run.begin; ++counted_faces_)
      counted_corners_ += pieces_[run.piece].sizes[counted_faces_];
    return counted_corners_;
  }

  TriangleMesh take_vertices(bool has_uvs, bool has_normals) {
    TriangleMesh mesh;
    const size_t count = vertices_.size();
    mesh.positions.resize(count);
    if (has_uvs) mesh.uvs.resize(count);
    if (has_normals) mesh.normals.resize(count);
    for (size_t i = 0; i < count; ++i) {
      const Corner& c = vertices_[i].corner;
      mesh.positions[i] = positions_[static_cast<size_t>(c.v)];
      if (has_uvs) mesh.uvs[i] = uvs_[static_cast<size_t>(c.vt)];
      if (has_normals) mesh.normals[i] = normals_[static_cast<size_t>(c.vn)];
      first_use_[static_cast<size_t>(c.v)] = -1;
    }
    return mesh;
  }

  int material_index(const std::string& name) {
    if (name.empty()) return -1;
    if (materials_.empty())
      for (size_t i = model_.materials.size(); i-- > 0;)
        materials_[model_.materials[i].name] = static_cast<int>(i);
    const auto [it, is_new] =
        materials_.try_emplace(name, static_cast<int>(model_.materials.size()));
    if (is_new) {
      add_note(&model_, fmt::format("material '{}' is not defined", name));
      model_.materials.emplace_back().name = name;
    }
    return it->second;
  }

  const ModelSource& source_;
  MemoryBudget budget_;
  ModelFile model_;
  std::vector<ObjPiece> pieces_;
  std::vector<std::array<int64_t, 3>> bases_;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec3f> colors_;  // linear, by position; empty = none
  PaintedMeshes painted_;
  std::vector<Vec2f> uvs_;
  std::vector<int32_t> first_use_;
  std::vector<Vertex> vertices_;
  std::map<std::string, int> materials_;
  size_t counted_piece_ = SIZE_MAX, counted_faces_ = 0, counted_corners_ = 0;
};

}  // namespace

Result<ModelFile> read_obj(const ModelSource& source) { return ObjReader(source).read(); }

}  // namespace gloam

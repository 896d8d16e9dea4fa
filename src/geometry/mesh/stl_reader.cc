// STL, binary and as text (3D Systems, "StereoLithography Interface Specification", 1989). Its
// normals are those of the flat triangles and are not kept.

#include <fmt/format.h>

#include <cstring>

#include "base/parallel.h"
#include "geometry/mesh/model_source.h"
#include "geometry/mesh/text_lines.h"
#include "geometry/mesh/weld.h"

namespace gloam {
namespace {

constexpr size_t kStlHeaderBytes = 84, kTriangleBytes = 50;

Error bad(const ModelSource& source, std::string message, uint64_t line = 0) {
  return {ErrorKind::kInput,
          std::move(message),
          {source.name, static_cast<int>(std::min<uint64_t>(line, INT32_MAX)), 0},
          "the file may be truncated; export or copy it again"};
}

Result<ModelFile> finish(const ModelSource& source, const std::vector<Vec3f>& corners,
                         std::string name) {
  ModelFile model;
  TriangleMesh mesh = weld(corners);
  GLOAM_TRY_STATUS(finish_mesh(&mesh, "the mesh", source.name, &model));
  model.meshes.push_back(std::move(mesh));
  model.instances.push_back({std::move(name), 0, -1, {}});
  return model;
}

Status check_size(const ModelSource& source, uint64_t triangles) {
  const ModelLimits& limits = source.options->limits;
  MemoryBudget budget(limits.decoded_bytes);
  // corners, the table that welds them, vertices and indices
  if (triangles > limits.triangles || 3 * triangles > limits.vertices ||
      !budget.take(3 * triangles, sizeof(Vec3f) * 2 + sizeof(uint32_t) * 5))
    return bad(source, fmt::format("has {} triangles, which exceeds the limit", triangles));
  return {};
}

Result<ModelFile> read_binary(const ModelSource& source) {
  const std::span<const uint8_t> bytes = source.bytes;
  if (bytes.size() < kStlHeaderBytes) return bad(source, "is too short for an STL file");
  uint32_t count;
  std::memcpy(&count, bytes.data() + 80, sizeof(count));
  if (uint64_t{count} * kTriangleBytes > bytes.size() - kStlHeaderBytes)
    return bad(source, fmt::format("is neither text nor binary STL: its byte 80 declares {} "
                                   "triangles, but it has room for {}",
                                   count, (bytes.size() - kStlHeaderBytes) / kTriangleBytes));
  GLOAM_TRY_STATUS(check_size(source, count));
  std::vector<Vec3f> corners(size_t{3} * count);
  ProgressCount progress(source.options->progress, count);
  parallel_for_range("read STL", count, 1 << 14, [&](int64_t begin, int64_t end) {
    for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
      std::memcpy(&corners[3 * i], bytes.data() + kStlHeaderBytes + i * kTriangleBytes + 12, 36);
    progress.add(static_cast<uint64_t>(end - begin));
  });
  return finish(source, corners, {});
}

struct StlPiece {
  std::vector<Vec3f> corners;
  uint64_t lines = 0;
  std::string error;  // at line `lines`
};

void parse_piece(std::string_view text, StlPiece* out) {
  size_t loop = 0;  // corners of the loop at hand
  while (!text.empty()) {
    std::string_view line = take_line(&text);
    ++out->lines;
    const std::string_view word = take_word(&line);
    if (word == "vertex") {
      Vec3f p;
      for (float* value : {&p.x, &p.y, &p.z}) {
        const std::string_view number = take_word(&line);
        if (parse_number(number, value)) continue;
        out->error = fmt::format("'{}' is not a number", number.substr(0, 40));
        return;
      }
      out->corners.push_back(p);
      ++loop;
    } else if (word == "outer") {
      loop = 0;
    } else if (word == "endloop") {
      if (loop != 3) {
        out->error = fmt::format("the facet has {} corners, not 3", loop);
        return;
      }
      loop = 0;
    } else if (!word.empty() && word != "facet" && word != "endfacet" && word != "solid" &&
               word != "endsolid") {
      out->error = fmt::format("unexpected '{}' in STL text", word.substr(0, 40));
      return;
    }
  }
  if (loop != 0) out->error = "the file ends within a facet";
}

// Pieces of whole facets.
std::vector<std::string_view> split_at_facets(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const size_t facet = text.find("endfacet", std::min(kPieceBytes, text.size()));
    const size_t end = facet == std::string_view::npos ? facet : text.find('\n', facet);
    const size_t length = end == std::string_view::npos ? text.size() : end + 1;
    out.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return out;
}

Result<ModelFile> read_ascii(const ModelSource& source) {
  const std::string_view text = as_text(source.bytes);
  const std::vector<std::string_view> texts = split_at_facets(text);
  std::vector<StlPiece> pieces(texts.size());
  ProgressCount progress(source.options->progress, text.size());
  parallel_for("parse STL", static_cast<int64_t>(texts.size()), [&](int64_t i) {
    parse_piece(texts[static_cast<size_t>(i)], &pieces[static_cast<size_t>(i)]);
    progress.add(texts[static_cast<size_t>(i)].size());
  });
  uint64_t lines = 0, count = 0;
  for (const StlPiece& piece : pieces) {
    if (!piece.error.empty()) return bad(source, piece.error, lines + piece.lines);
    lines += piece.lines;
    count += piece.corners.size();
  }
  GLOAM_TRY_STATUS(check_size(source, count / 3));
  std::vector<Vec3f> corners;
  corners.reserve(count);
  for (const StlPiece& piece : pieces)
    corners.insert(corners.end(), piece.corners.begin(), piece.corners.end());
  std::string_view rest = text;
  std::string_view first = take_line(&rest);
  (void)take_word(&first);
  return finish(source, corners, std::string(trim(first).substr(0, kMaxName)));
}

}  // namespace

Result<ModelFile> read_stl(const ModelSource& source) {
  const std::string_view text = as_text(source.bytes);
  uint64_t count = 0;
  if (text.size() >= kStlHeaderBytes) {
    uint32_t named;
    std::memcpy(&named, text.data() + 80, sizeof(named));
    count = named;
  }
  // Binary headers may begin with "solid" as well: there the size gives them away.
  const bool is_text = trim(text.substr(0, 80)).starts_with("solid") &&
                       text.size() != kStlHeaderBytes + kTriangleBytes * count;
  return is_text ? read_ascii(source) : read_binary(source);
}

}  // namespace gloam

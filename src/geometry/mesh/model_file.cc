#include "geometry/mesh/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "base/files.h"
#include "base/memory.h"
#include "base/plain_text.h"
#include "geometry/mesh/model_source.h"
#include "geometry/mesh/text_lines.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

bool starts_with(std::span<const uint8_t> bytes, std::string_view start) {
  return bytes.size() >= start.size() && std::memcmp(bytes.data(), start.data(), start.size()) == 0;
}

bool looks_like_json(std::span<const uint8_t> bytes) {
  const auto first = std::find_if(bytes.begin(), bytes.end(),
                                  [](uint8_t c) { return c > ' ' && c < 0x80; });  // or a BOM
  return first != bytes.end() && *first == '{';
}

// A binary STL of n triangles has 84 + 50 n bytes; its first 80 may say anything, "solid" too.
bool is_binary_stl(std::span<const uint8_t> bytes) {
  if (bytes.size() < 84) return false;
  uint32_t count;
  std::memcpy(&count, bytes.data() + 80, sizeof(count));
  return bytes.size() == 84 + uint64_t{50} * count;
}

// Formats of text, whose marks and line ends are made plain first.
bool is_text_model(const ModelSource& source) {
  const std::string_view text = as_text(source.bytes);
  if (starts_with(source.bytes, "glTF") || is_binary_stl(source.bytes)) return false;
  // Some tools end text by a zero; one before other bytes is none of a text's.
  const std::string_view head = text.substr(0, text.find_last_not_of('\0') + 1).substr(0, 200);
  const bool is_utf16 = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
  constexpr uint8_t kLastControl = 8;  // the ends of lines and of files come after it
  const auto is_control = [](char c) { return static_cast<uint8_t>(c) <= kLastControl; };
  if (!is_utf16 && std::any_of(head.begin(), head.end(), is_control)) return false;
  const bool is_ply = head.find("ply") < 6;
  return !is_ply || head.find("format ascii") != std::string_view::npos;
}

bool looks_like_collada(std::span<const uint8_t> bytes) {
  return as_text(bytes).substr(0, 4096).find("<COLLADA") != std::string_view::npos;
}

Result<ModelFile> read_by_format(const ModelSource& source) {
  const std::span<const uint8_t> bytes = source.bytes;
  constexpr uint64_t kUnpackFactor = 3;  // size unpacked over the file's, nearly at most
  GLOAM_TRY_STATUS(check_memory(kUnpackFactor * bytes.size(),
                                fmt::format("unpacking '{}'", source.name),
                                "use a mesh with fewer triangles"));
  if (starts_with(bytes, "glTF")) return read_glb(source);
  if (starts_with(bytes, "ply\n") || starts_with(bytes, "ply\r")) return read_ply(source);
  const std::string ending = lower_extension(source.name);
  if (ending == ".dae" || (ending != ".obj" && looks_like_collada(bytes)))
    return read_collada(source);
  if (ending == ".obj") return read_obj(source);
  if (ending == ".stl" || is_binary_stl(bytes)) return read_stl(source);
  if (ending == ".gltf" || looks_like_json(bytes)) return read_gltf(source);
  if (starts_with(bytes, "solid")) return read_stl(source);
  return Error{ErrorKind::kInput,
               "is not a glTF, GLB, COLLADA, OBJ, STL or PLY file",
               {source.name, 0, 0},
               "convert it to GLB"};
}

}  // namespace

Result<ModelFile> read_model_bytes(const ModelSource& source) {
  if (is_lfs_pointer(as_text(source.bytes))) return lfs_pointer_error(source.name);
  if (!is_text_model(source)) return read_by_format(source);
  GLOAM_TRY(const std::optional<std::string> plain, plain_text(as_text(source.bytes), source.name));
  if (!plain) return read_by_format(source);
  ModelSource copy = source;
  copy.bytes = {reinterpret_cast<const uint8_t*>(plain->data()), plain->size()};
  return read_by_format(copy);
}

bool is_model_file(const fs::path& path) {
  constexpr std::array<std::string_view, 6> kEndings = {".gltf", ".glb", ".dae",
                                                        ".obj",  ".stl", ".ply"};
  return std::find(kEndings.begin(), kEndings.end(), lower_extension(path)) != kEndings.end();
}

Result<ModelFile> read_model_file(const fs::path& path, const ModelFileOptions& options) {
  GLOAM_TRY(const std::vector<uint8_t> bytes, read_file(path, options.limits.file_bytes));
  GLOAM_TRY(ModelFolder folder, ModelFolder::open(path, options.root));
  return read_model_bytes({path.string(), bytes, &folder, &options});
}

}  // namespace gloam

#include "geometry/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "base/files.h"
#include "base/memory.h"
#include "geometry/model_source.h"

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

}  // namespace

Result<ModelFile> read_model_bytes(const ModelSource& source) {
  const std::span<const uint8_t> bytes = source.bytes;
  constexpr uint64_t kGrowth = 3;  // of what is unpacked over the file, nearly at most
  GLOAM_TRY_STATUS(check_memory(kGrowth * bytes.size(), fmt::format("unpacking '{}'", source.name),
                                "use a mesh of fewer triangles"));
  if (starts_with(bytes, "glTF")) return read_glb(source);
  if (starts_with(bytes, "ply\n") || starts_with(bytes, "ply\r")) return read_ply(source);
  const std::string ending = lower_extension(source.name);
  if (ending == ".obj") return read_obj(source);
  if (ending == ".stl" || is_binary_stl(bytes)) return read_stl(source);
  if (ending == ".gltf" || looks_like_json(bytes)) return read_gltf(source);
  if (starts_with(bytes, "solid")) return read_stl(source);
  return Error{ErrorKind::kInput,
               "is none of glTF, GLB, OBJ, STL and PLY",
               {source.name, 0, 0},
               "convert it to GLB"};
}

bool is_model_file(const fs::path& path) {
  constexpr std::array<std::string_view, 5> kEndings = {".gltf", ".glb", ".obj", ".stl", ".ply"};
  return std::find(kEndings.begin(), kEndings.end(), lower_extension(path)) != kEndings.end();
}

Result<ModelFile> read_model_file(const fs::path& path, const ModelFileOptions& options) {
  GLOAM_TRY(const std::vector<uint8_t> bytes, read_file(path, options.limits.file_bytes));
  GLOAM_TRY(ModelFolder folder, ModelFolder::open(path, options.root));
  return read_model_bytes({path.string(), bytes, &folder, &options});
}

}  // namespace gloam

// glTF 2.0 as text and as GLB.

#include <fmt/format.h>

#include <cstring>

#include "geometry/gltf/document.h"

namespace gloam {
namespace {

constexpr uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

uint32_t u32_at(std::span<const uint8_t> bytes, size_t at) {
  uint32_t value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

Result<ModelFile> read_document(const ModelSource& source, std::span<const uint8_t> json,
                                std::span<const uint8_t> bin) {
  GLOAM_TRY(const std::unique_ptr<GltfDocument> document, GltfDocument::open(source, json, bin));
  ModelFile model;
  model.was_y_up = true;
  const JsonErrors& errors = document->errors();
  if (document->root()["animations"].exists()) add_note(&model, "animations are ignored");
  note_unknown_extensions(document.get(), &model);
  read_gltf_images(document.get(), &model);
  if (errors.ok()) read_gltf_materials(document.get(), &model);
  GltfMeshTable meshes;
  if (errors.ok()) meshes = read_gltf_meshes(document.get(), &model);
  if (errors.ok()) read_gltf_nodes(document.get(), meshes, &model);
  GLOAM_TRY_STATUS(errors.status());
  return model;
}

}  // namespace

Result<ModelFile> read_gltf(const ModelSource& source) {
  return read_document(source, source.bytes, {});
}

Result<ModelFile> read_glb(const ModelSource& source) {
  const std::span<const uint8_t> bytes = source.bytes;
  const auto bad = [&](std::string message) {
    return Error{ErrorKind::kInput,
                 "not a readable GLB file: " + message,
                 {source.name, 0, 0},
                 "the file may be truncated; export or copy it again"};
  };
  if (bytes.size() < 20 || u32_at(bytes, 0) != kGlbMagic) return bad("it has no header");
  if (u32_at(bytes, 4) != 2) return bad(fmt::format("its version is {}", u32_at(bytes, 4)));
  const uint64_t length = u32_at(bytes, 8);
  if (length > bytes.size())
    return bad(fmt::format("it must have {} bytes, but has {}", length, bytes.size()));
  std::span<const uint8_t> json, bin;
  for (uint64_t at = 12; at + 8 <= length;) {
    const uint64_t size = u32_at(bytes, at);
    const uint32_t kind = u32_at(bytes, at + 4);
    if (size > length - at - 8)
      return bad(fmt::format("the chunk at byte {} of {} bytes extends beyond the end of the file",
                             at, size));
    if (at == 12 && kind != kJsonChunk) return bad("its first chunk is not JSON");
    if (at == 12) json = bytes.subspan(at + 8, size);
    if (kind == kBinChunk && bin.empty()) bin = bytes.subspan(at + 8, size);
    at += 8 + size;
  }
  return read_document(source, json, bin);
}

}  // namespace gloam

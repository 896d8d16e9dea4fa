#include "geometry/gltf/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gloam {
namespace {

constexpr std::array<std::string_view, 13> kExtensions = {
    "KHR_lights_punctual",        "KHR_texture_transform", "KHR_materials_clearcoat",
    "KHR_materials_transmission", "KHR_materials_ior",     "KHR_materials_specular",
    "KHR_materials_sheen",        "KHR_materials_volume",  "KHR_materials_anisotropy",
    "KHR_materials_unlit",        "KHR_mesh_quantization", "KHR_materials_emissive_strength",
    "EXT_mesh_gpu_instancing"};

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

// RFC 4648; false when a character is none of its.
bool decode_base64(std::string_view text, std::vector<uint8_t>* out) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  out->reserve(text.size() / 4 * 3 + 3);
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return false;
    bits = (bits << 6) | static_cast<uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out->push_back(static_cast<uint8_t>(bits >> count));
  }
  return true;
}

bool is_known(const std::string& extension) {
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

void check_asset(GltfDocument* document) {
  const JsonNode version = document->root()["asset"]["version"];
  if (!version.exists()) return version.fail("is missing; this is not glTF 2.0");
  if (const std::string text = version.text(); !text.starts_with("2."))
    version.fail(fmt::format("is '{}'; only glTF 2 is supported", text.substr(0, 20)),
                 "export the model as glTF 2.0");
  const JsonNode required = document->root()["extensionsRequired"];
  for (size_t i = 0; i < required.size(); ++i) {
    const std::string name = required.at(i).text();
    if (!is_known(name))
      required.at(i).fail(
          fmt::format("the file requires the extension '{}', which is not supported",
                      name.substr(0, 100)),
          "export the model without it");
  }
}

}  // namespace

void note_unknown_extensions(GltfDocument* document, ModelFile* model) {
  const JsonNode used = document->root()["extensionsUsed"];
  for (size_t i = 0; i < used.size() && document->errors().ok(); ++i) {
    const std::string name = used.at(i).text();
    if (!is_known(name))
      add_note(model, fmt::format("extension '{}' is ignored", name.substr(0, 100)));
  }
}

Result<std::vector<uint8_t>> GltfDocument::fetch(const std::string& uri,
                                                 const std::string& pointer) {
  const SourceLoc loc{source_.name, 0, 0};
  if (uri.starts_with("data:")) {
    std::vector<uint8_t> bytes;
    const size_t comma = uri.find(',');
    const std::string_view head = std::string_view(uri).substr(0, comma);
    if (comma == std::string::npos || !head.ends_with(";base64") ||
        !decode_base64(std::string_view(uri).substr(comma + 1), &bytes))
      return Error{ErrorKind::kInput, pointer + ": the data URI is not valid base64", loc,
                   "export the model again"};
    return bytes;
  }
  if (source_.folder == nullptr)
    return Error{ErrorKind::kInput, pointer + ": refers to a file, but the model has no folder",
                 loc};
  Result<std::vector<uint8_t>> bytes = source_.folder->read(uri, loc, source_.options->limits);
  if (bytes.ok()) return bytes;
  Error error = std::move(bytes).error();
  error.message = pointer + ": " + error.message;
  return error;
}

Result<std::unique_ptr<GltfDocument>> GltfDocument::open(const ModelSource& source,
                                                         std::span<const uint8_t> json,
                                                         std::span<const uint8_t> bin) {
  GLOAM_TRY(nlohmann::json parsed, parse_bounded_json(json, source.name));
  std::unique_ptr<GltfDocument> out(new GltfDocument(source, std::move(parsed)));
  check_asset(out.get());
  if (out->errors_.ok()) out->open_buffers(bin);
  GLOAM_TRY_STATUS(out->errors_.status());
  return out;
}

void GltfDocument::open_buffers(std::span<const uint8_t> bin) {
  const JsonNode buffers = root()["buffers"];
  for (size_t i = 0; i < buffers.size() && errors_.ok(); ++i) {
    const JsonNode buffer = buffers.at(i);
    const uint64_t length = buffer["byteLength"].integer(0, source_.options->limits.file_bytes);
    std::span<const uint8_t> bytes;
    if (buffer["uri"].exists()) {
      Result<std::vector<uint8_t>> fetched = fetch(buffer["uri"].text(), buffer.pointer());
      if (!fetched.ok()) return errors_.add(std::move(fetched).error());
      if (!budget_.take(fetched->size(), 1))
        return buffer.fail("the buffers exceed the size limit");
      owned_.push_back(std::move(*fetched));
      bytes = owned_.back();
    } else if (i == 0) {
      bytes = bin;
    }
    if (bytes.size() < length)
      buffer.fail(fmt::format("must have {} bytes, but has {}", length, bytes.size()),
                  "the file may be truncated; export the model again");
    buffers_.push_back(bytes.first(std::min<uint64_t>(length, bytes.size())));
  }
}

std::span<const uint8_t> GltfDocument::view(int index) {
  const JsonNode view = root()["bufferViews"].at(static_cast<size_t>(index));
  const int buffer = view["buffer"].required_index(buffers_.size(), "buffer");
  const uint64_t offset = view["byteOffset"].integer(0, UINT64_MAX);
  const uint64_t length = view["byteLength"].integer(0, UINT64_MAX);
  if (!errors_.ok()) return {};
  const std::span<const uint8_t> bytes = buffers_[static_cast<size_t>(buffer)];
  if (offset > bytes.size() || length > bytes.size() - offset) {
    view.fail(fmt::format("bytes {} to {} are outside of buffer {} of {} bytes", offset,
                          offset + length, buffer, bytes.size()));
    return {};
  }
  return bytes.subspan(offset, length);
}

}  // namespace gloam

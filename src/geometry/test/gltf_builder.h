#pragma once
// Writes glTF and GLB files for tests.

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/vec.h"

namespace gloam {

inline std::string base64(const std::vector<uint8_t>& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = (bits << 8) | (i + k < bytes.size() ? bytes[i + k] : 0u);
    const size_t digits = std::min<size_t>(3, bytes.size() - i) + 1;
    for (size_t k = 0; k < 4; ++k) out += k < digits ? kDigits[(bits >> (18 - 6 * k)) & 63] : '=';
  }
  return out;
}

class GltfBuilder {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  std::vector<uint8_t> bin;

  template <class T>
  int add_view(const std::vector<T>& values, int stride = 0) {
    while (bin.size() % 4 != 0) bin.push_back(0);
    const size_t at = bin.size(), size = values.size() * sizeof(T);
    bin.resize(at + size);
    std::memcpy(bin.data() + at, values.data(), size);
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", at}, {"byteLength", size}};
    if (stride > 0) view["byteStride"] = stride;
    return push("bufferViews", view);
  }
  template <class T>
  int add_accessor(const std::vector<T>& values, const char* type, int component_type, size_t count,
                   bool normalized = false, int stride = 0) {
    nlohmann::json accessor = {{"bufferView", add_view(values, stride)},
                               {"componentType", component_type},
                               {"type", type},
                               {"count", count}};
    if (normalized) accessor["normalized"] = true;
    return push("accessors", accessor);
  }
  int add_positions(const std::vector<Vec3f>& p) { return add_accessor(p, "VEC3", 5126, p.size()); }
  int push(const char* list, nlohmann::json value) {
    json[list].push_back(std::move(value));
    return static_cast<int>(json[list].size()) - 1;
  }
  /// A mesh of one primitive.
  int add_mesh(nlohmann::json primitive) {
    return push("meshes", {{"primitives", nlohmann::json::array({std::move(primitive)})}});
  }
  /// A triangle on one node: what most tests need to have a mesh at all.
  void add_triangle() {
    const int mesh = add_mesh(
        {{"attributes", {{"POSITION", add_positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}}}});
    push("nodes", {{"mesh", mesh}});
  }

  std::string gltf() const {
    nlohmann::json out = json;
    if (!bin.empty())
      out["buffers"] = {{{"byteLength", bin.size()},
                         {"uri", "data:application/octet-stream;base64," + base64(bin)}}};
    return out.dump();
  }
  std::string gltf_with_file(const std::string& uri) const {
    nlohmann::json out = json;
    out["buffers"] = {{{"byteLength", bin.size()}, {"uri", uri}}};
    return out.dump();
  }
  std::string glb() const {
    nlohmann::json out = json;
    if (!bin.empty()) out["buffers"] = {{{"byteLength", bin.size()}}};
    std::string text = out.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string data(bin.begin(), bin.end());
    data.resize((data.size() + 3) / 4 * 4, '\0');
    std::string file = "glTF" + u32(2) + u32(static_cast<uint32_t>(28 + text.size() + data.size()));
    file += u32(static_cast<uint32_t>(text.size())) + "JSON" + text;
    file += u32(static_cast<uint32_t>(data.size())) + std::string("BIN\0", 4) + data;
    return file;
  }
  static std::string u32(uint32_t v) {
    std::string out(4, '\0');
    std::memcpy(out.data(), &v, 4);
    return out;
  }
};

}  // namespace gloam

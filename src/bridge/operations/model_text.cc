#include "bridge/operations/model_text.h"

#include <algorithm>

namespace gloam::bridge {

bool is_model_extension(const std::string& extension) {
  return extension == ".xml" || extension == ".urdf" || extension == ".toml" ||
         extension == ".mjcf";
}

bool is_mesh_extension(const std::string& extension) {
  constexpr std::string_view kMeshes[] = {".glb", ".gltf", ".obj", ".stl", ".ply"};
  return std::ranges::find(kMeshes, extension) != std::end(kMeshes);
}

ModelText model_text_of(std::string_view text) {
  if (text.starts_with("#usda")) return ModelText::kUsd;
  for (size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    const std::string_view tag = text.substr(at + 1, 8);
    if (tag.starts_with('?')) continue;
    if (tag.starts_with("!--")) {
      at = text.find("-->", at);
      if (at == std::string_view::npos) break;
      continue;
    }
    const auto is_tag = [&](std::string_view name) {
      return tag.starts_with(name) &&
             (tag.size() == name.size() ||
              std::string_view(" \t\r\n>/").find(tag[name.size()]) != std::string_view::npos);
    };
    if (is_tag("mujoco")) return ModelText::kMjcf;
    if (is_tag("robot")) return ModelText::kUrdf;
    if (is_tag("sdf")) return ModelText::kSdf;
    break;
  }
  return ModelText::kOther;
}

std::string attribute_of(std::string_view text, const std::string& tag, const std::string& name) {
  const size_t begin = text.find("<" + tag), end = text.find('>', begin);
  if (begin == std::string_view::npos || end == std::string_view::npos) return {};
  const std::string_view element = text.substr(begin, end - begin);
  for (const char* space : {" ", "\n", "\t"}) {
    const size_t at = element.find(space + name + "=");
    if (at == std::string_view::npos) continue;
    const size_t quote = at + name.size() + 2;
    if (quote >= element.size()) return {};
    const size_t last = element.find(element[quote], quote + 1);
    if (last == std::string_view::npos) return {};
    return std::string(element.substr(quote + 1, last - quote - 1));
  }
  return {};
}

bool is_fixed_urdf(std::string_view text) {
  return text.find("link name=\"world\"") != std::string_view::npos ||
         text.find("link name='world'") != std::string_view::npos;
}

}  // namespace gloam::bridge

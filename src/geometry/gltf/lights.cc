// Lamps of KHR_lights_punctual.

#include "geometry/gltf/document.h"

namespace gloam {

ImportedLight read_gltf_light(const JsonNode& node) {
  ImportedLight out;
  out.name = node["name"].text().substr(0, kMaxName);
  const std::string type = node["type"].text();
  if (type == "spot") {
    out.type = ImportedLightType::kSpot;
    out.inner_cone = node["spot"]["innerConeAngle"].number(0, 0, kPi / 2);
    out.outer_cone = node["spot"]["outerConeAngle"].number(kPi / 4, 0, kPi / 2 + 1e-4f);
    if (!(out.inner_cone < out.outer_cone))
      node["spot"].fail("innerConeAngle must be less than outerConeAngle");
  } else if (type == "directional") {
    out.type = ImportedLightType::kDirectional;
  } else if (type != "point") {
    node["type"].fail("must be one of point, spot, directional");
  }
  out.color = node["color"].vec3({1, 1, 1}, 0);
  out.intensity = node["intensity"].number(1, 0);
  out.range = node["range"].number(0, 0);
  return out;
}

}  // namespace gloam

// The node hierarchy of COLLADA, flattened.

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "geometry/collada/document.h"
#include "geometry/mesh/vertex_colors.h"

namespace gloam {
namespace {

constexpr int kDeepestNode = 128;  // instances of nodes can be nested without end
constexpr uint64_t kMostVisits = uint64_t{1} << 20;

bool is_finite_place(const Affine3f& X) {
  for (const Vec3f& v : {X.x, X.y, X.z, X.p})
    if (!(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) return false;
  return true;
}

// Rodrigues' formula.
Affine3f rotation_about(Vec3f axis, float degrees) {
  const float l = length(axis);
  if (!(l > 0)) return {};
  const Vec3f a = axis * (1 / l);
  const float angle = degrees * kPi / 180, c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](Vec3f v) { return v * c + cross(a, v) * s + a * (dot(a, v) * (1 - c)); };
  return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1}), {}};
}

class SceneReader {
 public:
  SceneReader(ColladaDocument* document, ModelFile* model)
      : document_(document), model_(model), materials_(document, model) {}

  Status read() {
    const pugi::xml_node root = document_->root();
    GLOAM_TRY(const Affine3f X_FD, read_asset(root.child("asset")));
    const pugi::xml_node instance = root.child("scene").child("instance_visual_scene");
    pugi::xml_node scene = document_->find(instance.attribute("url").value());
    if (!scene) scene = root.child("library_visual_scenes").child("visual_scene");
    if (root.child("library_animations").first_child()) add_note(model_, "animations are ignored");
    if (scene) return visit_children(scene, X_FD, 0);
    // Without a scene, all geometry as it lies.
    for (const pugi::xml_node& library : root.children("library_geometries"))
      for (const pugi::xml_node& geometry : library.children("geometry"))
        GLOAM_TRY_STATUS(add_geometry(geometry, {}, geometry.attribute("name").value(), X_FD));
    return {};
  }

 private:
  // Document axes and units to Gloam's: Z up, metres.
  Result<Affine3f> read_asset(const pugi::xml_node& asset) {
    std::vector<float> meter = {1};
    if (const pugi::xml_attribute unit = asset.child("unit").attribute("meter")) {
      const float value = unit.as_float();
      if (!(value > 0 && std::isfinite(value)))
        return document_->bad(asset.child("unit"), "must have a positive 'meter'");
      meter[0] = value;
    }
    const float m = meter[0];
    std::string_view up = asset.child("up_axis").text().get();
    while (!up.empty() && up.back() <= ' ') up.remove_suffix(1);
    while (!up.empty() && up.front() <= ' ') up.remove_prefix(1);
    if (up == "Z_UP") return Affine3f{{m, 0, 0}, {0, m, 0}, {0, 0, m}, {}};
    // X_UP: right is -y, up x, in is z; so (x, y, z) -> (-y, -z, x).
    if (up == "X_UP") return Affine3f{{0, 0, m}, {-m, 0, 0}, {0, -m, 0}, {}};
    if (!up.empty() && up != "Y_UP")
      return document_->bad(asset.child("up_axis"), "must be one of X_UP, Y_UP, Z_UP");
    model_->was_y_up = true;  // the specification's default
    return Affine3f{{m, 0, 0}, {0, 0, m}, {0, -m, 0}, {}};
  }

  Status read_transforms(const pugi::xml_node& node, Affine3f* X) {
    std::vector<float> n;
    for (const pugi::xml_node& child : node.children()) {
      const std::string_view kind = child.name();
      const size_t needed = kind == "matrix"      ? 16
                            : kind == "rotate"    ? 4
                            : kind == "translate" ? 3
                            : kind == "scale"     ? 3
                            : kind == "lookat"    ? 9
                            : kind == "skew"      ? 7
                                                  : 0;
      if (needed == 0) continue;
      GLOAM_TRY_STATUS(document_->read_floats(child, &n));
      if (n.size() != needed)
        return document_->bad(child, fmt::format("has {} numbers, expected {}", n.size(), needed));
      Affine3f own;
      if (kind == "matrix") {
        if (n[12] != 0 || n[13] != 0 || n[14] != 0 || n[15] != 1)
          return document_->bad(child, "is not an affine transform: its last row must be 0 0 0 1");
        own = {{n[0], n[4], n[8]}, {n[1], n[5], n[9]}, {n[2], n[6], n[10]}, {n[3], n[7], n[11]}};
      } else if (kind == "rotate") {
        own = rotation_about({n[0], n[1], n[2]}, n[3]);
      } else if (kind == "translate") {
        own.p = {n[0], n[1], n[2]};
      } else if (kind == "scale") {
        own = {{n[0], 0, 0}, {0, n[1], 0}, {0, 0, n[2]}, {}};
      } else {
        add_note(model_, fmt::format("<{}> in nodes is ignored", kind));
      }
      *X = *X * own;
      if (!is_finite_place(*X))
        return document_->bad(child, "gives the node a transform that is not finite");
    }
    return {};
  }

  Status visit_children(const pugi::xml_node& parent, const Affine3f& X_FP, int depth) {
    for (const pugi::xml_node& node : parent.children("node"))
      GLOAM_TRY_STATUS(visit(node, X_FP, depth));
    return {};
  }

  Status visit(const pugi::xml_node& node, const Affine3f& X_FP, int depth) {
    if (depth > kDeepestNode)
      return document_->bad(node, "is its own ancestor or is nested more than 128 levels deep");
    if (++visits_ > kMostVisits) return document_->bad(node, "exceeds the limit on nodes");
    Affine3f X_FN = X_FP;
    GLOAM_TRY_STATUS(read_transforms(node, &X_FN));
    std::string name = node.attribute("name").value();
    if (name.empty()) name = node.attribute("id").value();
    for (const pugi::xml_node& instance : node.children("instance_geometry")) {
      const pugi::xml_node geometry = document_->find(instance.attribute("url").value());
      if (!geometry)
        return document_->bad(instance,
                              fmt::format("refers to geometry '{:.80}', which is not in the file",
                                          instance.attribute("url").value()));
      GLOAM_TRY_STATUS(add_geometry(geometry, instance, name, X_FN));
    }
    for (const pugi::xml_node& instance : node.children("instance_controller"))
      GLOAM_TRY_STATUS(add_controller(instance, name, X_FN));
    for (const pugi::xml_node& instance : node.children("instance_node")) {
      const pugi::xml_node other = document_->find(instance.attribute("url").value());
      if (!other) {
        add_note(model_, fmt::format("node '{:.80}' is not in the file",
                                     instance.attribute("url").value()));
        continue;
      }
      GLOAM_TRY_STATUS(visit(other, X_FN, depth + 1));
    }
    if (node.child("instance_camera")) add_note(model_, "cameras are ignored");
    if (node.child("instance_light")) add_note(model_, "lights of COLLADA files are ignored");
    return visit_children(node, X_FN, depth + 1);
  }

  // A skin at rest: its geometry, as it was bound.
  Status add_controller(const pugi::xml_node& instance, const std::string& name,
                        const Affine3f& X_FN) {
    const pugi::xml_node skin = document_->find(instance.attribute("url").value()).child("skin");
    const pugi::xml_node geometry = document_->find(skin.attribute("source").value());
    add_note(model_, "skins are ignored: the mesh is not deformed");
    if (!geometry) return {};
    return add_geometry(geometry, instance, name, X_FN);
  }

  Status add_geometry(const pugi::xml_node& geometry, const pugi::xml_node& instance,
                      const std::string& name, const Affine3f& X_FN) {
    const std::string id = geometry.attribute("id").value();
    auto known = geometries_.find(id);
    if (known == geometries_.end() || id.empty()) {
      GLOAM_TRY(std::vector<ColladaPart> parts, read_collada_geometry(document_, geometry, model_));
      known = geometries_.insert_or_assign(id, std::move(parts)).first;
    }
    const pugi::xml_node bound = instance.child("bind_material").child("technique_common");
    for (const ColladaPart& part : known->second) {
      std::string url;
      for (const pugi::xml_node& bind : bound.children("instance_material"))
        if (part.symbol == bind.attribute("symbol").value()) url = bind.attribute("target").value();
      // Files without <bind_material> name their materials directly.
      if (url.empty() && !part.symbol.empty() && document_->find(part.symbol)) url = part.symbol;
      int material = -1;
      if (!url.empty()) {
        GLOAM_TRY(material, materials_.row(url));
      }
      int mesh = part.mesh;
      if (!part.colors.empty())
        material = paint_vertices(part.colors, material, &mesh, &painted_, model_);
      if (model_->instances.size() >= document_->source().options->limits.instances)
        return document_->bad(geometry, "exceeds the limit on instances");
      model_->instances.push_back({name.substr(0, kMaxName), mesh, material, X_FN});
    }
    return {};
  }

  ColladaDocument* document_;
  ModelFile* model_;
  ColladaMaterials materials_;
  std::map<std::string, std::vector<ColladaPart>> geometries_;
  PaintedMeshes painted_;
  uint64_t visits_ = 0;
};

}  // namespace

Status read_collada_scene(ColladaDocument* document, ModelFile* model) {
  return SceneReader(document, model).read();
}

Result<ModelFile> read_collada(const ModelSource& source) {
  GLOAM_TRY(const std::unique_ptr<ColladaDocument> document, ColladaDocument::open(source));
  ModelFile model;
  GLOAM_TRY_STATUS(read_collada_scene(document.get(), &model));
  if (model.instances.empty()) add_note(&model, "the file contains no geometry");
  return model;
}

}  // namespace gloam

// The node hierarchy of glTF, flattened.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/gltf/document.h"
#include "geometry/gltf/node_place.h"
#include "geometry/gltf/skins.h"

namespace gloam {
namespace {

// Y up to Z up: (x, y, z) -> (x, -z, y).
constexpr Affine3f kZUp{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, 0}};

bool is_finite(const Affine3f& X) {
  for (const Vec3f& v : {X.x, X.y, X.z, X.p})
    if (!(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) return false;
  return true;
}

class NodeReader {
 public:
  NodeReader(GltfDocument* document, const GltfMeshTable& meshes, ModelFile* model)
      : document_(document), meshes_(meshes), model_(model), nodes_(document->root()["nodes"]) {}

  void read() {
    const JsonNode lights = document_->root()["extensions"]["KHR_lights_punctual"]["lights"];
    for (size_t i = 0; i < lights.size() && ok(); ++i)
      lights_.push_back(read_gltf_light(lights.at(i)));
    if (!find_parents() || !refuse_cycles()) return;
    skins_ = read_gltf_skins(document_);
    std::vector<int> roots = find_roots();
    struct Visit {
      int node;
      Affine3f X_FP;  // pose of the parent
    };
    std::vector<Visit> stack;
    for (auto it = roots.rbegin(); it != roots.rend(); ++it) stack.push_back({*it, kZUp});
    while (!stack.empty() && ok()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const JsonNode node = nodes_.at(static_cast<size_t>(visit.node));
      const Affine3f X_FN = visit.X_FP * place_in_parent(node);
      if (!is_finite(X_FN)) return node.fail("its transform is not finite");
      add_content(node, X_FN);
      const std::vector<int>& children = children_[static_cast<size_t>(visit.node)];
      for (auto it = children.rbegin(); it != children.rend(); ++it) stack.push_back({*it, X_FN});
    }
  }

 private:
  bool ok() const { return document_->errors().ok(); }

  // The hierarchy is a forest by the standard: a node has one parent at most.
  bool find_parents() {
    const size_t count = nodes_.size();
    parents_.assign(count, -1);
    children_.resize(count);
    for (size_t i = 0; i < count && ok(); ++i) {
      const JsonNode children = nodes_.at(i)["children"];
      for (size_t k = 0; k < children.size() && ok(); ++k) {
        const int child = children.at(k).required_index(count, "node");
        if (child < 0) return false;
        int& parent = parents_[static_cast<size_t>(child)];
        if (parent >= 0)
          children.at(k).fail(fmt::format("node {} has two parents, {} and {}", child, parent, i),
                              "nodes must form a tree");
        parent = static_cast<int>(i);
        children_[i].push_back(child);
      }
    }
    return ok();
  }

  bool refuse_cycles() {
    enum : uint8_t { kNew, kOnPath, kDone };
    std::vector<uint8_t> state(parents_.size(), kNew);
    std::vector<int> path;
    for (size_t i = 0; i < parents_.size(); ++i) {
      path.clear();
      int n = static_cast<int>(i);
      while (n >= 0 && state[static_cast<size_t>(n)] == kNew) {
        state[static_cast<size_t>(n)] = kOnPath;
        path.push_back(n);
        n = parents_[static_cast<size_t>(n)];
      }
      if (n >= 0 && state[static_cast<size_t>(n)] == kOnPath) {
        nodes_.at(static_cast<size_t>(n)).fail("is its own ancestor", "nodes must form a tree");
        return false;
      }
      for (const int visited : path) state[static_cast<size_t>(visited)] = kDone;
    }
    return true;
  }

  std::vector<int> find_roots() {
    std::vector<int> out;
    const JsonNode scenes = document_->root()["scenes"];
    if (scenes.size() == 0) {
      for (size_t i = 0; i < parents_.size(); ++i)
        if (parents_[i] < 0) out.push_back(static_cast<int>(i));
      return out;
    }
    const int named = document_->root()["scene"].index(scenes.size(), "scene");
    if (scenes.size() > 1)
      add_note(model_, fmt::format("only one of {} scenes is read", scenes.size()));
    const JsonNode roots = scenes.at(static_cast<size_t>(std::max(named, 0)))["nodes"];
    std::vector<bool> taken(parents_.size(), false);
    for (size_t i = 0; i < roots.size() && ok(); ++i) {
      const int root = roots.at(i).required_index(parents_.size(), "node");
      if (root < 0) break;
      if (parents_[static_cast<size_t>(root)] >= 0 || taken[static_cast<size_t>(root)])
        roots.at(i).fail(fmt::format("node {} is not a root node or is listed twice", root));
      taken[static_cast<size_t>(root)] = true;
      out.push_back(root);
    }
    return out;
  }

  // EXT_mesh_gpu_instancing: shift, rotation and scale of each copy, any of them left out.
  bool read_copies(const JsonNode& attributes, std::vector<Affine3f>* out) {
    std::vector<float> shift, turn, scale;
    size_t count = SIZE_MAX;
    const auto read = [&](const char* name, size_t width, std::vector<float>* to) {
      const JsonNode attribute = attributes[name];
      if (!attribute.exists()) return true;
      const int accessor = attribute.index(document_->root()["accessors"].size(), "accessor");
      if (accessor < 0 || !document_->read_floats(accessor, width, to)) return false;
      if (count != SIZE_MAX && count != to->size() / width)
        attribute.fail(fmt::format("has {} instances, but another attribute has {}",
                                   to->size() / width, count));
      count = to->size() / width;
      return ok();
    };
    if (!read("TRANSLATION", 3, &shift) || !read("ROTATION", 4, &turn) || !read("SCALE", 3, &scale))
      return false;
    if (count == SIZE_MAX) return true;  // no attributes: the mesh itself
    if (count > document_->source().options->limits.instances) {
      attributes.fail(fmt::format("has {} instances, which exceeds the limit", count));
      return false;
    }
    out->clear();
    for (size_t i = 0; i < count; ++i) {
      std::array<float, 4> q = {0, 0, 0, 1};
      if (!turn.empty()) std::copy_n(&turn[4 * i], 4, q.begin());
      if (!normalize_rotation(&q)) {
        attributes["ROTATION"].fail(fmt::format("instance {} has an invalid rotation", i));
        return false;
      }
      const Vec3f s =
          scale.empty() ? Vec3f{1, 1, 1} : Vec3f{scale[3 * i], scale[3 * i + 1], scale[3 * i + 2]};
      Affine3f X = place_from(q, s);
      if (!shift.empty()) X.p = {shift[3 * i], shift[3 * i + 1], shift[3 * i + 2]};
      out->push_back(X);
    }
    return true;
  }

  // Pose of any node in the file, also of one that no scene shows: joints may be such nodes.
  const Affine3f& place_of(int node) {
    if (places_.empty()) places_.resize(parents_.size());
    std::vector<int> path;  // up to an ancestor whose place is known
    for (int n = node; n >= 0 && !places_[static_cast<size_t>(n)];
         n = parents_[static_cast<size_t>(n)])
      path.push_back(n);
    for (; !path.empty(); path.pop_back()) {
      const auto n = static_cast<size_t>(path.back());
      const Affine3f X_FP = parents_[n] < 0 ? kZUp : *places_[static_cast<size_t>(parents_[n])];
      places_[n] = X_FP * place_in_parent(nodes_.at(n));
    }
    return *places_[static_cast<size_t>(node)];
  }

  // Its place is the joints'; that of its node does not count.
  void add_skinned(const JsonNode& node, const std::string& name, const GltfMeshTable::Part& part,
                   const GltfSkin& skin) {
    std::vector<Affine3f> X_FM;
    for (size_t i = 0; i < skin.joints.size(); ++i)
      X_FM.push_back(place_of(skin.joints[i]) * skin.X_JM[i]);
    const int mesh = add_bent_mesh(document_, node, part, X_FM, model_);
    if (mesh >= 0) model_->instances.push_back({name, mesh, part.material, Affine3f{}});
  }

  void add_mesh(const JsonNode& node, const std::string& name, size_t mesh, const Affine3f& X_FN) {
    const ModelLimits& limits = document_->source().options->limits;
    const int skin = node["skin"].index(skins_.size(), "skin");
    std::vector<Affine3f> places = {Affine3f{}};
    const JsonNode copies = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    if (skin >= 0) add_note(model_, "skinned meshes are drawn in the pose of the file's nodes");
    if (copies.exists() && !read_copies(copies, &places)) return;
    for (const Affine3f& X_NC : places) {
      const Affine3f X_FC = copies.exists() ? X_FN * X_NC : X_FN;
      if (!is_finite(X_FC)) return copies.fail("gives an instance a transform that is not finite");
      for (const GltfMeshTable::Part& part : meshes_.parts[mesh]) {
        if (!ok()) return;
        if (model_->instances.size() >= limits.instances)
          return node.fail(fmt::format("there are more than {} instances", limits.instances));
        if (skin >= 0 && part.weights.per_vertex > 0)
          add_skinned(node, name, part, skins_[static_cast<size_t>(skin)]);
        else
          model_->instances.push_back({name, part.mesh, part.material, X_FC});
      }
      if (skin >= 0) return;  // all copies would be in one place
    }
  }

  void add_content(const JsonNode& node, const Affine3f& X_FN) {
    if (node["camera"].exists()) add_note(model_, "cameras are ignored");
    const ModelLimits& limits = document_->source().options->limits;
    const std::string name = node["name"].text().substr(0, kMaxName);
    if (const int mesh = node["mesh"].index(meshes_.parts.size(), "mesh"); mesh >= 0)
      add_mesh(node, name, static_cast<size_t>(mesh), X_FN);
    const int light =
        node["extensions"]["KHR_lights_punctual"]["light"].index(lights_.size(), "light");
    if (light < 0) return;
    if (model_->lights.size() >= limits.instances)
      return node.fail(fmt::format("there are more than {} lights", limits.instances));
    model_->lights.push_back(lights_[static_cast<size_t>(light)]);
    model_->lights.back().X_FL = X_FN;
    if (!name.empty()) model_->lights.back().name = name;
  }

  GltfDocument* document_;
  const GltfMeshTable& meshes_;
  ModelFile* model_;
  JsonNode nodes_;
  std::vector<int> parents_;
  std::vector<std::vector<int>> children_;
  std::vector<ImportedLight> lights_;
  std::vector<GltfSkin> skins_;
  std::vector<std::optional<Affine3f>> places_;  // by node, as far as they are known
};

}  // namespace

void read_gltf_nodes(GltfDocument* document, const GltfMeshTable& meshes, ModelFile* model) {
  NodeReader(document, meshes, model).read();
}

}  // namespace gloam

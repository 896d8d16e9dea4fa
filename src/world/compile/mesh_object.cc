#include "world/compile/mesh_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/archive.h"
#include "base/hash.h"
#include "world/compile/model_loader.h"
#include "world/compile/model_nodes.h"
#include "world/shapes/file_axes.h"
#include "world/shapes/imported_mesh.h"
#include "world/shapes/visual_file.h"

namespace gloam {
namespace {

// Suspicious sizes [m]: of dynamic objects, of static objects, of a place.
constexpr double kTiny = 1e-3, kHuge = 10, kHugeFixed = 100, kHugePlace = 10'000;

bool is_place(const EnvironmentOptions& e) { return is_model_file(e.file); }

void append(const ModelFile& model, int instance, const Affine3f& X_BF, TriangleMesh* out) {
  const ImportedInstance& in = model.instances[static_cast<size_t>(instance)];
  const TriangleMesh& from = model.meshes[static_cast<size_t>(in.mesh)];
  const Affine3f X = X_BF * in.X_FI;
  const bool is_mirrored = dot(X.x, cross(X.y, X.z)) < 0;
  const auto first = static_cast<uint32_t>(out->positions.size());
  for (const Vec3f p : from.positions) out->positions.push_back(transform_point(X, p));
  for (size_t t = 0; t + 2 < from.indices.size(); t += 3)
    for (const size_t k : {size_t{0}, size_t{1} + is_mirrored, size_t{2} - is_mirrored})
      out->indices.push_back(first + from.indices[t + k]);
}

class ObjectLoader {
 public:
  ObjectLoader(const Scene& scene, CompileProgress* progress)
      : scene_(scene), progress_(progress) {}

  Result<MeshObjects> load() {
    if (scene_.objects.empty() && !is_place(scene_.environment)) return MeshObjects{};
    std::vector<FileUse> uses;
    for (const ObjectOptions& o : scene_.objects) uses.push_back({o.file, title(o), o.loc});
    const EnvironmentOptions& place = scene_.environment;
    if (is_place(place)) uses.push_back({place.file, "environment", place.loc});
    GLOAM_TRY(files_, load_model_files(scene_, uses, progress_));
    for (const ObjectOptions& o : scene_.objects) GLOAM_TRY_STATUS(add_object(o));
    if (is_place(place)) GLOAM_TRY_STATUS(add_place(place));
    out_.hash = hash();
    return std::move(out_);
  }

 private:
  const ModelFile& file_of(const std::filesystem::path& path) const {
    return std::find_if(files_.begin(), files_.end(),
                        [&](const LoadedModel& file) { return file.path == path; })
        ->model;
  }

  Status add_object(const ObjectOptions& options) {
    const ModelFile& model = file_of(options.file);
    const std::string file = options.file.filename().string();
    const std::vector<ModelNode> nodes = nodes_of(model);
    std::vector<int> instances;
    if (options.node.empty()) {
      for (const ModelNode& node : nodes)
        instances.insert(instances.end(), node.instances.begin(), node.instances.end());
      if (instances.empty())
        return Error{ErrorKind::kInput,
                     fmt::format("{}: '{}' has no triangles", title(options), file), options.loc};
    } else {
      const Result<ModelNode> node = find_node(nodes, file, options.node);
      if (!node.ok()) return said_of(title(options), options.loc, node.error());
      instances = node->instances;
    }
    add(options, instances, model);
    const double size = 2.0 * max_component(half_extents(out_.objects.back().mesh));
    const double huge = options.motion == "static" ? kHugeFixed : kHuge;
    if (size > huge || size < kTiny) note_size(title(options), size, options.loc);
    return {};
  }

  void note_size(const std::string& what, double size, const SourceLoc& loc) {
    std::string hint = "set 'unit' to the length of one unit of the file in metres";
    if (size > kTiny) hint = "if the file is in millimetres, set unit = 0.001";
    out_.notes.push_back({ErrorKind::kInput, fmt::format("{} has a size of {:.3g} m", what, size),
                          loc, std::move(hint)});
  }

  /// Names that are taken, with the kind of thing that has each.
  std::map<std::string, std::string> names_taken(const EnvironmentOptions& place) const {
    std::map<std::string, std::string> taken = {{"world", "the world"}};
    const auto add = [&](const auto& things, std::string_view kind) {
      for (const auto& thing : things)
        taken.emplace(thing.name, fmt::format("{} '{}'", kind, thing.name));
    };
    add(scene_.objects, "object"), add(scene_.props, "prop"), add(scene_.robots, "robot");
    for (const VisualOptions& v : scene_.visuals)
      if (v.file != place.file) taken.emplace(v.name, fmt::format("visual '{}'", v.name));
    return taken;
  }

  Result<std::string> name_for(const ModelNode& node, const EnvironmentOptions& place,
                               std::map<std::string, std::string>* taken) {
    std::string own = node.own;
    std::replace(own.begin(), own.end(), '/', '_');
    const std::string prefix =
        place.clash == "prefix" ? place.file.stem().string() + "/" : std::string();
    std::string name = prefix + own;
    for (int i = 2; !taken->emplace(name, "another node").second; ++i) {
      if (place.clash == "refuse")
        return Error{ErrorKind::kInput,
                     fmt::format("environment: node '{}' and {} have the same name", node.own,
                                 taken->at(name)),
                     place.loc, "rename one of them, or set clash = \"rename\" or \"prefix\""};
      name = fmt::format("{}{}_{}", prefix, own, i);
    }
    if (name != prefix + node.own)
      out_.notes.push_back(
          {ErrorKind::kInput,
           fmt::format("environment: node '{}' is renamed to '{}'", node.own, name), place.loc});
    return name;
  }

  Status add_place(const EnvironmentOptions& place) {
    const ModelFile& model = file_of(place.file);
    std::map<std::string, std::string> taken = names_taken(place);
    const std::string stem = place.file.stem().string();
    for (const RobotOptions& robot : scene_.robots)
      if (place.clash == "prefix" && robot.name == stem)
        return Error{ErrorKind::kInput,
                     fmt::format("the environment's nodes and robot '{}' have the same prefix "
                                 "'{}/'",
                                 robot.name, stem),
                     robot.loc, "rename the robot, or the environment's file"};
    TriangleMesh corners;
    for (const ModelNode& node : nodes_of(model)) {
      ObjectOptions options;
      GLOAM_TRY(options.name, name_for(node, place, &taken));
      options.file = place.file;
      options.node = node.name;
      options.up = place.up;
      options.unit = place.unit;
      options.colliders = place.colliders;
      options.motion = "static";
      options.loc = place.loc;
      add(std::move(options), node.instances, model);
      out_.objects.back().is_place = true;
      const TriangleMesh& mesh = out_.objects.back().mesh;
      corners.positions.insert(corners.positions.end(), mesh.positions.begin(),
                               mesh.positions.end());
    }
    if (corners.positions.empty())
      return Error{
          ErrorKind::kInput,
          fmt::format("the environment '{}' has no triangles", place.file.filename().string()),
          place.loc};
    const double size = 2.0 * max_component(half_extents(corners));
    if (size > kHugePlace || size < kTiny) note_size("the environment", size, place.loc);
    return {};
  }

  void add(ObjectOptions o, const std::vector<int>& instances, const ModelFile& model) {
    const Affine3f X_BF = file_axes(o.scale, o.unit, o.up, model.was_y_up);
    MeshObject& object = out_.objects.emplace_back(MeshObject{std::move(o), {}});
    for (const int instance : instances) append(model, instance, X_BF, &object.mesh);
  }

  uint64_t hash() const {
    uint64_t hash = 1;
    for (const MeshObject& object : out_.objects) {
      const ObjectOptions& o = object.options;
      ArchiveWriter key;
      key(o.name), key(o.X_WO), key(o.motion), key(o.density), key(o.mass.value_or(0));
      key(o.colliders), key(o.concavity), key(o.max_hulls);
      key(o.friction.has_value()), key(o.friction.value_or(Vec3{}));
      key(object.is_place);
      key(o.loc.line);  // part of cached messages
      hash = hash_bytes(key.bytes.data(), key.bytes.size(), hash);
      hash = hash_span(std::span<const Vec3f>(object.mesh.positions), hash);
      hash = hash_span(std::span<const uint32_t>(object.mesh.indices), hash);
    }
    return hash;
  }

  const Scene& scene_;
  CompileProgress* progress_;
  std::vector<LoadedModel> files_;
  MeshObjects out_;
};

}  // namespace

Result<MeshObjects> load_mesh_objects(const Scene& scene, CompileProgress* progress) {
  return ObjectLoader(scene, progress).load();
}

Status add_object_visuals(const MeshObjects& objects, Scene* scene) {
  for (const MeshObject& object : objects.objects) {
    const ObjectOptions& o = object.options;
    GLOAM_TRY_STATUS(add_visual_of(title(o),
                                   {.name = o.name,
                                    .file = o.file,
                                    .node = o.node,
                                    .body = o.name,
                                    .scale = o.scale,
                                    .up = o.up,
                                    .unit = o.unit,
                                    .loc = o.loc},
                                   scene));
  }
  return {};
}

}  // namespace gloam

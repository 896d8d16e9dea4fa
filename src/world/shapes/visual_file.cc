#include "world/shapes/visual_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "base/parallel.h"
#include "base/text.h"
#include "world/compile/level.h"
#include "world/compile/model_loader.h"
#include "world/compile/model_nodes.h"
#include "world/materials/imported_surface.h"
#include "world/shapes/file_axes.h"
#include "world/shapes/visual_pose.h"

namespace gloam {
namespace {

std::string title(const VisualOptions& v) { return fmt::format("visual '{}'", v.name); }

constexpr float kFarthest = 1e9f;  // [m] a vertex from its mesh's origin

/// Metres of one unit of the file, the mean of the three axes.
float mean_scale(const VisualOptions& v) {
  return static_cast<float>(std::cbrt(std::abs(v.scale.x * v.scale.y * v.scale.z)) * v.unit);
}

/// Metres that one texture length spans on a mesh, 0 = it has no uvs.
float texture_length(const TriangleMesh& mesh) {
  if (mesh.uvs.empty()) return 0;
  double area = 0, uv_area = 0;
  for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const uint32_t* i = &mesh.indices[t];
    const Vec3f a = mesh.positions[i[0]];
    area += length(cross(mesh.positions[i[1]] - a, mesh.positions[i[2]] - a));
    const Vec2f u = mesh.uvs[i[1]] - mesh.uvs[i[0]], v = mesh.uvs[i[2]] - mesh.uvs[i[0]];
    uv_area += std::abs(u.x * v.y - u.y * v.x);
  }
  return uv_area > 0 ? static_cast<float>(std::sqrt(area / uv_area)) : 0;
}

class VisualImporter {
 public:
  VisualImporter(const CompiledWorld& world, const std::vector<Affine3f>& poses,
                 const AddVisualPart& add, LightLevels* levels, RenderDescription* out)
      : world_(world), poses_(poses), add_(add), levels_(levels), out_(out) {}

  Status run() {
    visuals_ = world_.scene.visuals;
    for (const VisualOptions& visual : visuals_) {
      int body = 0;
      if (!visual.body.empty())
        body = mj_name2id(world_.model.get(), mjOBJ_BODY, visual.body.c_str());
      if (body < 0) return no_body(visual);
      bodies_.push_back(body);
    }
    std::vector<FileUse> uses;
    for (const VisualOptions& v : visuals_) uses.push_back({v.file, title(v), v.loc});
    GLOAM_TRY(files_, load_model_files(world_.scene, uses));
    return import();
  }

  /// Meshes of URDFs instead.
  Status run(const std::vector<DrawnMesh>& meshes, std::vector<int>* indices) {
    is_model_ = true;
    for (const DrawnMesh& drawn : meshes) {
      const VisualOnlyGeom& geom = world_.visual_only[static_cast<size_t>(drawn.index)];
      const VisualOnlyMesh& mesh = world_.visual_meshes[static_cast<size_t>(geom.mesh)];
      if (!has_file(mesh.file)) {
        const std::string user = fmt::format("the visual mesh of '{}' is not drawn", mesh.name);
        Result<ModelFile> model = load_model_file(world_.scene, mesh.file, user, mesh.loc);
        if (!model.ok()) {
          out_->unsupported.push_back(model.error());
          continue;
        }
        files_.push_back({mesh.file, mesh.file.filename().string(), std::move(model).value()});
      }
      VisualOptions visual;
      visual.name = mesh.name;
      visual.file = mesh.file;
      visual.X_BV = geom.X_BG;
      visual.scale = mesh.scale;
      visual.loc = mesh.loc;
      visuals_.push_back(std::move(visual));
      bodies_.push_back(geom.body);
      plain_rows_.push_back(drawn.material);
      indices->push_back(drawn.index);
    }
    return import();
  }

 private:
  bool has_file(const std::filesystem::path& path) const {
    return std::any_of(files_.begin(), files_.end(),
                       [&](const LoadedModel& file) { return file.path == path; });
  }

  Status import() {
    for (LoadedModel& file : files_) {
      GLOAM_TRY(ImportedTextures textures, ImportedTextures::decode(file.model, file.name, out_));
      file.model.images.clear();
      nodes_.push_back(nodes_of(file.model));
      textures_.push_back(std::move(textures));
    }
    for (size_t v = 0; v < bodies_.size(); ++v) GLOAM_TRY_STATUS(add_visual(static_cast<int>(v)));
    for (ImportedTextures& textures : textures_) textures.finish();
    return bake_meshes();
  }

  Error no_body(const VisualOptions& visual) const {
    const mjModel* m = world_.model.get();
    return {ErrorKind::kInput, fmt::format("{}: there is no body '{}'", title(visual), visual.body),
            visual.loc, suggest_name(visual.body, object_names(m, mjOBJ_BODY))};
  }

  Status add_visual(int index) {
    const VisualOptions& visual = visuals_[static_cast<size_t>(index)];
    const size_t file = file_of(visual);
    const ModelFile& model = files_[file].model;
    const Affine3f X_BF = visual_placement(visual, model.was_y_up);
    first_surface_ = surfaces_.size();
    plain_ = -1;
    for (size_t i = 0; i < model.materials.size(); ++i) {
      const ImportedMaterial& material = model.materials[i];
      const std::string own = material.name.empty() ? fmt::format("material_{}", i) : material.name;
      add_surface(describe_imported(material, visual.name + "/" + own, mean_scale(visual),
                                    &textures_[file], out_));
    }
    if (visual.node.empty()) {
      for (size_t i = 0; i < model.instances.size(); ++i)
        add_part(visual, index, file, static_cast<int>(i), X_BF);
    } else {
      const Result<ModelNode> node = find_node(nodes_[file], files_[file].name, visual.node);
      if (!node.ok()) return said_of(title(visual), visual.loc, node.error());
      for (const int part : node->instances) add_part(visual, index, file, part, X_BF);
      if (visual.node != nodes_[file][0].name) return {};
    }
    // Lamps and reports that belong to no node come once, with the first. A robot's meshes bring no
    // lamps.
    if (is_model_) {
      report(visual, model);
      return {};
    }
    for (const ImportedLight& light : model.lights) add_light(visual, index, light, X_BF);
    report(visual, model);
    return {};
  }

  size_t file_of(const VisualOptions& visual) const {
    const auto found = std::find_if(files_.begin(), files_.end(), [&](const LoadedModel& file) {
      return file.path == visual.file;
    });
    return static_cast<size_t>(found - files_.begin());
  }

  /// Without a material of its own, a part of a URDF's mesh has the visual's.
  void add_plain(const VisualOptions& visual, int index) {
    plain_ = static_cast<int>(surfaces_.size());
    if (!is_model_) return add_surface(plain_surface(visual.name));
    rows_.push_back(plain_rows_[static_cast<size_t>(index)]);
    surfaces_.push_back({});
  }

  void add_surface(ImportedSurface surface) {
    rows_.push_back(static_cast<int>(out_->materials.size()));
    out_->materials.push_back(surface.material);
    surfaces_.push_back(std::move(surface));
  }

  void add_part(const VisualOptions& visual, int index, size_t file, int part,
                const Affine3f& X_BF) {
    const ImportedInstance& in = files_[file].model.instances[static_cast<size_t>(part)];
    if (files_[file].model.meshes[static_cast<size_t>(in.mesh)].indices.empty()) return;
    if (in.material < 0 && plain_ < 0) add_plain(visual, index);
    const size_t surface = in.material < 0 ? static_cast<size_t>(plain_)
                                           : first_surface_ + static_cast<size_t>(in.material);
    const RigidAndStretch X = split_stretch(X_BF * in.X_FI);
    InstanceDescription instance;
    instance.shape = ShapeType::kMesh;
    instance.mesh = mesh_row(file, in.mesh, X.stretch, surface);
    instance.X_BG = X.rigid;
    instance.material = rows_[surface];
    instance.casts_shadow = visual.casts_shadow;
    const std::string own = in.name.empty() ? fmt::format("part_{}", part) : in.name;
    parts_.push_back(out_->instances.size());
    add_(std::move(instance), bodies_[static_cast<size_t>(index)], visual.name + "/" + own, index,
         visual.name);
  }

  int mesh_row(size_t file, int mesh, const Affine3f& stretch, size_t surface) {
    const UvUse& uv = surfaces_[surface].uv;
    const UvTransform& t = uv.transform;
    const Affine3f& s = stretch;
    const MeshKey key{file,
                      mesh,
                      uv.set,
                      {s.x.x, s.x.y, s.x.z, s.y.x, s.y.y, s.y.z, s.z.x, s.z.y, s.z.z, t.offset.x,
                       t.offset.y, t.rotation, t.scale.x, t.scale.y}};
    const auto [entry, added] = mesh_rows_.try_emplace(key, static_cast<int>(out_->meshes.size()));
    if (added) {
      out_->meshes.emplace_back();
      baked_.push_back({file, mesh, entry->second, stretch, uv, files_[file].name});
    }
    if (surfaces_[surface].bump_by_texture) bumped_.try_emplace(rows_[surface], entry->second);
    return entry->second;
  }

  void add_light(const VisualOptions& visual, int index, const ImportedLight& in,
                 const Affine3f& X_BF) {
    const Affine3f X_BL = X_BF * in.X_FL;
    LightDescription light;
    light.name = visual.name + "/" + (in.name.empty() ? "light" : in.name);
    light.body = bodies_[static_cast<size_t>(index)];
    light.intensity = in.color * in.intensity;
    light.casts_shadow = true;
    const Vec3f back = length_squared(X_BL.z) > 0 ? normalize(X_BL.z) : Vec3f{0, 0, 1};
    const Frame frame = Frame::from_z(back);
    light.X_BL = {frame.x, frame.y, frame.z, X_BL.p};
    if (in.type == ImportedLightType::kDirectional) light.type = PunctualLightType::kDirectional;
    if (in.type == ImportedLightType::kSpot) {
      light.type = PunctualLightType::kSpot;
      light.cos_cutoff = std::cos(in.outer_cone);
      light.softness = 1 - in.inner_cone / in.outer_cone;
    }
    const Vec3f p_W = transform_point(poses_[static_cast<size_t>(light.body)], light.X_BL.p);
    levels_->add(light, light_distance(p_W, *out_));
    out_->lights.push_back(std::move(light));
  }

  void report(const VisualOptions& visual, const ModelFile& model) {
    const auto add = [&](const std::string& note) {
      out_->unsupported.push_back(
          {ErrorKind::kUnsupported, fmt::format("{}: {}", title(visual), note), visual.loc});
    };
    for (const std::string& note : model.notes) add(note);
    if (model.dropped_triangles > 0)
      add(fmt::format("{} triangles without area are ignored", model.dropped_triangles));
    const bool has_triangles = std::any_of(
        model.instances.begin(), model.instances.end(), [&](const ImportedInstance& in) {
          return !model.meshes[static_cast<size_t>(in.mesh)].indices.empty();
        });
    if (!has_triangles && model.lights.empty()) add("the file contains nothing to draw");
  }

  /// Fills the rows of meshes that were handed out. The last user of a mesh takes it.
  Status bake_meshes() {
    std::map<std::pair<size_t, int>, int> users;
    for (const BakedMesh& baked : baked_) ++users[{baked.file, baked.mesh}];
    parallel_for("bake meshes", static_cast<int64_t>(baked_.size()), [&](int64_t i) {
      const BakedMesh& baked = baked_[static_cast<size_t>(i)];
      TriangleMesh& from = files_[baked.file].model.meshes[static_cast<size_t>(baked.mesh)];
      TriangleMesh& mesh = out_->meshes[static_cast<size_t>(baked.row)];
      mesh = users.at({baked.file, baked.mesh}) == 1 ? std::move(from) : from;
      bake_mesh(baked.stretch, baked.uv, &mesh);
    });
    files_.clear();
    for (const BakedMesh& baked : baked_) {
      const Vec3f half = half_extents(out_->meshes[static_cast<size_t>(baked.row)]);
      half_[baked.row] = half;
      if (max_component(half) < kFarthest) continue;
      return Error{
          ErrorKind::kInput,
          fmt::format("{}: a mesh has a size of {:.3g} m", baked.name, 2 * max_component(half)),
          {},
          "set 'unit' to the length of one unit of the file in metres"};
    }
    for (const size_t part : parts_) {
      InstanceDescription& instance = out_->instances[part];
      instance.size = half_.at(instance.mesh);
    }
    for (const auto& [material, mesh] : bumped_) {
      MaterialDescription& m = out_->materials[static_cast<size_t>(material)];
      m.bump_scale *= texture_length(out_->meshes[static_cast<size_t>(mesh)]) /
                      std::sqrt(m.texture_repeat.x * m.texture_repeat.y);
    }
    return {};
  }

  struct MeshKey {
    size_t file;
    int mesh, uv_set;
    std::array<float, 14> stretch_and_uv;
    auto operator<=>(const MeshKey&) const = default;
  };
  struct BakedMesh {
    size_t file;
    int mesh, row;
    Affine3f stretch;
    UvUse uv;
    std::string name;
  };
  const CompiledWorld& world_;
  std::vector<VisualOptions> visuals_;
  bool is_model_ = false;        // meshes of URDFs
  std::vector<int> plain_rows_;  // rows of plain materials, by visual
  const std::vector<Affine3f>& poses_;
  const AddVisualPart& add_;
  LightLevels* levels_;
  RenderDescription* out_;
  std::vector<LoadedModel> files_;
  std::vector<ImportedTextures> textures_;     // by file
  std::vector<std::vector<ModelNode>> nodes_;  // by file
  std::vector<int> bodies_;                    // by visual
  std::vector<ImportedSurface> surfaces_;      // surfaces of all visuals
  std::vector<int> rows_;                      // rows of materials, by surface
  size_t first_surface_ = 0;                   // first surface of the visual at hand
  int plain_ = -1;                             // its surface for parts without one
  std::map<MeshKey, int> mesh_rows_;
  std::vector<BakedMesh> baked_;
  std::vector<size_t> parts_;  // rows of instances
  std::map<int, Vec3f> half_;  // extents by row of meshes
  std::map<int, int> bumped_;  // row of material -> the first mesh that it is on
};

}  // namespace

Affine3f visual_placement(const VisualOptions& visual, bool was_y_up) {
  const mjtNum p[3] = {visual.X_BV.p.x, visual.X_BV.p.y, visual.X_BV.p.z};
  const mjtNum q[4] = {visual.X_BV.q.w, visual.X_BV.q.x, visual.X_BV.q.y, visual.X_BV.q.z};
  return rigid_pose(p, q) * file_axes(visual.scale, visual.unit, visual.up, was_y_up);
}

Status add_visual_of(const std::string& user, VisualOptions visual, Scene* scene) {
  const auto same = std::find_if(scene->visuals.begin(), scene->visuals.end(),
                                 [&](const VisualOptions& v) { return v.name == visual.name; });
  if (same == scene->visuals.end()) {
    scene->visuals.push_back(std::move(visual));
  } else if (same->file != visual.file || same->body != visual.body) {
    return Error{ErrorKind::kInput, fmt::format("{} and {} have the same name", user, title(*same)),
                 visual.loc, "rename one of them"};
  }
  return {};
}

Status describe_visuals(const CompiledWorld& world, const std::vector<Affine3f>& poses,
                        const AddVisualPart& add, LightLevels* levels, RenderDescription* out) {
  if (world.scene.visuals.empty()) return {};
  return VisualImporter(world, poses, add, levels, out).run();
}

Status describe_model_meshes(const CompiledWorld& world, const std::vector<DrawnMesh>& meshes,
                             const std::vector<Affine3f>& poses, const AddMeshPart& add,
                             RenderDescription* out) {
  if (meshes.empty()) return {};
  std::vector<int> indices;  // the importer counts those that it could read
  const AddVisualPart add_part = [&](InstanceDescription instance, int body, std::string,
                                     int visual, const std::string&) {
    add(std::move(instance), body, indices[static_cast<size_t>(visual)]);
  };
  LightLevels none;
  VisualImporter importer(world, poses, add_part, &none, out);
  return importer.run(meshes, &indices);
}

int64_t count_visual_triangles(const CompiledWorld& world) {
  std::map<std::filesystem::path, std::optional<ModelFile>> files;
  int64_t triangles = 0;
  std::vector<VisualOptions> visuals = world.scene.visuals;
  for (const VisualOnlyMesh& mesh : world.visual_meshes) {
    VisualOptions& v = visuals.emplace_back();
    v.name = mesh.name;
    v.file = mesh.file;
    v.loc = mesh.loc;
  }
  for (const VisualOptions& v : visuals) {
    const auto [file, is_new] = files.try_emplace(v.file);
    if (is_new) {
      Result<ModelFile> read = load_model_file(world.scene, v.file, title(v), v.loc);
      if (read.ok()) file->second = std::move(read).value();
    }
    if (!file->second) continue;
    const ModelFile& model = *file->second;
    for (const ModelNode& node : nodes_of(model)) {
      if (!v.node.empty() && node.name != v.node) continue;
      for (const int i : node.instances) {
        const int mesh = model.instances[static_cast<size_t>(i)].mesh;
        triangles += static_cast<int64_t>(model.meshes[static_cast<size_t>(mesh)].triangle_count());
      }
    }
  }
  return triangles;
}

}  // namespace gloam

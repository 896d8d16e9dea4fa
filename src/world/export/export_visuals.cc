#include "world/export/export_visuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

#include "base/files.h"
#include "base/srgb.h"
#include "places/writer/spec_edit.h"
#include "world/model_names.h"
#include "world/render_description.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr int kExportedGroup = 2;  // group of visuals in MuJoCo's own collection of models

// The mesh as Wavefront OBJ, in metres.
std::string to_obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Vec3f& p : mesh.positions)
    text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
  for (const Vec3f& n : mesh.normals)
    text += fmt::format("vn {:.6g} {:.6g} {:.6g}\n", n.x, n.y, n.z);
  const bool has_normals = mesh.normals.size() == mesh.positions.size();
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    text += 'f';
    for (size_t k = i; k < i + 3; ++k) {
      const uint32_t v = mesh.indices[k] + 1;
      text += has_normals ? fmt::format(" {}//{}", v, v) : fmt::format(" {}", v);
    }
    text += '\n';
  }
  return text;
}

mjtGeom geom_type(ShapeType shape) {
  switch (shape) {
    case ShapeType::kPlane:
      return mjGEOM_PLANE;
    case ShapeType::kSphere:
      return mjGEOM_SPHERE;
    case ShapeType::kCapsule:
      return mjGEOM_CAPSULE;
    case ShapeType::kEllipsoid:
      return mjGEOM_ELLIPSOID;
    case ShapeType::kCylinder:
      return mjGEOM_CYLINDER;
    case ShapeType::kBox:
      return mjGEOM_BOX;
    case ShapeType::kMesh:
      return mjGEOM_MESH;
    default:
      return mjGEOM_NONE;
  }
}

class VisualExport {
 public:
  VisualExport(const CompiledWorld& world, const RenderDescription& description,
               const fs::path& folder, mjSpec* spec)
      : world_(world), description_(description), folder_(folder), spec_(spec) {
    for (mjsElement* e = mjs_firstElement(spec, mjOBJ_BODY); e != nullptr;
         e = mjs_nextElement(spec, e))
      bodies_[mjs_getId(e)] = mjs_asBody(e);
  }

  Status add_all() {
    for (const InstanceDescription& instance : description_.instances) {
      if (instance.geom >= 0 || !instance.shown || instance.color_only || instance.motion >= 0 ||
          is_site(instance))
        continue;
      if (geom_type(instance.shape) != mjGEOM_NONE) {
        GLOAM_TRY_STATUS(add(instance));
      }
    }
    return {};
  }
  int count() const { return count_; }
  int pictures() const { return pictures_; }

 private:
  bool is_site(const InstanceDescription& instance) const {
    return world_.scene.render.sites && !instance.label.geom.empty() &&
           mj_name2id(world_.model.get(), mjOBJ_SITE, instance.label.geom.c_str()) >= 0;
  }

  Status add(const InstanceDescription& instance) {
    const auto body = bodies_.find(instance.body);
    if (body == bodies_.end()) return {};
    std::string mesh;
    if (instance.shape == ShapeType::kMesh) {
      GLOAM_TRY(mesh, mesh_of(instance.mesh));
    }
    mjsGeom* geom = edit(mjs_addGeom, body->second, nullptr);
    if (geom == nullptr) return Error{ErrorKind::kUnsupported, "MuJoCo rejects the visual geom"};
    geom->type = geom_type(instance.shape);
    geom->contype = geom->conaffinity = 0;
    geom->group = kExportedGroup;
    geom->mass = 0;
    place(instance, geom);
    const MaterialDescription& material =
        description_.materials[static_cast<size_t>(instance.material)];
    geom->rgba[0] = srgb_encode(material.base_color.x);
    geom->rgba[1] = srgb_encode(material.base_color.y);
    geom->rgba[2] = srgb_encode(material.base_color.z);
    geom->rgba[3] = material.opacity;
    if (!mesh.empty()) edit(mjs_setString, geom->meshname, mesh.c_str());
    const auto textures = material.textures.all();
    if (std::ranges::any_of(textures, [](int row) { return row >= 0; })) ++pictures_;
    ++count_;
    return {};
  }

  static void place(const InstanceDescription& instance, mjsGeom* geom) {
    const Affine3f& X = instance.X_BG;
    const Vec3f x = transform_vector(X, {1, 0, 0}), y = transform_vector(X, {0, 1, 0}),
                z = transform_vector(X, {0, 0, 1}), p = transform_point(X, {0, 0, 0});
    const mjtNum R[9] = {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
    mju_mat2Quat(geom->quat, R);
    const float position[3] = {p.x, p.y, p.z};
    const float size[3] = {instance.size.x, instance.size.y, instance.size.z};
    std::copy_n(position, 3, geom->pos);
    if (instance.shape != ShapeType::kMesh) std::copy_n(size, 3, geom->size);
  }

  // Name in the spec of a mesh, which is written at its first use.
  Result<std::string> mesh_of(int row) {
    const auto [known, is_new] = meshes_.try_emplace(row, fmt::format("visual_{}", row));
    if (!is_new) return known->second;
    const std::string& name = known->second;
    const std::string text = to_obj(description_.meshes[static_cast<size_t>(row)]);
    const std::string file = "assets/" + name + ".obj";
    GLOAM_TRY_STATUS(make_folder(folder_ / "assets"));
    GLOAM_TRY_STATUS(write_file_atomic(
        folder_ / file, {reinterpret_cast<const uint8_t*>(text.data()), text.size()}));
    mjsMesh* mesh = edit(mjs_addMesh, spec_, nullptr);
    edit(mjs_setName, mesh->element, name.c_str());
    edit(mjs_setString, mesh->file, file.c_str());
    mesh->inertia = mjMESH_INERTIA_SHELL;  // plates have no volume
    return name;
  }

  const CompiledWorld& world_;
  const RenderDescription& description_;
  const fs::path& folder_;
  mjSpec* spec_;
  std::map<int, mjsBody*> bodies_;  // by id
  std::map<int, std::string> meshes_;
  int count_ = 0, pictures_ = 0;
};

template <class Option>
void list(std::span<const Option> options, std::string_view table, std::vector<Error>* out) {
  if (options.empty()) return;
  out->push_back({ErrorKind::kUnsupported,
                  fmt::format("{} [[{}]]{} not exported: MJCF cannot represent it", options.size(),
                              table, options.size() == 1 ? " is" : "s are"),
                  options.front().loc});
}

}  // namespace

Result<int> add_visual_geoms(const CompiledWorld& world, const fs::path& folder, mjSpec* spec,
                             std::vector<Error>* left_out) {
  GLOAM_TRY(const RenderDescription description, describe_for_rendering(world));
  left_out->insert(left_out->end(), description.unsupported.begin(), description.unsupported.end());
  VisualExport visuals(world, description, folder, spec);
  GLOAM_TRY_STATUS(visuals.add_all());
  if (visuals.pictures() > 0) {
    left_out->push_back(
        {ErrorKind::kUnsupported,
         fmt::format("{} visual geoms are exported with colours, but without textures",
                     visuals.pictures()),
         {(folder / "scene.xml").string(), 0, 0}});
  }
  return visuals.count();
}

std::vector<Error> list_left_out(const Scene& scene) {
  std::vector<Error> out;
  const auto of = [&](const auto& options, std::string_view table) {
    using Option = typename std::decay_t<decltype(options)>::value_type;
    list(std::span<const Option>(options), table, &out);
  };
  of(scene.lights, "light");
  of(scene.materials, "material");
  of(scene.volumes, "volume");
  of(scene.gases, "gas");
  of(scene.fires, "fire");
  of(scene.smokes, "smoke");
  of(scene.dusts, "dust");
  of(scene.rotors, "rotor");
  of(scene.waters, "water");
  of(scene.soils, "soil");
  of(scene.lidars, "lidar");
  of(scene.pushes, "push");
  const auto one = [&](const auto& table, std::string_view name) {
    if (table)
      out.push_back({ErrorKind::kUnsupported,
                     fmt::format("[{}] is not exported: MJCF cannot represent it", name),
                     table->loc});
  };
  one(scene.sky, "sky");
  one(scene.weather, "weather");
  one(scene.blackout, "blackout");
  return out;
}

}  // namespace gloam

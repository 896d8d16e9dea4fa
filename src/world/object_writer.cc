#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "geometry/convert/convert.h"
#include "gloam/world.h"
#include "scene/spec_geom.h"
#include "scene/validate.h"
#include "world/imported_mesh.h"
#include "world/long_wait.h"
#include "world/mesh_object.h"
#include "world/model_loader.h"

namespace gloam {
namespace {

class ObjectWriter {
 public:
  ObjectWriter(const MeshObject& object, mjSpec* spec)
      : o_(object.options), mesh_(object.mesh), spec_(spec) {}

  Status write(const Converted& converted) {
    if (mjs_findBody(spec_, o_.name.c_str()) != nullptr)
      return Error{ErrorKind::kInput,
                   fmt::format("{}: the environment has a body of that name", title(o_)), o_.loc,
                   "rename the object"};
    mjsBody* body = mjs_addBody(mjs_findBody(spec_, "world"), nullptr);
    name(body->element, o_.name);
    write_pose(o_.X_WO, body->pos, body->quat);
    const double mass = o_.mass.value_or(o_.density * converted.mass.volume);
    if (o_.motion == "dynamic") {
      name(mjs_addFreeJoint(body)->element, o_.name);
      set_inertia(converted.mass, mass, body);
      if (mass < mjMINVAL || *std::min_element(body->inertia, body->inertia + 3) < mjMINVAL)
        return Error{ErrorKind::kInput,
                     fmt::format("{} weighs {:.2g} kg and is {:.2g} m large: too light to move",
                                 title(o_), mass, 2.0 * max_component(half_extents(mesh_))),
                     o_.loc,
                     "say in 'unit' how many metres one unit of the file is, or give motion = "
                     "\"static\""};
    }
    body->mocap = o_.motion == "mocap";
    double volume = 0;
    for (const MeshCollider& c : converted.colliders) volume += volume_of(c);
    int number = 0;
    for (const MeshCollider& c : converted.colliders)
      add_collider(c, ++number, mass * volume_of(c) / volume, body);
    return {};
  }

 private:
  static void name(mjsElement* element, const std::string& text) {
    mjs_setName(element, text.c_str());
  }

  static void set_inertia(const MassProperties& m, double mass, mjsBody* body) {
    const double per_volume = mass / m.volume;
    const auto& i = m.inertia;
    double full[9] = {i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2]}, axes[9], q[4];
    for (double& value : full) value *= per_volume;
    mju_eig3(body->inertia, axes, q, full);
    write_pose({{m.center.x, m.center.y, m.center.z}, {q[0], q[1], q[2], q[3]}}, body->ipos,
               body->iquat);
    body->mass = mass;
    body->explicitinertial = 1;
  }

  void add_collider(const MeshCollider& c, int number, double mass, mjsBody* body) {
    mjsGeom* geom = add_collider_geom(body, fmt::format("{}/collider_{}", o_.name, number));
    if (c.type == MeshColliderType::kHull) {
      const std::string mesh = fmt::format("{}/hull_{}", o_.name, number);
      add_mesh(mesh, c.hull);
      geom->type = mjGEOM_MESH;
      mjs_setString(geom->meshname, mesh.c_str());
    } else {
      constexpr mjtGeom kTypes[] = {mjGEOM_BOX, mjGEOM_SPHERE, mjGEOM_CYLINDER, mjGEOM_CAPSULE};
      geom->type = kTypes[static_cast<size_t>(c.type)];
      const double size[3] = {c.size.x, c.size.y, c.size.z};
      std::copy(size, size + 3, geom->size);
      const Vec3d& p = c.X_MG.p;
      write_pose({{p.x, p.y, p.z}, quaternion_of(c.X_MG)}, geom->pos, geom->quat);
    }
    geom->mass = mass;  // only where a model wants it from geoms (inertiafromgeom)
    write_friction(o_.friction, geom);
  }

  void add_mesh(const std::string& mesh_name, const TriangleMesh& hull) {
    mjsMesh* mesh = mjs_addMesh(spec_, nullptr);
    name(mesh->element, mesh_name);
    mesh->inertia = mjMESH_INERTIA_SHELL;  // small hulls have too little volume for MuJoCo
    mjs_setFloat(mesh->uservert, &hull.positions[0].x, static_cast<int>(3 * hull.positions.size()));
    const std::vector<int> faces(hull.indices.begin(), hull.indices.end());
    mjs_setInt(mesh->userface, faces.data(), static_cast<int>(faces.size()));
  }

  const ObjectOptions& o_;
  const TriangleMesh& mesh_;
  mjSpec* spec_;
};

}  // namespace

Result<ObjectReport> convert_object(const ObjectOptions& options, const FileAccess& access) {
  Scene scene;
  scene.access = access;
  scene.objects = {options};
  GLOAM_TRY_STATUS(validate_scene(scene));
  GLOAM_TRY(const MeshObjects loaded, load_mesh_objects(scene));
  const TriangleMesh& mesh = loaded.objects[0].mesh;
  const auto start = std::chrono::steady_clock::now();
  const LongWait wait(fmt::format("making '{}' physical", options.name), 0);
  const Result<Converted> converted =
      convert_mesh(mesh, {options.colliders, options.concavity, options.max_hulls});
  if (!converted.ok()) return said_of(title(options), options.loc, converted.error());
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  const Overlap overlap = overlap_of(*converted);
  const Vec3f half = half_extents(mesh);
  ObjectReport out;
  for (const MeshCollider& c : converted->colliders) out.colliders.emplace_back(word_of(c.type));
  out.triangles = mesh.triangle_count();
  out.is_closed = converted->is_closed;
  out.size = {2.0 * half.x, 2.0 * half.y, 2.0 * half.z};
  out.volume = converted->mass.volume;
  out.mass = options.mass.value_or(options.density * out.volume);
  out.shared = overlap.shared;
  out.mean_distance = overlap.mean_distance;
  out.max_distance = overlap.max_distance;
  out.seconds = passed.count();
  for (const Error& note : loaded.notes) out.notes.push_back(note.message + ": " + note.hint);
  for (const std::string& note : converted->notes) out.notes.push_back("the mesh " + note);
  return out;
}

Status add_objects(const MeshObjects& objects, mjSpec* spec, std::vector<Error>* unsupported) {
  unsupported->insert(unsupported->end(), objects.notes.begin(), objects.notes.end());
  for (const MeshObject& object : objects.objects) {
    const ObjectOptions& o = object.options;
    const LongWait wait(fmt::format("making '{}' physical", o.name), 0);
    const Result<Converted> converted =
        convert_mesh(object.mesh, {o.colliders, o.concavity, o.max_hulls});
    if (!converted.ok()) return said_of(title(o), o.loc, converted.error());
    for (const std::string& note : converted->notes)
      if (o.motion == "dynamic" || !note.starts_with("is open"))
        unsupported->push_back({ErrorKind::kInput, fmt::format("{} {}", title(o), note), o.loc});
    GLOAM_TRY_STATUS(ObjectWriter(object, spec).write(*converted));
  }
  return {};
}

}  // namespace gloam

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "geometry/convert/convert.h"
#include "geometry/convert/decompose.h"
#include "gloam/world.h"
#include "places/writer/spec_edit.h"
#include "places/writer/spec_geom.h"
#include "scene/validate/validate.h"
#include "world/compile/mesh_object.h"
#include "world/compile/model_loader.h"
#include "world/compile/progress/compile_progress.h"
#include "world/compile/progress/long_wait.h"
#include "world/shapes/imported_mesh.h"

namespace gloam {
namespace {

class ObjectWriter {
 public:
  ObjectWriter(const MeshObject& object, mjSpec* spec)
      : o_(object.options), mesh_(object.mesh), spec_(spec) {}

  Status write(const Converted& converted) {
    for (const auto& [type, word] :
         {std::pair(mjOBJ_BODY, "body"), std::pair(mjOBJ_JOINT, "joint")})
      if (mjs_findElement(spec_, type, o_.name.c_str()) != nullptr)
        return Error{
            ErrorKind::kInput,
            fmt::format("{}: the environment already has a {} of that name", title(o_), word),
            o_.loc, "rename the object"};
    mjsBody* body = edit(mjs_addBody, mjs_findBody(spec_, "world"), nullptr);
    name(body->element, o_.name);
    write_pose(o_.X_WO, body->pos, body->quat);
    const double mass = o_.mass.value_or(o_.density * converted.mass.volume);
    if (o_.motion == "dynamic") {
      name(edit(mjs_addFreeJoint, body)->element, o_.name);
      set_inertia(converted.mass, mass, body);
      if (mass < mjMINVAL || *std::min_element(body->inertia, body->inertia + 3) < mjMINVAL)
        return Error{
            ErrorKind::kInput,
            fmt::format("{} has a mass of {:.2g} kg and a size of {:.2g} m: too light to move",
                        title(o_), mass, 2.0 * max_component(half_extents(mesh_))),
            o_.loc,
            "set 'unit' to the length of one unit of the file in metres, or set motion = "
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
    edit(mjs_setName, element, text.c_str());
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
    mjsGeom* geom =
        add_collider_geom(body, fmt::format("{}/collider_{}", o_.name, number), nullptr);
    if (c.type == MeshColliderType::kHull) {
      const std::string mesh = add_mesh(fmt::format("{}/hull_{}", o_.name, number), c.hull);
      geom->type = mjGEOM_MESH;
      edit(mjs_setString, geom->meshname, mesh.c_str());
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

  std::string add_mesh(const std::string& mesh_name, const TriangleMesh& hull) {
    mjsMesh* mesh = edit(mjs_addMesh, spec_, own_defaults());
    std::string written = set_free_name(mesh->element, mesh_name);
    mesh->inertia = mjMESH_INERTIA_SHELL;  // small hulls have too little volume for MuJoCo
    edit(mjs_setFloat, mesh->uservert, &hull.positions[0].x,
         static_cast<int>(3 * hull.positions.size()));
    const std::vector<int> faces(hull.indices.begin(), hull.indices.end());
    edit(mjs_setInt, mesh->userface, faces.data(), static_cast<int>(faces.size()));
    return written;
  }

  const ObjectOptions& o_;
  const TriangleMesh& mesh_;
  mjSpec* spec_;
};

// About how long CoACD takes [s], for the display alone: a search for every cut, of which a finer
// concavity asks more. A rough guess: 37 s for a cup that was seen to take 53 s.
double expected_seconds(const MeshObject& object) {
  if (object.options.colliders != "hulls" && object.options.colliders != "auto") return 0;
  constexpr double kLeast = 8, kPerTriangle = 1e-3, kUsual = 0.05, kPower = 0.9;
  const double triangles =
      std::min(static_cast<double>(object.mesh.triangle_count()), double{kMostDecomposed});
  return (kLeast + kPerTriangle * triangles) * std::pow(kUsual / object.options.concavity, kPower);
}

// Logs the conversion if there is no progress callback.
class ConvertWatch {
 public:
  ConvertWatch(const MeshObjects& objects, CompileProgress* progress) {
    const std::vector<MeshObject>& all = objects.objects;
    const std::string what = all.size() == 1
                                 ? fmt::format("building colliders for '{}'", all[0].options.name)
                                 : fmt::format("building colliders for {} meshes", all.size());
    double expected = 0;  // CoACD takes one mesh at a time
    for (const MeshObject& object : all) expected += expected_seconds(object);
    if (progress != nullptr) progress->begin(what, kConvertWeight, expected);
    if (progress == nullptr || !progress->is_watched()) wait_.emplace(what, expected);
  }

 private:
  std::optional<LongWait> wait_;
};

std::string title_of(const MeshObject& object) {
  if (!object.is_place) return title(object.options);
  return fmt::format("environment: node '{}'", object.options.name);
}

// About, in no unit. CoACD's time grows with the triangles that it is given.
double cost_of(const MeshObject& object) {
  constexpr double kLeast = 200, kMost = 20'000;
  return kLeast + std::min(static_cast<double>(object.mesh.triangle_count()), kMost);
}

Result<Converted> convert_one(const MeshObject& object, CompileProgress* progress) {
  const ObjectOptions& o = object.options;
  Result<Converted> converted = convert_mesh(
      object.mesh, {.colliders = o.colliders,
                    .concavity = o.concavity,
                    .max_hulls = o.max_hulls,
                    .may_be_room = object.is_place,
                    .is_cancelled = progress == nullptr ? nullptr : &progress->is_cancelled()});
  if (converted.ok() || converted.error().kind == ErrorKind::kInterrupted) return converted;
  return said_of(title_of(object), o.loc, converted.error());
}

}  // namespace

Result<ObjectReport> convert_object(const ObjectOptions& options, const FileAccess& access,
                                    const ProgressCallback& callback) {
  Scene scene;
  scene.access = access;
  scene.objects = {options};
  GLOAM_TRY_STATUS(validate_scene(scene));
  CompileProgress progress(callback, kReadWeight + kConvertWeight);
  progress.begin("reading model files", kReadWeight);
  GLOAM_TRY(const MeshObjects loaded, load_mesh_objects(scene, &progress));
  const TriangleMesh& mesh = loaded.objects[0].mesh;
  const auto start = std::chrono::steady_clock::now();
  Result<Converted> converted = Error{};
  {
    const ConvertWatch watch(loaded, &progress);
    converted = convert_one(loaded.objects[0], &progress);
  }
  if (!converted.ok()) return converted.error();
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
  progress.finish();
  return out;
}

Result<std::vector<Converted>> convert_objects(const MeshObjects& objects,
                                               CompileProgress* progress) {
  const std::vector<MeshObject>& all = objects.objects;
  if (all.empty()) return std::vector<Converted>();
  const ConvertWatch watch(objects, progress);
  // Large objects come first, so that none of them is left for the end. Progress counts their
  // costs.
  std::vector<size_t> order(all.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return cost_of(all[a]) > cost_of(all[b]); });
  double cost = 0;
  for (const MeshObject& object : all) cost += cost_of(object);
  std::mutex mutex;
  double done = 0;
  std::vector<std::optional<Result<Converted>>> made(all.size());
  parallel_for("convert meshes", static_cast<int64_t>(all.size()), [&](int64_t i) {
    const size_t k = order[static_cast<size_t>(i)];
    if (progress != nullptr && progress->is_cancelled()) return;
    made[k] = convert_one(all[k], progress);
    if (made[k]->ok()) made[k]->value().mesh = {};
    const std::lock_guard lock(mutex);
    done += cost_of(all[k]) / cost;
    if (progress != nullptr) progress->report(done);
  });
  if (progress != nullptr) GLOAM_TRY_STATUS(progress->check());
  std::vector<Converted> out;
  for (std::optional<Result<Converted>>& one : made) {
    if (!one->ok()) return one->error();
    out.push_back(std::move(*one).value());
  }
  return out;
}

Status add_objects(const MeshObjects& objects, const std::vector<Converted>& converted,
                   mjSpec* spec, std::vector<Error>* notes) {
  notes->insert(notes->end(), objects.notes.begin(), objects.notes.end());
  for (size_t i = 0; i < objects.objects.size(); ++i) {
    const ObjectOptions& o = objects.objects[i].options;
    for (const std::string& note : converted[i].notes)
      if (o.motion == "dynamic" || !note.ends_with("its hull's"))  // static objects have no weight
        notes->push_back(
            {ErrorKind::kInput, fmt::format("{} {}", title_of(objects.objects[i]), note), o.loc});
    GLOAM_TRY_STATUS(ObjectWriter(objects.objects[i], spec).write(converted[i]));
  }
  return {};
}

}  // namespace gloam

#include "world/mesh_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "base/archive.h"
#include "base/hash.h"
#include "base/text.h"
#include "geometry/convert/convert.h"
#include "gloam/world.h"
#include "scene/environment/place_writer.h"
#include "world/file_axes.h"
#include "world/imported_mesh.h"
#include "world/long_wait.h"
#include "world/model_loader.h"

namespace gloam {
namespace {

constexpr double kHuge = 100, kTiny = 1e-3, kHugePlace = 10'000;  // [m]
constexpr int kColliderGroup = 3;

std::string title(const ObjectOptions& o) { return fmt::format("object '{}'", o.name); }

Error located(const Error& error, const ObjectOptions& o) {
  return {error.kind, fmt::format("{}: {}", title(o), error.message), o.loc, error.hint};
}

bool is_place(const EnvironmentOptions& e) { return is_model_file(e.file); }

std::string node_name(const ModelFile& model, size_t part) {
  const std::string& own = model.instances[part].name;
  return own.empty() ? fmt::format("node_{}", part + 1) : own;
}

/// Parts of the nodes, in the order of the file. A node of several materials is several parts at
/// one place.
struct Node {
  std::string name;
  std::vector<int> parts;
};
std::vector<Node> nodes_of(const ModelFile& model) {
  const auto same_place = [](const Affine3f& a, const Affine3f& b) {
    return (a.x == b.x) & (a.y == b.y) & (a.z == b.z) & (a.p == b.p);
  };
  std::vector<Node> nodes;
  std::map<std::string, std::vector<size_t>> known;
  for (size_t i = 0; i < model.instances.size(); ++i) {
    const ImportedInstance& in = model.instances[i];
    if (model.meshes[static_cast<size_t>(in.mesh)].indices.empty()) continue;
    std::vector<size_t>& same = known[node_name(model, i)];
    const auto node = std::find_if(same.begin(), same.end(), [&](size_t n) {
      return same_place(model.instances[static_cast<size_t>(nodes[n].parts[0])].X_FI, in.X_FI);
    });
    if (node != same.end()) {
      nodes[*node].parts.push_back(static_cast<int>(i));
    } else {
      same.push_back(nodes.size());
      nodes.push_back({node_name(model, i), {static_cast<int>(i)}});
    }
  }
  return nodes;
}

void append(const ModelFile& model, int part, const Affine3f& X_BF, TriangleMesh* out) {
  const ImportedInstance& in = model.instances[static_cast<size_t>(part)];
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
  explicit ObjectLoader(const Scene& scene) : scene_(scene) {}

  Result<MeshObjects> load() {
    if (scene_.objects.empty() && !is_place(scene_.environment)) return MeshObjects{};
    std::vector<FileUse> uses;
    for (const ObjectOptions& o : scene_.objects) uses.push_back({o.file, title(o), o.loc});
    const EnvironmentOptions& place = scene_.environment;
    if (is_place(place)) uses.push_back({place.file, "environment", place.loc});
    GLOAM_TRY(files_, load_model_files(scene_, uses));
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
    MeshObject object{options, {}, {}};
    std::vector<std::string> names;
    bool is_found = options.node.empty();
    for (Node& node : nodes_of(model)) {
      names.push_back(node.name);
      if (is_found || node.name != options.node) continue;
      object.parts = std::move(node.parts);
      is_found = true;
    }
    if (!is_found)
      return Error{ErrorKind::kInput,
                   fmt::format("{}: '{}' has no node '{}' with a mesh", title(options),
                               options.file.filename().string(), options.node),
                   options.loc, suggest_name(options.node, names)};
    if (names.empty())
      return Error{ErrorKind::kInput,
                   fmt::format("{}: '{}' has no triangles", title(options),
                               options.file.filename().string()),
                   options.loc};
    add(std::move(object), model);
    const double size = 2.0 * max_component(half_extents(out_.objects.back().mesh));
    if (size > kHuge || size < kTiny) note_size(title(options), size, options.loc);
    return {};
  }

  void note_size(const std::string& what, double size, const SourceLoc& loc) {
    out_.notes.push_back({ErrorKind::kInput, fmt::format("{} is {:.3g} m large", what, size), loc,
                          "say in 'unit' how many metres one unit of the file is: 0.001 for "
                          "millimetres"});
  }

  Status add_place(const EnvironmentOptions& place) {
    const ModelFile& model = file_of(place.file);
    std::set<std::string> taken;
    for (const ObjectOptions& o : scene_.objects) taken.insert(o.name);
    for (const PropOptions& p : scene_.props) taken.insert(p.name);
    for (const RobotOptions& r : scene_.robots) taken.insert(r.name);
    for (const VisualOptions& v : scene_.visuals)
      if (v.file != place.file) taken.insert(v.name);
    taken.insert("world");
    TriangleMesh corners;
    for (const Node& node : nodes_of(model)) {
      ObjectOptions options;
      std::string name = node.name;
      std::replace(name.begin(), name.end(), '/', '_');
      options.name = name;
      for (int i = 2; !taken.insert(options.name).second; ++i)
        options.name = fmt::format("{}_{}", name, i);
      if (options.name != node.name)
        out_.notes.push_back(
            {ErrorKind::kInput,
             fmt::format("environment: node '{}' is called '{}' here", node.name, options.name),
             place.loc});
      options.file = place.file;
      options.node = node.name;
      options.up = place.up;
      options.unit = place.unit;
      options.colliders = place.colliders;
      options.motion = "static";
      options.loc = place.loc;
      add({options, node.parts, {}}, model);
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

  void add(MeshObject object, const ModelFile& model) {
    const ObjectOptions& o = object.options;
    const Affine3f X_BF = file_axes(o.scale, o.unit, o.up, model.was_y_up);
    if (object.parts.empty())
      for (size_t i = 0; i < model.instances.size(); ++i)
        append(model, static_cast<int>(i), X_BF, &object.mesh);
    for (const int part : object.parts) append(model, part, X_BF, &object.mesh);
    out_.objects.push_back(std::move(object));
  }

  uint64_t hash() const {
    uint64_t hash = 1;
    for (const MeshObject& object : out_.objects) {
      const ObjectOptions& o = object.options;
      ArchiveWriter key;
      key(o.name), key(o.X_WO), key(o.motion), key(o.density), key(o.mass.value_or(0));
      key(o.colliders), key(o.concavity), key(o.max_hulls);
      key(o.friction.has_value()), key(o.friction.value_or(Vec3{}));
      key(o.loc.line);  // stands in cached messages
      hash = hash_bytes(key.bytes.data(), key.bytes.size(), hash);
      hash = hash_span(std::span<const Vec3f>(object.mesh.positions), hash);
      hash = hash_span(std::span<const uint32_t>(object.mesh.indices), hash);
    }
    return hash;
  }

  const Scene& scene_;
  std::vector<LoadedModel> files_;
  MeshObjects out_;
};

class ObjectWriter {
 public:
  ObjectWriter(const MeshObject& object, mjSpec* spec) : o_(object.options), spec_(spec) {}

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
    mjsGeom* geom = mjs_addGeom(body, nullptr);
    name(geom->element, fmt::format("{}/collider_{}", o_.name, number));
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
    geom->group = kColliderGroup;
    geom->mass = mass;  // only where a model wants it from geoms (inertiafromgeom)
    if (o_.friction) {
      const double friction[3] = {o_.friction->x, o_.friction->y, o_.friction->z};
      std::copy(friction, friction + 3, geom->friction);
    }
    geom->rgba[0] = 0.3f, geom->rgba[1] = 0.6f, geom->rgba[2] = 0.9f, geom->rgba[3] = 0.3f;
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
  mjSpec* spec_;
};

}  // namespace

Result<MeshObjects> load_mesh_objects(const Scene& scene) { return ObjectLoader(scene).load(); }

Result<ObjectReport> convert_object(const ObjectOptions& options, const FileAccess& access) {
  Scene scene;
  scene.access = access;
  scene.objects = {options};
  GLOAM_TRY(const MeshObjects loaded, load_mesh_objects(scene));
  const TriangleMesh& mesh = loaded.objects[0].mesh;
  const auto start = std::chrono::steady_clock::now();
  const LongWait wait(fmt::format("making '{}' physical", options.name), 0);
  const Result<Converted> converted =
      convert_mesh(mesh, {options.colliders, options.concavity, options.max_hulls});
  if (!converted.ok()) return located(converted.error(), options);
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

Status add_object_visuals(const MeshObjects& objects, Scene* scene) {
  for (const MeshObject& object : objects.objects) {
    const ObjectOptions& o = object.options;
    VisualOptions visual{.name = o.name,
                         .file = o.file,
                         .body = o.name,
                         .scale = o.scale,
                         .up = o.up,
                         .unit = o.unit,
                         .parts = object.parts,
                         .loc = o.loc};
    const auto same = std::find_if(scene->visuals.begin(), scene->visuals.end(),
                                   [&](const VisualOptions& v) { return v.name == o.name; });
    if (same == scene->visuals.end())
      scene->visuals.push_back(std::move(visual));
    else if (same->file != o.file || same->body != o.name)  // else: the scene was compiled before
      return Error{ErrorKind::kInput,
                   fmt::format("{} and visual '{}' have the same name", title(o), same->name),
                   o.loc, "rename one of them"};
  }
  return {};
}

Status add_objects(const MeshObjects& objects, mjSpec* spec, std::vector<Error>* unsupported) {
  unsupported->insert(unsupported->end(), objects.notes.begin(), objects.notes.end());
  for (const MeshObject& object : objects.objects) {
    const ObjectOptions& o = object.options;
    const LongWait wait(fmt::format("making '{}' physical", o.name), 0);
    const Result<Converted> converted =
        convert_mesh(object.mesh, {o.colliders, o.concavity, o.max_hulls});
    if (!converted.ok()) return located(converted.error(), o);
    for (const std::string& note : converted->notes)
      if (o.motion == "dynamic" || !note.starts_with("is open"))
        unsupported->push_back({ErrorKind::kInput, fmt::format("{} {}", title(o), note), o.loc});
    GLOAM_TRY_STATUS(ObjectWriter(object, spec).write(*converted));
  }
  return {};
}

}  // namespace gloam

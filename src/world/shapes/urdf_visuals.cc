#include "world/shapes/urdf_visuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "base/parallel.h"
#include "scene/files/mujoco_compiles.h"
#include "scene/files/mujoco_guard.h"
#include "scene/files/urdf_text.h"
#include "world/compile/model_loader.h"
#include "world/model_memory.h"
#include "world/model_names.h"
#include "world/world.h"

namespace gloam {
namespace {

struct UrdfRobot {
  std::string file;
  std::string prefix;
  Pose X_WR;
  UrdfText text;
};

// The level's URDF robots that have visuals of their own.
std::vector<UrdfRobot> find_robots(const Scene& scene, ModelFiles* files,
                                   std::vector<Error>* unsupported) {
  std::vector<UrdfRobot> robots;
  const auto add = [&](const std::filesystem::path& file, const std::string& prefix,
                       const Pose& X_WR) {
    const std::string path = absolute_path(file, "").string();
    if (files->root_element(path) != "robot") return;
    const Result<UrdfText> urdf =
        prepare_urdf(files->text(path), path, scene.access,
                     [&](const std::filesystem::path& mesh) { return files->readable(mesh); });
    if (!urdf.ok()) return;  // the physics model has reported this error already
    unsupported->insert(unsupported->end(), urdf->unsupported.begin(), urdf->unsupported.end());
    if (!urdf->visual.empty()) robots.push_back({path, prefix, X_WR, *urdf});
  };
  if (!scene.bare_model.empty()) add(scene.bare_model, "", {});
  for (const RobotOptions& robot : scene.robots) add(robot.file, robot.name + "/", robot.X_WR);
  return robots;
}

Result<ModelPtr> compile_visuals(const std::vector<UrdfRobot>& robots, ModelFiles* files) {
  const SpecPtr base(mj_makeSpec());
  const MujocoWarningCapture warnings;
  for (const UrdfRobot& robot : robots) {
    files->forget_failures();
    files->set_overlay(robot.file, robot.text.visual);
    char message[2048] = "";
    mjSpec* spec = nullptr;
    const Status parsed = guarded(
        [&] { spec = mj_parseXML(robot.file.c_str(), files->vfs(), message, sizeof(message)); });
    files->clear_overlay(robot.file);
    const SpecPtr child(spec);
    if (!parsed.ok()) return files->explain(parsed.error().message, robot.file);
    if (spec == nullptr) return files->explain(message, robot.file);
    mjsElement* attached = nullptr;
    const Status joined = guarded([&] {
      mjsFrame* frame = mjs_addFrame(mjs_findBody(base.get(), "world"), nullptr);
      const double p[3] = {robot.X_WR.p.x, robot.X_WR.p.y, robot.X_WR.p.z};
      const double q[4] = {robot.X_WR.q.w, robot.X_WR.q.x, robot.X_WR.q.y, robot.X_WR.q.z};
      std::copy(p, p + 3, frame->pos);
      std::copy(q, q + 4, frame->quat);
      attached = mjs_attach(frame->element, spec->element, robot.prefix.c_str(), "");
    });
    if (!joined.ok() || attached == nullptr)
      return files->explain(mjs_getError(base.get()), robot.file);
  }
  mjModel* model = nullptr;
  mjSpec* spec = base.get();
  const mjVFS* vfs = files->vfs();
  const MujocoCompiles threads;
  const Status compiled = guarded([&] { model = mj_compile(spec, vfs); });
  if (!compiled.ok()) return files->explain(compiled.error().message, robots[0].file);
  if (model == nullptr) return files->explain(mjs_getError(spec), robots[0].file);
  return ModelPtr(model);
}

// Both models stand at qpos0, and between a link and the body that it was fused into nothing moves:
// the pose of the geom in that body is the same at every instant.
std::vector<VisualOnlyGeom> place_geoms(const mjModel* visual, const mjModel* physics) {
  const DataPtr visual_data = make_data(*visual), physics_data = make_data(*physics);
  mj_kinematics(visual, visual_data.get());
  mj_kinematics(physics, physics_data.get());
  std::vector<VisualOnlyGeom> geoms;
  for (int geom = 0; geom < visual->ngeom; ++geom) {
    int link = visual->geom_bodyid[geom], body = -1;
    for (; link > 0 && body < 0; link = visual->body_parentid[link]) {
      const char* name = mj_id2name(visual, mjOBJ_BODY, link);
      body = name != nullptr ? mj_name2id(physics, mjOBJ_BODY, name) : -1;
    }
    body = std::max(body, 0);
    const double* q_WB = physics_data->xquat + 4 * body;
    double q_BW[4], q_WG[4], q_BG[4], p_BG_W[3], p_BG[3];
    mju_negQuat(q_BW, q_WB);
    mju_mat2Quat(q_WG, visual_data->geom_xmat + 9 * geom);
    mju_mulQuat(q_BG, q_BW, q_WG);
    mju_sub3(p_BG_W, visual_data->geom_xpos + 3 * geom, physics_data->xpos + 3 * body);
    mju_rotVecQuat(p_BG, p_BG_W, q_BW);
    geoms.push_back(
        {body, geom, {{p_BG[0], p_BG[1], p_BG[2]}, {q_BG[0], q_BG[1], q_BG[2], q_BG[3]}}});
  }
  return geoms;
}

bool draws_something(const ModelFile& model) {
  return std::any_of(model.instances.begin(), model.instances.end(),
                     [&](const ImportedInstance& in) {
                       return !model.meshes[static_cast<size_t>(in.mesh)].indices.empty();
                     });
}

// Meshes by the name of the sphere that stands in for each. Unreadable files are reported.
std::map<std::string, VisualOnlyMesh> find_meshes(const Scene& scene,
                                                  const std::vector<UrdfRobot>& robots,
                                                  std::vector<Error>* unsupported) {
  std::map<std::string, VisualOnlyMesh> meshes;
  std::map<std::filesystem::path, std::pair<const UrdfVisualMesh*, std::optional<Error>>> files;
  for (const UrdfRobot& robot : robots)
    for (const UrdfVisualMesh& mesh : robot.text.visual_meshes)
      files.try_emplace(mesh.file, &mesh, std::nullopt);
  std::vector<decltype(files)::value_type*> list;
  for (auto& file : files) list.push_back(&file);
  parallel_for("visual meshes", static_cast<int64_t>(list.size()), [&](int64_t i) {
    auto& [path, use] = *list[static_cast<size_t>(i)];
    const Result<ModelFile> model = load_model_file(
        scene, path, fmt::format("the visual mesh '{:.200}' is not drawn", path.string()),
        use.first->loc);
    if (!model.ok()) {
      use.second = model.error();
    } else if (!draws_something(*model)) {
      use.second =
          Error{ErrorKind::kUnsupported,
                fmt::format("the visual mesh '{:.200}' has no triangles to draw", path.string()),
                use.first->loc};
    }
  });
  for (const auto* file : list)
    if (file->second.second) unsupported->push_back(*file->second.second);
  for (const UrdfRobot& robot : robots)
    for (const UrdfVisualMesh& m : robot.text.visual_meshes)
      if (!files.at(m.file).second.has_value())
        meshes.emplace(robot.prefix + m.stand_in,
                       VisualOnlyMesh{robot.prefix + m.link, m.name, m.file, m.scale, m.loc});
  return meshes;
}

// Stand-ins of meshes get their row, those of meshes that cannot be read are taken out.
void bind_meshes(const std::map<std::string, VisualOnlyMesh>& meshes,
                 const std::set<std::string>& stand_ins, CompiledWorld* world) {
  std::vector<VisualOnlyGeom> kept;
  for (VisualOnlyGeom geom : world->visual_only) {
    const std::string name = name_of(*world->visual_model, mjOBJ_GEOM, geom.geom);
    if (const auto mesh = meshes.find(name); mesh != meshes.end()) {
      geom.mesh = static_cast<int>(world->visual_meshes.size());
      world->visual_meshes.push_back(mesh->second);
    } else if (stand_ins.contains(name)) {
      continue;
    }
    kept.push_back(geom);
  }
  world->visual_only = std::move(kept);
}

}  // namespace

void add_urdf_visuals(const Scene& scene, ModelFiles* files, CompiledWorld* world) {
  const std::vector<UrdfRobot> robots = find_robots(scene, files, &world->unsupported);
  if (robots.empty()) return;
  Result<ModelPtr> visual = compile_visuals(robots, files);
  if (!visual.ok()) {
    Error error = visual.error();
    error.kind = ErrorKind::kUnsupported;
    error.message = "the visuals are not drawn: " + error.message;
    world->unsupported.push_back(std::move(error));
    return;
  }
  world->visual_model = std::move(visual).value();
  world->visual_only = place_geoms(world->visual_model.get(), world->model.get());
  std::set<std::string> stand_ins;
  for (const UrdfRobot& robot : robots)
    for (const UrdfVisualMesh& mesh : robot.text.visual_meshes)
      stand_ins.insert(robot.prefix + mesh.stand_in);
  bind_meshes(find_meshes(scene, robots, &world->unsupported), stand_ins, world);
}

}  // namespace gloam

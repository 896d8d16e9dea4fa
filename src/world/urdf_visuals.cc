#include "world/urdf_visuals.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/mujoco_guard.h"
#include "scene/urdf_text.h"
#include "world/world.h"

namespace gloam {
namespace {

struct UrdfRobot {
  std::string file;
  std::string prefix;
  Pose X_WR;
  std::string visual_text;
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
    if (!urdf.ok()) return;  // the physics model has met this error already
    unsupported->insert(unsupported->end(), urdf->unsupported.begin(), urdf->unsupported.end());
    if (!urdf->visual.empty()) robots.push_back({path, prefix, X_WR, urdf->visual});
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
    files->set_overlay(robot.file, robot.visual_text);
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
  const Status compiled = guarded([&] { model = mj_compile(spec, vfs); });
  if (!compiled.ok()) return files->explain(compiled.error().message, robots[0].file);
  if (model == nullptr) return files->explain(mjs_getError(spec), robots[0].file);
  return ModelPtr(model);
}

// Both models stand at qpos0, and between a link and the body that it was fused into nothing moves:
// the pose of the geom in that body is the same at every instant.
std::vector<VisualOnlyGeom> place_geoms(const mjModel* visual, const mjModel* physics) {
  const DataPtr visual_data(mj_makeData(visual)), physics_data(mj_makeData(physics));
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
}

}  // namespace gloam

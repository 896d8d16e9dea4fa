#include "world/compile/level.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "base/check.h"
#include "base/text.h"
#include "geometry/mesh/model_file.h"
#include "places/generators.h"
#include "places/writer/place_writer.h"
#include "places/writer/spec_edit.h"
#include "scene/files/mujoco_compiles.h"
#include "scene/files/mujoco_guard.h"
#include "scene/files/mujoco_plugins.h"
#include "scene/files/urdf_text.h"
#include "scene/overrides.h"
#include "world/compile/agent_writer.h"
#include "world/compile/compiler_options.h"
#include "world/compile/finite_model.h"
#include "world/compile/level_cameras.h"
#include "world/compile/level_keyframe.h"
#include "world/compile/mesh_copy.h"
#include "world/compile/mesh_object.h"
#include "world/compile/progress/compile_progress.h"
#include "world/compile/progress/endless_compile.h"
#include "world/compile/progress/long_wait.h"
#include "world/compile/sampled_ground.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

// Strings cross into MuJoCo by its C functions only: the wheel is built with another standard
// library, whose std::string has another layout than mjString's declaration says here.
void set_name(mjsElement* element, const std::string& name) {
  edit(mjs_setName, element, name.c_str());
}

// Several robots may be of one file.
void add_once(const Error& note, std::vector<Error>* notes) {
  const bool is_known = std::any_of(notes->begin(), notes->end(), [&](const Error& known) {
    return known.message == note.message && known.loc.file == note.loc.file;
  });
  if (!is_known) notes->push_back(note);
}

// Reports warnings of MuJoCo's parser and compiler ("<mimic> on joint 'x' ignored"): those of its
// log, and those after the first `known` of the spec.
void report_warnings(const MujocoWarningCapture& warnings, const mjSpec* spec, int known,
                     const fs::path& file, std::vector<Error>* notes) {
  std::vector<std::string> messages = warnings.messages();
  for (int i = known; i < mjs_numWarnings(spec); ++i)
    messages.emplace_back(mjs_getWarning(spec, i));
  for (const std::string& message : messages) {
    std::string line = "MuJoCo: " + message.substr(0, message.find('\n'));
    const bool is_known = std::any_of(notes->begin(), notes->end(),
                                      [&](const Error& e) { return e.message == line; });
    if (!is_known) notes->push_back({ErrorKind::kInput, std::move(line), {file.string(), 0, 0}});
  }
}

// Reports that MuJoCo is working, in the log if there is no progress callback. MuJoCo cannot be
// interrupted.
class ModelWatch {
 public:
  ModelWatch(std::string what, double weight, double expected, CompileProgress* progress) {
    if (progress != nullptr) progress->begin(what, weight, expected);
    if (progress == nullptr || !progress->is_watched()) wait_.emplace(std::move(what), expected);
  }

 private:
  std::optional<LongWait> wait_;
};

Result<SpecPtr> parse_model(const fs::path& file, const FileAccess& access, ModelFiles* files,
                            std::vector<Error>* notes, CompileProgress* progress) {
  if (progress != nullptr) GLOAM_TRY_STATUS(progress->check());
  const std::string path = absolute_path(file, "").string();
  if (files->root_element(path) == "robot") {
    GLOAM_TRY(const UrdfText urdf,
              prepare_urdf(files->text(path), path, access,
                           [&](const fs::path& mesh) { return files->readable(mesh); }));
    for (const Error& note : urdf.notes) add_once(note, notes);
    if (!urdf.physics.empty()) files->set_overlay(path, urdf.physics);
    GLOAM_TRY_STATUS(add_mesh_copies(urdf.copies, files));
  }
  char message[2048] = "";
  mjSpec* spec = nullptr;
  files->forget_failures();
  const MujocoWarningCapture warnings;
  const ModelWatch watch(fmt::format("loading {} in MuJoCo", file.filename().string()), 0,
                         files->slowest_replicate(), progress);
  const Status status =
      guarded([&] { spec = mj_parseXML(path.c_str(), files->vfs(), message, sizeof(message)); });
  if (!status.ok()) return files->explain(status.error().message, path);
  if (spec == nullptr) return files->explain(message, path);
  SpecPtr owned(spec);
  GLOAM_TRY_STATUS(files->set_spec_only(path, spec));
  report_warnings(warnings, spec, 0, path, notes);
  return owned;
}

bool names_mjcf(const EnvironmentOptions& e) { return !e.file.empty() && !is_model_file(e.file); }

void add_default_floor(mjSpec* spec) {
  mjsTexture* texture = edit(mjs_addTexture, spec, nullptr);
  set_name(texture->element, "floor");
  texture->type = mjTEXTURE_2D;
  texture->builtin = mjBUILTIN_CHECKER;
  texture->width = texture->height = 256;
  for (int i = 0; i < 3; ++i) {
    texture->rgb1[i] = 0.45;
    texture->rgb2[i] = 0.55;
  }
  mjsMaterial* material = edit(mjs_addMaterial, spec, nullptr);
  set_name(material->element, "floor");
  edit(mjs_setInStringVec, material->textures, mjTEXROLE_RGB, "floor");
  material->texrepeat[0] = material->texrepeat[1] = 1;  // one square pattern per metre
  material->texuniform = 1;
  mjsGeom* floor = edit(mjs_addGeom, mjs_findBody(spec, "world"), nullptr);
  set_name(floor->element, "floor");
  floor->type = mjGEOM_PLANE;
  floor->size[0] = floor->size[1] = 0;  // unbounded
  floor->size[2] = 0.05;
  edit(mjs_setString, floor->material, "floor");
}

// Settings that an attached model lost according to MuJoCo, one per line, as "timestep: parent has
// 0.002, child has 0.001, keeping parent value": also those that the file gives and that are
// MuJoCo's default.
std::set<std::string> settings_told(mjSpec* spec, int first) {
  std::set<std::string> names;
  for (int i = first; i < mjs_numWarnings(spec); ++i) {
    const std::string text = mjs_getWarning(spec, i);
    for (size_t begin = 0; begin < text.size();) {
      const size_t end = std::min(text.find('\n', begin), text.size());
      const std::string line = text.substr(begin, end - begin);
      begin = end + 1;
      if (line.find("keeping parent value") != std::string::npos)
        names.insert(line.substr(0, line.find(':')));
    }
  }
  return names;
}

void report_dropped(const LevelRobot& robot, const mjSpec& level, const ModelFiles& files,
                    std::vector<Error>* unsupported) {
  const RobotOptions& o = robot.options;
  const SourceLoc loc = o.loc.file.empty() ? SourceLoc{o.file.string(), 0, 0} : o.loc;
  for (const DroppedSetting& setting :
       dropped_settings(robot.settings, ModelSettings::of(level), robot.settings_told)) {
    const SourceLoc own = files.find_setting(o.file, setting.element, setting.attribute);
    unsupported->push_back({ErrorKind::kUnsupported,
                            fmt::format("robot '{}' has {}", o.name, setting.text),
                            own.line > 0 ? own : loc,
                            "a scene has one value for all robots; set it in the environment"});
  }
}

// A free joint at the root of the robot, where it has none.
Status free_base(const RobotOptions& robot, mjSpec* spec) {
  if (robot.base != "free") return {};
  std::vector<mjsBody*> roots;
  mjsBody* world = mjs_findBody(spec, "world");
  for (mjsElement* e = mjs_firstChild(world, mjOBJ_BODY, 0); e != nullptr;
       e = mjs_nextChild(world, e, 0))
    roots.push_back(mjs_asBody(e));
  const auto fault = [&](std::string what, std::string hint) {
    return Error{ErrorKind::kInput, fmt::format("robot '{}' cannot float: {}", robot.name, what),
                 robot.loc, std::move(hint)};
  };
  if (roots.size() != 1)
    return fault(fmt::format("its model has {} bodies below the world", roots.size()),
                 "base = \"free\" requires a model with one root; a URDF's root link must not be "
                 "called 'world'");
  if (mjs_firstChild(roots[0], mjOBJ_JOINT, 0) != nullptr)
    return fault("its root already has a joint", "remove 'base'");
  mjsJoint* joint = edit(mjs_addFreeJoint, roots[0]);
  if (joint == nullptr) return fault("MuJoCo rejects the joint", "");
  set_name(joint->element, "floating_base");
  return {};
}

// An element whose name begins with the robot's name would count as a part of it: in labels,
// overrides, bindings.
Status check_prefix(mjSpec* base, const RobotOptions& robot) {
  for (mjsElement* e = mjs_firstElement(base, mjOBJ_BODY); e != nullptr;
       e = mjs_nextElement(base, e)) {
    const std::string name = mjs_getString(mjs_getName(e));
    if (name != robot.name && !name.starts_with(robot.name + "/")) continue;
    return Error{ErrorKind::kInput,
                 fmt::format("robot '{}': the environment has a body '{}', which would be taken "
                             "for a part of the robot",
                             robot.name, name),
                 robot.loc, "rename the robot: its bodies are called ROBOT/BODY"};
  }
  return {};
}

bool has_nested_keyframes(mjSpec* spec) {
  if (mjs_firstElement(spec, mjOBJ_KEY) == nullptr) return false;
  for (mjsElement* e = mjs_firstElement(spec, mjOBJ_BODY); e != nullptr;
       e = mjs_nextElement(spec, e)) {
    if (mjs_getOriginSpec(e) != nullptr && mjs_getOriginSpec(e) != spec) return true;
  }
  return false;
}

// Keyframes of models that the robot's own file attaches wait for a compilation: without one they
// would join the level under names without the robot's prefix, cut to the nested model's size.
Status settle_nested_keyframes(const RobotOptions& robot, mjSpec* child, const ModelFiles& files) {
  if (!has_nested_keyframes(child)) return {};
  mjModel* model = nullptr;
  const MujocoWarningCapture warnings;
  const MujocoCompiles threads;
  const Status status = guarded([&] { model = mj_compile(child, files.vfs()); });
  const ModelPtr compiled(model);
  if (status.ok() && compiled != nullptr) return {};
  return files.explain(status.ok() ? mjs_getError(child) : status.error().message, robot.file);
}

Status attach_robot(mjSpec* base, LevelRobot* level_robot, ModelFiles* files) {
  const RobotOptions& robot = level_robot->options;
  mjSpec* child = level_robot->spec.get();
  level_robot->settings = ModelSettings::of(*child);
  GLOAM_TRY_STATUS(settle_nested_keyframes(robot, child, *files));
  const std::string prefix = robot.name + "/";
  const int warnings_before = mjs_numWarnings(base);
  const MujocoWarningCapture warnings;
  mjsElement* attached = nullptr;
  const Status status = guarded([&] {
    mjsFrame* frame = mjs_addFrame(mjs_findBody(base, "world"), nullptr);
    const double p[3] = {robot.X_WR.p.x, robot.X_WR.p.y, robot.X_WR.p.z};
    const double q[4] = {robot.X_WR.q.w, robot.X_WR.q.x, robot.X_WR.q.y, robot.X_WR.q.z};
    std::copy(p, p + 3, frame->pos);
    std::copy(q, q + 4, frame->quat);
    attached = mjs_attach(frame->element, child->element, prefix.c_str(), "");
  });
  if (!status.ok() || attached == nullptr) {
    Error error =
        files->explain(status.ok() ? mjs_getError(base) : status.error().message, robot.file);
    error.message =
        fmt::format("robot '{}' cannot be added to the scene: {}", robot.name, error.message);
    return error;
  }
  level_robot->settings_told = settings_told(base, warnings_before);
  return {};
}

Result<Level> assemble(const Scene& scene, const std::optional<Place>& place,
                       const MeshObjects& objects, const std::vector<Converted>& converted,
                       ModelFiles* files, const std::vector<SampledGround>& grounds,
                       mjtConflict policy, CompileProgress* progress) {
  Level level;
  if (!scene.bare_model.empty()) {
    GLOAM_TRY(level.spec,
              parse_model(scene.bare_model, scene.access, files, &level.notes, progress));
  } else if (names_mjcf(scene.environment)) {
    GLOAM_TRY(level.spec,
              parse_model(scene.environment.file, scene.access, files, &level.notes, progress));
    GLOAM_TRY_STATUS(settle_compiler_options(scene.environment.file, "the environment",
                                             level.spec->compiler.LRopt, files, level.spec.get(),
                                             &level.notes));
    level.spec->compiler.fusestatic = 0;
  } else {
    level.spec.reset(mj_makeSpec());
    edit(mjs_setString, level.spec->modelname, scene.name.c_str());
    const bool has_things = !scene.robots.empty() || !scene.objects.empty() || place ||
                            !scene.agents.empty() || !scene.crowds.empty();
    if (!has_generator(scene.environment) && scene.environment.file.empty() && grounds.empty() &&
        has_things)
      add_default_floor(level.spec.get());
  }
  if (place) GLOAM_TRY_STATUS(add_place(*place, level.spec.get()));
  GLOAM_TRY_STATUS(add_grounds(grounds, level.spec.get()));
  GLOAM_TRY_STATUS(add_objects(objects, converted, level.spec.get(), &level.notes));
  GLOAM_TRY_STATUS(add_agents(scene, level.spec.get()));
  GLOAM_TRY_STATUS(apply_overrides(scene.overrides, kEnvironmentName, level.spec.get()));
  if (level.spec->compiler.conflict == mjCONFLICT_WARNING && !scene.robots.empty())
    level.spec->compiler.conflict = policy;
  for (const RobotOptions& robot : scene.robots) {
    GLOAM_TRY_STATUS(check_prefix(level.spec.get(), robot));
    GLOAM_TRY(SpecPtr child, parse_model(robot.file, scene.access, files, &level.notes, progress));
    GLOAM_TRY_STATUS(apply_overrides(scene.overrides, robot.name, child.get()));
    GLOAM_TRY_STATUS(free_base(robot, child.get()));
    GLOAM_TRY_STATUS(settle_compiler_options(robot.file, fmt::format("robot '{}'", robot.name),
                                             level.spec->compiler.LRopt, files, child.get(),
                                             &level.notes));
    level.robots.push_back({robot, std::move(child), {}, {}});
    GLOAM_TRY_STATUS(attach_robot(level.spec.get(), &level.robots.back(), files));
  }
  for (const LevelRobot& robot : level.robots)
    report_dropped(robot, *level.spec, *files, &level.unsupported);
  if (scene.sim.timestep) level.spec->option.timestep = *scene.sim.timestep;
  return level;
}

// The file that an element of this name comes from: a robot's, else the level's own.
fs::path file_of(const Scene& scene, const std::string& name) {
  for (const RobotOptions& robot : scene.robots) {
    if (name.starts_with(robot.name + "/")) return robot.file;
  }
  return !scene.bare_model.empty()         ? scene.bare_model
         : !scene.environment.file.empty() ? scene.environment.file
         : scene.robots.empty()            ? scene.file
                                           : scene.robots[0].file;
}

// As "line 3"; empty when it was made in code.
const char* info_of(mjsElement* e) {
  const mjString* info = nullptr;
  if (const auto* body = mjs_asBody(e)) info = body->info;
  if (const auto* joint = mjs_asJoint(e)) info = joint->info;
  if (const auto* geom = mjs_asGeom(e)) info = geom->info;
  if (const auto* site = mjs_asSite(e)) info = site->info;
  if (const auto* camera = mjs_asCamera(e)) info = camera->info;
  if (const auto* light = mjs_asLight(e)) info = light->info;
  if (const auto* tendon = mjs_asTendon(e)) info = tendon->info;
  if (const auto* material = mjs_asMaterial(e)) info = material->info;
  return info == nullptr ? "" : mjs_getString(info);
}

std::string written_at(const mjSpec* spec, mjtObj type, int id) {
  for (mjsElement* e = mjs_firstElement(spec, type); e != nullptr; e = mjs_nextElement(spec, e))
    if (mjs_getId(e) == id) return info_of(e);
  return {};
}

std::vector<int> lines_of(const mjSpec* spec, mjtObj type, mjtSize count) {
  std::vector<int> lines(static_cast<size_t>(count), 0);
  for (mjsElement* e = mjs_firstElement(spec, type); e != nullptr; e = mjs_nextElement(spec, e)) {
    const int id = mjs_getId(e);
    int line = 0;
    if (id >= 0 && id < count && std::sscanf(info_of(e), "line %d", &line) == 1)
      lines[static_cast<size_t>(id)] = line;
  }
  return lines;
}

Status check_finite(const Scene& scene, const Level& level, const ModelFiles& files) {
  const std::optional<NotFinite> found = find_not_finite(*level.model);
  if (!found) return {};
  const std::string place = written_at(level.spec.get(), found->type, found->id);
  Error error =
      files.explain(fmt::format("{}, {}", found->fault, place), file_of(scene, found->name));
  error.hint = "MuJoCo accepts nan and inf as numbers: use a finite one";
  return error;
}

Status compile(const Scene& scene, ModelFiles* files, Level* level, double weight,
               CompileProgress* progress) {
  if (progress != nullptr) GLOAM_TRY_STATUS(progress->check());
  files->forget_failures();
  mjModel* model = nullptr;
  mjSpec* spec = level->spec.get();
  if (const std::optional<EndlessCompile> endless = find_endless_compile(*spec)) {
    Error error = files->explain(endless->fault, file_of(scene, endless->name));
    error.hint = "MuJoCo's compiler simulates muscles: set it to 0 or more";
    return error;
  }
  const mjVFS* vfs = files->vfs();
  const int warnings_before = mjs_numWarnings(spec);
  const MujocoWarningCapture warnings;
  const ModelWatch watch("compiling the model in MuJoCo", weight, 0, progress);
  const MujocoCompiles threads;
  const Status status = guarded([&] { model = mj_compile(spec, vfs); });
  level->model.reset(model);
  const fs::path file = file_of(scene, "");
  if (!status.ok() || model == nullptr)
    return files->explain(status.ok() ? mjs_getError(spec) : status.error().message, file);
  report_warnings(warnings, spec, warnings_before, file, &level->notes);
  return check_finite(scene, *level, *files);
}

}  // namespace

int object_count(const mjModel& model, mjtObj type) {
  using Count = std::pair<mjtObj, mjtSize mjModel::*>;
  static constexpr Count kCounts[] = {
      {mjOBJ_BODY, &mjModel::nbody},         {mjOBJ_JOINT, &mjModel::njnt},
      {mjOBJ_GEOM, &mjModel::ngeom},         {mjOBJ_SITE, &mjModel::nsite},
      {mjOBJ_CAMERA, &mjModel::ncam},        {mjOBJ_LIGHT, &mjModel::nlight},
      {mjOBJ_FLEX, &mjModel::nflex},         {mjOBJ_MESH, &mjModel::nmesh},
      {mjOBJ_SKIN, &mjModel::nskin},         {mjOBJ_HFIELD, &mjModel::nhfield},
      {mjOBJ_TEXTURE, &mjModel::ntex},       {mjOBJ_MATERIAL, &mjModel::nmat},
      {mjOBJ_PAIR, &mjModel::npair},         {mjOBJ_EXCLUDE, &mjModel::nexclude},
      {mjOBJ_EQUALITY, &mjModel::neq},       {mjOBJ_TENDON, &mjModel::ntendon},
      {mjOBJ_ACTUATOR, &mjModel::nactuator}, {mjOBJ_SENSOR, &mjModel::nsensor},
      {mjOBJ_NUMERIC, &mjModel::nnumeric},   {mjOBJ_TEXT, &mjModel::ntext},
      {mjOBJ_TUPLE, &mjModel::ntuple},       {mjOBJ_KEY, &mjModel::nkey},
      {mjOBJ_PLUGIN, &mjModel::nplugin}};
  for (const auto& [listed, count] : kCounts)
    if (listed == type) return static_cast<int>(model.*count);
  return -1;
}

std::vector<std::string> object_names(const mjModel* model, mjtObj type) {
  std::vector<std::string> names;
  const int count = object_count(*model, type);
  for (int i = 0; i < count; ++i) {
    const char* name = mj_id2name(model, type, i);
    names.emplace_back(name != nullptr ? name : "");
  }
  return names;
}

Status add_scene_files(const Scene& scene, ModelFiles* files) {
  if (!scene.bare_model.empty()) {
    GLOAM_TRY_STATUS(files->add_model(scene.bare_model, scene.access));
  } else if (names_mjcf(scene.environment)) {
    GLOAM_TRY_STATUS(files->add_model(scene.environment.file, scene.access, scene.environment.loc));
  }
  for (const RobotOptions& robot : scene.robots)
    GLOAM_TRY_STATUS(files->add_model(robot.file, scene.access, robot.loc));
  GLOAM_TRY_STATUS(admit_ground_files(scene, files));
  if (files->uses_plugins()) load_mujoco_plugins();
  return {};
}

Result<Level> build_level(const Scene& scene, const std::optional<Place>& place,
                          const MeshObjects& objects, ModelFiles* files,
                          CompileProgress* progress) {
  std::vector<Error> notes;
  GLOAM_TRY(const std::vector<SampledGround> grounds,
            sample_grounds(scene, files, &notes, progress));
  GLOAM_TRY(const std::vector<Converted> converted, convert_objects(objects, progress));
  // MuJoCo's "merge" rules let a robot bring its solver settings along; where two files cannot both
  // be right ("merge" fails), the earlier file wins and the rest is reported.
  const auto assembled_by = [&](mjtConflict policy) {
    return assemble(scene, place, objects, converted, files, grounds, policy, progress);
  };
  Result<Level> assembled = assembled_by(mjCONFLICT_MERGE);
  if (!assembled.ok() && assembled.error().message.find("onflict") != std::string::npos)
    assembled = assembled_by(mjCONFLICT_WARNING);
  if (!assembled.ok()) return assembled;
  Level level = std::move(assembled).value();
  level.notes.insert(level.notes.begin(), notes.begin(), notes.end());
  GLOAM_TRY_STATUS(add_cameras(scene, &level));
  add_initial_keyframe(scene, &level);
  GLOAM_TRY_STATUS(compile(scene, files, &level, kModelWeight, progress));
  if (turn_tracking_cameras(scene, &level))
    GLOAM_TRY_STATUS(compile(scene, files, &level, 0, progress));
  GLOAM_TRY_STATUS(fill_initial_keyframe(&level));
  const mjSpec* spec = level.spec.get();
  level.lines = {lines_of(spec, mjOBJ_GEOM, level.model->ngeom),
                 lines_of(spec, mjOBJ_SITE, level.model->nsite),
                 lines_of(spec, mjOBJ_TENDON, level.model->ntendon)};
  return level;
}

}  // namespace gloam

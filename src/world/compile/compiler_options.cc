#include "world/compile/compiler_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scene/files/mujoco_compiles.h"
#include "scene/files/mujoco_guard.h"
#include "world/compile/progress/endless_compile.h"
#include "world/world.h"

namespace gloam {
namespace {

template <class F>
void each(mjSpec* spec, mjtObj type, const F& f) {
  for (mjsElement* e = mjs_firstElement(spec, type); e != nullptr; e = mjs_nextElement(spec, e))
    f(e);
}

// The model by itself, with the bodies of its file in their order and their frames as written.
Result<ModelPtr> compile_alone(const std::filesystem::path& file, ModelFiles* files,
                               const mjSpec* model) {
  const SpecPtr copy(mj_copySpec(model));
  if (copy == nullptr) return Error{ErrorKind::kInput, "MuJoCo cannot copy the model"};
  copy->compiler.fusestatic = 0;
  copy->compiler.alignfree = 0;
  copy->compiler.settotalmass = -1;
  each(copy.get(), mjOBJ_JOINT, [](mjsElement* e) { mjs_asJoint(e)->align = mjALIGNFREE_FALSE; });
  files->forget_failures();
  mjModel* compiled = nullptr;
  const MujocoWarningCapture warnings;
  const MujocoCompiles threads;
  const Status status = guarded([&] { compiled = mj_compile(copy.get(), files->vfs()); });
  ModelPtr out(compiled);
  if (status.ok() && out != nullptr) return out;
  return files->explain(status.ok() ? mjs_getError(copy.get()) : status.error().message, file);
}

// As mj_setTotalmass() scales a compiled model, bounds and balance applied before.
void set_total_mass(const mjModel& compiled, mjSpec* model) {
  mjsCompiler& compiler = model->compiler;
  double total = 0;
  for (int body = 1; body < compiled.nbody; ++body) {
    const bool joins_world = compiler.fusestatic != 0 && compiled.body_weldid[body] == 0;
    if (!joins_world) total += compiled.body_mass[body];
  }
  const double scale = std::max(mjMINVAL, compiler.settotalmass / std::max(mjMINVAL, total));
  int id = 0;
  each(model, mjOBJ_BODY, [&](mjsElement* e) {
    const int i = id++;
    mjsBody* body = mjs_asBody(e);
    if (i == 0 || compiled.body_mass[i] <= 0) return;
    body->mass = compiled.body_mass[i] * scale;
    std::copy_n(compiled.body_ipos + 3 * i, 3, body->ipos);
    std::copy_n(compiled.body_iquat + 4 * i, 4, body->iquat);
    for (int k = 0; k < 3; ++k) body->inertia[k] = compiled.body_inertia[3 * i + k] * scale;
    mjs_defaultOrientation(&body->ialt);
    body->fullinertia[0] = std::numeric_limits<double>::quiet_NaN();
    body->explicitinertial = 1;
  });
  compiler.settotalmass = -1;
  compiler.boundmass = compiler.boundinertia = 0;
  if (compiler.inertiafromgeom == mjINERTIAFROMGEOM_TRUE)
    compiler.inertiafromgeom = mjINERTIAFROMGEOM_AUTO;
}

bool same(const mjLROpt& a, const mjLROpt& b) {
  return a.mode == b.mode && a.useexisting == b.useexisting && a.uselimit == b.uselimit &&
         a.accel == b.accel && a.maxforce == b.maxforce && a.timeconst == b.timeconst &&
         a.timestep == b.timestep && a.inttotal == b.inttotal && a.interval == b.interval &&
         a.tolrange == b.tolrange;
}

void keep_length_ranges(const mjModel& compiled, mjSpec* model) {
  int id = 0;
  each(model, mjOBJ_ACTUATOR, [&](mjsElement* e) {
    std::copy_n(compiled.actuator_lengthrange + 2 * id++, 2, mjs_asActuator(e)->lengthrange);
  });
}

}  // namespace

Status settle_compiler_options(const std::filesystem::path& file, const std::string& title,
                               const mjLROpt& level, ModelFiles* files, mjSpec* model,
                               std::vector<Error>* notes) {
  const SourceLoc fuse = files->find_setting(file, "compiler", "fusestatic");
  if (model->compiler.fusestatic != 0 && fuse.line > 0)
    notes->push_back(
        {ErrorKind::kInput,
         fmt::format("{}: 'fusestatic' is ignored: static bodies remain separate bodies", title),
         fuse, "the motion is the same: remove it from the file"});
  const bool has_mass = model->compiler.settotalmass > 0;
  const bool has_ranges =
      mjs_firstElement(model, mjOBJ_ACTUATOR) != nullptr && !same(model->compiler.LRopt, level);
  if ((!has_mass && !has_ranges) || find_endless_compile(*model)) return {};
  GLOAM_TRY(const ModelPtr compiled, compile_alone(file, files, model));
  if (has_mass) set_total_mass(*compiled, model);
  if (has_ranges) keep_length_ranges(*compiled, model);
  return {};
}

}  // namespace gloam

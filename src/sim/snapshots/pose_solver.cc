#include "sim/snapshots/pose_solver.h"

#include <algorithm>

#include "base/check.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "scene/files/mujoco_guard.h"
#include "sim/commands/live_fields.h"
#include "sim/effects/surface_vertices.h"
#include "sim/snapshots/skinning.h"
#include "sim/state/state_layout.h"
#include "world/model_memory.h"
#include "world/view/render_origin.h"

namespace gloam {
namespace {

void assign(const mjtNum* values, mjtSize n, std::vector<double>& out) {
  out.assign(values, values + n);
}

}  // namespace

Result<std::unique_ptr<PoseSolver>> PoseSolver::create(std::shared_ptr<const CompiledWorld> world) {
  return or_no_memory("the poses", [&]() -> Result<std::unique_ptr<PoseSolver>> {
    std::unique_ptr<PoseSolver> solver(new PoseSolver);
    solver->world_ = std::move(world);
    solver->layout_ = deformable_layout(*solver->world_->model);
    const bool sleeps = (solver->model().opt.enableflags & mjENBL_SLEEP) != 0;
    if (sleeps || !is_zero(solver->world_->render_origin)) solver->own_the_model();
    solver->data_ = make_data(solver->model());
    return solver;
  });
}

void PoseSolver::own_the_model() {
  if (own_model_) return;
  own_model_ = copy_model(*world_->model);
  own_model_->opt.enableflags &= ~mjENBL_SLEEP;  // kinematics skips what sleeps
  move_model(world_->render_origin, own_model_.get());
}

// Masses move centres of mass, which cameras and lights may track; no other live field moves
// anything that is seen.
Status PoseSolver::follow_live_fields(const std::shared_ptr<const LiveFields>& live) {
  const auto field = static_cast<size_t>(LiveFieldId::kBodyMass);
  const bool changed = live != nullptr && !live->values[field].empty();
  if (!changed && masses_.empty()) return {};
  const std::vector<double> masses =
      changed ? live->values[field] : read_live_field(*world_->model, LiveFieldId::kBodyMass);
  if (masses == masses_) return {};
  own_the_model();
  if (scratch_ == nullptr) scratch_ = make_data(*own_model_);
  masses_ = masses;
  return write_live_field(*world_->model, LiveFieldId::kBodyMass, masses, *own_model_,
                          scratch_.get());
}

Status PoseSolver::solve_bodies(const Snapshot& snapshot, PoseFrame& frame) {
  const SnapshotData& in = snapshot.data();
  GLOAM_CHECK(in.world == world_, "the Snapshot belongs to another World");
  GLOAM_TRY_STATUS(follow_live_fields(in.live));
  const mjModel* model = &this->model();
  mjData* data = data_.get();
  GLOAM_TRY_STATUS(guarded([&] {
    mj_setState(model, data, in.state.data(), mjSTATE_INTEGRATION);
    if (!is_zero(world_->render_origin)) move_state(*model, world_->render_origin, data);
    mj_kinematics(model, data);
    mj_comPos(model, data);
    mj_camlight(model, data);
  }));
  frame.n_world = 1;
  frame.run = in.run;
  frame.step = in.step;
  frame.time = in.time;
  frame.vertices.clear();
  fill_poses(frame);
  return {};
}

Status PoseSolver::solve(const Snapshot& snapshot, PoseFrame& frame) {
  GLOAM_TRY_STATUS(solve_bodies(snapshot, frame));
  const SnapshotData& in = snapshot.data();
  const mjModel* model = &this->model();
  mjData* data = data_.get();
  GLOAM_TRY_STATUS(guarded([&] {
    if (model->nflex > 0) mj_flex(model, data);
    if (layout_.has_tendons) mj_tendon(model, data);
  }));
  ++meshed_;
  fill_vertices(in.live.get(), frame);
  append_surface_vertices(*world_, in.effects.surfaces, in.time, &heights_, &frame.vertices);
  fill_live(in.live.get(), frame);
  frame.snow_left.clear();
  if (in.effects.snow_left != nullptr) frame.snow_left = *in.effects.snow_left;
  frame.fields.resize(in.effects.media.size());
  for (size_t i = 0; i < frame.fields.size(); ++i) {
    PoseFrame::Field& field = frame.fields[i];
    in.effects.media[i].read(&field.density, &field.temperature, &field.flame);
  }
  return {};
}

void PoseSolver::fill_poses(PoseFrame& frame) const {
  const mjModel& m = model();
  const mjData& d = *data_;
  assign(d.xpos, 3 * m.nbody, frame.body_p);
  assign(d.xmat, 9 * m.nbody, frame.body_R);
  assign(d.cam_xpos, 3 * m.ncam, frame.camera_p);
  assign(d.cam_xmat, 9 * m.ncam, frame.camera_R);
  assign(d.light_xpos, 3 * m.nlight, frame.light_p);
  assign(d.light_xdir, 3 * m.nlight, frame.light_dir);
}

void PoseSolver::fill_vertices(const LiveFields* live, PoseFrame& frame) {
  const mjModel& m = model();
  const mjData& d = *data_;
  frame.vertices.resize(static_cast<size_t>(3 * layout_.nvertex));
  parallel_for("skins", m.nskin, [&](int64_t skin) {
    skin_vertices(m, static_cast<int>(skin), d.xpos, d.xquat,
                  frame.vertices.data() + 3 * layout_.skin_first[static_cast<size_t>(skin)]);
  });
  std::transform(d.flexvert_xpos, d.flexvert_xpos + 3 * m.nflexvert,
                 frame.vertices.begin() + 3 * m.nskinvert,
                 [](mjtNum x) { return static_cast<float>(x); });
  live_field_at(m, live, LiveFieldId::kGravity, &gravity_);
  place_capsules(m, d, gravity_.data(), layout_, frame.vertices.data());
}

void PoseSolver::fill_live(const LiveFields* live, PoseFrame& frame) {
  const mjModel& m = *world_->model;
  frame.live_serial = live != nullptr ? live->serial : 0;
  live_field_at(m, live, LiveFieldId::kLightDiffuse, &frame.light_diffuse);
  live_field_at(m, live, LiveFieldId::kLightIntensity, &frame.light_intensity);
  live_field_at(m, live, LiveFieldId::kLightActive, &active_);
  frame.light_active.resize(active_.size());
  std::transform(active_.begin(), active_.end(), frame.light_active.begin(),
                 [](float v) { return static_cast<uint8_t>(v != 0); });
  live_field_at(m, live, LiveFieldId::kGeomColor, &frame.geom_rgba);
  live_field_at(m, live, LiveFieldId::kMaterialColor, &frame.material_rgba);
  live_field_at(m, live, LiveFieldId::kMaterialEmission, &frame.material_emission);
  live_field_at(m, live, LiveFieldId::kMaterialSpecular, &frame.material_specular);
  live_field_at(m, live, LiveFieldId::kMaterialShininess, &frame.material_shininess);
  live_field_at(m, live, LiveFieldId::kMaterialReflectance, &frame.material_reflectance);
  live_field_at(m, live, LiveFieldId::kMaterialMetallic, &frame.material_metallic);
  live_field_at(m, live, LiveFieldId::kMaterialRoughness, &frame.material_roughness);
  const uint64_t height_field = live != nullptr ? live->height_field_serial : 0;
  if (height_field == frame.height_field_serial) return;
  frame.height_field_serial = height_field;
  frame.height_field.clear();
  if (height_field != 0) live_field_at(m, live, LiveFieldId::kHeightField, &frame.height_field);
}

}  // namespace gloam

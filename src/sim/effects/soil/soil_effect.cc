#include "sim/effects/soil/soil_effect.h"

#include <algorithm>

#include "sim/effects/bodies/collider_mesh.h"
#include "world/effects/surface_layout.h"

namespace gloam {

Result<std::unique_ptr<Effect>> SoilEffect::make(const EffectParts& parts) {
  if (parts.world->soils.empty()) return std::unique_ptr<Effect>();
  return std::unique_ptr<Effect>(new SoilEffect(parts.world, parts.model));
}

SoilEffect::SoilEffect(std::shared_ptr<const CompiledWorld> world, const mjModel& m)
    : world_(std::move(world)), solver_(m) {
  const std::vector<bool> collide = colliders(m);
  std::vector<int> geoms;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const bool moves = m.body_weldid[m.geom_bodyid[geom]] != 0;
    if (!moves || !collide[static_cast<size_t>(geom)] || !ColliderBottom::can_be(m, geom)) continue;
    colliders_.emplace_back(m, geom);
    geoms.push_back(geom);
  }
  for (int sensor = 0; sensor < m.nsensor; ++sensor) {
    if (m.sensor_type[sensor] == mjSENS_TOUCH && m.sensor_historyadr[sensor] < 0)
      touch_sensors_.push_back(sensor);
  }
  near_.reserve(colliders_.size());
  if (has_probe(*world_, "soil_work")) work_.resize(static_cast<size_t>(m.nbody));
  for (const SoilDescription& soil : world_->soils)
    beds_.push_back(std::make_unique<SoilBed>(soil, m, geoms));
}

void SoilEffect::reset(const EffectContext& at) {
  at.events.loads.reserve(colliders_.size() * beds_.size());
  for (const auto& bed : beds_) bed->reset();
  std::ranges::fill(work_, 0.0);
}

void SoilEffect::take_over(const EffectContext& at, Effect* before) {
  reset(at);
  const auto* other = static_cast<const SoilEffect*>(before);
  for (size_t i = 0; other != nullptr && i < beds_.size(); ++i) {
    for (const auto& bed : other->beds_)
      if (beds_[i]->take_over(*bed)) break;
  }
  if (other != nullptr && !work_.empty() && !other->work_.empty()) take_over_work(*other);
}

// Work of bodies of the same names.
void SoilEffect::take_over_work(const SoilEffect& before) {
  for (size_t body = 1; body < work_.size(); ++body) {
    const char* name = mj_id2name(world_->model.get(), mjOBJ_BODY, static_cast<int>(body));
    const int same = name != nullptr && *name != 0
                         ? mj_name2id(before.world_->model.get(), mjOBJ_BODY, name)
                         : -1;
    if (same >= 0) work_[body] = before.work_[static_cast<size_t>(same)];
  }
}

void SoilEffect::apply_loads(const EffectContext& at) {
  const mjModel& m = at.model;
  mjData& d = at.data;
  near_.clear();
  for (ColliderBottom& collider : colliders_) {
    const bool near = std::any_of(beds_.begin(), beds_.end(), [&](const auto& bed) {
      return bed->is_near(m, d, collider.geom());
    });
    if (!near) continue;
    collider.set_pose(d);
    near_.push_back(&collider);
  }
  // Cells count from 1, so that one that nothing has touched is none of the last step's.
  const uint32_t now = static_cast<uint32_t>(at.step) + 1;
  for (const auto& bed : beds_) {
    at.hash = bed->press(now, m, d, near_, at.hash);
    bed->push(now, m, d, &solver_, work_);
    at.events.loads.insert(at.events.loads.end(), bed->loads().begin(), bed->loads().end());
  }
}

void SoilEffect::update_sensors(const EffectContext& at) {
  const mjModel& m = at.model;
  mjData& d = at.data;
  if (m.opt.disableflags & mjDSBL_SENSOR) return;
  for (const ContactLoad& contact : at.events.loads) {
    const double load = dot3(contact.force, contact.normal);
    const double outwards[3] = {-contact.normal[0], -contact.normal[1], -contact.normal[2]};
    for (const int sensor : touch_sensors_) {
      const int site = m.sensor_objid[sensor];
      if (load <= 0 || m.site_bodyid[site] != contact.body ||
          mju_rayGeom(d.site_xpos + 3 * site, d.site_xmat + 9 * site, m.site_size + 3 * site,
                      contact.p, outwards, m.site_type[site], nullptr) < 0)
        continue;
      double& reading = d.sensordata[m.sensor_adr[sensor]];
      reading += load;
      if (m.sensor_cutoff[sensor] > 0) reading = std::min(reading, m.sensor_cutoff[sensor]);
    }
  }
}

void SoilEffect::publish(int64_t, EffectOutputs* out) {
  for (size_t i = 0; i < beds_.size(); ++i)
    out->surfaces[soil_surface(*world_, i)] = {beds_[i]->tracks().field(), 0};
  std::ranges::copy(work_, out->ground_work.begin());
}

}  // namespace gloam

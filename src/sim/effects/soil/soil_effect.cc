#include "sim/effects/soil/soil_effect.h"

#include <algorithm>

#include "sim/effects/bodies/collider_mesh.h"

namespace gloam {

std::unique_ptr<SoilEffect> SoilEffect::create(std::shared_ptr<const CompiledWorld> world,
                                               const mjModel& model) {
  return std::unique_ptr<SoilEffect>(new SoilEffect(std::move(world), model));
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
  reactions_.reserve(geoms.size() * world_->soils.size());
  for (const SoilDescription& soil : world_->soils)
    beds_.push_back(std::make_unique<SoilBed>(soil, m, geoms));
}

void SoilEffect::reset() {
  reactions_.clear();
  for (const auto& bed : beds_) bed->reset();
}

void SoilEffect::take_over(const SoilEffect* before) {
  reset();
  for (size_t i = 0; before != nullptr && i < beds_.size(); ++i) {
    for (const auto& other : before->beds_)
      if (beds_[i]->take_over(*other)) break;
  }
}

uint64_t SoilEffect::begin_step(int64_t step, const mjModel& m, mjData& d, uint64_t hash) {
  reactions_.clear();
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
  const uint32_t now = static_cast<uint32_t>(step) + 1;
  for (const auto& bed : beds_) {
    hash = bed->press(now, m, d, near_, hash);
    bed->push(now, m, d, &solver_);
    reactions_.insert(reactions_.end(), bed->reactions().begin(), bed->reactions().end());
  }
  return hash;
}

void SoilEffect::feel(const mjModel& m, mjData& d) const {
  if (m.opt.disableflags & mjDSBL_SENSOR) return;
  for (const SoilReaction& reaction : reactions_) {
    const double load = dot3(reaction.force, reaction.normal);
    const double outwards[3] = {-reaction.normal[0], -reaction.normal[1], -reaction.normal[2]};
    for (const int sensor : touch_sensors_) {
      const int site = m.sensor_objid[sensor];
      if (load <= 0 || m.site_bodyid[site] != reaction.body ||
          mju_rayGeom(d.site_xpos + 3 * site, d.site_xmat + 9 * site, m.site_size + 3 * site,
                      reaction.p, outwards, m.site_type[site], nullptr) < 0)
        continue;
      double& reading = d.sensordata[m.sensor_adr[sensor]];
      reading += load;
      if (m.sensor_cutoff[sensor] > 0) reading = std::min(reading, m.sensor_cutoff[sensor]);
    }
  }
}

void SoilEffect::fill(std::vector<HeightChange>* tracks) {
  for (size_t i = 0; i < beds_.size(); ++i) (*tracks)[i] = {beds_[i]->tracks().field(), 0};
}

}  // namespace gloam

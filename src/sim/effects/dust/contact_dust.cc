#include "sim/effects/dust/contact_dust.h"

#include <algorithm>
#include <cmath>

#include "sim/effects/bodies/body_forces.h"
#include "sim/effects/dust/dust_law.h"

namespace gloam {
namespace {

// Least part of a contact's normal along z: ground, not a wall.
constexpr double kGroundNormal = 0.7;

// Speed at which the rim of a geom rolls past `p`, across `normal`, times `load`, the fraction of
// its tree's weight [m/s].
double rolled_way(const mjModel& m, const mjData& d, int geom, const double* p,
                  const double* normal, double load) {
  const int body = m.geom_bodyid[geom];
  double arm[3], rim[3];
  mju_sub3(arm, p, d.geom_xpos + 3 * geom);
  mju_cross(rim, d.cvel + 6 * body, arm);
  mju_addToScl3(rim, normal, -mju_dot3(rim, normal));
  const double tree = m.body_subtreemass[m.body_rootid[body]];
  const double weight = tree * std::max(mju_norm3(m.opt.gravity), 1e-3);
  return mju_norm3(rim) * std::min(load / weight, 1.0);
}

}  // namespace

ContactDust::ContactDust(const CompiledWorld& world, Vec3f low, Vec3f high)
    : low_(low),
      high_(high),
      of_geoms_(static_cast<size_t>(world.model->ngeom)),
      of_agents_(world.agents.size()) {
  const mjModel& m = *world.model;
  for (const DustDescription& dust : world.gases.dusts) {
    Ground& ground = grounds_.emplace_back();
    ground.box = &dust;
    ground.per_energy = dust_per_energy(double{dust.silt});
    for (int body = 0; body < static_cast<int>(m.nbody); ++body) {
      const double tree = m.body_subtreemass[m.body_rootid[body]];
      ground.per_way.push_back(rolling_dust(double{dust.silt}, tree));
    }
  }
}

void ContactDust::reset() {
  std::fill(of_geoms_.begin(), of_geoms_.end(), Heap{});
  std::fill(of_agents_.begin(), of_agents_.end(), Heap{});
}

const ContactDust::Ground* ContactDust::ground_at(const double* p) const {
  const Vec3f at{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  for (int a = 0; a < 3; ++a)
    if (!(at[a] >= low_[a] && at[a] <= high_[a])) return nullptr;
  for (const Ground& ground : grounds_)
    if (ground.box->holds(at)) return &ground;
  return nullptr;
}

void ContactDust::put(double mass, const double* p, Heap* heap) {
  heap->mass += mass;
  mju_addToScl3(heap->moment, p, mass);
}

void ContactDust::gather(const mjModel& model, const mjData& data, const StepEvents& events) {
  for (int i = 0; i < data.ncon; ++i) gather_contact(model, data, i);
  for (const ContactLoad& load : events.loads) gather_soil(model, data, load);
  for (const Footfall& footfall : events.footfalls) gather_footfall(footfall);
}

void ContactDust::gather_contact(const mjModel& m, const mjData& d, int i) {
  const mjContact& contact = d.contact[i];
  if (contact.efc_address < 0 || contact.geom[0] < 0 || contact.geom[1] < 0) return;
  if (std::abs(contact.frame[2]) < kGroundNormal) return;
  const bool first_stands = m.body_weldid[m.geom_bodyid[contact.geom[0]]] == 0;
  const bool second_stands = m.body_weldid[m.geom_bodyid[contact.geom[1]]] == 0;
  if (first_stands == second_stands) return;
  const Ground* ground = ground_at(contact.pos);
  if (ground == nullptr) return;
  const int geom = contact.geom[first_stands ? 1 : 0], body = m.geom_bodyid[geom];
  double force[6], v_W[3], v[3];  // normal first
  mj_contactForce(&m, &d, i, force);
  velocity_at(m, d, body, contact.pos, v_W);
  mju_mulMatVec3(v, contact.frame, v_W);
  // The normal points to the second geom; forces of friction are against slip.
  const double nearing = first_stands ? -v[0] : v[0];
  const double work = force[0] * std::max(nearing, 0.0) +
                      std::hypot(force[1], force[2]) * std::hypot(v[1], v[2]);  // [W]
  const double rolled = ground->per_way[static_cast<size_t>(body)] *
                        rolled_way(m, d, geom, contact.pos, contact.frame, force[0]);
  put((ground->per_energy * work + rolled) * m.opt.timestep, contact.pos,
      &of_geoms_[static_cast<size_t>(geom)]);
}

void ContactDust::gather_soil(const mjModel& m, const mjData& d, const ContactLoad& soil) {
  const Ground* ground = ground_at(soil.p);
  if (ground == nullptr) return;
  double v[3];
  velocity_at(m, d, soil.body, soil.p, v);
  const double work = std::max(-mju_dot3(soil.force, v), 0.0);  // [W]
  const double load = std::max(mju_dot3(soil.force, soil.normal), 0.0);
  const double rolled = ground->per_way[static_cast<size_t>(soil.body)] *
                        rolled_way(m, d, soil.geom, soil.p, soil.normal, load);
  put(std::max(ground->per_energy * work, rolled) * m.opt.timestep, soil.p,
      &of_geoms_[static_cast<size_t>(soil.geom)]);
}

void ContactDust::gather_footfall(const Footfall& footfall) {
  const Ground* ground = ground_at(footfall.p);
  if (ground == nullptr) return;
  put(ground->per_energy * step_energy(footfall.mass, footfall.speed), footfall.p,
      &of_agents_[static_cast<size_t>(footfall.agent)]);
}

std::vector<DustDeposit> ContactDust::take() {
  std::vector<DustDeposit> out;
  for (auto* heaps : {&of_geoms_, &of_agents_}) {
    for (Heap& heap : *heaps) {
      if (!(heap.mass > 0)) continue;
      const double* p = heap.moment;
      const double scale = 1 / heap.mass;
      out.push_back({{static_cast<float>(p[0] * scale), static_cast<float>(p[1] * scale),
                      static_cast<float>(p[2] * scale)},
                     static_cast<float>(heap.mass)});
      heap = {};
    }
  }
  return out;
}

}  // namespace gloam

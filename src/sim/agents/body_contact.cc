#include "sim/agents/body_contact.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kMaxIndentation = 0.8;  // indentation where bones begin, over a capsule's radius
constexpr double kBoneStiffnessFactor = 10;  // stiffness there, over the region's
constexpr double kUnloadingFraction = 0.4;   // force on the way out over that on the way in
constexpr double kUnloadingSpeed = 0.1;      // of parting, from which that counts in full [m/s]

double stiffness_of(int part, bool is_head) {
  if (part == kThighL || part == kThighR) return kThighStiffness;
  if (part == kShankL || part == kShankR) return kShankStiffness;
  return is_head ? kSkullStiffness : kChestStiffness;
}

/// Rows of a contact in the solver.
struct Rows {
  int first = 0, count = 1;
  bool is_pyramid = false;
};

Rows rows_of(const mjData& data, const mjContact& contact) {
  Rows rows{contact.efc_address, contact.dim, false};
  rows.is_pyramid = data.efc_type[rows.first] == mjCNSTR_CONTACT_PYRAMIDAL;
  if (rows.is_pyramid) rows.count = 2 * (contact.dim - 1);
  return rows;
}

/// Sets a row to the force D (aref - a) with the constraint's acceleration a.
void set_row(int row, double mass, double reference, mjData* data) {
  data->efc_D[row] = mass;
  data->efc_R[row] = 1 / mass;
  data->efc_aref[row] = reference;
  if (data->nisland == 0) return;
  const int own = data->map_efc2iefc[row];
  data->iefc_D[own] = mass;
  data->iefc_R[own] = 1 / mass;
}

}  // namespace

BodyContacts::BodyContacts(const CompiledWorld& world, const mjModel& m)
    : springs_(static_cast<size_t>(m.ngeom)) {
  for (const AgentDescription& agent : world.agents) {
    if (agent.kind != AgentKind::kPerson) continue;
    any_ = true;
    for (int part = 0; part < agent.parts(); ++part) {
      const int body = agent.body[static_cast<size_t>(part)];
      bool is_head = false;  // of the chest's colliders all but the first
      for (int g = m.body_geomadr[body]; g < m.body_geomadr[body] + m.body_geomnum[body]; ++g) {
        if (m.geom_contype[g] == 0 && m.geom_conaffinity[g] == 0) continue;
        springs_[static_cast<size_t>(g)] = {stiffness_of(part, is_head),
                                            kMaxIndentation * m.geom_size[3 * g]};
        is_head = true;
      }
    }
  }
}

BodyContacts::Side BodyContacts::side_of(const mjModel& m, const mjContact& contact) const {
  for (int side = 0; side < 2; ++side) {
    const int geom = contact.geom[side], other = contact.geom[1 - side];
    if (geom >= 0 && springs_[static_cast<size_t>(geom)].stiffness > 0)
      return {geom, other >= 0 ? m.geom_bodyid[other] : -1};
  }
  return {};
}

void BodyContacts::soften(const mjModel& m, mjData* data) const {
  for (int i = 0; i < static_cast<int>(data->ncon); ++i) {
    const mjContact& contact = data->contact[i];
    const Side side = side_of(m, contact);
    if (side.geom < 0 || contact.efc_address < 0) continue;
    // Where a body touches in several points they share the region's spring.
    int points = 0;
    for (int k = 0; k < static_cast<int>(data->ncon); ++k) {
      const Side other = side_of(m, data->contact[k]);
      points += other.geom == side.geom && other.other_body == side.other_body;
    }
    BodySpring spring = springs_[static_cast<size_t>(side.geom)];
    spring.stiffness /= points;
    soften(m, contact, spring, data);
  }
}

void BodyContacts::soften(const mjModel& m, const mjContact& contact, const BodySpring& spring,
                          mjData* data) const {
  const Rows rows = rows_of(*data, contact);
  const double dt = m.opt.timestep, into = std::max(-contact.dist, 0.0);
  const double* velocity = data->efc_vel + rows.first;  // positive: parting [m/s]
  const double parting = rows.is_pyramid ? 0.5 * (velocity[0] + velocity[1]) : velocity[0];
  const double returned =
      1 - (1 - kUnloadingFraction) * std::clamp(parting / kUnloadingSpeed, 0.0, 1.0);
  const double in_bones = std::max(into - spring.depth, 0.0);
  const double force =
      returned * spring.stiffness * (into + kBoneStiffnessFactor * in_bones);  // [N]
  const double slope =
      returned * spring.stiffness * (in_bones > 0 ? 1 + kBoneStiffnessFactor : 1.0);  // [N/m]
  // Force at the end of a part of the step: none of it where an explicit force keeps the motion;
  // all of it for what is so light that an explicit force would make it jump.
  const double inverse_mass = std::max(data->efc_diagA[rows.first], 1e-9);
  const double stiff = slope * inverse_mass * dt * dt;  // squared phase of a step; above 4 it jumps
  const double ahead = std::clamp(0.5 * (stiff - 1), 1e-3, 1.0);
  const double mass = slope * ahead * dt * dt;
  const double reference = (force - slope * ahead * dt * parting) / mass;
  if (rows.is_pyramid) {
    for (int k = 0; k < rows.count; ++k)
      set_row(rows.first + k, mass / rows.count, reference - (velocity[k] - parting) / dt, data);
    return;
  }
  const double softer = 1 / (mass * data->efc_R[rows.first]);
  set_row(rows.first, mass, reference, data);
  for (int k = 1; k < rows.count; ++k) {
    const int row = rows.first + k;
    set_row(row, 1 / (softer * data->efc_R[row]), -velocity[k] / dt, data);
  }
}

}  // namespace gloam

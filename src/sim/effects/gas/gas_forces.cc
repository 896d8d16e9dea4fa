#include "sim/effects/gas/gas_forces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/effects/bodies/body_forces.h"
#include "sim/effects/wind/wind.h"
#include "world/shapes/visual_pose.h"

namespace gloam {
namespace {

constexpr Rational kForceUpdateRate{50, 1};  // [Hz]
// Share of its velocity through the air that drag may take from a body in a step: with more what is
// very light would swing.
constexpr double kMostPerStep = 0.25;
constexpr double kLeastMass = 1e-9;  // [kg]: MuJoCo's model ignores bodies without mass, too

// Cell of a gas that holds a point or is the nearest to it.
size_t nearest_cell(const GasDescription& gas, const double* p) {
  const auto along = [&](double x, float low, int n) {
    return static_cast<size_t>(std::clamp((x - double{low}) / double{gas.voxel}, 0.0, n - 1.0));
  };
  return (along(p[2], gas.low.z, gas.nz) * static_cast<size_t>(gas.ny) +
          along(p[1], gas.low.y, gas.ny)) *
             static_cast<size_t>(gas.nx) +
         along(p[0], gas.low.x, gas.nx);
}

bool is_inside(const GasDescription& gas, const double* p) {
  const Vec3f high = gas.low + gas.size();
  return p[0] >= double{gas.low.x} && p[0] <= double{high.x} && p[1] >= double{gas.low.y} &&
         p[1] <= double{high.y} && p[2] >= double{gas.low.z} && p[2] <= double{high.z};
}

// Velocity between the centres of cells; beside the box that at its edge.
void add_velocity(const GasDescription& gas, const std::vector<float>& velocity, const double* p,
                  double share, double* to) {
  const int n[3] = {gas.nx, gas.ny, gas.nz};
  int at[3];
  double part[3];
  for (int a = 0; a < 3; ++a) {
    const double x = (p[a] - double{gas.low[a]}) / double{gas.voxel} - 0.5;
    const double in = std::clamp(x, 0.0, n[a] - 1.0);
    at[a] = std::min(static_cast<int>(in), n[a] - 2);
    part[a] = in - at[a];
  }
  for (int corner = 0; corner < 8; ++corner) {
    double weight = share;
    size_t cell = 0;
    for (int a = 2; a >= 0; --a) {
      const int side = corner >> a & 1;
      weight *= side != 0 ? part[a] : 1 - part[a];
      cell = cell * static_cast<size_t>(n[a]) + static_cast<size_t>(at[a] + side);
    }
    for (size_t a = 0; a < 3; ++a) to[a] += weight * double{velocity[3 * cell + a]};
  }
}

// Air of a gas at the temperature of its surroundings.
Fluid air_of(const mjOption& option) {
  const Fluid own{option.density, option.viscosity};
  return own.fills_space() ? own : kAir;
}

// MuJoCo's drag on a box of half edges `half` that moves at `v` [m/s] through a fluid, in its axes.
void add_drag(const double* half, const double* v, Fluid fluid, double scale, double* force) {
  const double diameter = 2 * (half[0] + half[1] + half[2]) / 3;
  for (int a = 0; a < 3; ++a) {
    const double area = 4 * half[(a + 1) % 3] * half[(a + 2) % 3];
    force[a] -= scale * (3 * std::numbers::pi * diameter * fluid.viscosity * v[a] +
                         fluid.density / 2 * area * std::abs(v[a]) * v[a]);
  }
}

}  // namespace

GasForces::GasForces(const CompiledWorld& world, Rational timestep)
    : gases_(world.gases.gases),
      model_(*world.model),
      blows_(world.wind.blows()),
      is_mujocos_(has_own_drag(model_)),
      looks_(StepSchedule::at_most(kForceUpdateRate, timestep)) {
  const mjModel& m = model_;
  std::vector<bool> moves(static_cast<size_t>(m.nbody));
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) {
    const auto parent = static_cast<size_t>(m.body_parentid[b]);
    moves[static_cast<size_t>(b)] = m.body_dofnum[b] > 0 || moves[parent];
  }
  if (!is_mujocos_) parts_ = drag_parts(m);
  size_t part = 0;
  const std::vector<Affine3f> X_WB = body_poses_at_qpos0(m);
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) {
    if (!moves[static_cast<size_t>(b)] || m.body_mass[b] < kLeastMass) continue;
    ExposedBody exposed;
    exposed.body = b;
    while (part < parts_.size() && parts_[part].body < b) ++part;
    exposed.from = part;
    while (part < parts_.size() && parts_[part].body == b) ++part;
    exposed.to = part;
    const mjtNum* inertia = m.body_inertia + 3 * b;
    for (int a = 0; a < 3; ++a) {
      const double square = inertia[(a + 1) % 3] + inertia[(a + 2) % 3] - inertia[a];
      exposed.half[a] = std::sqrt(std::max(square, 1e-15) / m.body_mass[b] * 6) / 2;
    }
    for (int a = 0; a < 3; ++a)
      exposed.area = std::max(exposed.area, 4 * exposed.half[a] * exposed.half[(a + 1) % 3]);
    const int root = m.body_rootid[b];
    for (const RotorDescription& rotor : world.gases.rotors) {
      if (m.body_rootid[rotor.body] != root) continue;
      const Vec3f away = transform_point(X_WB[static_cast<size_t>(rotor.body)], rotor.p_B) -
                         X_WB[static_cast<size_t>(root)].p;
      exposed.reach = std::max(exposed.reach, double{length(away) + rotor.radius});
    }
    exposed_.push_back(exposed);
  }
}

// The air that would be where a body is: the mean of what it is a voxel beside each side of its
// box, since in it and close to it the gas moves as the body does. A tree with rotors feels what is
// beside all of its discs, in the plane: not the air that they drive.
void GasForces::look(int row, const mjModel& m, const mjData& d, const MediumField& field) {
  const GasDescription& gas = gases_[static_cast<size_t>(row)];
  if (field.velocity() == nullptr) return;
  const std::vector<float>& velocity = *field.velocity();
  const double voxel = double{gas.voxel};
  for (ExposedBody& exposed : exposed_) {
    const bool flies = exposed.reach > 0;
    const double* centre =
        flies ? d.subtree_com + 3 * model_.body_rootid[exposed.body] : d.xipos + 3 * exposed.body;
    if (!is_inside(gas, centre)) continue;
    exposed.gas = row;
    const double* R = d.ximat + 9 * exposed.body;
    std::fill_n(exposed.wind, 3, 0.0);
    const int sides = flies ? 4 : 6;
    for (int side = 0; side < sides; ++side) {
      const int axis = side / 2;
      const double way = (side % 2 != 0 ? 1 : -1) *
                         (flies ? exposed.reach + 2 * voxel : exposed.half[axis] + voxel);
      double p[3] = {centre[0], centre[1], centre[2]};
      for (int a = 0; a < 3; ++a) p[a] += way * (flies ? (a == axis ? 1 : 0) : R[3 * a + axis]);
      add_velocity(gas, velocity, p, 1.0 / sides, exposed.wind);
    }
    exposed.thinness =
        double{gas.temperature} / double{(*field.temperature())[nearest_cell(gas, centre)]};
    if (most_push(m, d, exposed) < kLeastPush) exposed.gas = -1;
  }
}

// Air around a body that is in no gas.
Fluid GasForces::outside(const mjModel& m) const {
  if (!is_mujocos_) return blows_ ? kAir : Fluid{};
  return {m.opt.density, m.opt.viscosity};
}

// Greatest acceleration that air can give a body at its present speed [m/s²].
double GasForces::most_push(const mjModel& m, const mjData& d, const ExposedBody& exposed) const {
  const Fluid air = air_of(m.opt);
  double twist[6];
  mj_objectVelocity(&m, &d, mjOBJ_BODY, exposed.body, twist, 0);
  double fast = mju_dist3(twist + 3, exposed.wind), square = fast * fast;
  if (outside(m).fills_space()) {
    const double own = mju_dist3(twist + 3, m.opt.wind);
    fast = mju_dist3(exposed.wind, m.opt.wind);
    square = fast * (fast + 2 * own) + std::abs(1 - exposed.thinness) * own * own;
  }
  const double edges = 2 * (exposed.half[0] + exposed.half[1] + exposed.half[2]);
  double area = is_mujocos_ ? exposed.area : 0;
  for (size_t n = exposed.from; n < exposed.to; ++n)
    area += *std::max_element(parts_[n].face, parts_[n].face + 3);
  return (air.density / 2 * area * square + std::numbers::pi * edges * air.viscosity * fast) /
         m.body_mass[exposed.body];
}

void GasForces::push(const mjModel& m, mjData& d) const {
  for (const ExposedBody& exposed : exposed_) {
    if (exposed.gas < 0) continue;
    if (is_mujocos_) push_box(m, d, exposed);
    for (size_t n = exposed.from; n < exposed.to; ++n) push_part(m, d, exposed, parts_[n]);
  }
}

void GasForces::push_part(const mjModel& m, mjData& d, const ExposedBody& exposed,
                          const DragPart& part) const {
  const Fluid own = outside(m);
  double p[3], v[3], past[3], force[3] = {}, less[3] = {};
  part.place(d, p);
  velocity_at(m, d, part.body, p, v);
  mju_sub3(past, v, exposed.wind);
  part.add_force(d, past, {kAir.density * exposed.thinness, kAir.viscosity}, m.opt.timestep, force);
  if (own.fills_space()) {
    mju_sub3(past, v, m.opt.wind);
    part.add_force(d, past, own, m.opt.timestep, less);
    mju_subFrom3(force, less);
  }
  constexpr double kNoTorque[3] = {};
  add_wrench(m, d, part.body, force, kNoTorque, p);
}

void GasForces::push_box(const mjModel& m, mjData& d, const ExposedBody& exposed) const {
  const Fluid own = outside(m), air = air_of(m.opt);
  const double* R = d.ximat + 9 * exposed.body;
  double twist[6], past[3], past_own[3], force[3] = {}, force_W[3];
  mj_objectVelocity(&m, &d, mjOBJ_BODY, exposed.body, twist, 0);
  mju_sub3(past, twist + 3, exposed.wind);
  const double speed = mju_norm3(past);
  mju_mulMatTVec3(past_own, R, past);
  add_drag(exposed.half, past_own, {air.density * exposed.thinness, air.viscosity}, 1, force);
  const double most = kMostPerStep * m.body_mass[exposed.body] * speed / m.opt.timestep;
  const double drag = mju_norm3(force);
  if (drag > most) mju_scl3(force, force, most / drag);
  mju_sub3(past, twist + 3, m.opt.wind);
  mju_mulMatTVec3(past_own, R, past);
  add_drag(exposed.half, past_own, own, -1, force);
  mju_mulMatVec3(force_W, R, force);
  constexpr double kNoTorque[3] = {};
  add_wrench(m, d, exposed.body, force_W, kNoTorque, d.xipos + 3 * exposed.body);
}

}  // namespace gloam

#include "sim/effects/water/water_forces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/effects/bodies/body_forces.h"

namespace gloam {
namespace {

constexpr double kRippleCrest = 0.3;  // [m]

}  // namespace

// One collider in a water. All in the geom's frame about its origin, but for what has a W.
struct WaterForces::Wet {
  const ImmersedShape& shape;
  const WaterDescription& water;
  const double *p, *R;           // X_WG
  double v[3], v_W[3], turn[3];  // its motion through the water [m/s], [rad/s]
  double flow_W[3], lift_W[3];   // acceleration of the water, and that less gravity [m/s²]
  // Sums over its elements:
  double mass = 0;                       // mass of the water displaced [kg]
  double centre[3] = {};                 // centre of it [m]
  double entering = 0;                   // rate at which the displaced mass grows [kg/s]
  double force[3] = {}, torque[3] = {};  // [N], [N m]
  double damping[3] = {}, spin[3] = {};  // -force over velocity [kg/s], -torque over turn [N m s]
};

WaterForces::WaterForces(const mjModel& model, const std::vector<WaterDescription>& waters,
                         const std::vector<ImmersedShape>& shapes)
    : waters_(waters),
      shapes_(shapes),
      armature_(static_cast<size_t>(model.nv)),
      inertia_(armature_.size()) {
  for (const WaterDescription& water : waters) {
    double crest = water.ripples.nx > 0 ? kRippleCrest : 0;
    for (const WaveDescription& wave : water.waves) crest += wave.amplitude;
    crests_.push_back(crest);
  }
}

bool WaterForces::is_near(size_t water, const ImmersedShape& shape, const mjData& data) const {
  const WaterDescription& w = waters_[water];
  const double *p = data.geom_xpos + 3 * shape.geom, *R = data.geom_xmat + 9 * shape.geom;
  double centre[3], half[3];
  mju_mulMatVec3(centre, R, shape.centre);
  mju_addTo3(centre, p);
  edges_around(R, shape.half, half);
  return std::abs(centre[0] - w.x) < half[0] + w.size_x / 2 &&
         std::abs(centre[1] - w.y) < half[1] + w.size_y / 2 &&
         centre[2] - half[2] < w.level + crests_[water] && centre[2] + half[2] > w.level - w.depth;
}

bool WaterForces::begin(mjModel& model, mjData& data, std::span<const HeightChange> ripples) {
  for (size_t water = 0; water < waters_.size(); ++water) {
    for (const ImmersedShape& shape : shapes_) {
      if (!is_near(water, shape, data)) continue;
      if (model_armature_ == nullptr) carry_nothing(model);
      push(model, data, shape, waters_[water], ripples[water]);
    }
  }
  return model_armature_ != nullptr;
}

void WaterForces::push(const mjModel& model, mjData& data, const ImmersedShape& shape,
                       const WaterDescription& water, const HeightChange& ripples) {
  Wet wet{
      shape, water, data.geom_xpos + 3 * shape.geom, data.geom_xmat + 9 * shape.geom, {}, {}, {},
      {},    {}};
  double centre[3], half[3];
  mju_mulMatVec3(centre, wet.R, shape.centre);
  mju_addTo3(centre, wet.p);
  edges_around(wet.R, shape.half, half);
  const SurfacePatch surface(water, ripples, centre[0], centre[1], half[0], half[1], data.time);
  const WaveMotion waves =
      wave_motion(water, centre[0], centre[1], centre[2] - water.level, data.time);
  const double flow[3] = {waves.velocity.x + water.current.x, waves.velocity.y + water.current.y,
                          waves.velocity.z + water.current.z};
  velocity_at(model, data, shape.body, wet.p, wet.v_W);
  mju_subFrom3(wet.v_W, flow);
  mju_mulMatTVec3(wet.v, wet.R, wet.v_W);
  mju_mulMatTVec3(wet.turn, wet.R, data.cvel + 6 * shape.body);
  wet.flow_W[0] = waves.acceleration.x;
  wet.flow_W[1] = waves.acceleration.y;
  wet.flow_W[2] = waves.acceleration.z;
  mju_sub3(wet.lift_W, wet.flow_W, model.opt.gravity);
  if (!sum_elements(surface, &wet)) return;
  sum_whole(&wet);
  double force_W[3], torque_W[3];
  mju_mulMatVec3(force_W, wet.R, wet.force);
  mju_mulMatVec3(torque_W, wet.R, wet.torque);
  add_wrench(model, data, shape.body, force_W, torque_W, wet.p);
  carry(model, data, wet);
}

// Sums displacement and drag. False: nothing is under water.
bool WaterForces::sum_elements(const SurfacePatch& surface, Wet* wet) {
  const ImmersedShape& shape = wet->shape;
  const WaterDescription& water = wet->water;
  const double *p = wet->p, *R = wet->R, *v = wet->v, *turn = wet->turn;
  const double bottom = water.level - water.depth;
  const double low_x = water.low_x(), low_y = water.low_y();
  const double high_x = low_x + water.size_x, high_y = low_y + water.size_y;
  // An element stands for a column as high as an upright one with its spread of heights.
  double high = 0, k[3];  // [m]; drag over v |v| and volume [kg/m⁴]
  for (int a = 0; a < 3; ++a) {
    high += R[6 + a] * R[6 + a] * shape.cell[a] * shape.cell[a];
    k[a] = water.density / 2 * shape.drag[a] * shape.area[a] / shape.volume;
  }
  high = std::sqrt(high);
  const double per_high = 1 / high;
  const double axial = shape.is_round ? 0 : 1;  // weight of the flow along z for the drag across
  constexpr size_t kSide = ElementCluster::kSide;
  double mass[kSide] = {}, entering[kSide] = {}, centre[3][kSide] = {}, force[3][kSide] = {};
  double damping[3][kSide] = {}, torque[3][kSide] = {}, spin[3][kSide] = {};
  for (const ElementCluster& cluster : shape.clusters) {
    const double *c = cluster.centre, *h = cluster.half;
    const double lowest = p[2] + R[6] * c[0] + R[7] * c[1] + R[8] * c[2] - std::abs(R[6]) * h[0] -
                          std::abs(R[7]) * h[1] - std::abs(R[8]) * h[2];
    if (lowest - high / 2 >= surface.most()) continue;  // dry
    for (size_t n = 0; n < kSide; ++n) {
      const double e[3] = {cluster.x[n], cluster.y[n], cluster.z[n]};
      const double x = p[0] + R[0] * e[0] + R[1] * e[1] + R[2] * e[2];
      const double y = p[1] + R[3] * e[0] + R[4] * e[1] + R[5] * e[2];
      const double z = p[2] + R[6] * e[0] + R[7] * e[1] + R[8] * e[2];
      // Masks instead of branches.
      const double inside = (x >= low_x && x <= high_x ? 1.0 : 0.0) *
                            (y >= low_y && y <= high_y ? 1.0 : 0.0) * (z >= bottom ? 1.0 : 0.0);
      const double over = (surface.height(x, y) - z) * per_high + 0.5;
      const double share = inside * (over > 0 ? (over < 1 ? over : 1.0) : 0.0);
      const double volume = share * cluster.volume[n];
      const double u[3] = {v[0] + turn[1] * e[2] - turn[2] * e[1],
                           v[1] + turn[2] * e[0] - turn[0] * e[2],
                           v[2] + turn[0] * e[1] - turn[1] * e[0]};
      const double lower = (1 - share) * high / 2;  // lower part, which is wet
      const double crossing =
          inside * per_high * cluster.volume[n] * (over > 0 ? 1.0 : 0.0) * (over < 1 ? 1.0 : 0.0);
      entering[n] -= crossing * (R[6] * u[0] + R[7] * u[1] + R[8] * u[2]);
      mass[n] += volume;
      const double across = u[0] * u[0] + u[1] * u[1], along = u[2] * u[2];
      const double beside = std::sqrt(across + axial * along);
      const double speed[3] = {beside, beside, std::sqrt(across + along)};
      double c[3], f[3];
      for (int a = 0; a < 3; ++a) {
        centre[a][n] += volume * (e[a] - R[6 + a] * lower);
        c[a] = k[a] * speed[a] * volume;
        f[a] = -c[a] * u[a];
        force[a][n] += f[a];
        damping[a][n] += c[a];
      }
      torque[0][n] += e[1] * f[2] - e[2] * f[1];
      torque[1][n] += e[2] * f[0] - e[0] * f[2];
      torque[2][n] += e[0] * f[1] - e[1] * f[0];
      spin[0][n] += c[2] * e[1] * e[1] + c[1] * e[2] * e[2];
      spin[1][n] += c[0] * e[2] * e[2] + c[2] * e[0] * e[0];
      spin[2][n] += c[1] * e[0] * e[0] + c[0] * e[1] * e[1];
    }
  }
  for (size_t n = 0; n < kSide; ++n) {
    wet->mass += mass[n], wet->entering += entering[n];
    for (int a = 0; a < 3; ++a) {
      wet->centre[a] += centre[a][n], wet->damping[a] += damping[a][n];
      wet->force[a] += force[a][n], wet->torque[a] += torque[a][n], wet->spin[a] += spin[a][n];
    }
  }
  if (wet->mass <= 0) return false;
  for (double& x : wet->centre) x /= wet->mass;
  wet->mass *= water.density;
  wet->entering *= water.density;
  return true;
}

// Sums the forces on the collider as a whole, at the middle of its submerged part: buoyancy and
// waves, viscous drag, and the momentum of the added water as it enters.
void WaterForces::sum_whole(Wet* wet) {
  const ImmersedShape& shape = wet->shape;
  const double part = wet->mass / wet->water.density / shape.volume;
  // Drag of a sphere (Stokes).
  const double viscous = 6 * std::numbers::pi * wet->water.viscosity * shape.radius * part;
  const double viscous_spin = viscous * shape.radius * shape.radius * 4 / 3;  // Kirchhoff
  double lift[3], flow[3], u[3], force[3], torque[3];
  mju_mulMatTVec3(lift, wet->R, wet->lift_W);
  mju_mulMatTVec3(flow, wet->R, wet->flow_W);
  mju_cross(u, wet->turn, wet->centre);
  mju_addTo3(u, wet->v);
  for (int a = 0; a < 3; ++a) {
    const double damping = viscous + std::max(wet->entering, 0.0) * shape.added[a];
    force[a] = wet->mass * (lift[a] + shape.added[a] * flow[a]) - damping * u[a];
    wet->damping[a] += damping;
    wet->torque[a] -= viscous_spin * wet->turn[a];
    wet->spin[a] += viscous_spin;
  }
  mju_cross(torque, wet->centre, force);
  mju_addTo3(wet->force, force);
  mju_addTo3(wet->torque, torque);
}

// Added mass and inertia, as armature of each joint by how it moves the collider; what couples two
// joints is left out. A step's worth of damping comes to it, (M + c dt) a = F - c v, which is
// drag by the velocity at the step's end and stable however light the body is.
void WaterForces::carry(const mjModel& m, mjData& d, const Wet& wet) {
  const ImmersedShape& shape = wet.shape;
  // Density of the water, spread over the whole shape
  const double density = wet.mass / shape.volume;
  const double mean = (shape.added[0] + shape.added[1] + shape.added[2]) / 3;
  const double dt = m.opt.timestep;
  double arm[3];
  mju_mulMatVec3(arm, wet.R, wet.centre);
  mju_addTo3(arm, wet.p);
  mju_subFrom3(arm, d.subtree_com + 3 * m.body_rootid[shape.body]);
  for (int dof = last_dof(m, shape.body); dof >= 0; dof = m.dof_parentid[dof]) {
    const int joint = m.dof_jntid[dof], axis = dof - m.jnt_dofadr[joint];
    const bool shift = m.jnt_type[joint] == mjJNT_FREE && axis < 3;
    const double* motion = d.cdof + 6 * dof;
    // Motion of the collider per unit of the joint's.
    double shift_W[3], s[3], t[3], change[3];
    mju_cross(shift_W, motion, arm);
    mju_addTo3(shift_W, motion + 3);
    mju_mulMatTVec3(s, wet.R, shift_W);
    mju_mulMatTVec3(t, wet.R, motion);
    mju_cross(change, s, wet.turn);
    double more = 0, growth = 0;
    for (int a = 0; a < 3; ++a) {
      const double mass = wet.mass * (shift ? shape.added[a] : mean);
      more += (mass + dt * wet.damping[a]) * s[a] * s[a] +
              (density * shape.added_inertia[a] + dt * wet.spin[a]) * t[a] * t[a];
      growth += 2 * mass * s[a] * change[a];
    }
    // A body that turns shows the water another side. With half of what its mass grows by, times
    // its velocity, against it that neither makes energy nor loses any.
    if (shift) d.qfrc_applied[dof] -= growth / 2 * wet.v_W[axis];
    armature_[static_cast<size_t>(dof)] += more;
    if (m.dof_simplenum[dof] > 0) inertia_[static_cast<size_t>(dof)] += more;  // read instead
  }
}

}  // namespace gloam

#include "sim/effects/bodies/body_drag.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/effects/bodies/body_forces.h"
#include "sim/effects/bodies/immersed_shape.h"

namespace gloam {
namespace {

constexpr double kMostTaken = 0.5;  // fraction of its velocity that drag takes in a step

// Mean over the volume of what the speed and the lever of its elements make of a turn.
void set_spin(const ImmersedShape& shape, DragPart* part) {
  for (const VolumeElement& e : shape.elements) {
    const double weight = e.volume / shape.volume;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const double x = e.p[b] - part->centre[b], y = e.p[c] - part->centre[c];
      part->spin[a] +=
          weight * std::sqrt(x * x + y * y) * (part->face[c] * x * x + part->face[b] * y * y);
    }
  }
}

DragPart part_of(const mjModel& m, const ImmersedShape& shape) {
  DragPart part;
  part.body = shape.body, part.geom = shape.geom, part.radius = shape.radius;
  for (const VolumeElement& e : shape.elements)
    for (int a = 0; a < 3; ++a) part.centre[a] += e.volume / shape.volume * e.p[a];
  for (int a = 0; a < 3; ++a) part.face[a] = shape.drag[a] * shape.area[a];
  set_spin(shape, &part);
  const int type = m.geom_type[shape.geom];
  part.is_round = shape.is_round;
  // A surface of revolution that turns about its axis displaces nothing.
  if (part.is_round) part.spin[2] = 0;
  if (type == mjGEOM_SPHERE) std::fill_n(part.spin, 3, 0.0);
  return part;
}

// The box of equal inertia.
DragPart box_part(const mjModel& m, int body) {
  DragPart part;
  part.body = body;
  const mjtNum* inertia = m.body_inertia + 3 * body;
  double edge[3];  // [m]
  for (int a = 0; a < 3; ++a) {
    const double square = inertia[(a + 1) % 3] + inertia[(a + 2) % 3] - inertia[a];
    edge[a] = std::sqrt(std::max(square, double{mjMINVAL}) / m.body_mass[body] * 6);
  }
  for (int a = 0; a < 3; ++a) part.face[a] = kBoxDrag * edge[(a + 1) % 3] * edge[(a + 2) % 3];
  // Over a box the mean of |x|³ is an eighth of its edge's cube over four.
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    part.spin[a] = (part.face[c] * std::pow(edge[b], 3) + part.face[b] * std::pow(edge[c], 3)) / 32;
  }
  part.radius = std::cbrt(edge[0] * edge[1] * edge[2] * 3 / (4 * std::numbers::pi));
  return part;
}

}  // namespace

bool has_own_drag(const mjModel& m) {
  if (m.opt.density > 0 || m.opt.viscosity > 0 || (m.opt.enableflags & mjENBL_SLEEP) != 0)
    return true;
  for (int geom = 0; geom < static_cast<int>(m.ngeom); ++geom)
    if (m.geom_fluid[mjNFLUID * geom] > 0) return true;
  return false;
}

void DragPart::place(const mjData& d, double* p) const {
  mju_mulMatVec3(p, rotation(d), centre);
  mju_addTo3(p, geom >= 0 ? d.geom_xpos + 3 * geom : d.xipos + 3 * body);
}

void DragPart::add_force(const mjData& d, const double* v, Fluid fluid, double timestep,
                         double* force) const {
  const double* R = rotation(d);
  double u[3];
  mju_mulMatTVec3(u, R, v);
  const double across = u[0] * u[0] + u[1] * u[1], speed = std::sqrt(across + u[2] * u[2]);
  const double beside = is_round ? std::sqrt(across) : speed;
  const double viscous = 6 * std::numbers::pi * fluid.viscosity * radius;
  const double most = kMostTaken * mass / timestep;
  double f[3];
  for (int a = 0; a < 3; ++a) {
    const double k = viscous + fluid.density / 2 * face[a] * (a < 2 ? beside : speed);
    f[a] = -std::min(k, most) * u[a];
  }
  for (int i = 0; i < 3; ++i)
    force[i] += R[3 * i] * f[0] + R[3 * i + 1] * f[1] + R[3 * i + 2] * f[2];
}

void DragPart::add_torque(const mjData& d, const double* w, Fluid fluid, double timestep,
                          double* torque) const {
  const double* R = rotation(d);
  double u[3], t[3];
  mju_mulMatTVec3(u, R, w);
  const double viscous = 8 * std::numbers::pi * fluid.viscosity * radius * radius * radius;
  const double most = kMostTaken * inertia / timestep;
  for (int a = 0; a < 3; ++a)
    t[a] = -std::min(viscous + fluid.density / 2 * spin[a] * std::abs(u[a]), most) * u[a];
  for (int i = 0; i < 3; ++i)
    torque[i] += R[3 * i] * t[0] + R[3 * i + 1] * t[1] + R[3 * i + 2] * t[2];
}

std::vector<DragPart> drag_parts(const mjModel& m) {
  std::vector<DragPart> parts;
  std::vector<bool> is_done(static_cast<size_t>(m.nbody));
  for (const ImmersedShape& shape : immersed_shapes(m)) {
    if (last_dof(m, shape.body) < 0) continue;  // a mocap body
    parts.push_back(part_of(m, shape));
    is_done[static_cast<size_t>(shape.body)] = true;
  }
  for (int body = 1; body < static_cast<int>(m.nbody); ++body) {
    if (!is_done[static_cast<size_t>(body)] && m.body_mass[body] >= mjMINVAL &&
        last_dof(m, body) >= 0)
      parts.push_back(box_part(m, body));
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const DragPart& a, const DragPart& b) { return a.body < b.body; });
  weigh_parts(m, &parts);
  return parts;
}

void weigh_parts(const mjModel& m, std::vector<DragPart>* parts) {
  std::vector<double> mass(static_cast<size_t>(m.nbody)), count(mass.size()), own(mass.size());
  const auto group = [&](int body) { return static_cast<size_t>(m.body_weldid[body]); };
  for (int body = 1; body < static_cast<int>(m.nbody); ++body)
    mass[group(body)] += m.body_mass[body];
  for (const DragPart& part : *parts)
    ++count[group(part.body)], ++own[static_cast<size_t>(part.body)];
  for (DragPart& part : *parts) {
    part.mass = mass[group(part.body)] / count[group(part.body)];
    const mjtNum* inertia = m.body_inertia + 3 * part.body;
    part.inertia = *std::min_element(inertia, inertia + 3) / own[static_cast<size_t>(part.body)];
  }
}

}  // namespace gloam

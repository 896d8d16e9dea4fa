// Momentum that rotors give to faces, and smoke that emissions give to cells, in one substep.

#include "sim/effects/gas/stirring.h"

#include <cmath>
#include <numbers>

#include "sim/effects/gas/gas_state.h"

namespace gloam {
namespace gas {

float disc_radius(const GasRotor& rotor, float voxel) { return max(rotor.radius, voxel); }

float far_wake_speed(const GasRotor& rotor, float voxel, float ambient_density) {
  const float radius = disc_radius(rotor, voxel);
  const float area = std::numbers::pi_v<float> * radius * radius;
  return 2 * std::sqrt(std::abs(rotor.thrust) / (2 * ambient_density * area));
}

}  // namespace gas

namespace {

/// Share of the thrust per volume that air at `away` [voxels] from the hub gets, before it is made
/// to sum up to 1: even over the disc, less towards its edge; a hat function across it.
float disc_weight(Vec3f away, Vec3f axis, float radius) {
  const float across = dot(away, axis);
  const float out = length(away - axis * across);
  return max(1.0f - std::abs(across) * (1 / gas::kDiscReach), 0.0f) *
         clamp((radius - out) * (1 / gas::kDiscEdge) + 0.5f, 0.0f, 1.0f);
}

}  // namespace

// The disc's thrust to the open faces of each axis, by their weights: whatever of it lies in walls
// or out of the box, air gains all of its momentum.
void GasSolver::State::push_by(const GasRotor& rotor, Vec3f hub, float dt) {
  const gas::Faces<const float> open = pressure.open();
  const Vec3f p = (hub - grid.low) / grid.voxel;  // [voxels]
  for (int a = 0; a < 3; ++a) {
    if (!(p[a] >= 0.0f && p[a] < float(shape.n(a)))) return;
  }
  const float radius = gas::disc_radius(rotor, grid.voxel) / grid.voxel;
  for (int a = 0; a < 3; ++a) {
    const float force = -rotor.thrust * rotor.axis[a];  // [N]
    if (force == 0.0f) continue;
    const gas::Shape faces = shape.faces(a);
    const Vec3f first{a == 0 ? 0.0f : 0.5f, a == 1 ? 0.0f : 0.5f, a == 2 ? 0.0f : 0.5f};
    int from[3], to[3];
    for (int b = 0; b < 3; ++b) {
      const float tilt = std::sqrt(max(1.0f - rotor.axis[b] * rotor.axis[b], 0.0f));
      const float reach =
          (radius + 0.5f * gas::kDiscEdge) * tilt + gas::kDiscReach * std::abs(rotor.axis[b]);
      const float n = float(faces.n(b));
      from[b] = int(clamp(std::ceil(p[b] - first[b] - reach), 0.0f, n));
      to[b] = int(clamp(std::floor(p[b] - first[b] + reach) + 1, 0.0f, n));
    }
    const size_t begin = additions.at.size();
    double sum = 0;
    for (int k = from[2]; k < to[2]; ++k) {
      for (int j = from[1]; j < to[1]; ++j) {
        for (int i = from[0]; i < to[0]; ++i) {
          const int c = shape.at(i, j, k);
          if (!(open[a][c] > 0.0f)) continue;
          const Vec3f at = Vec3f{float(i), float(j), float(k)} + first;
          const float weight = disc_weight(at - p, rotor.axis, radius);
          if (!(weight > 0.0f)) continue;
          additions.at.push_back(c);
          additions.values.push_back(weight);
          sum += double(weight);
        }
      }
    }
    if (!(sum > 0)) continue;
    // Mass of the air of a face [kg]
    const double mass = double(ambient_density()) * cell_volume();
    const float gain = float(double(force) * double(dt) / (mass * sum));
    for (size_t n = begin; n < additions.values.size(); ++n) additions.values[n] *= gain;
    additions.list.push_back({a, int(additions.at.size() - begin)});
  }
}

void GasSolver::State::find_additions(float dt, float since, std::span<const GasRotor> rotors,
                                      std::span<const GasEmission> emissions) {
  additions.list.clear(), additions.at.clear(), additions.values.clear();
  for (const GasRotor& rotor : rotors) push_by(rotor, rotor.hub + rotor.velocity * since, dt);
  const size_t begin = additions.at.size();
  const auto nx = size_t(shape.nx), ny = size_t(shape.ny);
  for (const GasEmission& emission : emissions) {
    const size_t row = emission.cell / nx;
    const int c = shape.at(int(emission.cell % nx), int(row % ny), int(row / ny));
    if (openings.solid[size_t(c)]) continue;
    additions.at.push_back(c);
    additions.values.push_back(float(double(emission.rate) * double(dt) / cell_volume()));
    budget.smoke_added += double(emission.rate) * double(dt);
  }
  if (additions.at.size() > begin)
    additions.list.push_back({3 + gas::kSmoke, int(additions.at.size() - begin)});
}

void GasSolver::State::add(int from_field, int to_field) {
  const gas::HostFields all = fields();
  size_t n = 0;
  for (const gas::Addition& addition : additions.list) {
    const size_t end = n + size_t(addition.count);
    if (addition.field >= from_field && addition.field < to_field) {
      gas::Field& field = *all[size_t(addition.field)];
      for (; n < end; ++n) field[size_t(additions.at[n])] += additions.values[n];
    }
    n = end;
  }
}

}  // namespace gloam

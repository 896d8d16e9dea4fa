#pragma once
// Smoke and fire in a box of voxels: one gas, moved by its heat, around walls that move.
//
// Momentum is that of air of one density; what hot gas weighs less lifts it (Boussinesq's inertia),
// so the buoyancy flux of plume theory is conserved at any temperature. Heat makes volume (low Mach
// number: Rehm and Baum 1978), which the pressure then lets flow out. What is solved how
// stands in kernel/transport.h, kernel/trace.h, kernel/reaction.h, multigrid.h, pressure.h.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "sim/effects/gas/gas_walls.h"

namespace gloam {

struct GasProperties {
  float ambient_temperature = 293;  ///< [K], (200, 400]
  /// Strength of vorticity confinement (Fedkiw, Stam and Jensen 2001), 0 = none. It gives back
  /// eddies that a coarse grid loses, where flow is not smooth. With more than 0.2 plumes
  /// in voxels of 0.1 m to 0.16 m are too wide (gas_flow_test.cc).
  float vorticity = 0.2f;
  /// Share of its heat that warm gas loses per second to walls and by radiation [1/s].
  float cooling = 0.02f;
  float dissipation = 0;  ///< rate of deposition of smoke [1/s]
  /// [J/kg]. Flexible polyurethane foam: 25 MJ/kg (SFPE Handbook, Tewarson: GM21 to GM37).
  float heat_of_combustion = 25e6f;
  /// Soot per fuel [kg/kg]. Flexible polyurethane foam: 0.10 to 0.23 (same table), wood: 0.015.
  float soot_yield = 0.10f;
  float radiated = 0.35f;  ///< fraction of the heat release that is radiated (FDS's default)
  /// Time in which fuel and air of one voxel mix [s]: "mixed is burnt" (eddy break-up, Magnussen
  /// and Hjertager 1977; of FDS's order at voxels of this size).
  float mixing_time = 0.1f;
  /// Sides of the box, -x +x -y +y -z +z: open air at rest pressure, or closed.
  bool open[6] = {true, true, true, true, true, true};
};

/// Gives evenly to the open cells inside an ellipsoid or a box; where that is smaller than a voxel,
/// to the cell it lies in.
struct GasSource {
  Affine3f X_WS;
  bool box = false;
  Vec3f half_size{0.1f, 0.1f, 0.1f};  ///< semi-axes or half edges [m]
  float fuel = 0;                     ///< [kg/s]
  float heat = 0;                     ///< [W], all of it to the gas
  float smoke = 0;                    ///< [kg/s]
  bool blows = false;
  /// Velocity of a blower, to which its cells' air is driven [m/s], world; at most 50
  Vec3f velocity;
};

/// A disc that drives air, of which it takes its thrust: the actuator disc of momentum theory
/// (Rankine 1865, Froude 1889; Leishman, "Principles of Helicopter Aerodynamics", chapter 2). What
/// air gains through it each second is the thrust, so that far behind a hovering one it moves
/// at twice sqrt(thrust / (2 density area)). It makes no swirl and no tip vortices. A disc narrower
/// than a voxel is spread over one.
struct GasRotor {
  Vec3f hub;         ///< [m], world, at the beginning of the step; elsewhere it does nothing
  Vec3f velocity;    ///< velocity of the hub during the step [m/s], world
  Vec3f axis;        ///< unit, along which thrust points
  float radius = 0;  ///< [m]
  float thrust = 0;  ///< [N]
};

/// Smoke that a cell is given; nothing where it is solid.
struct GasEmission {
  size_t cell = 0;  ///< as GasWalls::cell() counts
  float rate = 0;   ///< [kg/s]
};

struct GasStep {
  int substeps = 0;             ///< substeps of the whole step
  int transport_substeps = 0;   ///< substeps of smoke, heat and fuel, in all
  int pressure_iterations = 0;  ///< in all
  float max_speed = 0;          ///< at the end [m/s]
  /// L2 norms over cells of what is wrong with the divergence [1/s], the worst substep's.
  double divergence_before = 0, divergence_after = 0;
  int source_cells_blocked = 0;  ///< cells of sources that are solid
  int sources_blocked = 0;       ///< sources that have no open cell in the box: they give nothing
};

/// Since the start.
struct GasBudget {
  double smoke_added = 0, smoke_escaped = 0, smoke_deposited = 0;  ///< [kg]
  double fuel_added = 0, fuel_escaped = 0, fuel_burnt = 0;         ///< [kg]
  /// [J]. Lost: by cooling, and what would have heated gas beyond kHottest.
  double heat_added = 0, heat_escaped = 0, heat_lost = 0;
  double smoke_buried = 0, fuel_buried = 0, heat_buried = 0;  ///< in pockets that walls filled
};

/// Processor that steps a gas. A card computes the same as the CPU, in the same order of sums, but
/// for the budget and for the mean divergence of enclosed spaces, which round in the sixteenth
/// digit.
enum class GasDevice { kCpu, kCuda };

class GasSolver {
 public:
  /// Errors: fewer than 4 or more than 1024 cells along an axis, more than 2^27 cells, what does
  /// not fit into memory, properties out of range; kUnsupported: no card, or a build without CUDA.
  static Result<std::unique_ptr<GasSolver>> create(const GasGrid& grid,
                                                   const GasProperties& properties,
                                                   GasDevice device = GasDevice::kCpu);
  ~GasSolver();

  /// Called before each step in which something moved. `walls.grid` is create()'s.
  void set_walls(const GasWalls& walls);
  /// Sets the initial velocity of the air along `axis` at each face [m/s], in GasWalls' order.
  void set_velocity(int axis, std::span<const float> faces);
  /// `wind`: velocity of the air beyond the open sides [m/s], world axes. `emissions`: at most one
  /// per cell.
  GasStep step(float dt, std::span<const GasSource> sources, Vec3f wind,
               std::span<const GasRotor> rotors = {}, std::span<const GasEmission> emissions = {});

  /// Smoke concentration [kg/m³] and mean temperature [K] of cells, (nz, ny, nx).
  void read(std::vector<float>* density, std::vector<float>* temperature) const;

  /// Heat release in the last substep, with what is radiated of it [W/m³], (nz, ny, nx).
  void read_heat_release(std::vector<float>* power) const;

  /// Velocities of cells' centres [m/s], world, (nz, ny, nx, 3).
  void read_velocity(std::vector<float>* velocity) const;

  double smoke_mass() const;  ///< [kg]
  double heat() const;        ///< above that of ambient air [J]
  double fuel_mass() const;   ///< [kg]
  const GasBudget& budget() const;
  /// [m/s], world; outside of the box that of the nearest point of it.
  Vec3f velocity_at(Vec3f p_W) const;
  const GasGrid& grid() const;
  const GasProperties& properties() const;
  std::string device_name() const;  ///< the card's; "CPU"

  /// All that decides what comes next; restore() continues bit for bit. Walls are part of it.
  void save(std::vector<std::byte>* out) const;
  /// Errors (kInput): bytes that save() of a solver of this grid did not write. Then all stays.
  Status restore(std::span<const std::byte> bytes);
  uint64_t hash() const;

 private:
  struct State;
  explicit GasSolver(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gloam

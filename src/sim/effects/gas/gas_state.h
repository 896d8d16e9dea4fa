#pragma once
// State of a GasSolver.

#include <string>

#include "sim/effects/gas/cuda/cuda_gas.h"
#include "sim/effects/gas/gas_solver.h"
#include "sim/effects/gas/kernel/reaction.h"
#include "sim/effects/gas/momentum.h"
#include "sim/effects/gas/pressure.h"
#include "sim/effects/gas/transport.h"

namespace gloam {

struct GasSolver::State {
  State(const GasGrid& g, const GasProperties& p);

  GasGrid grid;
  GasProperties properties;
  gas::Shape shape;
  gas::Openings openings;
  gas::Pressure pressure;
  gas::Momentum momentum;
  gas::Transport transport;

  // With the pressure's solution, all that decides what comes next.
  gas::Field velocity[3];             ///< velocity of faces [m/s]
  gas::Field scalars[gas::kScalars];  ///< scalars of cells; ghosts hold ambient air: 0
  gas::Field burning;                 ///< heat release in the last substep [W/m³]
  uint64_t parity = 0;                ///< substeps of transport so far
  float last_dt = 0;                  ///< length of the last substep [s]
  GasBudget budget;
  GasWalls walls;

  gas::Field heated;                      ///< gain of kHeat in a substep
  std::vector<double> row_sums;           ///< sums of reactions: four for each row
  std::vector<float> row_most;            ///< greatest speeds
  std::vector<int> filled, freed, order;  ///< cells that walls took or left
  std::vector<int> depth;                 ///< depth of filled cells, 0 elsewhere

  /// If there is one, it steps the gas; fields here are then what was last fetched of it.
  std::unique_ptr<gas::CudaGas> card;
  uint32_t stale = 0;                    ///< a bit for each field that is newer on the card
  std::vector<gas::Gift> gifts;          ///< gifts of sources in a substep on the card
  std::vector<int> gift_cells, touched;  ///< touched: cells that walls' motion reads or changes
  gas::Additions additions;              ///< additions of rotors and emissions in a substep

  gas::Faces<float> faces() { return {velocity[0].data(), velocity[1].data(), velocity[2].data()}; }
  float ambient_density() const {  ///< [kg/m³]
    return gas::kAirDensity * 293.0f / properties.ambient_temperature;
  }
  float heat_unit() const {  ///< excess heat at which kHeat would be 1 [J/m³]
    return ambient_density() * gas::kHeatCapacity * properties.ambient_temperature;
  }
  double cell_volume() const {  ///< [m³]
    return double(grid.voxel) * double(grid.voxel) * double(grid.voxel);
  }
  double total(gas::Scalar scalar);  ///< sum over cells

  gas::HostFields fields() {
    return {&velocity[0], &velocity[1], &velocity[2], &scalars[0],         &scalars[1],
            &scalars[2],  &scalars[3],  &burning,     &pressure.solution()};
  }
  void fetch(uint32_t wanted) {
    if (const uint32_t late = wanted & stale; late != 0) card->download(late), stale &= ~late;
  }

  void take_walls(const GasWalls& next);
  void use_walls();
  void push_out(const GasWalls& next);
  void fill_in();
  void find_touched();

  void substep(float dt, std::span<const GasSource> sources, Vec3f wind, GasStep* step);
  void substep_on_card(float dt, std::span<const GasSource> sources, Vec3f wind, GasStep* step);
  template <class F>
  void feed(float dt, std::span<const GasSource> sources, GasStep* step, F&& give);
  gas::ReactionRates rates(float dt) const;
  void burn(float dt);
  void account_reaction(const double (&sums)[4]);
  void account_motion(const gas::Projection& projection, int transport_substeps,
                      const double (&escaped)[gas::kScalars], GasStep* step);
  void blow(std::span<const GasSource> sources);
  /// Fills `additions`; `since`: the middle of the substep, of the step [s].
  void find_additions(float dt, float since, std::span<const GasRotor> rotors,
                      std::span<const GasEmission> emissions);
  void push_by(const GasRotor& rotor, Vec3f hub, float dt);
  void add(int from_field, int to_field);  ///< `additions` of [from, to) to the fields here
  float max_speed();
};

}  // namespace gloam

#pragma once
// The state of a gas on an NVIDIA card, and its steps there. no_cuda.cc where the build has none.

#include <array>
#include <memory>
#include <span>
#include <string>

#include "gloam/result.h"
#include "sim/effects/gas/cuda/gift.h"
#include "sim/effects/gas/gas_walls.h"
#include "sim/effects/gas/kernel/reaction.h"
#include "sim/effects/gas/multigrid.h"
#include "sim/effects/gas/openings.h"
#include "sim/effects/gas/pressure.h"

namespace gloam::gas {

/// The fields that decide what comes next, in this order: velocities, scalars, heat release, the
/// pressure's solution.
inline constexpr int kFields = 3 + kScalars + 2;
using HostFields = std::array<Field*, kFields>;
inline constexpr uint32_t kAllFields = (1u << kFields) - 1, kVelocityFields = 7;
inline constexpr uint32_t field_of(Scalar scalar) { return 1u << (3 + scalar); }
inline constexpr uint32_t kBurningField = 1u << (3 + kScalars);

class CudaGas {
 public:
  struct Substep {
    float dt = 0;               ///< [s]
    float rescale = 1;          ///< scale of the last solution, for another dt
    Vec3f wind;                 ///< [m/s]
    float ambient_density = 0;  ///< [kg/m³]
    float vorticity = 0;        ///< GasProperties::vorticity
    ReactionRates rates;
    float power = 0;  ///< [W/m³] per fuel burnt
  };
  struct Outcome {
    double reaction[4] = {};  ///< sums over cells: heat made, heat lost, fuel burnt, smoke settled
    Projection projection;
    int transport_substeps = 0;
    double escaped[kScalars] = {};  ///< in cells' volumes
  };

  /// `fields`: of the host, which live as long as this. Errors (kUnsupported): no card, one that is
  /// too old or too small, a build without CUDA.
  static Result<std::unique_ptr<CudaGas>> make(const GasGrid& grid, const Openings& openings,
                                               const Multigrid& multigrid,
                                               const HostFields& fields);
  virtual ~CudaGas() = default;
  virtual std::string device_name() const = 0;

  /// Openings and multigrid were changed; closed faces take their walls' velocities.
  virtual void take_walls(const GasWalls& walls) = 0;
  /// Between the host's fields and the card's; a bit for each.
  virtual void upload(uint32_t fields) = 0;
  virtual void download(uint32_t fields) = 0;
  /// The same for scalars and heat release of these cells alone.
  virtual void download_cells(std::span<const int> cells) = 0;
  virtual void upload_cells(std::span<const int> cells) = 0;

  virtual float max_speed() = 0;  ///< [m/s]
  /// `cells`: of the gifts, one after the other. `additions`: of velocities, which come before the
  /// projection, and of scalars, which come with the gifts. Advances `parity` as
  /// Transport::carry() does.
  virtual Outcome substep(const Substep& substep, std::span<const Gift> gifts,
                          std::span<const int> cells, const Additions& additions,
                          uint64_t* parity) = 0;
};

}  // namespace gloam::gas

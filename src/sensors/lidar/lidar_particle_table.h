#pragma once
// Falling particles as a LiDAR meets them: those that are echoes of their own at each range.

#include <vector>

#include "render/kernel/lidar/lidar_detect.h"
#include "world/render_description.h"

namespace gloam {

struct LidarParticleTable {
  std::vector<LidarParticle> classes;  ///< empty = the volume is a medium
  std::vector<LidarCell> cells;
  float density = 1;  ///< [kg/m³]

  LidarParticles view() const {
    return {{classes.data(), static_cast<uint32_t>(classes.size())},
            {cells.data(), static_cast<uint32_t>(cells.size())},
            density};
  }
};

/// Differential cross-section of a particle straight back [m²/sr]. Drops: the two axial rays, off
/// the front and once off the back (van de Hulst 1957, "Light scattering by small
/// particles", 12.2), without the glory, which is narrower (wavelength over diameter: 1 mrad) than
/// what lies between the two lenses of a sensor, and which drops of a millimetre, flattened and
/// swinging, have not. Flakes: a lidar ratio of 18.8 sr, as ice is taken everywhere here.
float particle_backscatter(ParticleKind kind, float diameter);

/// Tables by volume; empty where it holds no falling particles.
std::vector<LidarParticleTable> tabulate_particles(const RenderDescription& rendered,
                                                   const LidarOptics& optics);

}  // namespace gloam

#pragma once
// The scene file's [[water]] tables as numbers: the sinusoids that its waves are made of, the grid
// of its ripples, the mesh that is seen of it. Without MuJoCo types.

#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene.h"

namespace gloam {

/// One sinusoid of a surface: height = amplitude * cos(kx x + ky y - omega t + phase).
struct WaveDescription {
  double amplitude = 0;   ///< [m]
  double kx = 0, ky = 0;  ///< [rad/m], world
  double omega = 0;       ///< [rad/s]
  double phase = 0;       ///< [rad]
  double k() const;       ///< [rad/m]
};

/// Cells of equal size over the whole surface, rows along y.
struct WaterGrid {
  int nx = 0, ny = 0;     ///< cells; 0 = none
  double dx = 0, dy = 0;  ///< [m]
  bool operator==(const WaterGrid&) const = default;
};

struct WaterDescription {
  std::string name;
  double x = 0, y = 0;                       ///< middle [m]
  double level = 0;                          ///< z of the surface at rest [m]
  double size_x = 0, size_y = 0, depth = 0;  ///< [m]
  double density = 0;                        ///< [kg/m³]
  double viscosity = 0;                      ///< [Pa s]
  Vec3 current;                              ///< [m/s]
  double clarity = 0;                        ///< Secchi depth [m]
  double short_slopes = 0;                   ///< mean square slope of waves too short for `waves`
  std::vector<WaveDescription> waves;
  WaterGrid ripples;        ///< none = bodies make no waves
  Rational ripple_rate;     ///< steps of them [Hz]
  double ripple_speed = 0;  ///< speed of ripples [m/s]
  WaterGrid mesh;           ///< mesh of the visible surface
  SourceLoc loc;

  double low_x() const { return x - size_x / 2; }
  double low_y() const { return y - size_y / 2; }
};

/// Errors: waters that overlap, waves steeper than water carries, or higher than the water is deep.
Result<std::vector<WaterDescription>> describe_waters(const Scene& scene);

}  // namespace gloam

#pragma once
// Effects of a scene, physics in addition to rigid bodies: air, smoke, fire, rotors and dust
// ([[gas]], [[fire]], [[smoke]], [[rotor]], [[dust]]: docs/effects.md), [[water]] (docs/water.md)
// and [[soil]] (docs/soil.md). Part of gloam/scene.h.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[gas]]: a box in which the flow of air, smoke and heat is solved. Colliders are walls in it.
/// Without a [[gas]], fires and smoke use the generated place's rooms, or 8 x 8 x 4 m around them.
struct GasOptions {
  std::string name = {};              ///< unique
  std::optional<Vec3> position = {};  ///< centre of the box [m]
  std::optional<Vec3> size =
      {};  ///< edge lengths [m]; without position and size: as without a [[gas]]
  std::optional<double> voxel = {};  ///< edge of a cell [m]; empty = 0.1, or more in large boxes
  Rational rate = {10, 1};           ///< steps of the solver per second of simulation time
  std::string medium = "smoke";      ///< medium carried by the air, as in [[volume]]
  /// Fuel of its fires: propane heptane wood pmma polyurethane polystyrene.
  std::string fuel = "polyurethane";
  double temperature = 293;       ///< temperature of the surrounding air [K]
  std::optional<Vec3> wind = {};  ///< wind of the surrounding air, which enters at open sides
                                  ///< [m/s]; empty = wind of [weather]
  std::vector<std::string> closed = {};  ///< closed sides: -x +x -y +y -z +z
  double vorticity = 0.2;                ///< confinement of eddies, 0 … 1
  double cooling = 0.02;                 ///< fraction of the heat lost per second [1/s]
  double settling = 0;                   ///< fraction of the smoke lost per second [1/s]
  SourceLoc loc = {};
};

/// [[fire]]: a burning region and its heat release.
struct FireOptions {
  std::string name = {};            ///< unique
  std::string body = {};            ///< full name of the body it is on; empty = world
  Vec3 position = {};               ///< centre of the burning box, in that body [m]
  Vec3 size = {0.6, 0.6, 0.2};      ///< size of the box in which fuel becomes gas [m]
  double power = 200e3;             ///< heat release after growth [W]
  std::string growth = "instant";   ///< NFPA's t²: instant slow medium fast ultrafast
  double start = 0;                 ///< [s]
  std::optional<double> stop = {};  ///< [s]; empty = it does not stop
  SourceLoc loc = {};
};

/// [[smoke]]: a source without flames: a smoke machine, an exhaust, a steaming pot.
struct SmokeOptions {
  std::string name = {};              ///< unique
  std::string body = {};              ///< full name of the body it is on; empty = world
  Vec3 position = {};                 ///< centre of the source, in that body [m]
  Vec3 size = {0.2, 0.2, 0.2};        ///< size of the source box [m]
  double rate = 1e-4;                 ///< mass rate of the medium [kg/s]
  double heat = 0;                    ///< heat released with the medium [W]
  std::optional<Vec3> velocity = {};  ///< velocity of the air in the box, in that body [m/s]
  double start = 0;                   ///< [s]
  std::optional<double> stop = {};    ///< [s]; empty = it does not stop
  SourceLoc loc = {};
};

/// [[rotor]]: a propeller or a fan, which drives the air of a [[gas]] in its disc against its
/// thrust.
struct RotorOptions {
  std::string name = {};      ///< unique
  std::string actuator = {};  ///< full name; its transmission is a site, its force the thrust [N]
  std::string site = {};      ///< instead of an actuator: full name; thrust points along its z
  std::optional<double> thrust = {};  ///< thrust of a rotor at a site [N]
  double radius = 0;                  ///< radius of the disc [m]
  SourceLoc loc = {};
};

/// [[dust]]: ground that releases dust into the air of a [[gas]] with the medium dust, when air
/// flows over it fast enough and when wheels and feet roll, slip and tread on it.
struct DustOptions {
  std::string name = {};              ///< unique
  std::optional<Vec3> position = {};  ///< centre of a box in which ground is dusty [m]
  std::optional<Vec3> size =
      {};  ///< edge lengths of that box [m]; without position and size: all ground in the gas
  double silt = 0.085;      ///< fraction of the loose surface below 75 µm, 0 … 1
  double clay = 0.05;       ///< fraction of the soil below 2 µm, 0 … 0.2
  double threshold = 0.25;  ///< friction velocity of air at which saltation begins [m/s]
  SourceLoc loc = {};
};

/// [[water]]: a box of water with waves on its surface. It applies buoyancy and drag to bodies.
struct WaterOptions {
  std::string name = {};                ///< unique
  Vec3 position = {};                   ///< middle of the surface at rest [m]
  std::array<double, 2> size = {4, 4};  ///< along x and y [m]
  double depth = 1;                     ///< [m]
  double wave_height = 0;   ///< significant height of waves: mean of the highest third [m]
  double wave_period = 2;   ///< period of the strongest waves [s]
  double wave_to = 0;       ///< propagation direction, from +x to +y [deg]
  double spread = 30;       ///< standard deviation of their directions [deg]
  double density = 998;     ///< [kg/m³]
  double viscosity = 1e-3;  ///< dynamic [Pa s]
  Vec3 current = {};        ///< [m/s]
  double clarity = 8;       ///< depth at which a white disk becomes invisible (Secchi) [m]
  bool ripples = true;      ///< bodies that cross the surface make waves
  SourceLoc loc = {};
};

/// [[soil]]: a bed of soft ground in which feet and wheels sink and leave tracks. Omitted
/// parameters have the measured values of its kind: docs/soil.md.
struct SoilOptions {
  std::string name = {};                ///< unique
  Vec3 position = {};                   ///< middle of the surface at rest [m]
  std::array<double, 2> size = {4, 4};  ///< along x and y [m]
  /// Depth of soft ground over the rigid ground below [m]; empty = 0.15; for snow with
  /// `over_ground`: the snow depth of [weather], if it has one.
  std::optional<double> depth = {};
  bool over_ground = false;         ///< follows the static surfaces below `position` at a height of
                                    ///< `depth` and thins out at its edges, instead of being level
  std::optional<double> cell = {};  ///< edge of a cell [m]; empty = 0.02, or more in large beds
  std::string kind = "dry_sand";    ///< dry_sand sandy_loam clayey_soil lean_clay snow mud lunar
  std::optional<double> n = {};     ///< Bekker's exponent of sinkage
  std::optional<double> k_c = {};   ///< Bekker's cohesive modulus [N/m^(n+1)]
  std::optional<double> k_phi = {};     ///< Bekker's frictional modulus [N/m^(n+2)]
  std::optional<double> cohesion = {};  ///< Mohr-Coulomb cohesion [Pa]
  std::optional<double> friction = {};  ///< Mohr-Coulomb friction angle [deg]
  std::optional<double> shear = {};     ///< Janosi and Hanamoto's displacement modulus K [m]
  std::optional<double> k_0 = {};       ///< Wong's stiffness of unloading at no sinkage [N/m³]
  std::optional<double> a_u = {};       ///< growth of that stiffness with sinkage [N/m⁴]
  SourceLoc loc = {};
};

}  // namespace gloam

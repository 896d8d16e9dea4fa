#pragma once
// Effects of a scene, physics beside rigid bodies: air, smoke, fire, rotors and dust ([[gas]],
// [[fire]], [[smoke]], [[rotor]], [[dust]]: docs/effects.md), [[water]] (docs/water.md) and
// [[soil]] (docs/soil.md). Part of gloam/scene.h.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[gas]]: a box of air that is solved for: smoke, heat and what moves them. Colliders are walls
/// in it. Without one, fires and smoke get the generated place's rooms, or 8 x 8 x 4 m around them.
struct GasOptions {
  std::string name = {};              ///< unique
  std::optional<Vec3> position = {};  ///< centre of the box [m]
  std::optional<Vec3> size = {};      ///< edges [m]; with neither: as without a [[gas]]
  std::optional<double> voxel = {};   ///< edge of a cell [m]; empty = 0.1, or more in large boxes
  Rational rate = {10, 1};            ///< steps of the solver per second of simulation time
  std::string medium = "smoke";       ///< medium that the air carries, as in [[volume]]
  /// Fuel of its fires: propane heptane wood pmma polyurethane polystyrene.
  std::string fuel = "polyurethane";
  double temperature = 293;       ///< temperature of the air around [K]
  std::optional<Vec3> wind = {};  ///< wind of the air around, which blows in at open sides [m/s];
                                  ///< empty = that of [weather]
  std::vector<std::string> closed = {};  ///< sides nothing passes: -x +x -y +y -z +z
  double vorticity = 0.2;                ///< confinement of eddies, 0 … 1
  double cooling = 0.02;                 ///< fraction of the heat that is lost each second [1/s]
  double settling = 0;                   ///< fraction of the smoke that is lost each second [1/s]
  SourceLoc loc = {};
};

/// [[fire]]: what burns, and how strongly.
struct FireOptions {
  std::string name = {};            ///< unique
  std::string body = {};            ///< full name of the body it is on; empty = world
  Vec3 position = {};               ///< centre of the burning box, in that body [m]
  Vec3 size = {0.6, 0.6, 0.2};      ///< size of the box in which fuel becomes gas [m]
  double power = 200e3;             ///< heat released once it has grown [W]
  std::string growth = "instant";   ///< NFPA's t²: instant slow medium fast ultrafast
  double start = 0;                 ///< [s]
  std::optional<double> stop = {};  ///< [s]; empty = it burns on
  SourceLoc loc = {};
};

/// [[smoke]]: a source without flames: a smoke machine, an exhaust, a steaming pot.
struct SmokeOptions {
  std::string name = {};              ///< unique
  std::string body = {};              ///< full name of the body it is on; empty = world
  Vec3 position = {};                 ///< centre of the source, in that body [m]
  Vec3 size = {0.2, 0.2, 0.2};        ///< size of the box that it comes from [m]
  double rate = 1e-4;                 ///< mass rate of the medium [kg/s]
  double heat = 0;                    ///< heat that comes with it [W]
  std::optional<Vec3> velocity = {};  ///< velocity of the air in the box, in that body [m/s]
  double start = 0;                   ///< [s]
  std::optional<double> stop = {};    ///< [s]; empty = it goes on
  SourceLoc loc = {};
};

/// [[rotor]]: a propeller or a fan: the air of a [[gas]] in its disc is driven against its thrust.
struct RotorOptions {
  std::string name = {};      ///< unique
  std::string actuator = {};  ///< full name; its transmission is a site, its force the thrust [N]
  std::string site = {};      ///< instead of an actuator: full name; thrust points along its z
  std::optional<double> thrust = {};  ///< thrust of a rotor at a site [N]
  double radius = 0;                  ///< radius of the disc [m]
  SourceLoc loc = {};
};

/// [[dust]]: ground that gives dust to the air of a [[gas]] whose medium is dust: to air that blows
/// over it fast enough, and to what rolls, slips and treads on it.
struct DustOptions {
  std::string name = {};              ///< unique
  std::optional<Vec3> position = {};  ///< centre of a box in which ground is dusty [m]
  std::optional<Vec3> size = {};  ///< edges of that box [m]; with neither: all ground in the gas
  double silt = 0.085;            ///< fraction of the loose surface below 75 µm, 0 … 1
  double clay = 0.05;             ///< fraction of the soil below 2 µm, 0 … 0.2
  double threshold = 0.25;        ///< friction velocity of air at which grains begin to jump [m/s]
  SourceLoc loc = {};
};

/// [[water]]: a box of water with a surface that waves move. It carries and drags bodies.
struct WaterOptions {
  std::string name = {};                ///< unique
  Vec3 position = {};                   ///< middle of the surface at rest [m]
  std::array<double, 2> size = {4, 4};  ///< along x and y [m]
  double depth = 1;                     ///< [m]
  double wave_height = 0;   ///< significant height of waves: mean of the highest third [m]
  double wave_period = 2;   ///< period of the strongest waves [s]
  double wave_to = 0;       ///< direction they run to, from +x to +y [deg]
  double spread = 30;       ///< standard deviation of their directions [deg]
  double density = 998;     ///< [kg/m³]
  double viscosity = 1e-3;  ///< dynamic [Pa s]
  Vec3 current = {};        ///< [m/s]
  double clarity = 8;       ///< depth at which a white disk is lost from sight (Secchi) [m]
  bool ripples = true;      ///< bodies that cross the surface make waves
  SourceLoc loc = {};
};

/// [[soil]]: a bed of soft ground that feet and wheels sink into and leave tracks in. What is not
/// given is as measured of its kind: docs/soil.md.
struct SoilOptions {
  std::string name = {};                ///< unique
  Vec3 position = {};                   ///< middle of the surface at rest [m]
  std::array<double, 2> size = {4, 4};  ///< along x and y [m]
  /// Depth of soft ground over the rigid ground below [m]; empty = 0.15; for snow with
  /// `over_ground`: the depth that [weather] has let fall, if it gives one.
  std::optional<double> depth = {};
  bool over_ground = false;          ///< lies `depth` above what stands still below `position`
                                     ///< and thins out at its edges, instead of level
  std::optional<double> cell = {};   ///< edge of a cell [m]; empty = 0.02, or more in large beds
  std::string kind = "dry_sand";     ///< dry_sand sandy_loam clayey_soil lean_clay snow mud lunar
  std::optional<double> n = {};      ///< Bekker's exponent of sinkage
  std::optional<double> k_c = {};    ///< Bekker's cohesive modulus [N/m^(n+1)]
  std::optional<double> k_phi = {};  ///< Bekker's frictional modulus [N/m^(n+2)]
  std::optional<double> cohesion = {};  ///< Mohr and Coulomb's [Pa]
  std::optional<double> friction = {};  ///< their angle [deg]
  std::optional<double> shear = {};     ///< Janosi and Hanamoto's displacement modulus K [m]
  std::optional<double> k_0 = {};       ///< Wong's stiffness of unloading at no sinkage [N/m³]
  std::optional<double> a_u = {};       ///< growth of that stiffness with sinkage [N/m⁴]
  SourceLoc loc = {};
};

}  // namespace gloam

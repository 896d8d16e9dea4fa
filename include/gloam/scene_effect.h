#pragma once
// What happens in a scene beside its robots: smoke, fire, rotors and dust ([[gas]], [[fire]],
// [[smoke]], [[rotor]], [[dust]]: docs/effects.md), [weather] and [adversity] (docs/weather.md),
// [[water]] (docs/water.md), [[soil]] (docs/soil.md), people and vehicles ([[agent]], [[crowd]],
// [navigation]: docs/agents.md). Part of gloam/scene.h; longer than other headers so that those a
// user meets are few.

#include <array>
#include <filesystem>
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
  std::optional<Vec3> position = {};  ///< of the box's centre [m]
  std::optional<Vec3> size = {};      ///< edges [m]; with neither: as without a [[gas]]
  std::optional<double> voxel = {};   ///< edge of a cell [m]; empty = 0.1, or more in large boxes
  Rational rate = {10, 1};            ///< steps of the solver per second of simulation time
  std::string medium = "smoke";       ///< what is carried, as of [[volume]]
  std::string fuel = "polyurethane";  ///< of its fires: propane heptane wood pmma
                                      ///< polyurethane polystyrene
  double temperature = 293;           ///< of the air around [K]
  std::optional<Vec3> wind = {};      ///< of the air around, blows in at open sides [m/s]; empty =
                                      ///< that of [weather]
  std::vector<std::string> closed = {};  ///< sides nothing passes: -x +x -y +y -z +z
  double vorticity = 0.4;                ///< confinement of eddies, 0 … 1
  double cooling = 0.02;                 ///< share of the heat that is lost each second [1/s]
  double settling = 0;                   ///< share of the smoke that is lost each second [1/s]
  SourceLoc loc = {};
};

/// [[fire]]: what burns, and how strongly.
struct FireOptions {
  std::string name = {};            ///< unique
  std::string body = {};            ///< full name of the body it is on; empty = world
  Vec3 position = {};               ///< of the middle of what burns, in that body [m]
  Vec3 size = {0.6, 0.6, 0.2};      ///< of the box in which fuel becomes gas [m]
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
  Vec3 position = {};                 ///< of its middle, in that body [m]
  Vec3 size = {0.2, 0.2, 0.2};        ///< of the box that it comes from [m]
  double rate = 1e-4;                 ///< of the medium [kg/s]
  double heat = 0;                    ///< that comes with it [W]
  std::optional<Vec3> velocity = {};  ///< of the air in the box, in that body [m/s]
  double start = 0;                   ///< [s]
  std::optional<double> stop = {};    ///< [s]; empty = it goes on
  SourceLoc loc = {};
};

/// [[rotor]]: a propeller or a fan: the air of a [[gas]] in its disc is driven against its thrust.
struct RotorOptions {
  std::string name = {};      ///< unique
  std::string actuator = {};  ///< full name; its transmission is a site, its force the thrust [N]
  std::string site = {};      ///< instead of an actuator: full name; thrust points along its z
  std::optional<double> thrust = {};  ///< of a site's rotor [N]
  double radius = 0;                  ///< of the disc [m]
  SourceLoc loc = {};
};

/// [[dust]]: ground that gives dust to the air of a [[gas]] whose medium is dust: to air that blows
/// over it fast enough, and to what rolls, slips and treads on it.
struct DustOptions {
  std::string name = {};              ///< unique
  std::optional<Vec3> position = {};  ///< of the centre of a box in which ground is dusty [m]
  std::optional<Vec3> size = {};      ///< its edges [m]; with neither: all ground in the gas
  double silt = 0.085;                ///< share of the loose surface below 75 µm, 0 … 1
  double clay = 0.05;                 ///< share of the soil below 2 µm, 0 … 0.2
  double threshold = 0.25;  ///< friction velocity of air at which grains begin to jump [m/s]
  SourceLoc loc = {};
};

/// [weather]: in numbers. What is not given is what the level of [adversity] says, and without one
/// fair. Rain and snow fall where the sky is open above.
struct WeatherOptions {
  std::optional<double> rain = {};        ///< [mm/h], default 0
  std::optional<double> snow = {};        ///< of water [mm/h], default 0
  std::optional<double> visibility = {};  ///< through what hangs in the air, by Koschmieder [m];
                                          ///< without rain and snow; default: clear
  std::optional<std::string> medium =
      {};  ///< what hangs, as of [[volume]]: fog (default) mist haze dust smoke
  std::optional<std::string> where = {};  ///< it hangs: everywhere (default) | rooms, those of a
                                          ///< generated building alone
  double scale_height = 0;  ///< over which it thins to 1/e above the lowest ground [m]; 0 = even
  double turbulence = 0;    ///< of its density: standard deviation over mean, 0 … 1
  std::optional<double> wind = {};  ///< mean speed 10 m above the ground [m/s], default 0
  double wind_from = 270;           ///< where it comes from, as of [sky]'s azimuth [deg]
  std::optional<double> gusts =
      {};  ///< standard deviation of its speed over the mean, default 0.15
  std::optional<double> wetness = {};  ///< of what the sky reaches, at the start, 0 … 1; default:
                                       ///< what the rain keeps it at
  std::optional<double> snow_cover = {};  ///< likewise: depth of snow at the start [m], default 0
  std::optional<double> lens_drops = {};  ///< share of cameras' front glass under drops, default 0
  SourceLoc loc = {};
};

/// [adversity]: a level, for which docs/weather.md has the numbers, and its numbers that stand
/// nowhere else.
struct AdversityOptions {
  std::string level = "none";          ///< none | minor | major
  std::optional<double> light = {};    ///< share of its light that each lamp of the place keeps
  std::optional<double> failing = {};  ///< share of those lamps that flicker
  std::optional<double> clutter = {};  ///< of the generated place, 0 bare … 1
  std::optional<int> people = {};      ///< who walk about
  std::optional<double> people_speed = {};  ///< [m/s]
  SourceLoc loc = {};
};

/// [[water]]: a box of water with a surface that waves move. It carries and drags bodies.
struct WaterOptions {
  std::string name = {};                ///< unique
  Vec3 position = {};                   ///< of the middle of its surface at rest [m]
  std::array<double, 2> size = {4, 4};  ///< along x and y [m]
  double depth = 1;                     ///< [m]
  double wave_height = 0;   ///< significant height of waves: mean of the highest third [m]
  double wave_period = 2;   ///< of the strongest waves [s]
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
  Vec3 position = {};                   ///< of the middle of its surface at rest [m]
  std::array<double, 2> size = {4, 4};  ///< along x and y [m]
  /// Of soft ground over what is rigid below [m]; empty = 0.15, of snow `over_ground` what
  /// [weather] has let fall, where it says how much.
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
  std::optional<double> a_u = {};       ///< and its growth with sinkage [N/m⁴]
  SourceLoc loc = {};
};

/// [navigation]: where agents can go, as Recast finds it from the colliders.
struct NavigationOptions {
  double cell = 0.1;        ///< edge of its voxels in the plane [m]
  double headroom = 1.9;    ///< [m]
  double radius = 0.3;      ///< that people keep from walls [m]
  double climb = 0.22;      ///< step that is taken without stairs [m]
  double slope = 40;        ///< [deg]
  Rational rate = {10, 1};  ///< decisions per second of simulation time
  SourceLoc loc = {};
};

/// One place on the way of an agent.
struct WaypointOptions {
  Vec3 position = {};  ///< on the ground below [m]
  double pause = 0;    ///< there [s]
  SourceLoc loc = {};
};

/// [[agent]]: someone or something that moves by itself and is no robot.
struct AgentOptions {
  std::string name = {};                    ///< unique
  std::string kind = "person";              ///< person | cart | forklift | car
  Vec3 position = {};                       ///< on the ground below, at the start [m]
  double heading = 0;                       ///< at the start, from +x to +y [deg]
  uint64_t seed = 0;                        ///< of body, clothes, paint and what it decides
  std::optional<double> height = {};        ///< of a person [m]; default: drawn
  std::optional<double> speed = {};         ///< that it likes to go [m/s]; default: of its kind
  std::string behavior = "wander";          ///< stand | wander | route | spline | tree
  std::vector<WaypointOptions> route = {};  ///< where it goes in turn, or a spline's points
  bool loop = true;                         ///< from the last of them to the first
  std::filesystem::path tree = {};          ///< behaviour tree, BehaviorTree.CPP's XML
  double start = 0;                         ///< of its first step [s]
  bool yields = true;  ///< it is pushed aside, and stops for what stands in its way; false: goes on
  SourceLoc loc = {};
};

/// [[crowd]]: people at places drawn from where one can go.
struct CrowdOptions {
  std::string name = {};             ///< unique; they are NAME0, NAME1 …
  int count = 4;                     ///< of them
  uint64_t seed = 0;                 ///< of all of them
  std::optional<double> speed = {};  ///< that they like to go [m/s]; default: drawn
  bool yields = true;                ///< as of [[agent]]
  SourceLoc loc = {};
};

}  // namespace gloam

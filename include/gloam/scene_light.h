#pragma once
// What a scene says of light beyond MJCF: lamps, the sky, and volumes of smoke, fog and dust. Part
// of gloam/scene.h; docs/light.md and docs/media.md have examples.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// On for `duty` of every period.
struct OnOffOptions {
  double period = 1;  ///< [s], > 0
  double duty = 0.5;  ///< share of the period, 0 … 1
  double phase = 0;   ///< share of a period that is over at time 0, 0 … 1
};
/// The light's level from a time on.
struct LightKeyOptions {
  double time = 0;   ///< [s], rising
  double level = 1;  ///< >= 0, 1 = the lamp's full strength
};
/// Ripple at twice the mains' frequency, with the mean 1.
struct MainsOptions {
  double frequency = 50;  ///< of the mains [Hz], > 0
  double depth = 0.3;     ///< (max - min) / (max + min), 0 … 1
};
/// A fluorescent tube that is switched on.
struct StarterOptions {
  double at = 0;        ///< [s]
  double warm_up = 20;  ///< time constant of its growth to full light [s], > 0
};
/// Noise with the mean 1.
struct FlameOptions {
  double bandwidth = 9;  ///< [Hz], > 0
  double depth = 0.4;    ///< 0 … 1
};
/// [light.schedule]: how a lamp changes over simulation time: the product of what is given.
struct LightScheduleOptions {
  std::optional<OnOffOptions> on_off = {};
  std::vector<LightKeyOptions> keys = {};
  bool hold = false;  ///< each key's level holds up to the next; else straight lines between them
  std::optional<MainsOptions> mains = {};
  std::optional<StarterOptions> starter = {};
  std::optional<FlameOptions> flame = {};
  SourceLoc loc = {};
};

/// [light.motion]: how a lamp turns or swings on simulation time. It has `spin` or `sway`.
struct LightMotionOptions {
  std::optional<double> spin = {};  ///< turns about `axis` [rev/min], counter-clockwise seen
                                    ///< against it; less than 0 = clockwise
  std::optional<double> sway = {};  ///< greatest angle of a hanging lamp's swing [deg]
  std::optional<double> cord = {};  ///< sway: from the lamp up to where it hangs [m], which sets
                                    ///< its period; 1
  std::optional<Vec3> axis = {};    ///< that it turns about, in the frame of `body`; 0, 0, 1; of a
                                    ///< sway 1, 0, 0
  double phase = 0;                 ///< share of a turn or swing that is over at time 0, 0 … 1
  SourceLoc loc = {};
};

/// [blackout]: all lamps go out: those of the place, of models and of the scene, and what glows.
struct BlackoutOptions {
  double at = 0;                     ///< when [s]
  std::optional<double> until = {};  ///< when they come back [s], > at; empty = never
  bool starter = false;  ///< they come back as fluorescent tubes do, each in its own time
  std::vector<std::string> except = {};     ///< names of lamps, or materials that glow, that stay
                                            ///< as they are; * stands for any text
  std::vector<std::string> emergency = {};  ///< likewise: of those that shine only while it lasts
  SourceLoc loc = {};
};

/// [[light]]: a lamp added to the scene. It shines along its own -Z. Its strength is exactly one of
/// intensity, flux, luminance and illuminance; with `ies` it may be left to the file.
struct LightOptions {
  std::string name = {};                   ///< unique
  std::string type = {};                   ///< point spot directional rect disk sphere mesh
  std::string body = {};                   ///< full name of the body it is fixed to; empty = world
  Vec3 position = {};                      ///< in the frame of `body` [m]
  std::optional<Vec3> look_at = {};        ///< what it points at, in the same frame [m]
  std::optional<Quat> orientation = {};    ///< instead of look_at; with neither it shines along -Z
  std::optional<double> intensity = {};    ///< [cd]: point, spot: the most; rect, disk: along the
                                           ///< axis; sphere
  std::optional<double> flux = {};         ///< [lm]: all but directional
  std::optional<double> luminance = {};    ///< [cd/m²]: point and spot with a radius, areas
  std::optional<double> illuminance = {};  ///< [lx] on a surface that faces it: directional
  std::optional<Vec3> color = {};  ///< linear Rec. 709; hue only, brightness is the strength
  std::optional<double> temperature = {};          ///< colour of a black body [K], 1000 … 20000
  std::optional<std::array<double, 2>> size = {};  ///< rect: along its x and y [m]
  std::optional<double> radius = {};    ///< disk, sphere; point, spot: of the luminous sphere [m]
  std::optional<double> angle = {};     ///< spot: half angle of the cone, 45; directional: angular
                                        ///< diameter, 0 [deg]
  std::optional<double> softness = {};  ///< spot: outer share of the cone over which it fades, 0
  std::filesystem::path file = {};      ///< mesh: OBJ, STL, PLY, glTF in the light's frame
  std::filesystem::path ies = {};       ///< point, spot: photometric file (LM-63)
  bool casts_shadow = true;             ///< areas always do
  std::optional<LightMotionOptions> motion = {};
  std::optional<LightScheduleOptions> schedule = {};
  SourceLoc loc = {};
};

/// A day of the Gregorian calendar.
struct CalendarDate {
  int year = 2000, month = 1, day = 1;  ///< 1900 … 2100, 1 … 12, 1 … the month's last
  bool operator==(const CalendarDate&) const = default;
};
/// Of a local clock.
struct ClockTime {
  int hour = 12, minute = 0;  ///< 0 … 23, 0 … 59
  double second = 0;          ///< 0 <= second < 60
  bool operator==(const ClockTime&) const = default;
};

/// [sky]: light from far away, one of: a picture (`file`), an even sky (`luminance`), or a clear
/// sky with its sun, by date and place or by the sun's position. It takes the place of MuJoCo's
/// skybox, image lights, ambient light and headlight.
struct SkyOptions {
  std::filesystem::path file = {};         ///< equirectangular HDR or EXR; its middle faces +X
  std::optional<double> scale = {};        ///< file: [cd/m²] of a value of one; 1
  std::optional<double> illuminance = {};  ///< file: instead of `scale`, of level ground [lx]
  std::optional<double> turn = {};         ///< file: counter-clockwise from above [deg]; 0

  std::optional<double> luminance = {};  ///< even [cd/m²]
  std::optional<Vec3> color = {};        ///< even: linear Rec. 709, hue only

  std::optional<CalendarDate> date = {};     ///< 2026-06-21
  std::optional<ClockTime> time = {};        ///< of day, by the clock there: 14:30:00
  std::optional<double> utc_offset = {};     ///< of the clock, east positive [h]; 0
  std::optional<double> speed = {};          ///< of the clock, in seconds of it per second of the
                                             ///< simulation; 0 = it stands still
  std::optional<double> latitude = {};       ///< north positive [deg]
  std::optional<double> longitude = {};      ///< east positive [deg]
  std::optional<double> sun_elevation = {};  ///< instead of date and place [deg]
  std::optional<double> sun_azimuth = {};    ///< with it: clockwise from north [deg]; 180
  std::optional<double> turbidity = {};      ///< 1 … 10; 2 very clear, 3 clear, 6 hazy; 3
  std::optional<double> ground_albedo = {};  ///< 0 … 1; 0.2
  std::optional<double> altitude = {};       ///< above sea level [m]; 0
  std::optional<double> north = {};          ///< of true north from +Y, counter-clockwise [deg]; 0
  SourceLoc loc = {};
};

/// [volume.pattern]: a density made by formula, 0 … 1, times the volume's.
struct VolumePatternOptions {
  std::string kind = {};  ///< plume: rises from the middle of the floor; cloud: fills the box
  uint64_t seed = 0;      ///< another shape of the same kind
  int resolution = 64;    ///< voxels along the longest edge, 8 … 256
  SourceLoc loc = {};
};

/// [[volume]]: a box that holds a medium. How much is `density` or `visibility`: even, or of a
/// value of one of `grid` or `pattern`.
struct VolumeOptions {
  std::string name = {};                 ///< unique
  Vec3 position = {};                    ///< of the box's centre in the world [m]
  std::optional<Quat> orientation = {};  ///< of the box in the world
  Vec3 size = {};                        ///< edges of the box [m]
  std::string medium = {};               ///< smoke fog mist haze dust; empty = own numbers
  /// Own numbers: one for all bands, or one each for red, green, blue, 905 nm, 1550 nm, 8–14 µm.
  std::vector<double> mass_extinction = {};  ///< [m²/kg]
  std::vector<double> albedo = {};           ///< of single scattering, 0 … 1
  std::vector<double> g = {};                ///< mean cosine of scattering, -1 … 1
  std::optional<double> density = {};        ///< [kg/m³]
  std::optional<double> visibility = {};     ///< [m]: contrast falls to 2 % there, green light
  double temperature = 293;                  ///< [K]
  double emission = 0;  ///< of its glow, relative to a black body's (1: Kirchhoff's law)
  double fade = 0;      ///< smooth fall to zero over this distance from the walls [m]
  std::filesystem::path grid = {};              ///< density: .npy of float32, (nz, ny, nx)
  std::filesystem::path temperature_grid = {};  ///< temperatures [K], of the same shape
  std::optional<VolumePatternOptions> pattern = {};
  SourceLoc loc = {};
};

}  // namespace gloam

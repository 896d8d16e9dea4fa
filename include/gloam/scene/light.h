#pragma once
// Lamps of a scene: [[light]] with schedule and motion, [blackout]. Part of gloam/scene.h;
// docs/light.md has examples.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/text.h"
#include "gloam/types.h"

namespace gloam {

/// On during the fraction `duty` of every period.
struct OnOffOptions {
  double period = 1;  ///< [s], > 0
  double duty = 0.5;  ///< fraction of the period, 0 … 1
  double phase = 0;   ///< fraction of a period elapsed at time 0, 0 … 1
};
/// The light's level at a time.
struct LightKeyOptions {
  double time = 0;   ///< [s], rising
  double level = 1;  ///< >= 0, 1 = the lamp's full strength
};
/// Ripple at twice the mains frequency, with mean 1.
struct MainsOptions {
  double frequency = 50;  ///< frequency of the mains [Hz], > 0
  double depth = 0.3;     ///< (max - min) / (max + min), 0 … 1
};
/// A fluorescent tube that is switched on.
struct StarterOptions {
  double at = 0;        ///< [s]
  double warm_up = 20;  ///< time constant for reaching full light [s], > 0
};
/// Noise with mean 1.
struct FlameOptions {
  double bandwidth = 9;  ///< [Hz], > 0
  double depth = 0.4;    ///< 0 … 1
};
/// [light.schedule]: changes of a lamp over simulation time, the product of all given factors.
struct LightScheduleOptions {
  std::optional<OnOffOptions> on_off = {};
  std::vector<LightKeyOptions> keys = {};
  bool hold = false;  ///< true: each key's level holds until the next; false: linear interpolation
  std::optional<MainsOptions> mains = {};
  std::optional<StarterOptions> starter = {};
  std::optional<FlameOptions> flame = {};
  SourceLoc loc = {};
};

/// [light.motion]: rotation (`spin`) or swing (`sway`) of a lamp over simulation time.
struct LightMotionOptions {
  std::optional<double> spin = {};  ///< rotation about `axis` [rev/min], counter-clockwise as seen
                                    ///< against the axis; < 0 = clockwise
  std::optional<double> sway = {};  ///< amplitude of a hanging lamp's swing [deg]
  std::optional<double> cord = {};  ///< sway: distance from the lamp to its suspension point [m],
                                    ///< which determines its period; 1
  /// Axis of rotation in the frame of `body`; 0, 0, 1; for a sway 1, 0, 0.
  std::optional<Vec3> axis = {};
  double phase = 0;  ///< fraction of a rotation or swing elapsed at time 0, 0 … 1
  SourceLoc loc = {};
};

/// [blackout]: turns off all lamps of the place, of models and of the scene, and all glowing
/// materials.
struct BlackoutOptions {
  double at = 0;                     ///< start [s]
  std::optional<double> until = {};  ///< end [s], > at; empty = never
  bool starter = false;  ///< lamps turn on again like fluorescent tubes, each with its own delay
  std::vector<std::string> except =
      {};  ///< names of lamps or glowing materials that are not affected; * matches any text
  /// Names, as in `except`, of lamps that shine only during the blackout.
  std::vector<std::string> emergency = {};
  SourceLoc loc = {};
};

/// Shape of a lamp (docs/light.md).
enum class LightType : uint8_t { kPoint, kSpot, kDirectional, kRect, kDisk, kSphere, kMesh };
template <>
struct EnumTable<LightType> {
  static constexpr const char* kNoun = "light type";
  static constexpr auto kNames =
      std::to_array<EnumName<LightType>>({{LightType::kPoint, "point"},
                                          {LightType::kSpot, "spot"},
                                          {LightType::kDirectional, "directional"},
                                          {LightType::kRect, "rect"},
                                          {LightType::kDisk, "disk"},
                                          {LightType::kSphere, "sphere"},
                                          {LightType::kMesh, "mesh"}});
};

/// Whether the lamp is a luminous surface.
constexpr bool is_area_light(LightType type) {
  return type != LightType::kPoint && type != LightType::kSpot && type != LightType::kDirectional;
}

/// [[light]]: a lamp added to the scene, shining along its own -Z. Its strength is given by exactly
/// one of intensity, flux, luminance and illuminance; with `ies` it can be omitted, and is then
/// that of the file.
struct LightOptions {
  std::string name = {};                 ///< unique
  std::optional<LightType> type = {};    ///< point spot directional rect disk sphere mesh
  std::string body = {};                 ///< full name of the body it is fixed to; empty = world
  Vec3 position = {};                    ///< in the frame of `body` [m]
  std::optional<Vec3> look_at = {};      ///< target point, in the same frame [m]
  std::optional<Quat> orientation = {};  ///< instead of look_at; with neither it shines along -Z
  std::optional<double> intensity =
      {};  ///< [cd]: point, spot: the maximum; rect, disk: along the axis; sphere
  std::optional<double> flux = {};         ///< [lm]: all types except directional
  std::optional<double> luminance = {};    ///< [cd/m²]: point and spot with a radius, areas
  std::optional<double> illuminance = {};  ///< [lx] on a surface facing the light: directional
  std::optional<Vec3> color =
      {};  ///< linear Rec. 709; only the hue, the strength determines the brightness
  std::optional<double> temperature = {};          ///< colour of a black body [K], 1000 … 20000
  std::optional<std::array<double, 2>> size = {};  ///< rect: along its x and y [m]
  std::optional<double> radius =
      {};  ///< disk, sphere; point, spot: radius of the luminous sphere [m]
  std::optional<double> angle = {};     ///< spot: half angle of the cone, 45; directional: angular
                                        ///< diameter, 0 [deg]
  std::optional<double> softness = {};  ///< spot: outer fraction of the cone over which it fades, 0
  std::filesystem::path file = {};      ///< mesh: OBJ, STL, PLY, glTF in the light's frame
  std::filesystem::path ies = {};       ///< point, spot: photometric file (LM-63)
  bool casts_shadow = true;             ///< areas always do
  std::optional<LightMotionOptions> motion = {};
  std::optional<LightScheduleOptions> schedule = {};
  SourceLoc loc = {};
};

}  // namespace gloam

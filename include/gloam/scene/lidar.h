#pragma once
// [[lidar]]: a LiDAR added to the scene (docs/lidar.md).

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[lidar.surface]]: properties of a material at the LiDAR's wavelength, which do not follow from
/// its colour.
struct LidarSurfaceOptions {
  std::string material = {};  ///< full name; * matches any text; the last match applies
  std::optional<double> diffuse =
      {};  ///< albedo of its untextured base, 0 … 1; empty = its red component
  /// Coefficient of retroreflection [cd/(lx m²)] (ASTM D4956: 70 engineer grade, 580 prismatic).
  double retro = 0;
  SourceLoc loc = {};
};

/// Options of a LiDAR. Empty options are taken from the preset. Angles are in degrees, as in data
/// sheets. Axes of the sensor's frame: x ahead, y to the left, z up (ROS REP 103).
struct LidarOptions {
  std::string name = {};  ///< unique
  std::string body = {};  ///< full name of the body or site to which it is fixed; empty = world
  Vec3 position = {};     ///< in the frame of `body` [m]
  Quat orientation = {};  ///< in the frame of `body`
  std::string preset = "OS1-64";  ///< named after data sheets; docs/lidar.md has the list
  /// Scan pattern: spinning (rotating rings), raster (a grid, column by column), flash (a grid, all
  /// at once), rosette (two rotating prisms).
  std::optional<std::string> pattern = {};
  std::optional<Rational> rate = {};  ///< scans per second of simulation time [Hz]
  /// spinning: elevation of each ring, up [deg]
  std::optional<std::vector<double>> elevations = {};
  std::optional<int> columns = {};                    ///< spinning: columns per turn; raster; flash
  std::optional<int> rows = {};                       ///< raster, flash
  std::optional<int> points = {};                     ///< rosette: points per scan
  std::optional<std::array<double, 2>> azimuth = {};  ///< spinning: from, to, of -180 … 180 [deg]
  /// raster, flash: across and up; rosette: both the same [deg]
  std::optional<std::array<double, 2>> field_of_view = {};
  std::optional<bool> clockwise = {};  ///< spinning, seen from above

  std::optional<int> wavelength = {};    ///< 905 or 1550 [nm]
  std::optional<double> min_range = {};  ///< start of the beams [m]
  std::optional<double> max_range = {};  ///< [m]
  /// Range at which a plate of 10 % reflectance is just detected, which sets the threshold; 0 = all
  /// echoes are detected [m]
  std::optional<double> range_at_10_percent = {};
  std::optional<std::array<double, 2>> divergence = {};  ///< full angle at 1/e², across, up [deg]
  /// Full width of the beam at 1/e² at its origin, across, up [m].
  std::optional<std::array<double, 2>> beam_size = {};
  /// Diameter of the receiver's lens [m]; 0 = it sees everything that the beam illuminates, at any
  /// distance.
  std::optional<double> receiver_diameter = {};
  /// Distance between the axes of receiver and beam [m]; empty = half of the lens diameter.
  std::optional<double> receiver_offset = {};
  std::optional<double> receiver_view = {};  ///< full field of view of a detector [deg]
  std::optional<double> pulse_length = {};   ///< echoes closer together merge [m]
  int footprint_rays = 1;                    ///< rays over the beam's cross-section, 1 … 32
  std::optional<std::string> returns = {};   ///< first strongest last dual all
  int most_returns = 3;                      ///< maximum number of returns with `all`, 1 … 5

  /// Bodies that its beams pass through, each with all its descendants: full names, * matches any
  /// text.
  std::vector<std::string> hide = {};
  std::vector<LidarSurfaceOptions> surfaces = {};

  /// Enables errors of range and amplitude, and drop-outs at the threshold.
  bool noise = false;
  std::optional<double> range_noise = {};  ///< standard deviation for strong signals [m]

  int motion_keys = 4;  ///< number of poses per scan, with linear motion in between; 1 … 64
  bool deskew =
      false;  ///< express points in the frame at the end of the scan instead of at their own times
  bool truth = false;                      ///< output part, instance and semantic of each point
  std::string intensity = "reflectivity";  ///< reflectivity (0 … 255, calibrated) | signal
  /// Files of each scan: pcd ply npy; empty = pcd if [record] lists "lidar", which it does by
  /// default.
  std::optional<std::vector<std::string>> outputs = {};
  SourceLoc loc = {};
};

}  // namespace gloam

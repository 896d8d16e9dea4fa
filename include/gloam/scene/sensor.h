#pragma once
// Depth, event and thermal cameras, rigs of cameras, and models of MuJoCo's sensors
// (docs/sensors.md). Each model is off unless its table or value is given.

#include <optional>
#include <string>
#include <vector>

#include "gloam/scene/imager.h"

namespace gloam {

/// [camera.stereo_depth]: model of a stereo depth camera with a pattern projector, for the output
/// sensor_depth. The camera is the reference eye. Errors that neither the preset nor the table
/// gives are off. Khoshelham and Elberink 2012; Keselman et al. 2017.
struct StereoDepthOptions {
  std::string preset = "none";            ///< none | d435 | kinect
  std::optional<double> baseline = {};    ///< second eye along the camera's +X [m], not 0
  std::optional<double> subpixel = {};    ///< step of the disparity [px]; 0 = none
  std::optional<double> noise = {};       ///< standard deviation of the disparity [px]
  std::optional<double> min_range = {};   ///< minimum reported depth [m]
  std::optional<double> max_range = {};   ///< maximum reported depth [m]; 0 = no limit
  std::optional<int> max_disparity = {};  ///< widest search [px]; 0 = no limit
  std::optional<bool> occlusion = {};     ///< no depth where the second eye is occluded
  std::optional<int> edge_loss = {};  ///< no depth within this many pixels of a depth discontinuity
  std::optional<double> half_signal = {};  ///< signal at which half of the pixels are lost; a white
                                           ///< wall facing the camera at 1 m gives 1; 0 = no loss
  uint64_t seed = 0;                       ///< beside the simulation's and the sensor's name
  SourceLoc loc = {};
};

/// [camera.events]: an event camera, output events (Rebecq, Gehrig and Scaramuzza 2018, "ESIM";
/// Gallego et al. 2020, "Event-based Vision: A Survey").
struct EventOptions {
  double threshold = 0.2;  ///< change of log light that triggers an event, for both signs
  double mismatch = 0;     ///< spread of the pixels' thresholds, same unit
  double refractory = 0;   ///< a pixel's dead time after an event [s]
  double noise_rate = 0;   ///< rate of noise events of each pixel [Hz]
  double dark = 0.001;     ///< added light, as a fraction of full scale
  uint64_t seed = 0;       ///< beside the simulation's and the sensor's name
  SourceLoc loc = {};
};

/// [camera.thermal]: a bolometer camera for 8 … 14 µm, output thermal. Its noise is defined as in
/// ASTM E1543, "Noise Equivalent Temperature Difference of Thermal Imaging Systems".
struct ThermalOptions {
  double netd = 0;             ///< noise-equivalent temperature difference at 300 K [K]
  double fixed_pattern = 0;    ///< spread of the pixels' offsets, at 300 K [K]
  double step = 0;             ///< quantisation of the output temperatures [K]; 0 = none
  double min = 0, max = 5000;  ///< range of the output temperatures [K]
  uint64_t seed = 0;           ///< beside the simulation's and the sensor's name
  SourceLoc loc = {};
};

/// Everything between a camera's light and its messages: part of [[camera]].
struct CameraSensing {
  std::optional<ImagerOptions> imager = {};
  std::optional<TimingOptions> timing = {};
  std::optional<StereoDepthOptions> stereo_depth = {};
  std::optional<EventOptions> events = {};
  std::optional<ThermalOptions> thermal = {};
};

/// [[temperature]]: surface temperatures. Later tables take precedence.
struct TemperatureOptions {
  std::string body = "*", material = "*";  ///< full names; * matches any text
  double temperature = 293.15;             ///< [K]
  double emissivity = 0.95;                ///< in 8 … 14 µm, 0 … 1; the rest reflects `ambient`
  double ambient = 293.15;                 ///< temperature of its surroundings [K]
  SourceLoc loc = {};
};

/// [[sensor]]: a model for MuJoCo's sensors. If several tables match a sensor, the last one
/// applies. Units are the sensor's own. Omitted values are taken from the preset, or off:
/// docs/sensors.md. Terms: IEEE Std 952-1997.
struct SensorOptions {
  std::string match = {};       ///< full name of the sensor; * matches any text
  std::string preset = "none";  ///< none, adis16470_gyro … (docs/sensors.md)
  Rational rate = {100, 1};     ///< [Hz]
  std::optional<TimingOptions> timing = {};
  std::optional<double> noise = {};             ///< standard deviation of a sample
  std::optional<double> noise_density = {};     ///< white noise, one-sided [unit/√Hz]
  std::optional<double> bias_instability = {};  ///< flat part of the Allan deviation [unit]
  std::optional<double> random_walk = {};       ///< K of IEEE 952: rate random walk [unit √Hz]
  std::optional<double> bias = {};              ///< standard deviation of the initial offset
  std::optional<double> offset = {};            ///< known offset
  std::optional<double> scale_error = {};       ///< standard deviation of the scale factor's error
  std::optional<double> range = {};             ///< largest magnitude; 0 = no limit
  std::optional<double> resolution = {};        ///< step; 0 = none
  uint64_t seed = 0;                            ///< beside the simulation's and the sensor's name
  SourceLoc loc = {};
};

/// Pose of a rig and the common options of its cameras.
struct RigOptions {
  std::string name = {};  ///< unique; its cameras are NAME/…
  std::string body = {};  ///< full name of the body or site to which it is fixed; empty = world
  Vec3 position = {};     ///< position of the left (or only reference) eye [m]
  std::optional<Vec3> look_at = {};      ///< point to look at, in the same frame [m]
  std::optional<Quat> orientation = {};  ///< instead of look_at
  double fovy = 58;                      ///< vertical field of view [deg]
  int width = 640, height = 480;         ///< [px]
  Rational rate = {30, 1};               ///< images per second of simulation time [Hz]
};

/// [[stereo]]: two identical, parallel cameras NAME/left and NAME/right.
struct StereoOptions : RigOptions {
  double baseline = 0.05;  ///< offset of the right eye along the left eye's +X [m]
  CameraSensing sensing = {};
  SourceLoc loc = {};
};

/// [[rgbd]]: NAME/depth, the reference eye with a stereo_depth model, and NAME/color beside it.
struct RgbdOptions : RigOptions {
  StereoDepthOptions depth = {.preset = "d435"};
  double color_offset = 0.015;            ///< offset of the colour camera along +X [m]
  std::optional<double> color_fovy = {};  ///< [deg]; default: `fovy` of the rig
  CameraSensing sensing = {};
  SourceLoc loc = {};
};

}  // namespace gloam

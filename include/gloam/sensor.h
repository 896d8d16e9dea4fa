#pragma once
// Messages of sensors without images: LiDARs, and MuJoCo's sensors with the models of the scene's
// [[sensor]] tables.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gloam/stream.h"
#include "gloam/types.h"

namespace gloam {

/// One sample of one sensor.
struct SensorMessage {
  std::string sensor;          ///< full name
  int64_t index = 0;           ///< number of the sample since reset; missing ones were dropped
  int64_t step = 0;            ///< physics step at which it was taken
  double time = 0;             ///< time of the state from which it was computed [s]
  double delivery = 0;         ///< time at which it reaches readers [s], >= time
  std::vector<double> values;  ///< MuJoCo's numbers and units, with the model's errors
};

struct SensorRequest {
  std::string sensor;     ///< full name, or "sensor_ID" if the model gives none
  bool required = false;  ///< the simulation waits for it; else samples are lost, oldest first
  EndCallback on_end = {};
};

class SensorStream : public Stream {};
/// Called on the stream's own thread as soon as a sample is computed; `delivery` is the simulated
/// time of its arrival.
using SensorCallback = std::function<void(const SensorMessage&)>;

/// A change of light at a pixel.
struct Event {
  uint16_t x = 0, y = 0;  ///< [px]
  bool brighter = false;
  double time = 0;  ///< [s]
};

/// One scan: returns in the order in which the beams were fired. x, y, z, intensity, ring and time
/// have the names and meanings of the PointCloud2 messages of ROS drivers.
struct LidarScan {
  std::string lidar;  ///< name
  int64_t index = 0;  ///< number of the scan since reset
  int64_t step = 0;   ///< physics step at its end
  double start = 0;   ///< simulation time at its start [s]; `time` is relative to it
  double end = 0;     ///< [s]
  int rings = 0;      ///< rows of the range image
  int columns = 0;    ///< columns of the range image; 0 = the pattern has none
  int beams = 0;      ///< fired, with and without a return
  bool deskewed = false;
  Pose X_WL_start,
      X_WL_end;  ///< pose of the sensor at the start and end; x ahead, y to the left, z up

  /// In the sensor's frame at the time when the beam was fired, or, if deskewed, at the end of the
  /// scan [m], (n)
  std::vector<float> x, y, z;
  /// Calibrated reflectivity: 100 = white Lambertian surface perpendicular to the beam; logarithmic
  /// above, up to 255 = a thousand times that (retroreflectors). Or the signal (docs/lidar.md). (n)
  std::vector<float> intensity;
  std::vector<float> range;            ///< along the beam [m], (n)
  std::vector<float> time;             ///< time of firing since `start` [s], (n)
  std::vector<uint16_t> ring;          ///< counted from below, (n)
  std::vector<uint16_t> column;        ///< (n)
  std::vector<uint8_t> return_number;  ///< 0 = the first that the sensor reports of this beam, (n)
  // Ground truth, empty unless requested.
  std::vector<uint32_t> part;                ///< row of the label table, 0 = a medium, (n)
  std::vector<uint32_t> instance, semantic;  ///< ids of the label table, 0 = a medium, (n)

  size_t size() const { return x.size(); }
};

struct LidarRequest {
  std::string lidar;      ///< name of a [[lidar]]
  bool required = false;  ///< the simulation waits for it; else scans are dropped, oldest first
  EndCallback on_end = {};
};

class LidarStream : public Stream {};
using ScanCallback = std::function<void(std::shared_ptr<const LidarScan>)>;

}  // namespace gloam

#pragma once
// What sensors without pictures put out: LiDARs, and MuJoCo's with the models of the scene's
// [[sensor]]s.

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
  double time = 0;             ///< of the state that it was computed from [s]
  double delivery = 0;         ///< when it reaches a reader [s], >= time
  std::vector<double> values;  ///< MuJoCo's numbers and units, with the model's errors
};

struct SensorRequest {
  std::string sensor;     ///< full name, or "sensor_ID" where the model gives none
  bool required = false;  ///< the simulation waits for it; else samples are lost, oldest first
  EndCallback on_end = {};
};

class SensorStream : public Stream {};
/// Comes on the stream's own thread as soon as a sample is made; who wants it at its time looks at
/// `delivery`.
using SensorCallback = std::function<void(const SensorMessage&)>;

/// A pixel that saw its light change.
struct Event {
  uint16_t x = 0, y = 0;  ///< [px]
  bool brighter = false;
  double time = 0;  ///< [s]
};

/// One scan: returns in the order in which the beams were fired. Names and meanings of x, y, z,
/// intensity, ring and time are those of ROS drivers' PointCloud2 messages.
struct LidarScan {
  std::string lidar;  ///< name
  int64_t index = 0;  ///< number of the scan since reset
  int64_t step = 0;   ///< physics step at its end
  double start = 0;   ///< simulation time at which it began [s]; `time` counts from there
  double end = 0;     ///< [s]
  int rings = 0;      ///< rows of the range image
  int columns = 0;    ///< columns of the range image; 0 = the pattern has none
  int beams = 0;      ///< fired, with and without a return
  bool deskewed = false;
  Pose X_WL_start, X_WL_end;  ///< of the sensor at both ends; x ahead, y to the left, z up

  /// In the sensor's frame as it stood when the beam was fired, or, deskewed, as it stands at the
  /// end [m], (n)
  std::vector<float> x, y, z;
  /// Calibrated reflectivity: 100 = white Lambertian across the beam; above, logarithmically, up to
  /// 255 = a thousand times that (retroreflectors). Or the signal (docs/lidar.md). (n)
  std::vector<float> intensity;
  std::vector<float> range;            ///< along the beam [m], (n)
  std::vector<float> time;             ///< of the firing, since `start` [s], (n)
  std::vector<uint16_t> ring;          ///< counted from below, (n)
  std::vector<uint16_t> column;        ///< (n)
  std::vector<uint8_t> return_number;  ///< 0 = the first that the sensor reports of this beam, (n)
  // Truth, empty unless asked for.
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

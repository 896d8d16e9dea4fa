#pragma once
// What sensors without pictures put out: MuJoCo's, with the models of the scene's [[sensor]]s.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gloam/result.h"

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
};

/// An open stream. Closing (destroying) it waits for its last callback.
class SensorStream {
 public:
  virtual ~SensorStream() = default;
  virtual int64_t dropped() const = 0;  ///< lost because the reader was slow, not by the model
  /// Why it delivers no more, if so: a recompile took its sensor away.
  virtual Status status() const { return {}; }
};
/// Comes on the stream's own thread as soon as a sample is made; who wants it at its time looks at
/// `delivery`.
using SensorCallback = std::function<void(const SensorMessage&)>;

/// A pixel that saw its light change.
struct Event {
  uint16_t x = 0, y = 0;  ///< [px]
  bool brighter = false;
  double time = 0;  ///< [s]
};

}  // namespace gloam

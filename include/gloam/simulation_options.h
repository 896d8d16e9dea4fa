#pragma once
// Options and counts of a simulation.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gloam/handle.h"
#include "gloam/physics_memory.h"
#include "gloam/text.h"
#include "gloam/types.h"

namespace gloam {

enum class Pace {
  kFast,      ///< as fast as possible: waits for required consumers
  kLockstep,  ///< as fast as possible, but only during step() and run_until()
  kRealTime,  ///< paced by the wall clock times `speed`; late consumers lose frames
  /// Like kRealTime, but slower if sensors need it: waits for every open camera, LiDAR, sensor and
  /// topic, so that none of their messages is lost. Views (CameraRequest::is_view) lose frames as
  /// in kRealTime. SimulationStats::realtime_factor reports the achieved speed.
  kSensors,
};
template <>
struct EnumTable<Pace> {
  static constexpr const char* kNoun = "pace";
  static constexpr auto kNames = std::to_array<EnumName<Pace>>({{Pace::kFast, "fast"},
                                                                {Pace::kLockstep, "lockstep"},
                                                                {Pace::kRealTime, "realtime"},
                                                                {Pace::kSensors, "sensors"}});
};
/// Whether the simulation waits for its recorders and sensors, so that nothing is lost.
inline bool waits_for_sensors(Pace pace) { return pace == Pace::kFast || pace == Pace::kSensors; }

struct SimulationOptions {
  uint64_t seed = 1;
  double timestep = 0;  ///< [s]; 0 = the model's own
  Pace pace = Pace::kFast;
  double speed = 1;          ///< for Pace::kRealTime and Pace::kSensors, > 0
  DataMaker make_data = {};  ///< empty = the simulation makes its own
  /// Called every 50 ms by a thread that waits in step() or run_until(). Returning false has the
  /// effect of Simulation::request_stop(). Empty = true.
  std::function<bool()> keep_waiting = {};
};

/// Cost and rate of one stream of a simulation since it was opened.
struct SensorCost {
  std::string name;     ///< "camera 'front'", "lidar 'roof'"
  double rate = 0;      ///< messages that the scene requests [Hz of simulation time]
  double achieved = 0;  ///< messages that were produced [Hz of simulation time]; 0 = fewer than two
  int64_t messages = 0;
  int64_t dropped = 0;   ///< instants lost because the stream was late
  double wall_ms = 0;    ///< mean wall time to produce and deliver a message [ms]
  double waited_ms = 0;  ///< mean wall time spent waiting for other sensors' rendering [ms]
};

struct SimulationStats {
  int64_t step = 0;
  double time = 0;             ///< [s]
  uint64_t hash = 0;           ///< hash of the state, chained over all steps
  double realtime_factor = 0;  ///< simulated seconds per wall second since the last resume
  int64_t dropped_snapshots = 0;
  int64_t commands_applied = 0;  ///< posted Commands, over all runs
  int64_t warnings = 0;          ///< MuJoCo's warnings of all types
  Pace pace = Pace::kFast;
  /// Streams that are or were open, in the order in which they were opened.
  std::vector<SensorCost> sensors = {};
};

/// A body under a pixel, for dragging.
struct PickResult {
  Body body;
  std::string name;
  Vec3 point_B;  ///< hit point in the body's frame [m]
  Vec3 point_W;  ///< hit point in the world [m]
};

}  // namespace gloam

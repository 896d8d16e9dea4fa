#pragma once
// Streams of Snapshots of a running simulation: state, joints, sensors, effects.

#include <cstdint>
#include <functional>

#include "gloam/snapshot.h"
#include "gloam/stream.h"
#include "gloam/types.h"

namespace gloam {

struct SnapshotRequest {
  Rational rate = {0, 1};  ///< per second of simulation time [Hz]; 0 = every step
  bool required = false;   ///< true: the simulation waits for the reader; false: Snapshots may be
                           ///< lost, oldest first
  int capacity = 64;       ///< queued Snapshots, 1 … 65536
  EndCallback on_end = {};
};

class SnapshotStream : public Stream {};
/// Called on the stream's own thread, for Snapshots in order. A recompile changes their World:
/// Snapshot::world().
using SnapshotCallback = std::function<void(const Snapshot&)>;

}  // namespace gloam

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
  bool required = false;   ///< the simulation waits for it; else Snapshots are lost, oldest first
  int capacity = 64;       ///< Snapshots that wait for the reader, 1 … 65536
  EndCallback on_end = {};
};

class SnapshotStream : public Stream {};
/// Comes on the stream's own thread, Snapshots in order. After a recompile they are of another
/// World: Snapshot::world().
using SnapshotCallback = std::function<void(const Snapshot&)>;

}  // namespace gloam

#pragma once
// Streams of Snapshots of a running simulation: state, joints, sensors, effects.

#include <cstdint>
#include <functional>

#include "gloam/result.h"
#include "gloam/snapshot.h"
#include "gloam/types.h"

namespace gloam {

struct SnapshotRequest {
  Rational rate = {0, 1};  ///< per second of simulation time [Hz]; 0 = every step
  bool required = false;   ///< the simulation waits for it; else Snapshots are lost, oldest first
  int capacity = 64;       ///< Snapshots that wait for the reader, 1 …
};

/// An open stream. Closing (destroying) it waits for its last callback.
class SnapshotStream {
 public:
  virtual ~SnapshotStream() = default;
  virtual int64_t dropped() const = 0;
  /// Why it delivers no more, if so.
  virtual Status status() const { return {}; }
};
/// Comes on the stream's own thread, Snapshots in order. After a recompile they are of another
/// World: Snapshot::world().
using SnapshotCallback = std::function<void(const Snapshot&)>;

}  // namespace gloam

#pragma once
// The Snapshots that bracket what a sensor does in one go: an exposure, a revolution.

#include <array>
#include <span>

#include "sim/loop/step_schedule.h"
#include "sim/snapshots/snapshot.h"

namespace gloam {

/// One or more Snapshots at even steps. The first is of the event's own step, the last at or after
/// the end of the window.
struct SnapshotWindow {
  std::array<Snapshot, KeySteps::kMost> keys;
  int count = 0;

  explicit operator bool() const { return count > 0; }
  std::span<const Snapshot> all() const { return {keys.data(), static_cast<size_t>(count)}; }
  void add(Snapshot snapshot) { keys[static_cast<size_t>(count++)] = std::move(snapshot); }
};

}  // namespace gloam

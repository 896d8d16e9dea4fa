#pragma once
// Data of one instant that metrics read.

#include <mujoco/mujoco.h>

#include <functional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "gloam/snapshot.h"
#include "sensors/probe/probe.h"
#include "sim/snapshots/snapshot.h"

namespace gloam {

class ProbeReadings;

struct MetricInstant {
  const Snapshot* snapshot = nullptr;
  const mjModel* model = nullptr;  ///< with the live fields of that instant
  const mjData* data = nullptr;    ///< after a forward pass at that instant
  std::span<const ContactState> contacts;
  double elapsed = 0;                ///< since the sample before [s]; 0 = the first of its episode
  std::span<const double> light;     ///< illuminance over each robot [lx]; empty = not measured
  std::span<const double> row = {};  ///< built-in metrics of this instant, for expressions
  const ProbeReadings* probes = nullptr;

  double time() const { return snapshot->time(); }
};

/// Measures of what is around robots: functions of renderers, which metrics do not see.
struct MetricProbes {
  /// Visibility at a place [m] (Koschmieder); empty = the scene has no media.
  std::function<double(const SnapshotData&, Vec3f p_W)> visibility = {};
  /// Illuminance of level surfaces [lx] at places [m]; empty = it is not measured.
  std::function<std::vector<double>(const Snapshot&, const std::vector<Vec3>&)> illuminance = {};
  int64_t light_every = 1;    ///< samples from one illuminance to the next
  ProbeSources sources = {};  ///< of the [[probe]]s that expressions name
};

}  // namespace gloam

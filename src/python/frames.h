#pragma once
// Messages of sensors as Python objects.

#include <memory>

#include "core.h"
#include "gloam/camera.h"
#include "gloam/sensor.h"

namespace gloam::python {

/// Frames and scans are immutable and shared; arrays of them keep them alive.
struct Frame {
  std::shared_ptr<const CameraFrame> data;
};
struct Scan {
  std::shared_ptr<const LidarScan> data;
};

nb::list label_rows(const std::vector<LabelRow>& rows);

}  // namespace gloam::python

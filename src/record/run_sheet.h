#pragma once
// The contact sheet of a recording.

#include <cstdint>
#include <span>
#include <vector>

#include "record/camera_recorder.h"
#include "record/recorder.h"

namespace gloam {

/// PNG. `rows`: a selection of the metrics' rows.
std::vector<uint8_t> run_sheet_png(const RunInfo& info, const RunOutcome& outcome,
                                   std::span<const CameraRecorder* const> cameras,
                                   const std::vector<std::vector<double>>& rows);

}  // namespace gloam

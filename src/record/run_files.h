#pragma once
// The texts of a recording: summary.json, cameras.json, labels.json.

#include <map>
#include <string>
#include <vector>

#include "record/recorder.h"

namespace gloam {

/// Counts of a camera, or, with scans for frames, of a LiDAR.
struct CameraCounts {
  std::string name, file_name;
  int64_t frames = 0;
  uint64_t dropped = 0;
};

/// `outcome` null: the run is still going on. `sensor_files`: of RunInfo::sensors, in order.
/// `entries` = names in the folder that belong to it.
std::string summary_json(const RunInfo& info, const RunOutcome* outcome,
                         const std::vector<CameraCounts>& cameras,
                         const std::vector<CameraCounts>& lidars,
                         const std::vector<std::string>& sensor_files, int64_t metric_rows,
                         uint64_t dropped_metric_rows, const std::vector<std::string>& entries,
                         const std::string& error);

/// `file_names`: of the cameras, in order.
std::string cameras_json(const std::vector<RecordedCamera>& cameras,
                         const std::vector<std::string>& file_names);

/// Objects of one picture, as in CameraFrame::objects.
std::string objects_json(const std::vector<ObjectView>& objects);
/// `ids`: of the labels, in order.
std::string labels_json(const std::vector<LabelRow>& labels, const std::vector<LabelIds>& ids);

}  // namespace gloam

#pragma once
// Writes one run into one folder, on threads of its own:
//
//   summary.json        what ran, how it ended (written at the start, replaced at the end)
//   cameras.json        intrinsics, frames and file patterns of every camera
//   labels.json         what the numbers in instance and semantic pictures mean
//   metrics.csv         one row per add_metrics(); units in the column names
//   state.csv           one row per add_state(): joints, controls, poses of robots' bodies
//   sensors/NAME.csv    one row per add_sensor(): number, step, times, values
//   contact_sheet.png   the run at a glance
//   CAMERA.mp4          H.264
//   CAMERA/poses.csv    pose of the camera's optical frame (Z forward, X right, Y down) per frame
//   CAMERA/rgb/000000.png        8-bit sRGB; the kinds of pictures are in gloam/outputs.h:
//   CAMERA/depth/000000.png      16-bit mm along the optical axis (ROS 16UC1), 0 = nothing or
//                                beyond 65.535 m
//   CAMERA/depth_exr/000000.exr  float m, channel Z (ROS 32FC1), +inf = nothing
//   CAMERA/sensor_depth/000000.png  as depth, of a stereo_depth model
//   CAMERA/raw/000000.png        16-bit numbers of the imager; three colours side by side in a row
//   CAMERA/thermal/000000.png    16-bit hundredths of a kelvin
//   CAMERA/events.csv            time_s, x, y, brighter
//   CAMERA/instance/000000.png, CAMERA/semantic/…, CAMERA/part/…   16-bit ids of labels.json
//   CAMERA/motion/000000.exr     px, channels U and V; scene_flow, normal: X, Y, Z; albedo: R, G, B
//   CAMERA/boxes/000000.json     objects, their boxes and visibility
//   LIDAR/scans.csv     times, points and poses (X ahead, Y to the left, Z up) of each scan
//   LIDAR/pcd/000000.pcd, LIDAR/ply/…, LIDAR/npy/…   points (record/point_cloud_file.h)
//
// Pictures are written whole or not at all, tables and videos only grow: after any failure
// everything written before it is readable.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gloam/camera.h"
#include "gloam/result.h"
#include "gloam/sensor.h"
#include "gloam/types.h"
#include "record/file_store.h"
#include "record/lidar_recorder.h"

namespace gloam {

struct RecorderOptions {
  std::filesystem::path folder;
  bool overwrite = false;  ///< replace an earlier recording in `folder`
  /// As RecordOptions::outputs; channels that a frame does not have are not written.
  std::vector<std::string> outputs = {"video", "png", "metrics", "contact_sheet"};
  /// true: add_frame() waits for the disk (batch runs); false: oldest frames are dropped and
  /// counted, add_frame() never waits.
  bool wait = true;
  int queue_frames = 8;  ///< frames per camera that may wait to be written
  std::shared_ptr<FileStore> store = make_disk_store();
};

struct RecordedCamera {
  std::string name;  ///< full name, as in CameraFrame::camera
  Intrinsics intrinsics;
  Rational rate = {20, 1};  ///< frames per second of simulation time
  /// Files of this camera instead of RecorderOptions::outputs, as CameraOptions::outputs.
  std::optional<std::vector<std::string>> outputs = {};
};

/// A curve of the contact sheet: columns of the metrics; `commanded` may be "".
struct MetricPlot {
  std::string title;  ///< "forward speed"
  std::string unit;   ///< "m/s"
  std::string measured, commanded;
};

struct RecordedSensor {
  std::string name;                  ///< full name, as in SensorMessage::sensor
  std::vector<std::string> columns;  ///< of its values, with their units
};

/// MuJoCo's ids of what a row of the label table is; -1 = it is no geom, or no body moves it.
struct LabelIds {
  int geom = -1, body = -1;
};

using NamedText = std::pair<std::string, std::string>;
using NamedNumber = std::pair<std::string, double>;

/// Facts that are known when a run starts.
struct RunInfo {
  std::string title;                ///< heading of the contact sheet
  std::vector<NamedText> versions;  ///< {"gloam", "0.1.0"}, {"mujoco", "4.0.1"} …
  std::string scene_file;           ///< "" for scenes made in code
  std::string scene_hash;           ///< hash of its content, hexadecimal
  uint64_t seed = 0;
  double timestep = 0;              ///< [s]
  double duration = 0;              ///< planned [s]
  std::vector<NamedText> settings;  ///< renderer tier, samples, threads …
  std::vector<NamedText> drawn;     ///< result of [[randomize]]: option and value
  std::vector<RecordedCamera> cameras;
  std::vector<RecordedLidar> lidars;
  std::vector<LabelRow> labels;
  std::vector<LabelIds> label_ids;          ///< ids of `labels`, in order
  std::vector<std::string> metric_columns;  ///< the first is the time [s]
  std::vector<std::string> state_columns;   ///< likewise
  std::vector<MetricPlot> plots;
  std::vector<std::string> beside;      ///< names of files that others write into the folder
  std::vector<RecordedSensor> sensors;  ///< in the order that add_sensor() may be called for
};

/// Facts that are known when it ended.
struct RunOutcome {
  std::string exit_reason = "completed";  ///< or "interrupted", "diverged: …"
  int64_t steps = 0;
  double simulated = 0;              ///< [s]
  std::string final_state_hash;      ///< hexadecimal
  std::vector<NamedNumber> timings;  ///< [s]
  std::vector<NamedNumber> results;  ///< numbers worth a line: velocity errors, falls …
  /// From the start, or a reset, to the next or the end.
  struct Episode {
    int64_t steps = 0;
    double simulated = 0;    ///< [s]
    std::string state_hash;  ///< at its end, hexadecimal
    std::vector<NamedNumber> results;
  };
  std::vector<Episode> episodes;
  /// Columns of metrics.csv with empty cells for want of a value, and how many.
  std::vector<std::pair<std::string, int64_t>> missing_metrics;
};

class Recorder {
 public:
  /// Errors: the folder is in use or cannot be made, two sensors of one name, an unknown output,
  /// a picture too large for a video.
  static Result<std::unique_ptr<Recorder>> start(const RecorderOptions& options,
                                                 const RunInfo& info);
  virtual ~Recorder() = default;  ///< without finish(): as after a crash

  /// Frames of one camera come in order; frames of unknown cameras are a bug. Any thread.
  virtual void add_frame(std::shared_ptr<const CameraFrame> frame) = 0;
  /// The same of scans.
  virtual void add_scan(std::shared_ptr<const LidarScan> scan) = 0;
  /// One value per column. One thread.
  virtual void add_metrics(std::span<const double> row) = 0;

  /// One value per state column. The thread of add_metrics().
  virtual void add_state(std::span<const double> row) = 0;

  /// A sample of one of RunInfo::sensors. One thread.
  virtual void add_sensor(const SensorMessage& message) = 0;

  /// The first failure so far, as ErrorKind::kPartial; it stops the recording.
  virtual Status status() const = 0;
  /// Writes what is queued, ends videos, makes contact sheet and summary. Returns what status()
  /// does then. Call once.
  virtual Status finish(const RunOutcome& outcome) = 0;
  /// After finish(): frames all of whose files are whole.
  virtual int64_t frames() const = 0;
  virtual const std::filesystem::path& folder() const = 0;
};

}  // namespace gloam

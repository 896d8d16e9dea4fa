#pragma once
// Whole jobs: a recorded run, stills. What `gloam run`, `demo` and `render` do.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gloam/camera.h"
#include "gloam/checkpoint.h"
#include "gloam/command.h"
#include "gloam/log.h"
#include "gloam/result.h"
#include "gloam/scene.h"
#include "gloam/simulation.h"
#include "gloam/world.h"

namespace gloam {

/// Progress::what once a job has stopped and only finishes its files.
inline constexpr const char* kFinishingFiles = "finishing the files";

struct RunRequest {
  std::filesystem::path out = {};  ///< results folder; empty = nothing is recorded
  bool overwrite = false;          ///< an existing results folder is replaced
  std::vector<std::string> cameras =
      {};  ///< full names; empty = all [[camera]]s of the scene, else all of the model
  int width = 0, height = 0;  ///< of every camera [px]; 0 = the camera's own
  Rational rate = {0, 1};     ///< of every camera [Hz]; 0 = the camera's own
  SimulationOptions simulation = {};
  /// Log of the run; without a file, [record] mcap makes one in `out`, run.mcap.
  LogRequest log = {};
  double duration = 0;  ///< [s]; 0 = the scene's
  /// Instant that the run goes on from, for `duration` more, in the World that is given.
  std::optional<Checkpoint> from = {};
  std::vector<Command> commands = {};  ///< posted before the first step
};

struct RunReport {
  std::filesystem::path out;
  int64_t steps = 0;
  double sim_time = 0;   ///< [s]
  double wall_time = 0;  ///< [s]
  uint64_t hash = 0;
  int64_t frames = 0;                ///< of all cameras, whose files are whole
  std::vector<std::string> written;  ///< the main result files, for people
  std::vector<std::pair<std::string, double>>
      results;                      ///< velocity errors, falls … as in summary.json
  std::vector<SensorCost> sensors;  ///< costs and rates of what was recorded
  Status status;  ///< why it ended early, if it did; what was recorded is readable
  std::vector<std::string> notes = {};  ///< for people: "poses only, since …"
};

/// Makes `outputs`, of kRecordOutputs (gloam/outputs.h), what a run of the scene records, of
/// cameras and LiDARs with outputs of their own, too. Formats of LiDARs stay, where "lidar" is
/// among them.
void set_record_outputs(const std::vector<std::string>& outputs, Scene* scene);

/// Runs a World for its duration and records what its Scene asks for. `progress` is called first
/// before any file is written; when it returns false the files are finished all the same. An Error
/// means that nothing could be started.
Result<RunReport> run_and_record(const World& world, const RunRequest& request,
                                 const ProgressCallback& progress);

/// Renders stills of the named cameras at one time. Outputs as CameraRequest. Error: unknown
/// camera, time < 0.
Result<std::vector<CameraFrame>> render_stills(const World& world, double time,
                                               const std::vector<CameraRequest>& requests,
                                               const ProgressCallback& progress);

/// Scenes that differ in something, seen by the same sensors side by side.
struct ComparisonRequest {
  struct Row {
    std::string name;
    Scene scene;  ///< runs for its duration
  };
  std::vector<Row> rows;
  /// A [[camera]] of all scenes with [camera.stereo_depth] and [camera.thermal], and a [[lidar]]
  /// with `truth`.
  std::string camera, lidar;
  Rational rate = {5, 1};          ///< of both [Hz]
  std::filesystem::path out = {};  ///< existing folder
  std::string name;                ///< of the files in it: NAME.mp4, NAME.png of its middle
};
/// Of one row, over all its instants; means but for the least visibility.
struct ComparisonResult {
  std::string name;
  double visibility = 0;   ///< the least at the camera, by Koschmieder [m]; 1e5 = clear
  double illuminance = 0;  ///< of a level surface at the camera [lx]
  double contrast = 0;     ///< RMS difference of log luminance over four pixels, 1 = a factor of e
  double lidar_returns = 0;  ///< first returns of surfaces over beams
  double media_returns = 0;  ///< and of media
};
/// Runs the scenes one after the other. A row of the video is a scene: picture, measured depth,
/// thermal picture, LiDAR from above. Errors: a scene that does not compile or diverges, no such
/// camera or LiDAR, files that cannot be written or are there already; stopped by `progress`.
Result<std::vector<ComparisonResult>> compare_scenes(const ComparisonRequest& request,
                                                     const ProgressCallback& progress);

/// A still's files, as written.
struct StillFiles {
  std::string camera;
  std::vector<std::filesystem::path> files;
};
/// Writes stills of one World into a folder: each camera's pictures under a name of its own
/// (write_frame), cameras.json, which tells whose they are, and, where a picture holds ids,
/// labels.json; both as a recorded run has them. `outputs`: as of CameraRequest; files of others
/// are left out, empty = all that the frames hold.
Result<std::vector<StillFiles>> write_stills(const World& world,
                                             const std::vector<CameraFrame>& frames,
                                             const std::filesystem::path& folder,
                                             const std::vector<std::string>& outputs = {});

/// Writes the channels of one frame as files beside each other: NAME.png, NAME_depth.png … Returns
/// their paths.
Result<std::vector<std::filesystem::path>> write_frame(
    const CameraFrame& frame, const std::filesystem::path& folder, const std::string& name,
    const std::vector<std::string>& outputs = {});

}  // namespace gloam

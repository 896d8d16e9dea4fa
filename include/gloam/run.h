#pragma once
// Complete jobs: recorded runs and stills, as in `gloam run`, `demo` and `render`.

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

/// Value of `Progress::what` while a stopped job finishes its files.
inline constexpr const char* kFinishingFiles = "finishing the files";

struct RunRequest {
  std::filesystem::path out = {};         ///< results folder; empty = record nothing
  bool overwrite = false;                 ///< replace an existing results folder
  std::vector<std::string> cameras = {};  ///< full names; empty = all [[camera]]s of the scene or,
                                          ///< without any, all cameras of the model
  int width = 0, height = 0;              ///< image size of every camera [px]; 0 = the camera's own
  Rational rate = {0, 1};                 ///< frame rate of every camera [Hz]; 0 = the camera's own
  SimulationOptions simulation = {};
  /// Log of the run. If it names no file, [record] mcap writes run.mcap in `out`.
  LogRequest log = {};
  double duration = 0;  ///< [s]; 0 = the scene's
  /// Instant from which the run continues for `duration`, in the given World.
  std::optional<Checkpoint> from = {};
  std::vector<Command> commands = {};  ///< posted before the first step
};

struct RunReport {
  std::filesystem::path out;
  int64_t steps = 0;
  double sim_time = 0;   ///< [s]
  double wall_time = 0;  ///< [s]
  uint64_t hash = 0;
  int64_t frames = 0;                ///< number of frames of all cameras with complete files
  std::vector<std::string> written;  ///< main result files, for display
  std::vector<std::pair<std::string, double>>
      results;                      ///< velocity errors, falls … as in summary.json
  std::vector<SensorCost> sensors;  ///< costs and rates of the recorded sensors
  Status status;                    ///< reason if the run ended early; recorded data is readable
  std::vector<std::string> notes = {};  ///< for display: "poses only, since …"
};

/// Sets the outputs that a run of the scene records to `outputs`, from kRecordOutputs
/// (gloam/outputs.h), also for cameras and LiDARs with their own outputs. LiDARs keep their formats
/// if "lidar" is among the outputs.
void set_record_outputs(const std::vector<std::string>& outputs, Scene* scene);

/// Runs a World for its duration and records the outputs that its Scene requests. The first call of
/// `progress` comes before any file is written; when it returns false, the run stops and finishes
/// its files. An Error means that the run could not be started.
Result<RunReport> run_and_record(const World& world, const RunRequest& request,
                                 const ProgressCallback& progress);

/// Renders stills of the named cameras at one time. Outputs as in CameraRequest. Error: unknown
/// camera, time < 0.
Result<std::vector<CameraFrame>> render_stills(const World& world, double time,
                                               const std::vector<CameraRequest>& requests,
                                               const ProgressCallback& progress);

/// Comparison of several scenes, observed by the same sensors.
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
  std::string name;                ///< of the files: NAME.mp4, and NAME.png of its middle frame
};
/// Values of one row over all its instants: the minimum of the visibility, means of the others.
struct ComparisonResult {
  std::string name;
  double visibility = 0;   ///< minimum at the camera, by Koschmieder [m]; 1e5 = clear
  double illuminance = 0;  ///< of a level surface at the camera [lx]
  double contrast = 0;     ///< RMS difference of log luminance over four pixels, 1 = a factor of e
  double lidar_returns = 0;  ///< fraction of beams whose first return is from a surface
  double media_returns = 0;  ///< the same for media
};
/// Runs the scenes one after the other. Each row of the video is a scene: image, measured depth,
/// thermal image, LiDAR from above. Errors: a scene that does not compile or diverges, no such
/// camera or LiDAR, files that cannot be written or already exist; cancelled by `progress`.
Result<std::vector<ComparisonResult>> compare_scenes(const ComparisonRequest& request,
                                                     const ProgressCallback& progress);

/// Files written for one still.
struct StillFiles {
  std::string camera;
  std::vector<std::filesystem::path> files;
};
/// Writes stills of one World into a folder: each camera's images under a unique name
/// (write_frame), cameras.json, which maps the files to cameras, and labels.json if an image
/// contains ids. Both files have the format of a recorded run. `outputs`: the outputs to write, as
/// in CameraRequest; empty = all channels of the frames.
Result<std::vector<StillFiles>> write_stills(const World& world,
                                             const std::vector<CameraFrame>& frames,
                                             const std::filesystem::path& folder,
                                             const std::vector<std::string>& outputs = {});

/// Writes the channels of one frame as separate files: NAME.png, NAME_depth.png … Returns their
/// paths.
Result<std::vector<std::filesystem::path>> write_frame(
    const CameraFrame& frame, const std::filesystem::path& folder, const std::string& name,
    const std::vector<std::string>& outputs = {});

}  // namespace gloam

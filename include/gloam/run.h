#pragma once
// Whole jobs: a recorded run, stills. What `gloam run`, `demo` and `render` do.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gloam/camera.h"
#include "gloam/result.h"
#include "gloam/scene.h"
#include "gloam/simulation.h"
#include "gloam/world.h"

namespace gloam {

struct RunRequest {
  std::filesystem::path out = {};  ///< results folder; empty = nothing is recorded
  bool overwrite = false;          ///< an existing results folder is replaced
  std::vector<std::string> cameras =
      {};  ///< full names; empty = all [[camera]]s of the scene, else all of the model
  int width = 0, height = 0;  ///< of every camera [px]; 0 = the camera's own
  Rational rate = {0, 1};     ///< of every camera [Hz]; 0 = the camera's own
  SimulationOptions simulation = {};
  double duration = 0;  ///< [s]; 0 = the scene's
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
      results;    ///< velocity errors, falls … as in summary.json
  Status status;  ///< why it ended early, if it did; what was recorded is readable
};

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

/// Writes the channels of one frame as files beside each other: NAME.png, NAME_depth.png … Returns
/// their paths.
Result<std::vector<std::filesystem::path>> write_frame(const CameraFrame& frame,
                                                       const std::filesystem::path& folder,
                                                       const std::string& name);

}  // namespace gloam

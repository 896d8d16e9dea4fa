#pragma once
// RunPlan: a request for a recorded run, resolved against its World. It knows the files, streams
// and rates of the run before any of them is opened.

#include <span>
#include <string>
#include <vector>

#include "gloam/run.h"
#include "record/recorder.h"
#include "sensors/camera/camera_sensor.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {

struct RunPlan {
  /// Error: the log has no such topic.
  static Result<RunPlan> make(const World& world, const RunRequest& request);

  World world;
  RunRequest request;
  LogRequest log;           ///< the request's, or else the scene's; without a file, no log
  double duration = 0;      ///< [s]
  bool waits = false;       ///< the simulation waits for its sensors, recorder and log
  bool has_folder = false;  ///< a results folder is written, with the tables that follow
  bool records_pictures = false;
  bool records_metrics = false;
  bool records_state = false;
  bool records_sensors = false;
  bool meters = false;  ///< automatic exposures are computed also between pictures

  const Scene& scene() const { return world.compiled()->scene; }
  /// Rate of the metrics: the scene's, or every step of slower models.
  Rational metric_rate(Rational step_rate) const;
  /// The requested cameras that have outputs to record; by default all [[camera]]s of the scene and
  /// the cameras of its robots, or a bare model's own. A camera without a rate has the default one,
  /// or every step of slower models.
  std::vector<CameraRequest> cameras(const RenderDescription& description,
                                     Rational step_rate) const;
  /// LiDARs whose files are recorded. Errors: invalid options, a rate above the step rate.
  Result<std::vector<RecordedLidar>> lidars(Rational step_rate) const;
};

/// The `cameras` of a plan as the recorder writes them. Errors: no such camera, a rate above the
/// step rate, too little memory for the pictures of all cameras.
Result<std::vector<RecordedCamera>> recorded_cameras(const RunPlan& plan,
                                                     const std::vector<CameraRequest>& cameras,
                                                     const RenderDescription& description,
                                                     Rational step_rate);

/// Facts about the run that follow from a plan, without cameras, LiDARs and the columns of tables.
/// `description`: null if no pictures are recorded, and then there are no labels.
RunInfo run_info(const RunPlan& plan, const RenderDescription* description, Rational step_rate);

/// Memory for recording [bytes]: working memory of the sensors, and frames of each camera that are
/// rendered, wait or are written.
uint64_t recording_memory(std::span<const PictureMemory> cameras);

}  // namespace gloam

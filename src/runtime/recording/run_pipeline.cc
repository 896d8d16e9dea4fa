#include "runtime/recording/run_pipeline.h"

#include <algorithm>

#include "runtime/live/run_to_step.h"

namespace gloam {

Result<RunReport> run_and_record(const World& world, const RunRequest& request,
                                 const ProgressCallback& progress) {
  return record_motion(world, request, nullptr, progress);
}

Result<RunReport> record_motion(const World& world, const RunRequest& request,
                                std::unique_ptr<Motion> motion, const ProgressCallback& progress) {
  GLOAM_TRY(RunPlan plan, RunPlan::make(world, request));
  GLOAM_TRY(auto pipeline, RunPipeline::open(std::move(plan), std::move(motion), progress));
  return pipeline->run();
}

Result<std::unique_ptr<RunPipeline>> RunPipeline::open(RunPlan plan, std::unique_ptr<Motion> motion,
                                                       ProgressCallback progress) {
  std::unique_ptr<RunPipeline> run(new RunPipeline(std::move(plan), std::move(progress)));
  GLOAM_TRY_STATUS(run->open_simulation(std::move(motion)));
  GLOAM_TRY_STATUS(run->open_metrics());
  if (run->plan_.has_folder) GLOAM_TRY_STATUS(run->open_folder());
  if (!run->plan_.log.file.empty()) GLOAM_TRY_STATUS(run->open_log());
  GLOAM_TRY_STATUS(run->start_metrics());
  return run;
}

// Makes the simulation, resumes from the checkpoint, in the plan's World, and posts the Commands.
Status RunPipeline::open_simulation(std::unique_ptr<Motion> motion) {
  const RunRequest& request = plan_.request;
  GLOAM_TRY(simulation_,
            LiveSimulation::create(plan_.world, request.simulation,
                                   {.metering = plan_.meters ? Metering::kAlways : Metering::kNever,
                                    .motion = std::move(motion),
                                    .commands = request.commands.size()}));
  if (request.from) {
    GLOAM_TRY_STATUS(simulation_->restore(*request.from));
    if (request.from->world().compiled() != plan_.world.compiled())
      GLOAM_TRY_STATUS(simulation_->recompile(plan_.world));
  }
  if (!request.commands.empty()) GLOAM_TRY_STATUS(simulation_->post(request.commands));
  GLOAM_TRY(const int64_t steps,
            step_of_time(plan_.duration, simulation_->step_rate(), "a duration"));
  first_step_ = simulation_->latest().step();
  last_step_ = first_step_ + steps;
  return {};
}

Status RunPipeline::open_metrics() {
  const double rate = plan_.metric_rate(simulation_->step_rate()).value();
  GLOAM_TRY(metrics_, make_metrics(plan_.world, *simulation_,
                                   {.has_renderer = plan_.records_pictures,
                                    .records = plan_.records_metrics,
                                    .rate = rate}));
  const CompiledWorld& world = *plan_.world.compiled();
  if (plan_.records_state) state_.emplace(world, world.serial);
  return {};
}

// Starts the recorder and opens its streams.
Status RunPipeline::open_folder() {
  // Contents of the recording, checked before an older one is replaced
  const Rational rate = simulation_->step_rate();
  std::shared_ptr<SharedRenderer> shared;
  if (plan_.records_pictures) {
    GLOAM_TRY(shared, simulation_->renderer());
  }
  const RenderDescription* const description = shared != nullptr ? &shared->description : nullptr;
  RunInfo info = run_info(plan_, description, rate);
  GLOAM_TRY(info.lidars, plan_.lidars(rate));
  std::vector<CameraRequest> cameras;
  if (description != nullptr) {
    cameras = plan_.cameras(*description, rate);
    GLOAM_TRY(info.cameras, recorded_cameras(plan_, cameras, *description, rate));
  }
  info.metric_columns = metrics_->columns();
  for (const Metrics::Plot& plot : metrics_->plots())
    info.plots.push_back({plot.title, plot.unit, plot.measured, plot.commanded});
  if (state_) info.state_columns = state_->columns();

  // The recorder
  GLOAM_TRY_STATUS(show({"preparing", 0, seconds()}));
  RecorderOptions options;
  options.folder = plan_.request.out;
  options.overwrite = plan_.request.overwrite;
  options.outputs = plan_.scene().record.outputs;
  options.wait = plan_.waits;
  GLOAM_TRY(recorder_, Recorder::start(options, info));

  // Its streams
  GLOAM_TRY_STATUS(open_cameras(cameras));
  const auto add_sensor = [this](const SensorMessage& message) { recorder_->add_sensor(message); };
  if (!info.sensors.empty()) {
    GLOAM_TRY(sensors_, simulation_->open_all_sensors(plan_.waits, add_sensor));
  }
  GLOAM_TRY_STATUS(open_lidars(info.lidars));
  times_.prepared = seconds();
  return {};
}

Status RunPipeline::open_cameras(const std::vector<CameraRequest>& requests) {
  for (const CameraRequest& request : requests) {
    CameraQuality* const quality =
        plan_.records_metrics ? sensing_.add_camera(request.camera) : nullptr;
    GLOAM_TRY(auto camera, simulation_->open_live_camera(
                               request, [this, quality](std::shared_ptr<const CameraFrame> frame) {
                                 if (quality != nullptr) quality->add(*frame);
                                 recorder_->add_frame(std::move(frame));
                               }));
    drawing_.push_back(camera.get());
    cameras_.push_back(std::move(camera));
  }
  return {};
}

Status RunPipeline::open_lidars(const std::vector<RecordedLidar>& lidars) {
  for (const RecordedLidar& recorded : lidars) {
    LidarQuality* const quality =
        plan_.records_metrics ? sensing_.add_lidar(recorded.name) : nullptr;
    GLOAM_TRY(auto lidar, simulation_->open_live_lidar(
                              {recorded.name, plan_.waits},
                              [this, quality](const std::shared_ptr<const LidarScan>& scan) {
                                if (quality != nullptr) quality->add(*scan);
                                recorder_->add_scan(scan);
                              }));
    lidars_.push_back(std::move(lidar));
  }
  return {};
}

Status RunPipeline::open_log() {
  // From here on there is a file to finish: simulate() asks again whether to go on.
  if (progress_) progress_({"preparing", 0, seconds()});
  GLOAM_TRY(log_, LogRecorder::start(*simulation_, plan_.log));
  for (LiveCamera* const camera : log_->cameras()) drawing_.push_back(camera);
  return {};
}

Status RunPipeline::start_metrics() {
  const Rational rate = plan_.metric_rate(simulation_->step_rate());
  GLOAM_TRY(auto queue,
            simulation_->simulator().subscribe({.rate = rate, .required = true, .capacity = 256}));
  metrics_thread_.emplace(std::move(queue), *metrics_, state_ ? &*state_ : nullptr,
                          recorder_.get());
  return {};
}

void RunPipeline::simulate() {
  Simulator& simulator = simulation_->simulator();
  done_.emplace(simulator, first_step_, last_step_, drawing_);
  report_.status = run_to_step(
      simulator, last_step_, drawing_.empty() ? "simulating" : "rendering", seconds(),
      [this](const Progress& now) { return show(now).ok(); }, [this] { return parts_status(); });
  times_.simulated = seconds();
}

// Ends the streams once all that the simulation has given them is in the files.
void RunPipeline::drain() {
  const Snapshot last = simulation_->latest();

  // Pictures of an interrupted run, for which nobody waits any more
  if (!report_.status.ok() && report_.status.error().kind == ErrorKind::kInterrupted) {
    for (LiveCamera* const camera : drawing_) camera->abandon();
    for (const auto& lidar : lidars_) lidar->abandon();
    if (sensors_ != nullptr) sensors_->abandon();
  }

  // The last pictures, which take most of the time
  simulation_->simulator().stop();  // ends the queues; their contents are still delivered
  keep(drain_pictures());
  if (progress_) progress_({kFinishingFiles, 1, seconds()});

  // The streams of the recorder
  for (const auto& camera : cameras_) keep(camera->status());
  cameras_.clear();
  if (sensors_ != nullptr) sensors_->drain();
  sensors_.reset();
  for (const auto& lidar : lidars_) {
    lidar->drain();
    keep(lidar->status());
  }
  lidars_.clear();
  metrics_thread_->join();

  // The log
  if (log_ != nullptr) keep(log_->finish(last));
  report_.steps = last.step();
  report_.sim_time = last.time();
  report_.hash = last.hash();
}

// Waits until the cameras have rendered their last pictures. An Error ends all pictures.
Status RunPipeline::drain_pictures() {
  constexpr std::chrono::milliseconds kDrainPollPeriod{20};
  for (LiveCamera* const camera : drawing_) {
    while (!camera->drain_for(kDrainPollPeriod)) {
      Status status = parts_status();
      if (status.ok()) status = show({"rendering", 1, seconds()});
      if (status.ok()) continue;
      for (LiveCamera* const one : drawing_) one->abandon();
      return status;
    }
  }
  return {};
}

// The report, once the recorder has finished its files.
RunReport RunPipeline::report() {
  report_.out = plan_.request.out;
  if (log_ != nullptr) report_.written.push_back(plan_.log.file.string());
  if (recorder_ != nullptr) {
    times_.drained = seconds();
    const RunOutcome outcome = run_outcome(report_, times_, *metrics_, sensing_.summary());
    report_.results = outcome.results;
    keep(recorder_->finish(outcome));
    report_.frames = recorder_->frames();
    for (std::string& file : main_files(report_.out)) report_.written.push_back(std::move(file));
    std::ranges::sort(report_.written);
  }
  if (report_.results.empty()) report_.results = metrics_->summary();
  report_.sensors = simulation_->sensor_costs();
  report_.wall_time = seconds();
  return std::move(report_);
}

// Shows the progress, once the run has begun with the share of it that is done. Error: the user has
// stopped the run.
Status RunPipeline::show(Progress now) {
  if (!progress_ || progress_(done_ ? done_->of(std::move(now)) : now)) return {};
  return Error{ErrorKind::kInterrupted, "interrupted"};
}

// The first failure of a part that records.
Status RunPipeline::parts_status() const {
  for (const auto& camera : cameras_) GLOAM_TRY_STATUS(camera->status());
  for (const auto& lidar : lidars_) GLOAM_TRY_STATUS(lidar->status());
  if (log_ != nullptr) GLOAM_TRY_STATUS(log_->status());
  return recorder_ != nullptr ? recorder_->status() : Status();
}

}  // namespace gloam

// gloam::run_and_record: a simulation, its cameras and metrics, and a recorder, from start to
// finished files.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>
#include <thread>

#include "base/files.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/memory.h"
#include "gloam/output_names.h"
#include "gloam/program.h"
#include "gloam/run.h"
#include "record/recorder.h"
#include "runtime/changed_settings.h"
#include "runtime/label_table.h"
#include "runtime/live_simulation.h"
#include "runtime/log/log_recorder.h"
#include "runtime/log/wanted_topics.h"
#include "runtime/recorded_run.h"
#include "runtime/run_metrics.h"
#include "runtime/run_progress.h"
#include "runtime/run_to_step.h"
#include "runtime/sensing_metrics.h"
#include "runtime/state_table.h"
#include "scene/options/probe_quantities.h"
#include "sim/loop/step_schedule.h"
#include "world/sensors/camera_rate.h"
#include "world/version.h"

namespace gloam {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool wants(const std::vector<std::string>& outputs, std::string_view name) {
  return std::find(outputs.begin(), outputs.end(), name) != outputs.end();
}

// The channels that a camera must fill so that the recorder can write `outputs`. What needs a model
// is left out of cameras that have none.
std::vector<std::string> channels_for(const std::vector<std::string>& outputs,
                                      const CameraSensing& sensing) {
  std::set<std::string> channels;
  for (const CameraFile& file : kCameraFiles)
    if (wants(outputs, file.output)) channels.emplace(file.channel);
  if (wants(outputs, "contact_sheet")) channels.insert({"rgb", "depth", "segmentation"});
  std::erase_if(channels, [&](const std::string& channel) {
    return !find_camera_channel(channel)->has_model(sensing);
  });
  return {channels.begin(), channels.end()};
}

bool is_picture(const std::string& output) {
  return output == "contact_sheet" ||
         std::ranges::find(kCameraOutputs, output) != kCameraOutputs.end();
}

/// True if any camera has anything to record.
bool wants_pictures(const Scene& scene) {
  if (std::ranges::any_of(scene.record.outputs, is_picture)) return true;
  return std::ranges::any_of(scene.cameras, [](const CameraOptions& camera) {
    return camera.outputs && std::ranges::any_of(*camera.outputs, is_picture);
  });
}

const CameraOptions* find_options(const Scene& scene, const std::string& camera) {
  for (const CameraOptions& options : scene.cameras) {
    if (options.name == camera) return &options;
  }
  return nullptr;
}

// All [[camera]]s of a scene and the cameras of its robots; a bare model's own cameras. A camera
// without a rate has the default one, or every step of slower models.
Result<std::vector<CameraRequest>> camera_requests(const World& world, const RunRequest& request,
                                                   const RenderDescription& description,
                                                   Rational step_rate) {
  const Scene& scene = world.compiled()->scene;
  std::vector<std::string> names = request.cameras;
  if (names.empty()) {
    for (const CameraDescription& camera : description.cameras) {
      if (camera.camera >= 0) names.push_back(camera.name);
    }
    if (names.empty()) names.push_back("free");
  }
  std::vector<CameraRequest> requests;
  for (const std::string& name : names) {
    CameraRequest camera;
    camera.camera = name;
    camera.rate = kDefaultCameraRate;
    camera.width = request.width;
    camera.height = request.height;
    std::vector<std::string> outputs = scene.record.outputs;
    const CameraOptions* options = find_options(scene, name);
    if (options != nullptr) {
      camera.rate = options->rate;
      if (options->outputs) outputs = *options->outputs;
    }
    if (wants(scene.record.outputs, "contact_sheet")) outputs.emplace_back("contact_sheet");
    if (request.rate.num > 0)
      camera.rate = request.rate;
    else if (options == nullptr && step_rate.value() < camera.rate.value())
      camera.rate = step_rate;
    if (std::ranges::none_of(outputs, is_picture)) continue;
    camera.outputs = channels_for(outputs, options != nullptr ? options->sensing : CameraSensing{});
    camera.render = scene.render;
    camera.required = waits_for_sensors(request.simulation.pace);
    requests.push_back(camera);
  }
  return requests;
}

// LiDARs of the scene whose files are wanted.
Result<std::vector<RecordedLidar>> recorded_lidars(const World& world, Rational timestep) {
  const Scene& scene = world.compiled()->scene;
  const bool all = wants(scene.record.outputs, "lidar");
  std::vector<RecordedLidar> lidars;
  for (const LidarOptions& options : scene.lidars) {
    const auto formats = options.outputs.value_or(all ? std::vector<std::string>{"pcd"}
                                                      : std::vector<std::string>{});
    if (formats.empty()) continue;
    GLOAM_TRY(const LidarModel model, make_lidar_model(options));
    GLOAM_TRY_STATUS(StepSchedule::make(model.rate, {0, 1}, timestep));
    lidars.push_back({options.name, model.rate, formats});
  }
  return lidars;
}

// Columns of a sensor's file: numbers of MuJoCo's have no names.
std::vector<std::string> columns_of(const SensorDescription& sensor, const CompiledWorld& world) {
  std::vector<std::string> columns;
  for (int i = 0; i < sensor.count; ++i) {
    if (sensor.probe < 0) {
      columns.push_back(fmt::format("value_{}", i));
      continue;
    }
    const ProbeDescription& probe = world.probes[static_cast<size_t>(sensor.probe)];
    const ProbeNumber& number = probe.quantity->numbers[static_cast<size_t>(i)];
    columns.push_back(with_unit(std::string(number.name), number.unit));
  }
  return columns;
}

// The log that is asked for, or the scene's.
LogRequest log_request_of(const Scene& scene, const RunRequest& request) {
  LogRequest log = request.log;
  const RecordOptions& record = scene.record;
  if (log.file.empty() && record.mcap && !request.out.empty()) log.file = request.out / kRunLogName;
  if (log.topics.empty()) log.topics = record.topics;
  log.durable |= record.durable;
  log.embed |= record.embed;
  log.state_rate = record.state_rate;
  log.width = request.width;
  log.height = request.height;
  log.required = waits_for_sensors(request.simulation.pace);
  return log;
}

std::string scene_hash(const Scene& scene) {
  const auto path = scene.bare_model.empty() ? scene.file : scene.bare_model;
  if (path.empty()) return {};
  const auto text = read_file(path);
  return text.ok() ? hash_to_hex(hash_bytes(text->data(), text->size())) : std::string();
}

RunInfo run_info(const World& world, const RunRequest& request, bool has_media, double timestep,
                 double duration) {
  const Scene& scene = world.compiled()->scene;
  RunInfo info;
  info.title = scene.name;
  info.versions = {
      {"gloam", version()}, {"mujoco", mujoco_version()}, {"configuration", configuration()}};
  info.scene_file = (scene.bare_model.empty() ? scene.file : scene.bare_model).filename().string();
  info.scene_hash = scene_hash(scene);
  info.seed = request.simulation.seed;
  info.timestep = timestep;
  info.duration = duration;
  info.settings = {
      {"tier", scene.render.tier_or_default(request.simulation.pace == Pace::kRealTime)},
      {"spp", std::to_string(scene.render.samples())},
      {"max_depth", std::to_string(path_depth(scene.render, has_media))},
      {"denoise", scene.render.denoise ? "true" : "false"}};
  for (const DrawnOption& d : world.compiled()->drawn) info.drawn.push_back({d.option, d.value});
  if (scene.render.error)
    info.settings.push_back({"error", fmt::format("{}", *scene.render.error)});
  for (NamedText& setting : changed_settings(*world.compiled()))
    info.settings.push_back(std::move(setting));
  return info;
}

bool is_interrupt(const Status& status) {
  return !status.ok() && status.error().kind == ErrorKind::kInterrupted;
}

// Waits until the cameras have made their last pictures. `goes_on` is asked meanwhile; its Error
// ends the pictures, too.
Status drain_cameras(const RunProgress::Cameras& cameras, const std::function<Status()>& goes_on) {
  constexpr std::chrono::milliseconds kDrainPollPeriod{20};
  for (LiveCamera* const camera : cameras) {
    while (!camera->drain_for(kDrainPollPeriod)) {
      const Status status = goes_on();
      if (status.ok()) continue;
      for (LiveCamera* const one : cameras) one->abandon();
      return status;
    }
  }
  return {};
}

// Resumes from the request's checkpoint, in `world`, and posts its Commands.
Status begin_where_asked(LiveSimulation& simulation, const World& world,
                         const RunRequest& request) {
  if (request.from) {
    GLOAM_TRY_STATUS(simulation.restore(*request.from));
    if (request.from->world().compiled() != world.compiled())
      GLOAM_TRY_STATUS(simulation.recompile(world));
  }
  return request.commands.empty() ? Status() : simulation.post(request.commands);
}

}  // namespace

void set_record_outputs(const std::vector<std::string>& outputs, Scene* scene) {
  scene->record.outputs = recorded_outputs(outputs);
  for (CameraOptions& camera : scene->cameras) camera.outputs.reset();
  const bool has_lidar = wants(outputs, "lidar");
  for (LidarOptions& lidar : scene->lidars) {
    // Formats of its own are kept; [] asks for none, "lidar" for the usual one.
    if (!has_lidar || (lidar.outputs && lidar.outputs->empty())) lidar.outputs.reset();
  }
}

Result<RunReport> run_and_record(const World& world, const RunRequest& request,
                                 const ProgressCallback& progress) {
  return record_motion(world, request, nullptr, progress);
}

Result<RunReport> record_motion(const World& world, const RunRequest& request,
                                std::unique_ptr<Motion> motion, const ProgressCallback& progress) {
  const auto start = Clock::now();
  const Scene& scene = world.compiled()->scene;
  const bool pictures = !request.out.empty() && wants_pictures(scene);
  const LogRequest log_request = log_request_of(scene, request);
  const bool reads_exposure = has_probe(*world.compiled(), "exposure") &&
                              (wants(scene.record.outputs, "sensors") || !scene.metrics.empty() ||
                               !log_request.file.empty());
  bool metered_always = pictures || reads_exposure;
  if (!metered_always && !log_request.file.empty()) {
    GLOAM_TRY(metered_always, logs_pictures(world, log_request));
  }
  GLOAM_TRY(auto simulation, LiveSimulation::create(
                                 world, request.simulation,
                                 {.metering = metered_always ? Metering::kAlways : Metering::kNever,
                                  .motion = std::move(motion),
                                  .commands = request.commands.size()}));
  GLOAM_TRY_STATUS(begin_where_asked(*simulation, world, request));
  Simulator& simulator = simulation->simulator();
  const double duration = request.duration > 0 ? request.duration : scene.sim.duration;
  const Rational rate = simulation->step_rate();
  GLOAM_TRY(int64_t steps, step_of_time(duration, rate, "a duration"));
  const int64_t first_step = simulator.latest().step();
  steps += first_step;

  RunReport report;
  // Metrics at their rate, or every step of slower models.
  const Rational wanted = scene.record.metrics_rate;
  const Rational metric_rate = rate.value() >= wanted.value() ? wanted : rate;
  const bool recorded = !request.out.empty() && wants(scene.record.outputs, "metrics");
  GLOAM_TRY(
      const auto metrics,
      make_metrics(world, *simulation,
                   {.has_renderer = pictures, .records = recorded, .rate = metric_rate.value()}));
  std::optional<StateTable> state;
  if (!request.out.empty() && wants(scene.record.outputs, "state"))
    state.emplace(*world.compiled(), world.compiled()->serial);
  std::unique_ptr<Recorder> recorder;
  SensingMetrics sensing;
  std::vector<std::unique_ptr<LiveCamera>> cameras;
  std::unique_ptr<LiveSensors> sensors;
  std::vector<std::unique_ptr<LiveLidar>> lidars;
  std::unique_ptr<LogRecorder> log;
  double prepared = 0;
  if (!request.out.empty()) {
    std::shared_ptr<SharedRenderer> shared;
    std::vector<CameraRequest> requests;
    if (pictures) {
      GLOAM_TRY(shared, simulation->renderer());
      GLOAM_TRY(requests, camera_requests(world, request, shared->description, rate));
    }
    const bool has_media = shared != nullptr ? !shared->description.volumes.empty()
                                             : !scene.volumes.empty() || !scene.gases.empty();
    RunInfo info = run_info(world, request, has_media, 1 / rate.value(), duration);
    if (log_request.file == request.out / kRunLogName) info.beside = {kRunLogName};
    GLOAM_TRY(info.lidars, recorded_lidars(world, simulator.timestep()));
    uint64_t memory = 0;
    for (const CameraRequest& camera : requests) {
      GLOAM_TRY(const auto sensor,
                CameraSensor::create(shared->description, camera, request.simulation.seed));
      // Before an older recording is replaced: the simulation would refuse it later.
      GLOAM_TRY_STATUS(StepSchedule::make(camera.rate, {0, 1}, simulator.timestep()));
      const PictureMemory pictures = sensor->memory();
      constexpr uint64_t kFramesInWork =
          2;  // frames that are made and written beside those that wait
      memory +=
          pictures.working +
          (kFramesInWork + static_cast<uint64_t>(RecorderOptions().queue_frames)) * pictures.frame;
      const CameraOptions* own = find_options(scene, camera.camera);
      info.cameras.push_back({camera.camera, sensor->intrinsics(), camera.rate,
                              own != nullptr ? own->outputs : std::nullopt});
    }
    GLOAM_TRY_STATUS(check_memory(memory, fmt::format("recording {} camera(s)", requests.size()),
                                  "lower the resolution or record fewer cameras"));
    if (pictures) {
      LabelTableRows labels = label_rows(shared->description);
      info.labels = std::move(labels.rows);
      info.label_ids = std::move(labels.ids);
    }
    info.metric_columns = metrics->columns();
    if (state) info.state_columns = state->columns();
    for (const Metrics::Plot& plot : metrics->plots())
      info.plots.push_back({plot.title, plot.unit, plot.measured, plot.commanded});
    if (wants(scene.record.outputs, "sensors")) {
      for (const SensorDescription& sensor : describe_sensors(*world.compiled()))
        info.sensors.push_back({sensor.name, columns_of(sensor, *world.compiled())});
    }
    RecorderOptions options;
    options.folder = request.out;
    options.overwrite = request.overwrite;
    options.outputs = scene.record.outputs;
    options.wait = waits_for_sensors(request.simulation.pace);
    if (progress && !progress({"preparing", 0, seconds_since(start)}))
      return Error{ErrorKind::kInterrupted, "interrupted"};
    GLOAM_TRY(recorder, Recorder::start(options, info));
    for (const CameraRequest& camera : requests) {
      CameraQuality* const quality = recorded ? sensing.add_camera(camera.camera) : nullptr;
      const auto take = [&recorder, quality](std::shared_ptr<const CameraFrame> frame) {
        if (quality != nullptr) quality->add(*frame);
        recorder->add_frame(std::move(frame));
      };
      GLOAM_TRY(auto live, simulation->open_live_camera(camera, take));
      cameras.push_back(std::move(live));
    }
    if (!info.sensors.empty()) {
      GLOAM_TRY(sensors, simulation->open_all_sensors(
                             waits_for_sensors(request.simulation.pace),
                             [&](const SensorMessage& message) { recorder->add_sensor(message); }));
    }
    for (const RecordedLidar& lidar : info.lidars) {
      LidarQuality* const quality = recorded ? sensing.add_lidar(lidar.name) : nullptr;
      const auto take = [&recorder, quality](const std::shared_ptr<const LidarScan>& scan) {
        if (quality != nullptr) quality->add(*scan);
        recorder->add_scan(scan);
      };
      GLOAM_TRY(auto live, simulation->open_live_lidar(
                               {lidar.name, waits_for_sensors(request.simulation.pace)}, take));
      lidars.push_back(std::move(live));
    }
    prepared = seconds_since(start);
  }
  if (!log_request.file.empty()) {
    // From here on there is a file to finish: run_to_step() asks again whether to go on.
    if (progress) progress({"preparing", 0, seconds_since(start)});
    GLOAM_TRY(log, LogRecorder::start(*simulation, log_request));
  }
  GLOAM_TRY(auto metric_queue,
            simulator.subscribe({.rate = metric_rate, .required = true, .capacity = 256}));
  MetricsThread metrics_thread(metric_queue, *metrics, state ? &*state : nullptr, recorder.get());

  const auto recording = [&]() -> Status {
    for (const auto& camera : cameras) GLOAM_TRY_STATUS(camera->status());
    for (const auto& lidar : lidars) GLOAM_TRY_STATUS(lidar->status());
    if (log != nullptr) GLOAM_TRY_STATUS(log->status());
    return recorder != nullptr ? recorder->status() : Status();
  };
  RunProgress::Cameras drawing;
  for (const auto& camera : cameras) drawing.push_back(camera.get());
  if (log != nullptr) drawing.insert(drawing.end(), log->cameras().begin(), log->cameras().end());
  RunProgress done(simulator, first_step, steps, drawing);
  const ProgressCallback show_done =
      progress ? [&](const Progress& now) { return progress(done.of(now)); } : ProgressCallback();
  report.status = run_to_step(simulator, steps, drawing.empty() ? "simulating" : "rendering",
                              seconds_since(start), show_done, recording);
  const Snapshot last = simulator.latest();
  const double simulated = seconds_since(start);
  if (is_interrupt(report.status)) {  // at once: nobody waits for pictures any more
    for (LiveCamera* const camera : drawing) camera->abandon();
    for (auto& lidar : lidars) lidar->abandon();
    if (sensors != nullptr) sensors->abandon();
  }
  simulator.stop();  // ends the queues; what they hold is still delivered
  const Status drawn = drain_cameras(drawing, [&]() -> Status {
    GLOAM_TRY_STATUS(recording());
    if (!show_done || show_done({"rendering", 1, seconds_since(start)})) return {};
    return Error{ErrorKind::kInterrupted, "interrupted"};
  });
  if (report.status.ok()) report.status = drawn;
  if (progress) progress({kFinishingFiles, 1, seconds_since(start)});
  for (auto& camera : cameras)
    if (report.status.ok()) report.status = camera->status();
  cameras.clear();
  if (sensors != nullptr) sensors->drain();
  sensors.reset();
  for (auto& lidar : lidars) {
    lidar->drain();
    if (report.status.ok()) report.status = lidar->status();
  }
  lidars.clear();
  metrics_thread.join();
  if (log != nullptr) {
    const Status finished = log->finish(last);
    if (report.status.ok()) report.status = finished;
    report.written.push_back(log_request.file.string());
  }

  report.out = request.out;
  report.steps = last.step();
  report.sim_time = last.time();
  report.hash = last.hash();
  if (recorder != nullptr) {
    RunOutcome outcome;
    outcome.exit_reason = report.status.ok() ? "completed" : report.status.error().to_string();
    outcome.steps = report.steps;
    outcome.simulated = report.sim_time;
    outcome.final_state_hash = hash_to_hex(report.hash);
    outcome.timings = {{"prepare_s", prepared},
                       {"run_s", simulated - prepared},
                       {"total_s", seconds_since(start)}};
    add_metrics(*metrics, &outcome);
    for (auto& number : sensing.summary()) outcome.results.push_back(std::move(number));
    report.results = outcome.results;
    const Status finished = recorder->finish(outcome);
    if (report.status.ok()) report.status = finished;
    report.frames = recorder->frames();
    for (const char* name :
         {"contact_sheet.png", "metrics.csv", "state.csv", "summary.json", "labels.json"}) {
      if (std::filesystem::exists(request.out / name))
        report.written.push_back((request.out / name).string());
    }
    std::error_code code;
    for (const auto& entry : std::filesystem::directory_iterator(request.out, code)) {
      if (entry.path().extension() == ".mp4") report.written.push_back(entry.path().string());
    }
    std::sort(report.written.begin(), report.written.end());
  }
  if (report.results.empty()) report.results = metrics->summary();
  report.sensors = simulation->sensor_costs();
  report.wall_time = seconds_since(start);
  return report;
}

}  // namespace gloam

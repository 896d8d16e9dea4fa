#include "runtime/recording/run_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "base/memory.h"
#include "gloam/output_names.h"
#include "runtime/log/wanted_topics.h"
#include "sensors/lidar/lidar_model.h"
#include "sim/loop/step_schedule.h"
#include "world/sensors/camera_rate.h"
#include "world/sensors/probe_description.h"

namespace gloam {
namespace {

bool wants(const std::vector<std::string>& outputs, std::string_view name) {
  return std::ranges::find(outputs, name) != outputs.end();
}

bool is_picture(const std::string& output) {
  return output == "contact_sheet" ||
         std::ranges::find(kCameraOutputs, output) != kCameraOutputs.end();
}

bool has_pictures(const Scene& scene) {
  if (std::ranges::any_of(scene.record.outputs, is_picture)) return true;
  return std::ranges::any_of(scene.cameras, [](const CameraOptions& camera) {
    return camera.outputs && std::ranges::any_of(*camera.outputs, is_picture);
  });
}

// Channels that a camera must fill for `outputs`, except those whose model it lacks.
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

const CameraOptions* find_options(const Scene& scene, const std::string& camera) {
  const auto found = std::ranges::find(scene.cameras, camera, &CameraOptions::name);
  return found != scene.cameras.end() ? &*found : nullptr;
}

// The names of the cameras to record, some perhaps without outputs.
std::vector<std::string> camera_names(const RunRequest& request,
                                      const RenderDescription& description) {
  std::vector<std::string> names = request.cameras;
  if (!names.empty()) return names;
  for (const CameraDescription& camera : description.cameras)
    if (camera.camera >= 0) names.push_back(camera.name);
  return names.empty() ? std::vector<std::string>{"free"} : names;
}

LogRequest log_of(const RunRequest& request, const RecordOptions& record) {
  LogRequest log = request.log;
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

Rational inverse(Rational rate) { return {rate.den, rate.num}; }

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

Result<RunPlan> RunPlan::make(const World& world, const RunRequest& request) {
  const Scene& scene = world.compiled()->scene;
  const std::vector<std::string>& outputs = scene.record.outputs;
  RunPlan plan{.world = world, .request = request, .log = log_of(request, scene.record)};
  plan.duration = request.duration > 0 ? request.duration : scene.sim.duration;
  plan.waits = waits_for_sensors(request.simulation.pace);
  plan.has_folder = !request.out.empty();
  plan.records_pictures = plan.has_folder && has_pictures(scene);
  plan.records_metrics = plan.has_folder && wants(outputs, "metrics");
  plan.records_state = plan.has_folder && wants(outputs, "state");
  plan.records_sensors = plan.has_folder && wants(outputs, "sensors");
  const bool has_log = !plan.log.file.empty();
  const bool reads_exposure = has_probe(*world.compiled(), "exposure") &&
                              (wants(outputs, "sensors") || !scene.metrics.empty() || has_log);
  plan.meters = plan.records_pictures || reads_exposure;
  if (!plan.meters && has_log) {
    GLOAM_TRY(plan.meters, logs_pictures(world, plan.log));
  }
  return plan;
}

Rational RunPlan::metric_rate(Rational step_rate) const {
  const Rational wanted = scene().record.metrics_rate;
  return step_rate.value() >= wanted.value() ? wanted : step_rate;
}

std::vector<CameraRequest> RunPlan::cameras(const RenderDescription& description,
                                            Rational step_rate) const {
  const bool has_sheet = wants(scene().record.outputs, "contact_sheet");
  const Rational own_rate =
      step_rate.value() < kDefaultCameraRate.value() ? step_rate : kDefaultCameraRate;
  std::vector<CameraRequest> cameras;
  for (const std::string& name : camera_names(request, description)) {
    const CameraOptions* const options = find_options(scene(), name);
    std::vector<std::string> outputs =
        options != nullptr && options->outputs ? *options->outputs : scene().record.outputs;
    if (has_sheet) outputs.emplace_back("contact_sheet");
    if (std::ranges::none_of(outputs, is_picture)) continue;
    CameraRequest camera{.camera = name, .width = request.width, .height = request.height};
    camera.rate = options != nullptr ? options->rate : own_rate;
    if (request.rate.num > 0) camera.rate = request.rate;
    camera.outputs = channels_for(outputs, options != nullptr ? options->sensing : CameraSensing{});
    camera.render = scene().render;
    camera.required = waits;
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

Result<std::vector<RecordedLidar>> RunPlan::lidars(Rational step_rate) const {
  std::vector<std::string> usual;
  if (wants(scene().record.outputs, "lidar")) usual.emplace_back("pcd");
  std::vector<RecordedLidar> lidars;
  for (const LidarOptions& options : scene().lidars) {
    const std::vector<std::string> formats = options.outputs.value_or(usual);
    if (formats.empty()) continue;
    GLOAM_TRY(const LidarModel model, make_lidar_model(options));
    GLOAM_TRY_STATUS(StepSchedule::make(model.rate, {0, 1}, inverse(step_rate)));
    lidars.push_back({options.name, model.rate, formats});
  }
  return lidars;
}

Result<std::vector<RecordedCamera>> recorded_cameras(const RunPlan& plan,
                                                     const std::vector<CameraRequest>& cameras,
                                                     const RenderDescription& description,
                                                     Rational step_rate) {
  std::vector<RecordedCamera> recorded;
  std::vector<PictureMemory> memory;
  for (const CameraRequest& camera : cameras) {
    GLOAM_TRY(const auto sensor,
              CameraSensor::create(description, camera, plan.request.simulation.seed));
    // Before an older recording is replaced: the simulation would refuse it later.
    GLOAM_TRY_STATUS(StepSchedule::make(camera.rate, {0, 1}, inverse(step_rate)));
    memory.push_back(sensor->memory());
    const CameraOptions* const own = find_options(plan.scene(), camera.camera);
    recorded.push_back({camera.camera, sensor->intrinsics(), camera.rate,
                        own != nullptr ? own->outputs : std::nullopt});
  }
  GLOAM_TRY_STATUS(check_memory(recording_memory(memory),
                                fmt::format("recording {} camera(s)", cameras.size()),
                                "lower the resolution or record fewer cameras"));
  return recorded;
}

uint64_t recording_memory(std::span<const PictureMemory> cameras) {
  // Two frames are rendered and written beside those that wait.
  const auto frames = 2 + static_cast<uint64_t>(RecorderOptions().queue_frames);
  uint64_t memory = 0;
  for (const PictureMemory& camera : cameras) memory += camera.working + frames * camera.frame;
  return memory;
}

}  // namespace gloam

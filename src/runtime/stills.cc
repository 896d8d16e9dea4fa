// gloam::render_stills and write_frame.

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include "base/files.h"
#include "base/log.h"
#include "base/memory.h"
#include "gloam/run.h"
#include "record/run_files.h"
#include "render/film/exr.h"
#include "render/film/png.h"
#include "runtime/live_simulation.h"
#include "runtime/run_to_step.h"

namespace gloam {
namespace {

void tell_what_was_reached(const CameraRequest& request, const CameraFrame& frame,
                           const RenderStats& stats) {
  const double pixels =
      static_cast<double>(frame.intrinsics.width) * static_cast<double>(frame.intrinsics.height);
  const double unreached = static_cast<double>(stats.unreached) / pixels;
  log_info("camera {}: {:.0f} samples per pixel; {:.1f} % of the picture is above {:g} % error{}",
           frame.camera, static_cast<double>(stats.paths) / pixels, 100 * unreached,
           100 * *request.render.error,
           unreached > 0 ? fmt::format(" at {} samples", request.render.samples()) : "");
}

/// All pictures are kept; one at a time is made or written.
Status check_room(const std::vector<std::unique_ptr<CameraSensor>>& sensors) {
  uint64_t kept = 0, most = 0;
  for (const auto& sensor : sensors) {
    const PictureMemory memory = sensor->memory();
    kept += memory.frame;
    most = std::max(most, memory.working + memory.frame);
  }
  const Intrinsics& k = sensors.front()->intrinsics();
  return check_memory(kept + most,
                      sensors.size() == 1
                          ? fmt::format("a picture of {} x {} pixels", k.width, k.height)
                          : fmt::format("making {} pictures", sensors.size()),
                      "lower the resolution or ask for fewer outputs or cameras");
}

}  // namespace

Result<std::vector<CameraFrame>> render_stills(const World& world, double time,
                                               const std::vector<CameraRequest>& requests,
                                               const ProgressCallback& progress) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  SimulationOptions options;
  options.seed = world.compiled()->scene.sim.seed;
  options.timestep = world.compiled()->scene.sim.timestep.value_or(0);
  GLOAM_TRY(auto simulation, LiveSimulation::create(world, options));
  GLOAM_TRY(const int64_t steps, step_of_time(time, simulation->step_rate(), "a time"));
  GLOAM_TRY(auto shared, simulation->renderer());
  std::vector<std::unique_ptr<CameraSensor>> sensors;
  for (const CameraRequest& request : requests) {
    GLOAM_TRY(auto sensor, CameraSensor::create(shared->description, request, options.seed));
    GLOAM_TRY_STATUS(sensor->set_temperatures(world.compiled()->scene.temperatures));
    sensors.push_back(std::move(sensor));
  }
  if (!sensors.empty()) GLOAM_TRY_STATUS(check_room(sensors));
  const Rational timestep = simulation->simulator().timestep();
  std::set<int64_t> wanted;  // steps, over all cameras' exposures
  for (const auto& sensor : sensors) {
    const KeySteps keys = key_steps(sensor->window(), timestep);
    for (int k = 0; k < keys.count; ++k) wanted.insert(steps + k * keys.stride);
  }
  GLOAM_TRY(auto solver, PoseSolver::create(world.compiled()));
  std::map<int64_t, PoseFrame> poses;
  for (const int64_t step : wanted) {
    GLOAM_TRY_STATUS(
        run_to_step(simulation->simulator(), step, "simulating", seconds(), progress, {}));
    GLOAM_TRY_STATUS(solver->solve(simulation->latest(), poses[step]));
  }
  std::vector<CameraFrame> frames;
  for (size_t i = 0; i < requests.size(); ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(requests.size());
    if (progress && !progress({"rendering", done, seconds()})) {
      return Error{ErrorKind::kInterrupted, "interrupted"};
    }
    const std::unique_ptr<CameraSensor> sensor = std::move(sensors[i]);  // its film goes with it
    const double share = 1 / static_cast<double>(requests.size());
    sensor->set_progress([&](double part) {
      return !progress || progress({"rendering", done + share * part, seconds()});
    });
    if (const auto meter = simulation->meter_of(requests[i].camera))
      sensor->set_ev100(meter->ev100_at(steps));
    const KeySteps keys = key_steps(sensor->window(), timestep);
    std::vector<const PoseFrame*> exposure;
    for (int k = 0; k < keys.count; ++k) exposure.push_back(&poses[steps + k * keys.stride]);
    const auto frame =
        sensor->capture(*shared->renderer, shared->mutex, exposure, *exposure.front(), 0);
    if (frame == nullptr) return Error{ErrorKind::kInterrupted, "interrupted"};
    if (requests[i].render.error) {
      tell_what_was_reached(requests[i], *frame, sensor->stats());
    }
    frames.push_back(*frame);
  }
  return frames;
}

Result<std::vector<std::filesystem::path>> write_frame(const CameraFrame& frame,
                                                       const std::filesystem::path& folder,
                                                       const std::string& name) {
  GLOAM_TRY_STATUS(make_folder(folder));
  std::vector<std::filesystem::path> written;
  const int width = frame.intrinsics.width, height = frame.intrinsics.height;
  const auto write = [&](const std::string& suffix, const std::vector<uint8_t>& bytes) -> Status {
    const auto path = folder / (name + suffix);
    GLOAM_TRY_STATUS(write_file_atomic(path, bytes));
    written.push_back(path);
    return {};
  };
  const auto write_planes = [&](const std::string& suffix, const std::vector<float>& values,
                                const std::vector<std::string>& channels) -> Status {
    std::vector<ExrChannel> planes;
    for (size_t c = 0; c < channels.size(); ++c) {
      planes.push_back({channels[c], values.data() + c, static_cast<int>(channels.size())});
    }
    GLOAM_TRY(const auto bytes, encode_exr(width, height, planes));
    return write(suffix, bytes);
  };
  if (!frame.rgb.empty()) GLOAM_TRY_STATUS(write(".png", encode_png8(width, height, 3, frame.rgb)));
  if (!frame.radiance.empty())
    GLOAM_TRY_STATUS(write_planes(".exr", frame.radiance, {"R", "G", "B"}));
  if (!frame.samples.empty()) {
    const std::vector<float> counts(frame.samples.begin(), frame.samples.end());
    GLOAM_TRY_STATUS(write_planes("_samples.exr", counts, {"samples"}));
  }
  if (!frame.depth.empty()) {
    GLOAM_TRY_STATUS(
        write("_depth.png", encode_png16(width, height, depth_to_millimetres(frame.depth))));
    GLOAM_TRY_STATUS(write_planes("_depth.exr", frame.depth, {"Z"}));
  }
  if (!frame.sensor_depth.empty()) {
    GLOAM_TRY_STATUS(write("_sensor_depth.png",
                           encode_png16(width, height, depth_to_millimetres(frame.sensor_depth))));
    GLOAM_TRY_STATUS(write_planes("_sensor_depth.exr", frame.sensor_depth, {"Z"}));
  }
  if (!frame.raw.empty()) {
    const int row = static_cast<int>(frame.raw.size() / static_cast<size_t>(height));
    GLOAM_TRY_STATUS(write("_raw.png", encode_png16(row, height, frame.raw)));
  }
  if (!frame.thermal.empty()) {
    GLOAM_TRY_STATUS(
        write("_thermal.png", encode_png16(width, height, to_centikelvins(frame.thermal))));
    GLOAM_TRY_STATUS(write_planes("_thermal.exr", frame.thermal, {"K"}));
  }
  if (!frame.distance.empty())
    GLOAM_TRY_STATUS(write_planes("_distance.exr", frame.distance, {"distance"}));
  if (!frame.instance.empty()) {
    GLOAM_TRY_STATUS(write("_instance.png", encode_png16(width, height, frame.instance)));
    GLOAM_TRY_STATUS(write("_semantic.png", encode_png16(width, height, frame.semantic)));
  }
  if (!frame.normal.empty())
    GLOAM_TRY_STATUS(write_planes("_normal.exr", frame.normal, {"X", "Y", "Z"}));
  if (!frame.albedo.empty())
    GLOAM_TRY_STATUS(write_planes("_albedo.exr", frame.albedo, {"R", "G", "B"}));
  if (!frame.motion.empty())
    GLOAM_TRY_STATUS(write_planes("_motion.exr", frame.motion, {"U", "V"}));
  if (!frame.scene_flow.empty())
    GLOAM_TRY_STATUS(write_planes("_scene_flow.exr", frame.scene_flow, {"X", "Y", "Z"}));
  if (!frame.objects.empty()) {
    const std::string text = objects_json(frame.objects);
    GLOAM_TRY_STATUS(write("_boxes.json", std::vector<uint8_t>(text.begin(), text.end())));
  }
  return written;
}

}  // namespace gloam

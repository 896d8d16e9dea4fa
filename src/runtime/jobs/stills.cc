// gloam::render_stills and write_frame.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "base/files.h"
#include "base/log.h"
#include "base/memory.h"
#include "gloam/run.h"
#include "record/frame_files.h"
#include "record/run_files.h"
#include "record/run_folder.h"
#include "runtime/live/live_simulation.h"
#include "runtime/live/run_to_step.h"
#include "runtime/rendering/label_table.h"
#include "world/sensors/camera_rate.h"

namespace gloam {
namespace {

void tell_what_was_reached(const CameraRequest& request, const CameraFrame& frame,
                           const RenderStats& stats) {
  const double pixels =
      static_cast<double>(frame.intrinsics.width) * static_cast<double>(frame.intrinsics.height);
  const double unreached = static_cast<double>(stats.unreached) / pixels;
  log_info("camera {}: {:.0f} samples per pixel; {:.1f} % of the image is above {:g} % error{}",
           frame.camera, static_cast<double>(stats.paths) / pixels, 100 * unreached,
           100 * *request.render.error,
           unreached > 0 ? fmt::format(" after {} samples", request.render.samples()) : "");
}

/// Against which a still's motion counts: that of the picture 1 / rate earlier, or the first.
int64_t step_of_frame_before(int64_t step, Rational rate, Rational step_rate) {
  return std::max<int64_t>(0, step - std::llround(step_rate.value() / rate.value()));
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
                          ? fmt::format("an image of {} x {} pixels", k.width, k.height)
                          : fmt::format("rendering {} images", sensors.size()),
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
    if (std::ranges::count(request.outputs, "events") > 0) {
      return Error{
          ErrorKind::kInput,
          fmt::format(
              "camera '{}': events need all frames up to a time and are not available for stills",
              request.camera),
          {},
          "record them with gloam run and the output 'events'"};
    }
    GLOAM_TRY(auto sensor, CameraSensor::create(shared->description, request, options.seed));
    GLOAM_TRY_STATUS(sensor->set_temperatures(world.compiled()->scene.temperatures));
    sensors.push_back(std::move(sensor));
  }
  if (!sensors.empty()) GLOAM_TRY_STATUS(check_room(sensors));
  const Rational timestep = simulation->simulator().timestep();
  std::set<int64_t> wanted;  // steps, over all cameras' exposures
  std::vector<int64_t> previous;
  for (size_t i = 0; i < requests.size(); ++i) {
    const Rational rate = requests[i].rate.num > 0
                              ? requests[i].rate
                              : own_camera_rate(world.compiled()->scene, requests[i].camera);
    previous.push_back(step_of_frame_before(steps, rate, simulation->step_rate()));
    wanted.insert(previous.back());
    const KeySteps keys = key_steps(sensors[i]->window(), timestep);
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
    if (const auto meter = simulation->meters().of(requests[i].camera, *shared->world))
      sensor->set_ev100(meter->ev100_at(steps));
    const KeySteps keys = key_steps(sensor->window(), timestep);
    std::vector<const PoseFrame*> exposure;
    for (int k = 0; k < keys.count; ++k) exposure.push_back(&poses[steps + k * keys.stride]);
    // Draws are keyed by the step: pictures of two times have different noise.
    sensor->set_draws_by_index(true);
    const auto frame =
        sensor->capture(*shared->renderer, shared->turns, exposure, poses[previous[i]], steps);
    if (frame == nullptr) return Error{ErrorKind::kInterrupted, "interrupted"};
    if (requests[i].render.error) {
      tell_what_was_reached(requests[i], *frame, sensor->stats());
    }
    frames.push_back(*frame);
    frames.back().index = 0;
  }
  return frames;
}

Result<std::vector<StillFiles>> write_stills(const World& world,
                                             const std::vector<CameraFrame>& frames,
                                             const std::filesystem::path& folder,
                                             const std::vector<std::string>& outputs) {
  FileNames names{"cameras.json", "labels.json"};
  std::vector<std::string> suffixes, taken;
  for (const CameraFile& file : kCameraFiles)
    if (file.is_of_each_frame()) suffixes.emplace_back(file.suffix);
  std::vector<StillFiles> written;
  std::vector<RecordedCamera> cameras;
  bool has_ids = false;
  for (const CameraFrame& frame : frames) {
    taken.push_back(names.take(frame.camera, suffixes));
    GLOAM_TRY(auto files, write_frame(frame, folder, taken.back(), outputs));
    written.push_back({frame.camera, std::move(files)});
    cameras.push_back({.name = frame.camera, .intrinsics = frame.intrinsics});
    has_ids = has_ids || !frame.part.empty() || !frame.objects.empty();
  }
  GLOAM_TRY_STATUS(write_text_file_atomic(folder / "cameras.json", cameras_json(cameras, taken)));
  if (!has_ids) return written;
  GLOAM_TRY(const RenderDescription description, describe_for_rendering(*world.compiled()));
  const LabelTableRows labels = label_rows(description);
  GLOAM_TRY_STATUS(
      write_text_file_atomic(folder / "labels.json", labels_json(labels.rows, labels.ids)));
  return written;
}

Result<std::vector<std::filesystem::path>> write_frame(const CameraFrame& frame,
                                                       const std::filesystem::path& folder,
                                                       const std::string& name,
                                                       const std::vector<std::string>& outputs) {
  GLOAM_TRY_STATUS(make_folder(folder));
  std::vector<std::filesystem::path> written;
  for (const CameraFile& file : kCameraFiles) {
    const bool is_wanted =
        outputs.empty() || std::ranges::any_of(outputs, [&file](const std::string& output) {
          return output == file.output || output == file.channel;
        });
    if (!file.is_of_each_frame() || !is_wanted) continue;
    GLOAM_TRY(const std::vector<uint8_t> bytes, encode_frame_file(file, frame));
    if (bytes.empty()) continue;
    written.push_back(folder / fmt::format("{}{}", name, file.suffix));
    GLOAM_TRY_STATUS(write_file_atomic(written.back(), bytes));
  }
  return written;
}

}  // namespace gloam

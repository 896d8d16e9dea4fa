// gloam::render_stills and write_frame.

#include <chrono>

#include "base/files.h"
#include "base/log.h"
#include "gloam/run.h"
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
  GLOAM_TRY_STATUS(
      run_to_step(simulation->simulator(), steps, "simulating", seconds(), progress, {}));

  GLOAM_TRY(auto shared, simulation->renderer());
  GLOAM_TRY(auto solver, PoseSolver::create(world.compiled()));
  PoseFrame poses;
  GLOAM_TRY_STATUS(solver->solve(simulation->latest(), poses));
  std::vector<CameraFrame> frames;
  for (size_t i = 0; i < requests.size(); ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(requests.size());
    if (progress && !progress({"rendering", done, seconds()})) {
      return Error{ErrorKind::kInterrupted, "interrupted"};
    }
    GLOAM_TRY(auto sensor, CameraSensor::create(shared->description, requests[i], options.seed));
    const double share = 1 / static_cast<double>(requests.size());
    sensor->set_progress([&](double part) {
      return !progress || progress({"rendering", done + share * part, seconds()});
    });
    const auto frame = sensor->capture(*shared->renderer, shared->mutex, poses, poses, 0);
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
  return written;
}

}  // namespace gloam

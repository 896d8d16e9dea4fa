// gloam::compare_scenes: scenes one after the other, by the same sensors, into one video.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "base/files.h"
#include "gloam/run.h"
#include "record/canvas.h"
#include "record/sensor_panels.h"
#include "render/film/png.h"
#include "render/film/video.h"
#include "runtime/live/live_simulation.h"
#include "runtime/live/run_to_step.h"
#include "runtime/recording/sensing_quality.h"
#include "sensors/lidar/lidar_sensor.h"
#include "sensors/probe/visibility_probe.h"

namespace gloam {
namespace {

constexpr int kColumns = 4;
constexpr const char* kHeadings[kColumns] = {
    "camera", "depth camera, to 8 m", "thermal, 15 to 40 C", "LiDAR from above, rings of 2 m"};
constexpr float kFarDepth = 8, kCold = 288, kHot = 313, kReach = 8;  // [m], [K], [K], [m]
constexpr int kMargin = 26, kGap = 4;                                // [px]

/// Panels of one scene, by instant: (kColumns) each.
using Strip = std::vector<std::array<Panel, kColumns>>;

struct Seen {
  ComparisonResult result;
  Strip strip;
  int width = 0, height = 0;
  double seconds = 0;  // duration of simulation
};

class ComparedScene {
 public:
  static Result<ComparedScene> create(const ComparisonRequest& request, const Scene& scene,
                                      const ProgressCallback& progress) {
    ComparedScene out;
    GLOAM_TRY(const World world, World::compile(scene, progress));
    SimulationOptions options;
    options.seed = scene.sim.seed;
    options.timestep = scene.sim.timestep.value_or(0);
    GLOAM_TRY(out.simulation_, LiveSimulation::create(world, options));
    GLOAM_TRY(out.shared_, out.simulation_->renderer());
    GLOAM_TRY(out.solver_, PoseSolver::create(world.compiled()));
    GLOAM_TRY(out.probe_, VisibilityProbe::make(out.shared_->description));
    CameraRequest camera;
    camera.camera = request.camera;
    camera.rate = request.rate;
    camera.outputs = {"rgb", "radiance", "sensor_depth", "thermal"};
    camera.render = scene.render;
    GLOAM_TRY(out.camera_, CameraSensor::create(out.shared_->description, camera, options.seed));
    GLOAM_TRY_STATUS(out.camera_->set_temperatures(scene.temperatures));
    out.meter_ = out.simulation_->meters().of(request.camera, *world.compiled());
    GLOAM_TRY(const auto lidars, describe_lidars(*world.compiled()));
    const auto found = std::ranges::find_if(
        lidars, [&](const LidarDescription& lidar) { return lidar.options.name == request.lidar; });
    if (found == lidars.end())
      return Error{ErrorKind::kInput, fmt::format("the scene has no lidar '{}'", request.lidar)};
    GLOAM_TRY(out.lidar_, LidarSensor::create(out.shared_->description, *found, options.seed));
    return out;
  }

  Rational step_rate() const { return simulation_->step_rate(); }
  int width() const { return camera_->intrinsics().width; }
  int height() const { return camera_->intrinsics().height; }
  /// At `step`: adds to the sums, and one instant to the strip.
  Status look(int64_t step, int64_t index, const ProgressCallback& progress, Seen* seen) {
    GLOAM_TRY_STATUS(run_to_step(simulation_->simulator(), step, "simulating", 0, progress, {}));
    const Snapshot now = simulation_->latest();
    if (index == 0) GLOAM_TRY_STATUS(solver_->solve(now, before_));
    GLOAM_TRY_STATUS(solver_->solve(now, poses_));
    if (meter_ != nullptr) camera_->set_ev100(meter_->ev100_at(step));
    const auto frame = camera_->capture(*shared_->renderer, shared_->turns, poses_, before_, index);
    if (frame == nullptr) return Error{ErrorKind::kInterrupted, "interrupted"};
    const std::vector<PoseFrame> keys{poses_, poses_};
    const auto scan = lidar_->scan(*shared_->renderer, shared_->turns, keys, index);
    std::swap(poses_, before_);
    const Vec3f eye = to_affine(from_origin(frame->X_WC, shared_->description.origin)).p;
    ComparisonResult& sum = seen->result;
    sum.visibility = std::min(sum.visibility, probe_.visibility(now.data(), eye));
    sum.illuminance += static_cast<double>(shared_->renderer->illuminance(eye, {0, 0, 1}));
    sum.contrast += contrast_of(frame->radiance, width());
    const ReturnShares returns = returns_of(*scan);
    sum.lidar_returns += returns.surfaces, sum.media_returns += returns.media;
    seen->strip.push_back({frame->rgb, depth_panel(frame->sensor_depth, kFarDepth),
                           thermal_panel(frame->thermal, kCold, kHot),
                           lidar_panel(*scan, width(), height(), kReach)});
    return {};
  }

 private:
  std::unique_ptr<LiveSimulation> simulation_;
  std::shared_ptr<SharedRenderer> shared_;
  std::unique_ptr<PoseSolver> solver_;
  VisibilityProbe probe_;
  std::unique_ptr<CameraSensor> camera_;
  std::shared_ptr<ExposureMeter> meter_;  // null: the exposure is the camera's own
  std::unique_ptr<LidarSensor> lidar_;
  PoseFrame poses_, before_;
};

Result<Seen> see(const ComparisonRequest& request, size_t row, const ProgressCallback& progress) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const ComparisonRequest::Row& of = request.rows[row];
  GLOAM_TRY(ComparedScene scene, ComparedScene::create(request, of.scene, progress));
  Seen seen;
  seen.result.name = of.name;
  seen.result.visibility = VisibilityProbe::kMaxVisibility;
  seen.width = scene.width(), seen.height = scene.height();
  const double duration = of.scene.sim.duration;
  const auto count = std::max<int64_t>(std::llround(duration * request.rate.value()), 1);
  const std::string what = fmt::format("{} {}", request.name, of.name);
  for (int64_t k = 0; k < count; ++k) {
    const auto told = [&](const Progress&) {
      return !progress ||
             progress({what.c_str(), static_cast<double>(k) / static_cast<double>(count),
                       std::chrono::duration<double>(Clock::now() - start).count()});
    };
    if (!told({})) return Error{ErrorKind::kInterrupted, "interrupted"};
    GLOAM_TRY(const int64_t step, step_of_time(static_cast<double>(k) / request.rate.value(),
                                               scene.step_rate(), "an instant"));
    GLOAM_TRY_STATUS(scene.look(step, k, told, &seen));
  }
  const double share = 1 / static_cast<double>(count);
  seen.result.illuminance *= share, seen.result.contrast *= share;
  seen.result.lidar_returns *= share, seen.result.media_returns *= share;
  return seen;
}

Canvas draw(const ComparisonRequest& request, const std::vector<Seen>& rows, size_t instant) {
  constexpr Rgb8 kPaper{250, 250, 248}, kInk{30, 32, 36}, kLight{255, 255, 255};
  const int w = rows.front().width, h = rows.front().height;
  Canvas canvas(kColumns * (w + kGap) + kGap, kMargin + static_cast<int>(rows.size()) * (h + kGap),
                kPaper);
  for (int c = 0; c < kColumns; ++c) {
    canvas.text(static_cast<float>(kGap + c * (w + kGap)), kMargin - 8,
                fit_text(kHeadings[c], 9, static_cast<float>(w)), 9, kInk);
  }
  const double time = static_cast<double>(instant) / request.rate.value();
  canvas.text(static_cast<float>(canvas.width() - kGap), kMargin - 8, fmt::format("{:.1f} s", time),
              9, kInk, Align::kRight);
  for (size_t r = 0; r < rows.size(); ++r) {
    const int y = kMargin + static_cast<int>(r) * (h + kGap);
    const auto& panels = rows[r].strip[std::min(instant, rows[r].strip.size() - 1)];
    for (int c = 0; c < kColumns; ++c)
      canvas.paste(kGap + c * (w + kGap), y, w, h, panels[static_cast<size_t>(c)]);
    const int width = static_cast<int>(text_width(rows[r].result.name, 10)) + 12;
    canvas.fill(kGap, y, width, 20, kInk);
    canvas.text(kGap + 6, static_cast<float>(y + 15), rows[r].result.name, 10, kLight, Align::kLeft,
                true);
  }
  return canvas;
}

}  // namespace

Result<std::vector<ComparisonResult>> compare_scenes(const ComparisonRequest& request,
                                                     const ProgressCallback& progress) {
  if (request.rows.empty()) return Error{ErrorKind::kUsage, "there are no scenes to compare"};
  std::vector<Seen> rows;
  std::vector<ComparisonResult> results;
  size_t instants = 0;
  for (size_t row = 0; row < request.rows.size(); ++row) {
    GLOAM_TRY(Seen seen, see(request, row, progress));
    if (!rows.empty() && (seen.width != rows[0].width || seen.height != rows[0].height))
      return Error{ErrorKind::kInput,
                   fmt::format("camera '{}' does not have the same image size in all scenes",
                               request.camera)};
    instants = std::max(instants, seen.strip.size());
    results.push_back(seen.result);
    rows.push_back(std::move(seen));
  }
  GLOAM_TRY(auto sink, create_file_sink(request.out / (request.name + ".mp4")));
  const Canvas middle = draw(request, rows, instants / 2);
  VideoOptions options;
  options.width = middle.width(), options.height = middle.height(), options.rate = request.rate;
  GLOAM_TRY(VideoWriter video, VideoWriter::start(std::move(sink), options));
  for (size_t k = 0; k < instants; ++k)
    GLOAM_TRY_STATUS(video.add(static_cast<int64_t>(k), draw(request, rows, k).pixels()));
  GLOAM_TRY_STATUS(video.finish());
  GLOAM_TRY_STATUS(
      write_file_atomic(request.out / (request.name + ".png"),
                        encode_png8(middle.width(), middle.height(), 3, middle.pixels())));
  return results;
}

}  // namespace gloam

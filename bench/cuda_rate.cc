// Milliseconds per picture on an NVIDIA card, beside the CPU.
//   cuda_rate MODEL [--camera NAME]… [--size WxH] [--runs N] [--cpu] [--json]
// MODEL: MJCF or scene file. For each camera: the direct tier with one sample, and the path tier
// with 16 samples and depth 4 (`path 16`), both tone mapped on the card (on the CPU: light), and
// the direct tier with its light and exact channels (`channels`). Medians; `device`: of the stages
// on the card; `upload`: of the moved scene's copy before them; `wall`: with the BVH's refit and
// the picture's way back.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "bench/command_line.h"
#include "runtime/live/live_simulation.h"
#include "runtime/live/run_to_step.h"

using namespace gloam;

namespace {

struct Arguments {
  std::string model;
  std::vector<std::string> cameras;
  int width = 1280, height = 720, runs = 30;
  bool cpu = false, json = false;
};

Arguments parse(int argc, char** argv) {
  Arguments a;
  CommandLine line(argc, argv);
  a.cpu = line.flag("--cpu");
  a.json = line.flag("--json");
  for (std::string camera; line.value("--camera", &camera);) a.cameras.push_back(camera);
  line.value("--runs", &a.runs);
  line.size(&a.width, &a.height);
  if (!line.words().empty()) a.model = line.words().back();
  return a;
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

struct Work {
  const char* name;
  RenderSettings settings;
};

struct Times {
  std::vector<double> device, upload, wall;
  double rays = 0;
};

/// The robot moves between pictures: the scene is updated for each.
Times measure(Renderer* renderer, const CameraView& view, const RenderSettings& settings,
              const PoseFrame& poses, int runs) {
  Times times;
  Film film;
  PoseFrame now = poses;
  for (int i = -3; i < runs; ++i) {
    for (size_t body = 1; 3 * body < now.body_p.size(); ++body) {
      now.body_p[3 * body] = poses.body_p[3 * body] + 1e-3 * (i % 7);
    }
    const auto start = std::chrono::steady_clock::now();
    renderer->update(now, now, now);
    const RenderStats stats = renderer->render(view, settings, &film);
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (i < 0) continue;
    times.device.push_back(1e3 * stats.device_seconds);
    times.upload.push_back(1e3 * stats.upload_seconds);
    times.wall.push_back(1e3 * wall);
    times.rays = static_cast<double>(stats.rays);
  }
  return times;
}

Status run(const Arguments& a) {
  GLOAM_TRY(const Scene scene, load_scene(a.model, {}));
  GLOAM_TRY(const World world, World::compile(scene));
  GLOAM_TRY(auto simulation, LiveSimulation::create(world, {}));
  GLOAM_TRY(auto solver, PoseSolver::create(world.compiled()));
  PoseFrame poses;
  GLOAM_TRY_STATUS(solver->solve(simulation->latest(), poses));
  GLOAM_TRY(const RenderDescription description, describe_for_rendering(*world.compiled()));
  GLOAM_TRY(auto renderer,
            a.cpu ? make_cpu_renderer(description) : make_cuda_renderer(description));

  RenderSettings direct, path;
  direct.tier = RenderTier::kDirect;
  direct.spp = 1;
  const RenderSettings channels = direct;
  path.spp = 16;
  path.max_depth = 4;
  path.exact_channels = direct.exact_channels = false;
  path.finish.to_display = direct.finish.to_display = !a.cpu;
  for (size_t i = 0; i < description.cameras.size(); ++i) {
    const std::string& name = description.cameras[i].name;
    if (!a.cameras.empty() &&
        std::find(a.cameras.begin(), a.cameras.end(), name) == a.cameras.end()) {
      continue;
    }
    const PoseFrame* const key = &poses;
    CameraView view = view_at(description, static_cast<int>(i), {&key, 1}, poses);
    Intrinsics& k = view.intrinsics;
    const double scale = static_cast<double>(a.height) / k.height;
    k.fx *= scale;
    k.fy *= scale;
    k.cx = 0.5 * a.width;
    k.cy = 0.5 * a.height;
    k.width = a.width;
    k.height = a.height;
    for (const Work& work :
         {Work{"direct", direct}, Work{"channels", channels}, Work{"path 16", path}}) {
      const Times t = measure(renderer.get(), view, work.settings, poses, a.runs);
      const double device = median(t.device), upload = median(t.upload), wall = median(t.wall);
      const double rays = t.rays / (1e6 * (a.cpu ? wall : device));
      std::printf(a.json ? "{\"name\": \"cuda_rate\", \"camera\": \"%s\", \"work\": \"%s\", "
                           "\"device_ms\": %.4f, \"upload_ms\": %.4f, \"wall_ms\": %.3f, "
                           "\"grays_per_s\": %.3f}\n"
                         : "%-10s %-8s device %8.3f ms  upload %6.3f ms  wall %8.2f ms  "
                           "%6.2f Grays/s\n",
                  name.c_str(), work.name, device, upload, wall, rays);
      std::fflush(stdout);
    }
  }
  return {};
}

}  // namespace

int main(int argc, char** argv) { return exit_code(run(parse(argc, argv))); }

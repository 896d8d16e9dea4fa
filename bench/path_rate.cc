// How many paths per second, against a bare Embree loop that traces the very same rays.
//   path_rate [--picture FILE.ppm] [--spp N] [--direct] [--plain] [--size WxH]

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/parallel.h"
#include "bench/room_scene.h"

using namespace gloam;

namespace {

/// A quick look: exposure to a mean of 0.18, soft shoulder, sRGB.
void write_ppm(const std::string& path, const Film& film) {
  double mean = 0;
  for (const Vec3f& c : film.radiance) mean += std::log(1e-3 + luminance(c));
  const double scale = 0.22 / std::exp(mean / static_cast<double>(film.radiance.size()));
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return;
  std::fprintf(file, "P6 %d %d 255\n", film.width, film.height);
  for (const Vec3f& c : film.radiance) {
    for (int k = 0; k < 3; ++k) {
      double v = c[k] * scale;
      v = v * (1 + v / 16) / (1 + v);
      v = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
      std::fputc(static_cast<int>(std::lround(std::min(1.0, std::max(0.0, v)) * 255)), file);
    }
  }
  std::fclose(file);
}

}  // namespace

int main(int argc, char** argv) {
  std::string picture;
  RenderSettings settings;
  RoomOptions room;
  int width = 640, height = 480;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--picture" && i + 1 < argc) picture = argv[++i];
    if (arg == "--spp" && i + 1 < argc) settings.spp = std::atoi(argv[++i]);
    if (arg == "--depth" && i + 1 < argc) settings.max_depth = std::atoi(argv[++i]);
    if (arg == "--direct") settings.tier = RenderTier::kDirect;
    if (arg == "--plain") room.plain = true;
    if (arg == "--size" && i + 1 < argc) std::sscanf(argv[++i], "%dx%d", &width, &height);
  }
  const SceneBuilder builder = make_room(room);
  const auto start = std::chrono::steady_clock::now();
  auto renderer = builder.make();
  const double build =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Film film;
  const CameraView view = room_camera(width, height);
  RenderStats best;
  best.trace_seconds = 1e30;
  for (int i = 0; i < 5; ++i) {
    const RenderStats stats = renderer->render(view, settings, &film);
    if (stats.trace_seconds < best.trace_seconds) best = stats;
    if (settings.spp > 32) break;
  }
  std::printf("build %.0f ms, %d threads, %.1f ms, %.2f rays/path, %.3f Mpaths/s, %.2f Mrays/s\n",
              build * 1e3, thread_count(), best.trace_seconds * 1e3,
              static_cast<double>(best.rays) / static_cast<double>(best.paths),
              static_cast<double>(best.paths) / best.trace_seconds * 1e-6,
              static_cast<double>(best.rays) / best.trace_seconds * 1e-6);
  if (!picture.empty()) write_ppm(picture, film);
}

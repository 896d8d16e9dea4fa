// The kernel's stages over Embree and all threads of parallel_for.

#include <fmt/format.h>
#include <immintrin.h>

#include <algorithm>
#include <chrono>

#include "base/check.h"
#include "base/log.h"
#include "base/parallel.h"
#include "render/cpu/embree_scene.h"
#include "render/kernel/channels.h"
#include "render/kernel/direct.h"
#include "render/renderer.h"

namespace gloam {
namespace {

constexpr int kTile = 16;  // [px]

/// Denormals are zero while a tile is rendered, whatever thread does it.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

CameraView32 make_camera(const CameraView& view) {
  CameraView32 camera;
  camera.fx = static_cast<float>(view.intrinsics.fx);
  camera.fy = static_cast<float>(view.intrinsics.fy);
  camera.cx = static_cast<float>(view.intrinsics.cx);
  camera.cy = static_cast<float>(view.intrinsics.cy);
  camera.orthographic = view.intrinsics.orthographic;
  camera.pose = {view.X_WC_open, view.X_WC_close, view.X_WC_previous};
  const Affine3f &a = view.X_WC_open, &b = view.X_WC_close;
  camera.pose.moving = !(a.x == b.x && a.y == b.y && a.z == b.z && a.p == b.p);
  return camera;
}

/// One render call: everything that its pixels share.
struct Job {
  SceneView scene;
  EmbreeTracer tracer;
  CameraView32 camera;
  RenderSettings settings;
  PathOptions path;
  uint32_t log2_samples = 0;
  bool has_motion = false;  ///< something moves while the shutter is open
  Film* film = nullptr;
};

/// Mean over the samples of a pixel and the variance of that mean (Welford 1962).
struct PixelMean {
  Vec3f radiance, squares, albedo, normal;
  int count = 0;

  void add(const PathResult& sample) {
    ++count;
    const float weight = 1.0f / static_cast<float>(count);
    const Vec3f delta = sample.radiance - radiance;
    radiance += delta * weight;
    squares += delta * (sample.radiance - radiance);
    albedo += (sample.albedo - albedo) * weight;
    normal += (sample.normal - normal) * weight;
  }
  Vec3f variance() const {
    return count < 2 ? Vec3f{} : squares / (static_cast<float>(count) * (count - 1));
  }
};

void store_channels(Film* film, size_t pixel, const ExactChannels& c) {
  film->depth[pixel] = c.depth;
  film->distance[pixel] = c.distance;
  film->part[pixel] = c.part;
  film->center_normal[pixel] = c.normal;
  film->center_albedo[pixel] = c.albedo;
  film->motion[pixel] = c.motion;
}

void render_pixel(const Job& job, int x, int y, RenderStats* stats) {
  Film& film = *job.film;
  const size_t pixel = static_cast<size_t>(y) * film.width + x;
  const RenderSettings& settings = job.settings;
  const bool direct = settings.tier == RenderTier::kDirect;
  const float u = static_cast<float>(x) + 0.5f, v = static_cast<float>(y) + 0.5f;
  // A single direct sample goes through the pixel's centre, and serves the exact channels too.
  const bool centered = direct && settings.spp == 1 && !job.has_motion;
  uint32_t rays = 0;
  PixelMean mean;
  for (int i = 0; i < settings.spp; ++i) {
    Sampler sampler = Sampler::make(
        settings.seed, settings.frame, static_cast<uint32_t>(x), static_cast<uint32_t>(y),
        static_cast<uint32_t>(settings.first_sample + i), job.log2_samples);
    Vec2f offset;
    float time = 0;
    if (!centered) {
      offset = sample_pixel_filter(sampler.next_2d());
      if (job.has_motion) time = sampler.next_1d();
    }
    RayCone cone;
    const Ray ray = camera_ray(job.camera, u + offset.x, v + offset.y, time, &cone);
    PathResult result;
    if (direct) {
      Surface first;
      bool found = false;
      result = trace_direct(job.scene, job.tracer, ray, cone, sampler, &found, &first);
    } else {
      result = trace_path(job.scene, job.tracer, ray, cone, job.path, sampler);
    }
    rays += result.rays;
    mean.add(result);
  }
  film.radiance[pixel] = mean.radiance;
  film.albedo[pixel] = mean.albedo;
  film.normal[pixel] = mean.normal;
  if (settings.variance) film.variance[pixel] = mean.variance();
  if (settings.exact_channels) {
    RayCone cone;
    const Ray ray = camera_ray(job.camera, u, v, 0.0f, &cone);
    Surface surface;
    RayHit hit;
    const bool found = find_first(job.scene, job.tracer, ray, cone, &surface, &hit, &rays);
    store_channels(&film, pixel,
                   found ? describe_surface(job.scene, job.camera, ray, surface, hit)
                         : describe_sky(job.camera, ray));
  }
  stats->paths += static_cast<uint64_t>(settings.spp);
  stats->rays += rays;
}

void resize_film(const CameraView& view, const RenderSettings& settings, Film* film) {
  film->width = view.intrinsics.width;
  film->height = view.intrinsics.height;
  const size_t n = film->pixel_count(), exact = settings.exact_channels ? n : 0;
  film->radiance.resize(n);
  film->albedo.resize(n);
  film->normal.resize(n);
  film->variance.resize(settings.variance ? n : 0);
  film->depth.resize(exact);
  film->distance.resize(exact);
  film->part.resize(exact);
  film->center_normal.resize(exact);
  film->center_albedo.resize(exact);
  film->motion.resize(exact);
}

class CpuRenderer final : public Renderer {
 public:
  CpuRenderer(std::unique_ptr<RenderScene> scene, std::unique_ptr<EmbreeScene> embree)
      : scene_(std::move(scene)), embree_(std::move(embree)) {}

  void update(const PoseFrame& open, const PoseFrame& close, const PoseFrame& previous) override {
    scene_->update(open, close, previous);
    const Status status = embree_->update(*scene_);
    GLOAM_CHECK(status.ok(), "the BVH cannot be built: out of memory?");
    updated_ = true;
  }

  RenderStats render(const CameraView& view, const RenderSettings& settings, Film* film) override {
    GLOAM_CHECK(updated_, "update must come before render");
    const auto start = std::chrono::steady_clock::now();
    resize_film(view, settings, film);
    Job job;
    job.scene = scene_->view_from(view.X_WC_open);
    job.tracer = embree_->tracer(*scene_);
    job.camera = make_camera(view);
    job.settings = settings;
    job.path = {settings.max_depth, settings.roulette_depth};
    job.film = film;
    job.has_motion = job.camera.pose.moving || scene_->has_motion();
    while ((int64_t{1} << job.log2_samples) < int64_t{settings.first_sample} + settings.spp) {
      ++job.log2_samples;
    }
    const int columns = (film->width + kTile - 1) / kTile,
              rows = (film->height + kTile - 1) / kTile;
    tiles_.assign(static_cast<size_t>(columns) * rows, {});
    parallel_for("render tiles", static_cast<int64_t>(tiles_.size()), [&](int64_t tile) {
      const FlushDenormals flush;
      const int x0 = static_cast<int>(tile % columns) * kTile;
      const int y0 = static_cast<int>(tile / columns) * kTile;
      for (int y = y0; y < std::min(y0 + kTile, film->height); ++y) {
        for (int x = x0; x < std::min(x0 + kTile, film->width); ++x) {
          render_pixel(job, x, y, &tiles_[tile]);
        }
      }
    });
    RenderStats total;
    for (const RenderStats& tile : tiles_) {
      total.paths += tile.paths;
      total.rays += tile.rays;
    }
    total.trace_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return total;
  }

 private:
  std::unique_ptr<RenderScene> scene_;
  std::unique_ptr<EmbreeScene> embree_;
  std::vector<RenderStats> tiles_;
  bool updated_ = false;
};

Affine3f camera_pose(const CameraDescription& camera, const PoseFrame& frame) {
  if (camera.camera < 0) return camera.X_WC;
  const double* p = &frame.camera_p[3 * static_cast<size_t>(camera.camera)];
  const double* R = &frame.camera_R[9 * static_cast<size_t>(camera.camera)];
  const auto column = [R](int i) {
    return Vec3f{static_cast<float>(R[i]), static_cast<float>(R[3 + i]),
                 static_cast<float>(R[6 + i])};
  };
  return {column(0),
          column(1),
          column(2),
          {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}};
}

}  // namespace

std::string ray_tracer_version() {
  return fmt::format("Embree {}.{}.{}", RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}

Result<std::unique_ptr<Renderer>> make_cpu_renderer(const RenderDescription& description) {
  GLOAM_TRY(auto scene, RenderScene::make(description));
  GLOAM_TRY(auto embree, EmbreeScene::make());
  return std::unique_ptr<Renderer>(new CpuRenderer(std::move(scene), std::move(embree)));
}

CameraView view_at(const RenderDescription& description, int camera, const PoseFrame& open,
                   const PoseFrame& close, const PoseFrame& previous) {
  const CameraDescription& in = description.cameras[static_cast<size_t>(camera)];
  return {in.intrinsics, camera_pose(in, open), camera_pose(in, close), camera_pose(in, previous)};
}

}  // namespace gloam

// The renderer: a scene and the stages that make pictures of it, those of the CPU and, where there
// is one, a card's.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/check.h"
#include "base/log.h"
#include "render/cpu/cpu_stages.h"
#include "render/cpu/guide/distant_light.h"
#include "render/cpu/guide/illuminance.h"
#include "render/cpu/guide/light_guide.h"
#include "render/cpu/lidar_scan.h"
#include "render/cpu/particles/particle_streaks.h"
#include "render/cpu/path/ambient.h"
#include "render/cpu/path/edge_samples.h"
#include "render/cpu/path/object_cover.h"
#include "render/cpu/realtime/fast_tier.h"
#include "render/cpu/tracer/picture_clip.h"
#include "render/cpu/tracer/traced_scene.h"
#include "render/cuda/cuda_stages.h"
#include "render/scene/pose.h"

namespace gloam {
namespace {

/// Rotation as a unit quaternion wxyz.
CameraKey camera_key(const Affine3f& X) {
  const Quat q = quaternion_of(X);
  return {X.p,
          {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
           static_cast<float>(q.z)}};
}

/// `keys`: scratch for what it refers to.
CameraView32 make_camera(const CameraView& view, std::vector<CameraKey>* keys) {
  CameraView32 camera;
  camera.fx = static_cast<float>(view.intrinsics.fx);
  camera.fy = static_cast<float>(view.intrinsics.fy);
  camera.cx = static_cast<float>(view.intrinsics.cx);
  camera.cy = static_cast<float>(view.intrinsics.cy);
  camera.orthographic = view.intrinsics.orthographic;
  if (!view.intrinsics.orthographic) camera.lens = make_lens<float>(view.intrinsics);
  camera.shutter = view.shutter;
  camera.aperture = view.aperture;
  camera.pose = {view.X_WC_open, view.X_WC_previous, {}};
  keys->clear();
  for (const Affine3f& X_WC : view.X_WC_keys) keys->push_back(camera_key(X_WC));
  const bool moving = std::any_of(view.X_WC_keys.begin(), view.X_WC_keys.end(),
                                  [&](const Affine3f& X) { return !is_same(X, view.X_WC_open); });
  if (moving) camera.pose.keys = {keys->data(), static_cast<uint32_t>(keys->size())};
  return camera;
}

void resize_film(const CameraView& view, const RenderSettings& settings, Film* film) {
  film->width = view.intrinsics.width;
  film->height = view.intrinsics.height;
  const size_t n = film->pixel_count(), exact = settings.exact_channels ? n : 0;
  const size_t details = settings.exact_details ? exact : 0;
  const size_t light = settings.spp > 0 || settings.tier == RenderTier::kFast ? n : 0;
  film->radiance.resize(light);
  film->albedo.resize(light);
  film->normal.resize(light);
  film->variance.resize(settings.variance ? light : 0);
  film->sample_count.resize(settings.error > 0 ? n : 0);
  visit_places([&](auto& plane) { plane.resize(exact); }, *film);
  visit_details([&](auto& plane) { plane.resize(details); }, *film);
}

PictureClip clip_of(const CameraView& view, const SceneView& scene, const CameraView32& camera) {
  PictureClip clip{scene, camera, {view.near, view.culls_backs, {}}};
  if (view.hidden != nullptr)
    clip.view.hidden = {view.hidden->data(), static_cast<uint32_t>(view.hidden->size())};
  return clip;
}

/// Owns its stages, which know a picture's inputs (Job, CudaJob) and nothing of a renderer.
class StagedRenderer final : public Renderer {
 public:
  /// Without `embree` the CPU's rays go through our own BVH; `cuda` renders what it has stages for.
  StagedRenderer(std::unique_ptr<RenderScene> scene, std::unique_ptr<EmbreeScene> embree,
                 std::unique_ptr<CudaStages> cuda = nullptr)
      : traced_(std::move(scene), std::move(embree), cuda != nullptr), cuda_(std::move(cuda)) {
    for (const InstanceDescription& in : traced_.scene().description().instances)
      objects_.push_back(in.label.instance);
  }

  using Renderer::update;
  void update(std::span<const PoseFrame* const> keys, const PoseFrame& previous) override {
    traced_.update(keys, previous);
    opens_ = keys.front()->time;
    seconds_ = keys.back()->time - opens_;
    if (cuda_ != nullptr) cuda_->update(scene());
    if (!updated_) described_ = scene().described_look(*keys.front());
    updated_ = true;
  }

  RenderStats render(const CameraView& view, const RenderSettings& settings, Film* film) override {
    GLOAM_CHECK(updated_, "update must come before render");
    const auto start = std::chrono::steady_clock::now();
    resize_film(view, settings, film);
    film->cover.clear();
    Job job;
    job.camera = make_camera(view, &camera_keys_);
    job.scene = job.camera.pose.keys.empty() ? scene().view_from(view.X_WC_open)
                                             : scene().view_from(view.X_WC_open, view.X_WC_keys);
    // Measurements before the picture, and the fast tier, know no times: they see mean lamps.
    const DeviceSpan<const float> levels = std::exchange(job.scene.light_levels, {});
    job.tracer = traced_.tracer();
    const PictureClip clip = clip_of(view, job.scene, job.camera);
    if (!clip.view.is_idle()) job.tracer.clip = &clip;
    const bool few = job.scene.lights.size <= kMaxWeighedLights;
    if (settings.tier == RenderTier::kPath && few) job.scene.selects_by_tree = false;
    // The fast tier's cache keeps the light of scenes with a tree by itself.
    if (settings.tier == RenderTier::kPath ||
        (settings.tier == RenderTier::kFast && !job.scene.selects_by_tree)) {
      if (!has_guide_) guide_.build(job.scene, traced_.static_tracer(), described_);
      has_guide_ = true;
      described_ = {};
      job.scene.guide = guide_.view();
    }
    const bool moves = !job.camera.pose.keys.empty() || scene().has_motion();
    // Where all rows see all of the keys' time and nothing moves, the mean is exact and not noisy.
    const Shutter& shutter = job.camera.shutter;
    const bool flickers =
        scene().has_flicker() && (moves || shutter.row > 0 || shutter.open + shutter.length < 1);
    job.has_motion = moves || flickers;
    if (settings.cover) {
      film->cover = measure_cover(job.scene, job.tracer, job.camera, job.has_motion, film->width,
                                  film->height, objects_);
    }
    if (settings.tier == RenderTier::kFast) {
      job.scene.environment.row_cdf = {};  // the cache has the sky's light: none is sampled
      FastHistory own;
      auto* history = static_cast<FastHistory*>(settings.history);
      RenderStats stats = (history != nullptr ? *history : own)
                              .render(job.scene, job.tracer, job.camera, settings, film);
      job.settings = settings;
      job.film = film;
      if (settings.exact_channels) cpu_.render_exact_channels(job);
      stats.trace_seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      return stats;
    }
    const bool adaptive = settings.error > 0;
    const bool on_card = cuda_ != nullptr && !adaptive;
    job.settings = settings;
    job.path = {settings.max_depth, settings.roulette_depth};
    if (settings.tier == RenderTier::kDirect && settings.spp > 0) {
      job.scene.ambient =
          on_card ? mean_ambient(cuda_->trace_ambient(on_cuda(job), film->width, film->height))
                  : measure_ambient(job.scene, job.tracer, job.camera, film->width, film->height,
                                    settings.max_depth);
      job.scene.environment.row_cdf = {};  // it stands for the sky's light: none is sampled
    }
    if (flickers) job.scene.light_levels = levels;
    job.film = film;
    job.centered = settings.tier == RenderTier::kDirect && settings.spp == 1 &&
                   settings.first_sample == 0 && !job.has_motion &&
                   !(job.camera.aperture.radius > 0);
    GLOAM_CHECK(!adaptive || (settings.tier == RenderTier::kPath && settings.first_sample == 0 &&
                              settings.spp >= kLeastAdaptiveSpp),
                "adaptive sampling is of the path tier, from sample 0, of 16 and more");
    const int64_t samples =
        adaptive ? settings.spp / 2 : int64_t{settings.first_sample} + settings.spp;
    while ((int64_t{1} << job.log2_samples) < samples) ++job.log2_samples;
    RenderStats total = on_card ? cuda_->render(on_cuda(job), film) : cpu_.render(job);
    // Blurred pictures have blurred guides: those of the samples.
    const bool sharp =
        !(job.camera.aperture.radius > 0) && !(moves && job.camera.shutter.length > 0);
    if (total.finished && settings.spp > 0 && settings.spp < settings.guide_samples && sharp) {
      GLOAM_CHECK(settings.exact_channels && settings.exact_details,
                  "guide samples need the exact channels");
      total.rays += refine_guides({job.scene, job.tracer, job.camera, job.has_motion},
                                  settings.guide_samples, film);
    }
    total.trace_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return total;
  }

  void draw_particles(const CameraView& view, const Film& film,
                      std::vector<Vec3f>* radiance) override {
    const CameraView32 camera = make_camera(view, &camera_keys_);
    const SceneView seen = scene().view_from(view.X_WC_open);
    const CpuTracer tracer = traced_.tracer();
    gloam::draw_particles({seen, tracer, camera, scene().description().weather, opens_, seconds_},
                          film, radiance);
  }

  float illuminance(Vec3f p_W, Vec3f n_W) override {
    GLOAM_CHECK(updated_, "update must come before illuminance");
    constexpr int kDepth = 5;
    Affine3f X_WC;
    X_WC.p = p_W;
    return measure_illuminance(scene().view_from(X_WC), traced_.tracer(), p_W, n_W, kDepth);
  }

  void distant_light(const CameraView& view, std::span<const Vec3f> directions,
                     std::span<float> passed) override {
    GLOAM_CHECK(updated_, "update must come before distant_light");
    const CameraView32 camera = make_camera(view, &camera_keys_);
    const SceneView seen = scene().view_from(view.X_WC_open);
    const PictureClip clip = clip_of(view, seen, camera);
    CpuTracer tracer = traced_.tracer();
    if (!clip.view.is_idle()) tracer.clip = &clip;
    measure_distant_light(seen, tracer, view.X_WC_open.p, directions, passed);
  }

  void scan(const LidarView& view, std::span<LidarReturn> returns) override {
    GLOAM_CHECK(updated_, "update must come before scan");
    scan_beams(scene().view_from(view.motions.front().X_WL), traced_.tracer(), view, returns);
  }

  std::unique_ptr<ViewHistory> make_history() const override {
    return std::make_unique<FastHistory>();
  }

 private:
  RenderScene& scene() { return traced_.scene(); }
  const RenderScene& scene() const { return traced_.scene(); }
  CudaJob on_cuda(const Job& job) const {
    const ViewClip clip = job.tracer.clip != nullptr ? job.tracer.clip->view : ViewClip();
    return {scene(),      traced_.own(), job.scene,        job.camera,     clip,
            job.settings, job.path,      job.log2_samples, job.has_motion, job.centered};
  }

  TracedScene traced_;
  CpuStages cpu_;
  std::unique_ptr<CudaStages> cuda_;  // null: all is rendered on the CPU
  std::vector<CameraKey> camera_keys_;
  std::vector<uint32_t> objects_;  ///< by instance
  DescribedLook described_;        ///< until the guide is built
  LightGuideStore guide_;
  double opens_ = 0, seconds_ = 0;  ///< of the keys: the first, and to the last [s]
  bool updated_ = false, has_guide_ = false;
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

Result<std::unique_ptr<Renderer>> make_cpu_renderer(const RenderDescription& description,
                                                    RayTracer tracer) {
  GLOAM_TRY(auto scene, RenderScene::make(description));
  std::unique_ptr<EmbreeScene> embree;
  if (tracer == RayTracer::kEmbree) {
    GLOAM_TRY(embree, EmbreeScene::make());
  }
  return std::unique_ptr<Renderer>(new StagedRenderer(std::move(scene), std::move(embree)));
}

Result<std::unique_ptr<Renderer>> make_cuda_renderer(const RenderDescription& description) {
  GLOAM_TRY(auto cuda, CudaStages::make());
  GLOAM_TRY(auto scene, RenderScene::make(description));
  GLOAM_TRY(auto embree, EmbreeScene::make());
  return std::unique_ptr<Renderer>(
      new StagedRenderer(std::move(scene), std::move(embree), std::move(cuda)));
}

Result<std::unique_ptr<Renderer>> make_renderer(const RenderDescription& description,
                                                const std::string& device) {
  if (!renders_on_card(device)) return make_cpu_renderer(description);
  if (const auto card = cuda_device_name(); card.ok()) log_info("rendering on {}", *card);
  return make_cuda_renderer(description);
}

bool renders_on_card(const std::string& device) {
  return device == "cuda" || (device == "auto" && cuda_device_name().ok());
}

Result<std::string> cuda_device_name() {
  GLOAM_TRY(const auto cuda, CudaStages::make());
  return cuda->device_name();
}

CameraView view_at(const RenderDescription& description, int camera,
                   std::span<const PoseFrame* const> keys, const PoseFrame& previous) {
  const CameraDescription& in = description.cameras[static_cast<size_t>(camera)];
  CameraView view{in.intrinsics, camera_pose(in, *keys.front()), camera_pose(in, previous)};
  view.near = in.near;
  view.culls_backs = in.culls_backs;
  view.hidden = in.hidden;
  if (keys.size() > 1) {
    for (const PoseFrame* key : keys) view.X_WC_keys.push_back(camera_pose(in, *key));
  }
  return view;
}

}  // namespace gloam

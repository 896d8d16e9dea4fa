// The renderer: a scene and the stages that render images of it, on the CPU and, where there
// is one, a card's.

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/check.h"
#include "render/cpu/cpu_stages.h"
#include "render/cpu/guide/distant_light.h"
#include "render/cpu/guide/illuminance.h"
#include "render/cpu/guide/light_guide.h"
#include "render/cpu/interactive/interactive_tier.h"
#include "render/cpu/lidar_scan.h"
#include "render/cpu/particles/particle_streaks.h"
#include "render/cpu/path/ambient.h"
#include "render/cpu/path/edge_samples.h"
#include "render/cpu/path/object_cover.h"
#include "render/cpu/tracer/traced_scene.h"
#include "render/cuda/cuda_stages.h"
#include "render/film/denoise.h"
#include "render/picture.h"

namespace gloam {
namespace {

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
    keys_.assign(keys.begin(), keys.end());
    previous_ = &previous;
  }

  std::future<RenderStats> begin(const CameraView& view, const RenderSettings& settings,
                                 Film* film) override {
    GLOAM_CHECK(updated_, "update() must be called before begin()");
    const auto start = std::chrono::steady_clock::now();
    resize_film(view, settings, film);
    film->cover.clear();
    Picture picture{view};
    Job& job = picture.job;
    job.settings = settings;
    job.film = film;
    job.camera = make_camera(view, &picture.camera_keys);
    RenderSlices slices(settings.turns, [this, &picture, keys = keys_, previous = previous_] {
      update(keys, *previous);
      look(&picture);
      light(&picture);
    });
    job.slices = &slices;
    look(&picture);
    plan(&picture);
    light(&picture);
    if (settings.cover) {
      slices.pause();
      film->cover = measure_cover(job.scene, job.tracer, job.camera, job.has_motion, film->width,
                                  film->height, objects_);
    }
    std::future<RenderStats> result =
        settings.tier == RenderTier::kInteractive ? begin_interactive(job) : begin_exact(job);
    return std::async(std::launch::deferred, [start, result = std::move(result)]() mutable {
      RenderStats total = result.get();
      total.trace_seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      return total;
    });
  }

  bool finishes(const RenderSettings& settings) override {
    return cuda_ != nullptr && !(settings.error > 0) && cuda_->finishes(settings.finish);
  }

  void draw_particles(const CameraView& view, const Film& film,
                      std::vector<Vec3f>* radiance) override {
    std::vector<CameraKey> keys;
    const CameraView32 camera = make_camera(view, &keys);
    const SceneView seen = scene().view_from(view.X_WC_open);
    const CpuTracer tracer = traced_.tracer();
    gloam::draw_particles({seen, tracer, camera, scene().description().weather, opens_, seconds_},
                          film, radiance);
  }

  float illuminance(Vec3f p_W, Vec3f n_W) override {
    GLOAM_CHECK(updated_, "update() must be called before illuminance()");
    constexpr int kDepth = 5;
    Affine3f X_WC;
    X_WC.p = p_W;
    return measure_illuminance(scene().view_from(X_WC), traced_.tracer(), p_W, n_W, kDepth);
  }

  void distant_light(const CameraView& view, std::span<const Vec3f> directions,
                     std::span<float> passed) override {
    GLOAM_CHECK(updated_, "update() must be called before distant_light()");
    std::vector<CameraKey> keys;
    const CameraView32 camera = make_camera(view, &keys);
    const SceneView seen = scene().view_from(view.X_WC_open);
    const PictureClip clip = clip_of(view, seen, camera);
    CpuTracer tracer = traced_.tracer();
    if (!clip.view.is_idle()) tracer.clip = &clip;
    measure_distant_light(seen, tracer, view.X_WC_open.p, directions, passed);
  }

  void scan(const LidarView& view, std::span<LidarReturn> returns) override {
    GLOAM_CHECK(updated_, "update() must be called before scan()");
    SceneView seen = scene().view_from(view.motions.front().X_WL);
    if (cuda_ != nullptr) {
      const Job job{.scene = seen};
      return cuda_->scan(on_cuda(job), view, returns);
    }
    CpuTracer tracer = traced_.tracer();
    RenderSlices slices(view.turns, [&, keys = keys_, previous = previous_] {
      update(keys, *previous);
      seen = scene().view_from(view.motions.front().X_WL);
      tracer = traced_.tracer();
    });
    scan_beams(seen, tracer, view, &slices, returns);
  }

  std::unique_ptr<ViewHistory> make_history() const override {
    if (cuda_ != nullptr) return cuda_->make_history();
    return std::make_unique<InteractiveHistory>();
  }

 private:
  RenderScene& scene() { return traced_.scene(); }
  const RenderScene& scene() const { return traced_.scene(); }

  // Reads the scene as the last update left it.
  void look(Picture* picture) {
    Job& job = picture->job;
    const CameraView& view = picture->view;
    job.scene = job.camera.pose.keys.empty() ? scene().view_from(view.X_WC_open)
                                             : scene().view_from(view.X_WC_open, view.X_WC_keys);
    // Measurements before the picture, and the interactive tier, know no times: they see mean
    // lamps.
    picture->levels = std::exchange(job.scene.light_levels, {});
    if (!is_on_card(job) || job.settings.cover) job.tracer = traced_.tracer();
    picture->clip = clip_of(view, job.scene, job.camera);
    if (!picture->clip.view.is_idle()) job.tracer.clip = &picture->clip;
    const bool few = job.scene.lights.size <= kMaxWeighedLights;
    if (traces_paths(job) && few) job.scene.selects_by_tree = false;
  }

  // Decides how the picture is made, and measures what is needed before it.
  void plan(Picture* picture) {
    Job& job = picture->job;
    const RenderSettings& settings = job.settings;
    if (settings.tier == RenderTier::kInteractive && is_on_card(job)) {
      job.camera.aperture = {};  // its pictures are sharp
      job.camera.shutter.length = 0;
    }
    // The interactive tier's cache keeps the light of scenes with a tree by itself.
    picture->is_guided = traces_paths(job) ||
                         (settings.tier == RenderTier::kInteractive && !job.scene.selects_by_tree);
    if (picture->is_guided && !has_guide_) {
      guide_.build(job.scene, traced_.static_tracer(), described_);
      has_guide_ = true;
      described_ = {};
    }
    const bool moves = !job.camera.pose.keys.empty() || scene().has_motion();
    // Where all rows see all of the keys' time and nothing moves, the mean is exact and not noisy.
    const Shutter& shutter = job.camera.shutter;
    picture->flickers =
        scene().has_flicker() && (moves || shutter.row > 0 || shutter.open + shutter.length < 1);
    job.has_motion = moves || picture->flickers;
    job.path = {settings.max_depth, settings.roulette_depth};
    const Film& film = *job.film;
    if (has_ambient(settings) && !is_on_card(job)) {
      picture->ambient = measure_ambient(job.scene, job.tracer, job.camera, film.width, film.height,
                                         settings.max_depth);
    }
  }

  // Adds to the scene the light that is known before the picture.
  void light(Picture* picture) {
    Job& job = picture->job;
    const RenderTier tier = job.settings.tier;
    if (picture->is_guided) job.scene.guide = guide_.view();
    if (has_ambient(job.settings)) job.scene.ambient = &picture->ambient;
    // The ambient light, or the interactive tier's cache, stands for the sky's light: none is
    // sampled.
    const bool has_cache = tier == RenderTier::kInteractive && !is_on_card(job);
    if (has_ambient(job.settings) || has_cache) job.scene.environment.row_cdf = {};
    if (picture->flickers && tier != RenderTier::kInteractive)
      job.scene.light_levels = picture->levels;
  }

  static std::future<RenderStats> ready(const RenderStats& stats) {
    std::promise<RenderStats> promise;
    promise.set_value(stats);
    return promise.get_future();
  }

  std::future<RenderStats> begin_interactive(const Job& job) {
    if (is_on_card(job)) return begin_interactive_on_card(job);
    InteractiveHistory own;
    auto* history = static_cast<InteractiveHistory*>(job.settings.history);
    const RenderStats stats = (history != nullptr ? *history : own).render(job);
    CpuStages cpu;
    if (job.settings.exact_channels) cpu.render_exact_channels(job);
    return ready(stats);
  }

  std::future<RenderStats> begin_interactive_on_card(const Job& job) {
    constexpr int kGuideSamples = 4;
    std::future<RenderStats> result = cuda_->begin(on_cuda(job, kGuideSamples), job.film);
    if (job.settings.finish.denoise) return result;
    return std::async(std::launch::deferred,
                      [result = std::move(result), film = job.film]() mutable {
                        const RenderStats stats = result.get();
                        std::vector<Vec3f> clean;
                        const Status status = make_edge_denoiser()->denoise(*film, &clean);
                        GLOAM_CHECK(status.ok(), "the edge filter takes any film");
                        film->radiance.swap(clean);
                        return stats;
                      });
  }

  // The path tier and the direct tier.
  std::future<RenderStats> begin_exact(Job& job) {
    const RenderSettings& settings = job.settings;
    const bool adaptive = settings.error > 0;
    job.centered = settings.tier == RenderTier::kDirect && settings.spp == 1 &&
                   settings.first_sample == 0 && !job.has_motion &&
                   !(job.camera.aperture.radius > 0);
    GLOAM_CHECK(
        !adaptive || (settings.tier == RenderTier::kPath && settings.first_sample == 0 &&
                      settings.spp >= kLeastAdaptiveSpp),
        "adaptive sampling requires the path tier, a first sample of 0 and at least 16 samples");
    const int64_t samples =
        adaptive ? settings.spp / 2 : int64_t{settings.first_sample} + settings.spp;
    while ((int64_t{1} << job.log2_samples) < samples) ++job.log2_samples;
    job.slices->pause();
    // Blurred pictures have blurred guides: those of the samples.
    const bool moves = !job.camera.pose.keys.empty() || scene().has_motion();
    const bool sharp =
        !(job.camera.aperture.radius > 0) && !(moves && job.camera.shutter.length > 0);
    const bool refines = settings.spp > 0 && settings.spp < settings.guide_samples && sharp;
    if (is_on_card(job))
      return cuda_->begin(on_cuda(job, refines ? settings.guide_samples : 0), job.film);
    CpuStages cpu;
    RenderStats total = cpu.render(job);
    if (total.finished && refines) {
      GLOAM_CHECK(settings.exact_channels && settings.exact_details,
                  "guide samples require the exact channels");
      total.rays += refine_guides({job.scene, job.tracer, job.camera, job.has_motion},
                                  settings.guide_samples, job.slices, job.film);
    }
    return ready(total);
  }

  bool is_on_card(const Job& job) const { return cuda_ != nullptr && !(job.settings.error > 0); }
  static bool has_ambient(const RenderSettings& settings) {
    return settings.tier == RenderTier::kDirect && settings.spp > 0;
  }
  /// Whether light is that of whole paths: on a card the interactive tier takes a few.
  bool traces_paths(const Job& job) const {
    return job.settings.tier == RenderTier::kPath ||
           (job.settings.tier == RenderTier::kInteractive && is_on_card(job));
  }
  CudaJob on_cuda(const Job& job, int guide_samples = 0) const {
    const ViewClip clip = job.tracer.clip != nullptr ? job.tracer.clip->view : ViewClip();
    return {scene(),
            traced_.own(),
            job.scene,
            job.camera,
            clip,
            job.settings,
            job.path,
            job.log2_samples,
            job.has_motion,
            job.centered,
            has_ambient(job.settings),
            guide_samples};
  }

  TracedScene traced_;
  std::unique_ptr<CudaStages> cuda_;  // null: all is rendered on the CPU
  std::vector<uint32_t> objects_;     ///< by instance
  DescribedLook described_;           ///< until the guide is built
  LightGuideStore guide_;
  double opens_ = 0, seconds_ = 0;  ///< of the keys: the first, and to the last [s]
  bool updated_ = false, has_guide_ = false;
  std::vector<const PoseFrame*> keys_;  ///< of the last update, as is the next
  const PoseFrame* previous_ = nullptr;
};

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
  if (description.pattern_baking.by_formula) {
    return Error{ErrorKind::kUnsupported,
                 "GPUs draw procedural materials baked, the CPU alone by their formulas"};
  }
  GLOAM_TRY(auto cuda, CudaStages::make());
  GLOAM_TRY(auto scene, RenderScene::make(description));
  GLOAM_TRY(auto embree, EmbreeScene::make());
  return std::unique_ptr<Renderer>(
      new StagedRenderer(std::move(scene), std::move(embree), std::move(cuda)));
}

}  // namespace gloam

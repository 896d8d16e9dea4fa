#include "render/cuda/cuda_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>

#include "render/cuda/cuda_history.h"
#include "render/cuda/device_film.h"
#include "render/cuda/device_scene.h"
#include "render/cuda/finisher.h"
#include "render/cuda/lidar/device_lidar.h"
#include "render/cuda/stream.h"
#include "render/cuda/wavefront.h"

namespace gloam {
namespace {

using cuda::check;

/// Samples of a pixel in one launch: progress is reported between launches. A fixed number, so that
/// pictures do not depend on whether somebody asks.
constexpr int kSamplesOfLaunch = 64;

/// A picture that is being made: what the host writes before, and reads after, the card's work.
struct Flight {
  cuda::PinnedBuffer scene;
  cuda::DeviceFilmStore film;
  cuda::Event start, uploaded, finished, downloaded;
};

/// The samples of one picture's pixels.
struct Sampling {
  int first = 0, count = 0;
};

class Card final : public CudaStages {
 public:
  explicit Card(std::string name) : name_(std::move(name)) {}
  ~Card() override { cudaStreamSynchronize(stream_.get()); }

  std::string device_name() const override { return name_; }
  std::unique_ptr<ViewHistory> make_history() const override {
    return std::make_unique<cuda::CudaHistory>();
  }
  bool finishes(const PictureFinish& finish) override { return finisher_.can(finish); }

  void update(const RenderScene& scene) override {
    if (!scene.rebuilt_meshes().empty()) scene_.forget();
  }

  void scan(const CudaJob& job, const LidarView& view, std::span<LidarReturn> returns) override {
    DevicePicture scene;
    scene_.upload(job, stream_.get(), &scan_scene_, &scene);
    lidar_.scan(scene.scene, scene.tracer, view, stream_.get(), returns);
  }

  std::future<RenderStats> begin(const CudaJob& job, Film* film) override {
    const RenderSettings& settings = job.settings;
    const bool interactive = settings.tier == RenderTier::kInteractive;
    cuda::CudaHistory own;
    auto* history = static_cast<cuda::CudaHistory*>(settings.history);
    if (history == nullptr) history = &own;
    DevicePicture picture = make_picture(job, film->width, film->height);
    Sampling sampling{settings.first_sample, settings.spp};
    if (interactive) {
      const auto s = history->begin(job.camera, film->width, film->height);
      sampling = {s.first, s.count};
      picture.frame = s.frame;
      picture.log2_samples = s.log2_samples;
    }
    std::unique_ptr<Flight> flight = take_flight();
    picture.film = flight->film.place(*film, needs_of(job));
    flight->start.record(stream_.get());
    scene_.upload(job, stream_.get(), &flight->scene, &picture);
    flight->uploaded.record(stream_.get());
    // The channels need no zeros: the launches write every pixel of each.
    check(cudaMemsetAsync(picture.film.rays, 0, sizeof *picture.film.rays, stream_.get()),
          "cannot set GPU memory");
    if (job.measures_ambient) measure_ambient(&picture);
    RenderStats stats;
    take_samples(job, sampling, &picture, &stats);
    describe(job, &picture);
    const PictureFinish& finish = settings.finish;
    // A history's noise goes along with what moves, from pixel to pixel, and so looks like texture
    // to a denoiser: that comes first.
    const Vec3f* const noisy = picture.film.radiance;
    if (finish.denoise) finisher_.denoise(film->width, film->height, &picture.film);
    if (interactive) history->add(picture.camera, noisy, &picture.film, stream_.get());
    if (finish.to_display) finisher_.show(finish.tone, film->width, film->height, &picture.film);
    flight->finished.record(stream_.get());
    flight->film.begin_download(picture.film, film, stream_.get());
    flight->downloaded.record(stream_.get());
    stats.paths = film->pixel_count() * static_cast<uint64_t>(std::max(sampling.count, 0));
    return std::async(std::launch::deferred,
                      [this, stats, film, flight = std::move(flight)]() mutable {
                        return land(std::move(flight), film, stats);
                      });
  }

 private:
  static bool is_plain(const CudaJob& job) {
    return job.view.is_plain() && job.camera.is_plain() && !job.has_motion;
  }

  static DevicePicture make_picture(const CudaJob& job, int width, int height) {
    DevicePicture picture;
    picture.path = job.path;
    picture.width = width;
    picture.height = height;
    picture.seed = job.settings.seed;
    picture.frame = job.settings.frame;
    picture.log2_samples = job.log2_samples;
    picture.has_motion = job.has_motion;
    picture.centered = job.centered;
    return picture;
  }

  static cuda::FilmNeeds needs_of(const CudaJob& job) {
    const RenderSettings& settings = job.settings;
    const bool described = job.guide_samples > 0 || settings.tier == RenderTier::kInteractive;
    return {.light = settings.spp > 0,
            .places = described,
            .details = described,
            .clear = settings.tier == RenderTier::kInteractive && job.view.has_media()};
  }

  void measure_ambient(DevicePicture* picture) {
    auto* paths = ambient_paths_.reserve_of<AmbientPath>(size_t{1} << kLog2AmbientPaths);
    auto* ambient = ambient_.reserve_of<AmbientCube>(1);
    cuda::launch_ambient(*picture, paths, ambient, stream_.get());
    check(cudaGetLastError(), "cannot launch a CUDA kernel");
    picture->scene.ambient = ambient;
  }

  void take_samples(const CudaJob& job, const Sampling& sampling, DevicePicture* picture,
                    RenderStats* stats) {
    const RenderSettings& settings = job.settings;
    const bool plain = is_plain(job), direct = settings.tier == RenderTier::kDirect;
    const auto begin = std::chrono::steady_clock::now();
    double told = 0;
    for (int done = 0; done < sampling.count && stats->finished; done += kSamplesOfLaunch) {
      picture->done = done;
      picture->first_sample = sampling.first + done;
      picture->samples = std::min(kSamplesOfLaunch, sampling.count - done);
      picture->split = picture->samples >= 4 ? 4 : (picture->samples >= 2 ? 2 : 1);
      picture->last = done + picture->samples == sampling.count;
      if (direct) {
        (plain ? cuda::launch_plain_direct : cuda::launch_full_direct)(*picture, stream_.get());
      } else if (plain) {
        cuda::launch_plain_path(*picture, stream_.get());
      } else {
        wavefront_.render(*picture, stream_.get());
      }
      check(cudaGetLastError(), "cannot launch a CUDA kernel");
      if (!settings.progress || picture->last) continue;
      wait();
      const double now =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (now < told + 0.1) continue;
      told = now;
      stats->finished =
          settings.progress(static_cast<double>(done + picture->samples) / sampling.count);
    }
  }

  /// The exact channels, and the denoiser's guides that are made with them.
  void describe(const CudaJob& job, DevicePicture* picture) {
    const bool plain = is_plain(job);
    const auto launch = plain ? cuda::launch_plain_channels : cuda::launch_full_channels;
    if (picture->film.part != nullptr) {
      const bool known = job.centered && job.settings.spp == 1;
      if (!known || job.view.has_transparent)
        launch(*picture, known ? ChannelRays::kUnknown : ChannelRays::kAll, stream_.get());
    }
    if (job.guide_samples > 0) {
      picture->samples = job.guide_samples;
      launch(*picture, ChannelRays::kGuides, stream_.get());
    }
    check(cudaGetLastError(), "cannot launch a CUDA kernel");
  }

  std::unique_ptr<Flight> take_flight() {
    const std::lock_guard lock(mutex_);
    if (flights_.empty()) return std::make_unique<Flight>();
    std::unique_ptr<Flight> flight = std::move(flights_.back());
    flights_.pop_back();
    return flight;
  }

  /// Waits for a picture, on the thread that asks for it.
  RenderStats land(std::unique_ptr<Flight> flight, Film* film, RenderStats stats) {
    flight->downloaded.wait();
    stats.rays = flight->film.end_download(film);
    stats.device_seconds = flight->finished.since(flight->uploaded);
    stats.upload_seconds = flight->uploaded.since(flight->start);
    const std::lock_guard lock(mutex_);
    flights_.push_back(std::move(flight));
    return stats;
  }

  void wait() { check(cudaStreamSynchronize(stream_.get()), "a CUDA kernel failed"); }

  std::string name_;
  cuda::OwnStream stream_;
  cuda::DeviceScene scene_;
  cuda::DeviceLidar lidar_;
  cuda::Wavefront wavefront_;
  cuda::PinnedBuffer scan_scene_;
  cuda::Finisher finisher_{stream_.get()};
  cuda::DeviceBuffer ambient_paths_, ambient_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Flight>> flights_;  ///< that wait for a picture; guarded by mutex_
};

}  // namespace

Result<std::unique_ptr<CudaStages>> CudaStages::make() {
  const auto none = [](std::string why) {
    return Error{ErrorKind::kUnsupported, std::move(why), {}, "use --device cpu, or auto"};
  };
  int driver = 0;
  if (cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0) {
    return none("no NVIDIA GPU for rendering: the driver is not installed");
  }
  int count = 0;
  if (const cudaError_t error = cudaGetDeviceCount(&count); error != cudaSuccess || count == 0) {
    return none(fmt::format("no NVIDIA GPU for rendering: {}",
                            error != cudaSuccess ? cudaGetErrorString(error) : "none was found"));
  }
  cudaDeviceProp properties;
  if (const cudaError_t error = cudaGetDeviceProperties(&properties, 0); error != cudaSuccess) {
    return none(fmt::format("the NVIDIA GPU does not respond: {}", cudaGetErrorString(error)));
  }
  if (properties.major < 9) {
    return none(fmt::format("{} has compute capability {}.{}, but this build requires 9.0",
                            properties.name, properties.major, properties.minor));
  }
  return std::unique_ptr<CudaStages>(new Card(properties.name));
}

}  // namespace gloam

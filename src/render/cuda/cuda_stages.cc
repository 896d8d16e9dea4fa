#include "render/cuda/cuda_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "base/parallel.h"
#include "render/cuda/device_scene.h"
#include "render/cuda/wavefront.h"

namespace gloam {
namespace {

using cuda::check;

/// Samples of a pixel in one launch: progress is reported between launches. A fixed number, so that
/// pictures do not depend on whether somebody asks.
constexpr int kSamplesOfLaunch = 64;

class Event {
 public:
  Event() { check(cudaEventCreate(&event_), "cannot create a CUDA event"); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event() { cudaEventDestroy(event_); }
  void record(cuda::Stream stream) {
    check(cudaEventRecord(event_, stream), "a CUDA event failed");
  }
  /// [s]; both have happened.
  double since(const Event& start) const {
    float ms = 0;
    check(cudaEventElapsedTime(&ms, start.event_, event_), "a CUDA event failed");
    return 1e-3 * ms;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

class Card final : public CudaStages {
 public:
  explicit Card(std::string name) : name_(std::move(name)) {
    check(cudaStreamCreate(&stream_), "cannot create a CUDA stream");
  }
  ~Card() override {
    cudaStreamSynchronize(stream_);
    cudaStreamDestroy(stream_);
  }

  std::string device_name() const override { return name_; }

  void update(const RenderScene& scene) override {
    if (!scene.rebuilt_meshes().empty()) scene_.forget();
  }

  std::vector<AmbientPath> trace_ambient(const CudaJob& job, int width, int height) override {
    DevicePicture picture = make_picture(job, width, height);
    scene_.upload(job, stream_, &picture);
    std::vector<AmbientPath> paths(size_t{1} << kLog2AmbientPaths);
    auto* device = ambient_.reserve_of<AmbientPath>(paths.size());
    cuda::launch_ambient(picture, device, stream_);
    check(cudaGetLastError(), "cannot launch a CUDA kernel");
    check(cudaMemcpyAsync(paths.data(), device, paths.size() * sizeof(AmbientPath),
                          cudaMemcpyDeviceToHost, stream_),
          "cannot copy the ambient light from the GPU");
    finish();
    return paths;
  }

  RenderStats render(const CudaJob& job, Film* film) override {
    const RenderSettings& settings = job.settings;
    DevicePicture picture = make_picture(job, film->width, film->height);
    const bool plain = job.view.is_plain() && job.camera.is_plain() && !job.has_motion;
    place_film(*film, &picture.film);
    start_.record(stream_);
    scene_.upload(job, stream_, &picture);
    uploaded_.record(stream_);
    // The channels need no zeros: the launches write every pixel of each.
    check(cudaMemsetAsync(picture.film.rays, 0, sizeof *picture.film.rays, stream_),
          "cannot set GPU memory");
    RenderStats stats;
    const auto begin = std::chrono::steady_clock::now();
    double told = 0;
    for (int done = 0; done < settings.spp && stats.finished; done += kSamplesOfLaunch) {
      picture.done = done;
      picture.first_sample = settings.first_sample + done;
      picture.samples = std::min(kSamplesOfLaunch, settings.spp - done);
      picture.split = picture.samples >= 4 ? 4 : (picture.samples >= 2 ? 2 : 1);
      picture.last = done + picture.samples == settings.spp;
      if (settings.tier == RenderTier::kPath) {
        if (plain) {
          cuda::launch_plain_path(picture, stream_);
        } else {
          wavefront_.render(picture, stream_);
        }
      } else {
        (plain ? cuda::launch_plain_direct : cuda::launch_full_direct)(picture, stream_);
      }
      check(cudaGetLastError(), "cannot launch a CUDA kernel");
      if (!settings.progress || picture.last) continue;
      finish();
      const double now =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (now < told + 0.1) continue;
      told = now;
      stats.finished =
          settings.progress(static_cast<double>(done + picture.samples) / settings.spp);
    }
    if (settings.exact_channels) {
      const bool centered = job.centered && settings.spp == 1;
      if (!centered || job.view.has_transparent) {
        (plain ? cuda::launch_plain_channels : cuda::launch_full_channels)(picture, centered,
                                                                           stream_);
        check(cudaGetLastError(), "cannot launch a CUDA kernel");
      }
    }
    finished_.record(stream_);
    download(film, picture, &stats);
    stats.paths = film->pixel_count() * static_cast<uint64_t>(std::max(settings.spp, 0));
    stats.device_seconds = finished_.since(uploaded_);
    stats.upload_seconds = uploaded_.since(start_);
    return stats;
  }

 private:
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

  /// Calls visit(channel of the film, pointer in DeviceFilm) for each.
  template <class Film_, class Visit>
  static void each_channel(Film_& film, DeviceFilm* device, const Visit& visit) {
    visit(film.radiance, &device->radiance);
    visit(film.variance, &device->squares);
    visit(film.albedo, &device->albedo);
    visit(film.normal, &device->normal);
    const auto exact = [&](auto& plane, auto& pointer) { visit(plane, &pointer); };
    visit_places(exact, film, *device);
    visit_details(exact, film, *device);
  }

  void place_film(const Film& film, DeviceFilm* device) {
    size_t bytes = sizeof(unsigned long long);
    each_channel(film, device, [&](const auto& channel, auto*) {
      bytes += (channel.size() * sizeof(channel[0]) + 255) / 256 * 256;
    });
    char* at = static_cast<char*>(film_.reserve(bytes));
    film_bytes_ = bytes;
    each_channel(film, device, [&](const auto& channel, auto* pointer) {
      if (channel.empty()) return;
      *pointer = reinterpret_cast<std::decay_t<decltype(*pointer)>>(at);
      at += (channel.size() * sizeof(channel[0]) + 255) / 256 * 256;
    });
    device->rays = reinterpret_cast<unsigned long long*>(at);
  }

  void download(Film* film, DevicePicture& picture, RenderStats* stats) {
    char* host = staging_.reserve(film_bytes_);
    check(cudaMemcpyAsync(host, film_.data(), film_bytes_, cudaMemcpyDeviceToHost, stream_),
          "cannot copy the image from the GPU");
    finish();
    const char* base = static_cast<const char*>(film_.data());
    each_channel(*film, &picture.film, [&](auto& channel, auto* pointer) {
      if (channel.empty()) return;
      const size_t at = static_cast<size_t>(reinterpret_cast<const char*>(*pointer) - base);
      char* const to = reinterpret_cast<char*>(channel.data());
      parallel_for_range("copy from the card", channel.size() * sizeof(channel[0]), 1 << 20,
                         [&](int64_t begin, int64_t end) {
                           std::memcpy(to + begin, host + at + begin,
                                       static_cast<size_t>(end - begin));
                         });
    });
    unsigned long long rays = 0;
    std::memcpy(&rays, host + film_bytes_ - sizeof rays, sizeof rays);
    stats->rays = rays;
  }

  void finish() { check(cudaStreamSynchronize(stream_), "a CUDA kernel failed"); }

  std::string name_;
  cuda::Stream stream_ = nullptr;
  cuda::DeviceScene scene_;
  cuda::Wavefront wavefront_;
  cuda::DeviceBuffer film_, ambient_;
  cuda::PinnedBuffer staging_;
  size_t film_bytes_ = 0;
  Event start_, uploaded_, finished_;
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

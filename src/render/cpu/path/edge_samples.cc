#include "render/cpu/path/edge_samples.h"

#include <algorithm>
#include <vector>

#include "render/kernel/camera/channels.h"
#include "render/kernel/math/sampler.h"
#include "render/kernel/media/medium_march.h"

namespace gloam {
namespace {

/// Whether the centres of two pixels differ so much that one ray each cannot tell what lies
/// between.
bool differs(const Film& film, size_t i, size_t j) {
  constexpr float kCosine = 0.9f, kAlbedo = 0.15f;
  const Vec3f d = film.center_albedo[i] - film.center_albedo[j];
  return film.part[i] != film.part[j] || dot(d, d) > kAlbedo * kAlbedo ||
         (film.part[i] != 0 && dot(film.center_normal[i], film.center_normal[j]) < kCosine);
}

bool is_edge(const Film& film, int x, int y) {
  const size_t width = static_cast<size_t>(film.width), i = static_cast<size_t>(y) * width + x;
  for (int v = std::max(0, y - 1); v <= std::min(film.height - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(film.width - 1, x + 1); ++u) {
      if (differs(film, i, static_cast<size_t>(v) * width + u)) return true;
    }
  }
  return false;
}

/// The edges of one row of the picture.
class Row {
 public:
  Row(const EdgeSamples& job, int count, int y, Film* film)
      : job_(job), count_(count), y_(y), film_(film) {}

  uint64_t run() {
    for (int x = 0; x < film_->width; ++x) {
      const size_t i = pixel(x);
      const bool edge = is_edge(*film_, x, y_);
      film_->albedo[i] = edge ? Vec3f{} : film_->center_albedo[i];
      film_->normal[i] = edge ? Vec3f{} : film_->center_normal[i];
      for (int k = 0; edge && k < count_; ++k) add(x, k);
    }
    flush();
    for (int x = 0; job_.scene.has_media() && x < film_->width; ++x) veil(x);
    return rays_;
  }

 private:
  size_t pixel(int x) const { return static_cast<size_t>(y_) * film_->width + x; }

  void add(int x, int k) {
    // One pattern for every pixel and picture: what stands still must not flicker.
    Sampler sampler = Sampler::make(0, 0, 0, 0, static_cast<uint32_t>(k), 0);
    const Vec2f offset = sample_pixel_filter(sampler.next_2d());
    const float u = job_.has_motion ? sampler.next_1d() : 0.0f;
    const float time = job_.has_motion ? job_.camera.time_of(y_, u) : 0.0f;
    x_[used_] = x;
    samples_[used_] = camera_ray(job_.camera, static_cast<float>(x) + 0.5f + offset.x,
                                 static_cast<float>(y_) + 0.5f + offset.y, time, &cones_[used_]);
    if (++used_ == kPacket) flush();
  }

  /// Media before the surface: what scatters first counts, each by the light that it takes.
  void veil(int x) {
    constexpr int kSteps = 64;
    RayCone cone;
    const Ray ray = camera_ray(job_.camera, static_cast<float>(x) + 0.5f,
                               static_cast<float>(y_) + 0.5f, 0.0f, &cone);
    const size_t i = pixel(x);
    const MarchResult m =
        march(job_.scene.media, ray, min(film_->distance[i], 1e30f), 0.0f, kSteps, {}, true,
              [](const MarchStep& step) { return step.medium.scattering; });
    const Vec3f albedo = film_->albedo[i] * m.transmittance + m.radiance;
    // Emission is brighter than any albedo.
    film_->albedo[i] = {min(albedo.x, 1.0f), min(albedo.y, 1.0f), min(albedo.z, 1.0f)};
    film_->normal[i] *= luminance(m.transmittance);
  }

  void flush() {
    const Ray* rays[kPacket];
    RayHit hits[kPacket];
    bool found[kPacket];
    for (int j = 0; j < used_; ++j) rays[j] = &samples_[j];
    if (used_ > 0) job_.tracer.trace_packet(rays, used_, false, true, hits, found);
    rays_ += static_cast<uint64_t>(used_);
    for (int j = 0; j < used_; ++j) {
      if (!found[j]) continue;  // the sky's guides are zero
      Surface s = make_surface(job_.scene, samples_[j], hits[j], cones_[j]);
      uint32_t more = 0;
      const bool visible = shows(job_.scene, s) || find_first(job_.scene, job_.tracer, samples_[j],
                                                              cones_[j], &s, &hits[j], &more);
      rays_ += more;
      if (!visible) continue;
      film_->albedo[pixel(x_[j])] += s.base_color / static_cast<float>(count_);
      film_->normal[pixel(x_[j])] += s.normal / static_cast<float>(count_);
    }
    used_ = 0;
  }

  static constexpr int kPacket = CpuTracer::kPacket;

  const EdgeSamples& job_;
  const int count_, y_;
  Film* film_;
  Ray samples_[kPacket];
  RayCone cones_[kPacket];
  int x_[kPacket], used_ = 0;
  uint64_t rays_ = 0;
};

}  // namespace

uint64_t refine_guides(const EdgeSamples& job, int count, RenderSlices* slices, Film* film) {
  std::vector<uint64_t> rays(static_cast<size_t>(film->height));
  slices->run("edge samples", film->height, [&](int64_t y) {
    rays[static_cast<size_t>(y)] = Row(job, count, static_cast<int>(y), film).run();
  });
  uint64_t total = 0;
  for (const uint64_t n : rays) total += n;
  return total;
}

}  // namespace gloam

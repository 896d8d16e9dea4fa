#include "render/cpu/path/edge_samples.h"

#include <vector>

#include "render/kernel/camera/guides.h"

namespace gloam {
namespace {

/// The edges of one row of the picture.
class Row {
 public:
  Row(const EdgeSamples& job, int count, int y, Film* film)
      : job_(job), count_(count), y_(y), film_(film) {}

  uint64_t run() {
    for (int x = 0; x < film_->width; ++x) {
      const size_t i = pixel(x);
      const bool edge = guides::is_edge(*film_, film_->width, film_->height, x, y_);
      film_->albedo[i] = edge ? Vec3f{} : film_->center_albedo[i];
      film_->normal[i] = edge ? Vec3f{} : film_->center_normal[i];
      for (int k = 0; edge && k < count_; ++k) add(x, k);
    }
    flush();
    for (int x = 0; job_.scene.has_media() && x < film_->width; ++x) {
      const size_t i = pixel(x);
      guides::veil(job_.scene.media, job_.camera, x, y_, film_->distance[i], &film_->albedo[i],
                   &film_->normal[i]);
    }
    return rays_;
  }

 private:
  size_t pixel(int x) const { return static_cast<size_t>(y_) * film_->width + x; }

  void add(int x, int k) {
    x_[used_] = x;
    samples_[used_] = guides::edge_ray(job_.camera, x, y_, k, job_.has_motion, &cones_[used_]);
    if (++used_ == kPacket) flush();
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

#include "render/cpu/fast_edges.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/kernel/sampler.h"
#include "render/kernel/surface.h"

namespace gloam {
namespace {

constexpr int kRays = 8;  // through an edge pixel

class EdgeRow {
 public:
  EdgeRow(const SceneView& scene, const EmbreeTracer& tracer, const CameraView32& camera,
          const FastFrame& frame, const std::vector<Vec3f>& colors, int y, Film* film)
      : scene_(scene),
        tracer_(tracer),
        camera_(camera),
        frame_(frame),
        colors_(colors),
        y_(y),
        film_(film) {}

  uint64_t run() {
    for (int x = 0; x < frame_.width; ++x) {
      if (!is_edge(x)) continue;
      film_->radiance[pixel(x, y_)] = {};
      for (int k = 0; k < kRays; ++k) add(x, k);
    }
    flush();
    return rays_;
  }

 private:
  static constexpr int kPacket = EmbreeTracer::kPacket;

  size_t pixel(int x, int y) const { return static_cast<size_t>(y) * frame_.width + x; }

  bool is_edge(int x) const {
    const float part = *frame_.part.at(x, y_);
    const Vec3f n = frame_.n.get(x, y_);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const float other = *frame_.part.at(x + dx, y_ + dy);
        if (other < 0) continue;  // beyond the picture
        if (other != part || (part > 0 && dot(n, frame_.n.get(x + dx, y_ + dy)) < 0.9f)) {
          return true;
        }
      }
    }
    return false;
  }

  void add(int x, int k) {
    // One pattern for every pixel and picture: what stands still must not flicker.
    Sampler sampler = Sampler::make(0, 0, 0, 0, static_cast<uint32_t>(k), 3);
    offset_[used_] = sample_pixel_filter(sampler.next_2d());
    x_[used_] = x;
    RayCone cone;
    samples_[used_] = camera_ray(camera_, static_cast<float>(x) + 0.5f + offset_[used_].x,
                                 static_cast<float>(y_) + 0.5f + offset_[used_].y, 0, &cone);
    if (++used_ == kPacket) flush();
  }

  void flush() {
    const Ray* rays[kPacket];
    RayHit hits[kPacket];
    bool found[kPacket];
    for (int j = 0; j < used_; ++j) rays[j] = &samples_[j];
    if (used_ > 0) tracer_.trace_packet(rays, used_, false, true, hits, found);
    rays_ += static_cast<uint64_t>(used_);
    for (int j = 0; j < used_; ++j) {
      if (!sees(samples_[j])) continue;
      film_->radiance[pixel(x_[j], y_)] +=
          color_of(j, found[j], hits[j]) / static_cast<float>(kRays);
    }
    used_ = 0;
  }

  Vec3f color_of(int j, bool found, const RayHit& hit) const {
    const float part = found ? static_cast<float>(hit.instance + 1) : 0.0f;
    const Vec3f p = samples_[j].o + samples_[j].d * hit.t;
    const float u = static_cast<float>(x_[j]) + offset_[j].x;
    const float v = static_cast<float>(y_) + offset_[j].y;
    float least = 1e30f;
    size_t best = pixel(x_[j], y_);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = x_[j] + dx, y = y_ + dy;
        if (*frame_.part.at(x, y) != part) continue;
        const float across = sqr(static_cast<float>(x) - u) + sqr(static_cast<float>(y) - v);
        // Of one thing's faces, the one that the ray has met.
        const float off = part > 0 ? fabsf(dot(frame_.n.get(x, y), p - frame_.p.get(x, y))) : 0.0f;
        const float cost = across + 1e3f * off / max(hit.t, 1e-3f);
        if (cost >= least) continue;
        least = cost;
        best = pixel(x, y);
      }
    }
    if (least < 1e30f || !found) return colors_[best];
    const MaterialView& m = scene_.materials[scene_.instances[hit.instance].material];
    return max_component(m.emission) > 0 ? m.emission * m.opacity : colors_[best];
  }

  const SceneView& scene_;
  const EmbreeTracer& tracer_;
  const CameraView32& camera_;
  const FastFrame& frame_;
  const std::vector<Vec3f>& colors_;
  const int y_;
  Film* film_;
  Ray samples_[kPacket];
  Vec2f offset_[kPacket];
  int x_[kPacket], used_ = 0;
  uint64_t rays_ = 0;
};

}  // namespace

uint64_t smooth_edges(const SceneView& scene, const EmbreeTracer& tracer,
                      const CameraView32& camera, const FastFrame& frame, Film* film) {
  const std::vector<Vec3f> colors = film->radiance;
  std::vector<uint64_t> rays(static_cast<size_t>(film->height));
  parallel_for("fast edges", film->height, [&](int64_t y) {
    rays[static_cast<size_t>(y)] =
        EdgeRow(scene, tracer, camera, frame, colors, static_cast<int>(y), film).run();
  });
  uint64_t total = 0;
  for (const uint64_t n : rays) total += n;
  return total;
}

}  // namespace gloam

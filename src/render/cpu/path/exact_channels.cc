#include "render/cpu/path/exact_channels.h"

namespace gloam {
namespace {

using F = FloatLanes;

/// Lanes of a tile's pixels, as tile_pixel() orders them from `first` on.
class ChannelLanes {
 public:
  ChannelLanes(const Job& job, int x0, int y0, int first)
      : job_(job), film_(*job.film), first_(first) {
    for (int i = 0; i < kLaneCount; ++i) {
      tile_pixel(first + i, &x_[i], &y_[i]);
      x_[i] += x0;
      y_[i] += y0;
      set_lane(&inside_, i, x_[i] < film_.width && y_[i] < film_.height);
    }
  }

  uint64_t run(const CenterHits* centers) {
    if (!any(inside_)) return 0;
    F u, v, time = 0.0f;
    for (int i = 0; i < kLaneCount; ++i) {
      set_lane(&u, i, static_cast<float>(x_[i]) + 0.5f);
      set_lane(&v, i, static_cast<float>(y_[i]) + 0.5f);
      if (job_.has_motion) set_lane(&time, i, job_.camera.time_of(y_[i], 0));
    }
    RayConeOf<F> cone;
    const RayOf<F> ray = camera_rays(job_.camera, u, v, time, &cone);
    RayHitOf<F> hit;
    const MaskLanes found = trace(ray, centers, &hit);
    // Material of the surface is needed only where surfaces may be transparent or details are asked
    // for.
    const bool details = !film_.center_normal.empty();
    SurfaceOf<F> s;
    if (details || job_.scene.has_transparent) {
      s = make_surface(job_.scene, ray, hit, cone, found);
    } else {
      surfaces::place_surface(job_.scene, ray, hit, found, &s);
    }
    const auto c = describe_surface(job_.scene, job_.camera, ray, s, hit, found, details);
    each_lane(inside_, [&](int i) { store(i, lane(c, i), details); });
    const MaskLanes hidden = color_only_lanes<F>(job_.scene, hit.instance, found);
    each_lane(found & ((s.opacity < 0.5f) | hidden), [&](int i) {
      if (shows(job_.scene, lane(s, i))) return;
      store(i, look_through(lane(ray, i), lane(cone, i)), details);
    });
    return rays_;
  }

 private:
  MaskLanes trace(const RayOf<F>& ray, const CenterHits* centers, RayHitOf<F>* hit) {
    MaskLanes open = inside_, found = false;
    for (int i = 0; centers != nullptr && i < kLaneCount; ++i) {
      if (centers->known[first_ + i]) set_lane(&open, i, false);
    }
    if (any(open)) found = job_.tracer.closest(ray, open, true, hit);
    each_lane(open, [&](int) { ++rays_; });
    if (centers == nullptr) return found;
    each_lane(inside_ & !open, [&](int i) {
      set_lane(&found, i, centers->found[first_ + i]);
      set_lane(hit, i, centers->hits[first_ + i]);
    });
    return found;
  }

  /// First surface that a ray meets beyond surfaces that do not show.
  ExactChannels look_through(const Ray& ray, RayCone cone) {
    Surface s;
    RayHit hit;
    uint32_t rays = 0;
    const bool found = find_first(job_.scene, job_.tracer, ray, cone, &s, &hit, &rays);
    rays_ += rays;
    return found ? describe_surface(job_.scene, job_.camera, ray, s, hit)
                 : describe_sky(job_.camera, ray);
  }

  void store(int i, const ExactChannels& c, bool details) {
    const size_t pixel = static_cast<size_t>(y_[i]) * film_.width + x_[i];
    const auto put = [&](auto& plane, const auto& value) { plane[pixel] = value; };
    visit_places(put, film_, c);
    if (details) visit_details(put, film_, c);
  }

  const Job& job_;
  Film& film_;
  const int first_;
  int x_[kLaneCount], y_[kLaneCount];
  MaskLanes inside_ = false;
  uint64_t rays_ = 0;
};

}  // namespace

uint64_t render_channels(const Job& job, int x0, int y0, const CenterHits* centers) {
  uint64_t rays = 0;
  for (int first = 0; first < kTile * kTile; first += kLaneCount) {
    rays += ChannelLanes(job, x0, y0, first).run(centers);
  }
  return rays;
}

}  // namespace gloam

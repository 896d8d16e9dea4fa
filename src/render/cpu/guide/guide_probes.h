#pragma once
// Rays that measure the transmission through static geometry.

#include "render/cpu/tracer/embree_scene.h"
#include "render/kernel/surface/surface.h"

namespace gloam {

/// Traces rays a packet at a time. What is clear, or may be somewhere, is passed.
class Probes {
 public:
  Probes(const SceneView& scene, const CpuTracer& tracer) : scene_(scene), tracer_(tracer) {}

  /// Calls seen(i, ray) for each ray of make(i, &ray), i in [0, n), that nothing blocks; rays for
  /// which make returns false are left out.
  template <class Make, class Seen>
  void trace(int n, const Make& make, const Seen& seen) const {
    in_packets(n, true, make, [&](int i, Ray ray, bool found, RayHit hit) {
      if (!found || (scene_.has_transparent && !find_solid(&ray, &hit))) seen(i, ray);
    });
  }

  /// Calls met(i, ray, found, hit) for each of the rays with the first that blocks it; `ray` is
  /// what is left of it there.
  template <class Make, class Met>
  void find(int n, const Make& make, const Met& met) const {
    in_packets(n, false, make, [&](int i, Ray ray, bool found, RayHit hit) {
      if (found && is_clear(hit)) found = find_solid(&ray, &hit);
      met(i, ray, found, hit);
    });
  }

 private:
  template <class Make, class Done>
  void in_packets(int n, bool any, const Make& make, const Done& done) const {
    constexpr int kPacket = CpuTracer::kPacket;
    Ray rays[kPacket];
    const Ray* pointers[kPacket];
    RayHit hits[kPacket];
    bool found[kPacket];
    int which[kPacket], used = 0;
    const auto flush = [&] {
      if (used > 0) tracer_.trace_packet(pointers, used, any, false, hits, found);
      for (int j = 0; j < used; ++j) done(which[j], rays[j], found[j], hits[j]);
      used = 0;
    };
    for (int i = 0; i < n; ++i) {
      rays[used] = {};
      if (!make(i, &rays[used])) continue;
      pointers[used] = &rays[used];
      which[used++] = i;
      if (used == kPacket) flush();
    }
    flush();
  }

  bool is_clear(const RayHit& hit) const {
    return scene_.materials[scene_.instances[hit.instance].material].transparent;
  }

  /// The first on the ray's way that is not clear. After kMaxPassedSurfaces that are, whatever
  /// comes is passed.
  bool find_solid(Ray* ray, RayHit* hit) const {
    constexpr int kMaxPassedSurfaces = 8;
    for (int i = 0; i < kMaxPassedSurfaces; ++i) {
      if (!tracer_.trace(*ray, false, hit)) return false;
      if (!is_clear(*hit)) return true;
      const float step = hit->t + surface_step(ray->o, hit->t);
      ray->o = ray->o + ray->d * step;
      ray->tmax -= step;
      if (ray->tmax <= 0) return false;
    }
    return false;
  }

  const SceneView& scene_;
  const CpuTracer& tracer_;
};

}  // namespace gloam

// Embree or our own BVH, ray by ray or in lanes.

#include "render/cpu/cpu_tracer.h"

namespace gloam {

bool CpuTracer::trace(const Ray& ray, bool any, RayHit* hit) const {
  return own ? own->trace(ray, any, hit) : by_embree(ray, any, hit);
}

bool CpuTracer::closest(const Ray& ray, bool active, bool, RayHit* hit) const {
  return active && trace(ray, false, hit);
}
bool CpuTracer::occluded(const Ray& ray, bool active) const {
  RayHit hit;
  return active && trace(ray, true, &hit);
}

MaskLanes CpuTracer::closest(const RayOf<FloatLanes>& ray, MaskLanes active, bool coherent,
                             RayHitOf<FloatLanes>* hit) const {
  if (!own) return closest_by_embree(ray, active, coherent, hit);
  *hit = {};
  MaskLanes met = false;
  each_lane(active, [&](int i) {
    RayHit one;
    if (!own->trace(lane(ray, i), false, &one)) return;
    set_lane(&met, i, true);
    set_lane(hit, i, one);
  });
  return met;
}

MaskLanes CpuTracer::occluded(const RayOf<FloatLanes>& ray, MaskLanes active) const {
  if (!own) return occluded_by_embree(ray, active);
  MaskLanes met = false;
  each_lane(active, [&](int i) {
    RayHit none;
    set_lane(&met, i, own->trace(lane(ray, i), true, &none));
  });
  return met;
}

void CpuTracer::trace_packet(const Ray* const* rays, int count, bool any, bool coherent,
                             RayHit* hits, bool* found) const {
  RayOf<FloatLanes> ray;
  MaskLanes active = false;
  for (int i = 0; i < kPacket; ++i) {
    const Ray& one = *rays[i < count ? i : 0];
    set_lane(&active, i, i < count);
    set_lane(&ray.o, i, one.o);
    set_lane(&ray.d, i, one.d);
    set_lane(&ray.tmax, i, one.tmax);
    set_lane(&ray.time, i, one.time);
  }
  RayHitOf<FloatLanes> hit;
  const MaskLanes met = any ? occluded(ray, active) : closest(ray, active, coherent, &hit);
  for (int i = 0; i < count; ++i) {
    found[i] = lane(met, i);
    if (found[i] && !any) hits[i] = lane(hit, i);
  }
}

}  // namespace gloam

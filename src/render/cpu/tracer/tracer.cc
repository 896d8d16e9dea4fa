// Embree or our own BVH, ray by ray or in lanes.

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/cpu/tracer/picture_clip.h"

namespace gloam {

CpuTracer CpuTracer::fixed_part() const {
  CpuTracer part = *this;
  part.moving = {};
  part.clip = nullptr;
  return part;
}
CpuTracer CpuTracer::moving_part() const {
  CpuTracer part = *this;
  part.fixed = {};
  part.scanned.solids = {};
  part.scanned.groups = {};
  part.clip = nullptr;
  return part;
}

bool CpuTracer::trace(const Ray& ray, bool any, RayHit* hit) const {
  return own ? own->trace(ray, any, hit) : by_embree(ray, any, hit);
}

bool CpuTracer::closest(const Ray& ray, bool active, bool, RayHit* hit) const {
  if (!active) return false;
  if (clip == nullptr) return trace(ray, false, hit);
  RayOf<FloatLanes> rays;
  MaskLanes first = false;
  set_lane(&rays.o, 0, ray.o);
  set_lane(&rays.d, 0, ray.d);
  set_lane(&rays.tmax, 0, ray.tmax);
  set_lane(&rays.time, 0, ray.time);
  set_lane(&first, 0, true);
  RayHitOf<FloatLanes> hits;
  if (!any(closest(rays, first, false, &hits))) return false;
  *hit = lane(hits, 0);
  return true;
}
bool CpuTracer::occluded(const Ray& ray, bool active) const {
  RayHit hit;
  return active && trace(ray, true, &hit);
}

MaskLanes CpuTracer::closest(const RayOf<FloatLanes>& ray, MaskLanes active, bool coherent,
                             RayHitOf<FloatLanes>* hit) const {
  if (clip != nullptr) {
    const MaskLanes first = clip->from_camera(ray, active);
    if (any(first)) return closest_in_view(ray, active, first, coherent, hit);
  }
  return closest_of_all(ray, active, coherent, hit);
}

/// `first`: the rays that come from the camera.
MaskLanes CpuTracer::closest_in_view(const RayOf<FloatLanes>& ray, MaskLanes active,
                                     MaskLanes first, bool coherent,
                                     RayHitOf<FloatLanes>* hit) const {
  RayOf<FloatLanes> rest = ray;
  FloatLanes begun = 0.0f;  // [m] from the camera
  const auto move_on = [&](int i, float way) {
    set_lane(&begun, i, lane(begun, i) + way);
    set_lane(&rest.o, i, lane(rest.o, i) + lane(ray.d, i) * way);
    set_lane(&rest.tmax, i, lane(rest.tmax, i) - way);
  };
  each_lane(first, [&](int i) { move_on(i, clip->view.start(clip->camera, lane(ray, i))); });
  MaskLanes open = active & (rest.tmax > 0.0f), found = false;
  *hit = {};
  for (int n = 0; n < ViewClip::kMostPassed && any(open); ++n) {
    RayHitOf<FloatLanes> one;
    const MaskLanes met = closest_of_all(rest, open, coherent && n == 0, &one);
    const MaskLanes passed = clip->view.passes<FloatLanes>(clip->scene, rest, one, met & first);
    each_lane(met & !passed, [&](int i) {
      set_lane(hit, i, lane(one, i));
      set_lane(&hit->t, i, lane(one.t, i) + lane(begun, i));
      set_lane(&found, i, true);
    });
    each_lane(passed,
              [&](int i) { move_on(i, ViewClip::step_past(lane(rest.o, i), lane(one.t, i))); });
    open = passed & (rest.tmax > 0.0f);
  }
  return found;
}

MaskLanes CpuTracer::closest_of_all(const RayOf<FloatLanes>& ray, MaskLanes active, bool coherent,
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

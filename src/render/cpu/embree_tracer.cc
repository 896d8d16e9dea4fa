#include "render/cpu/embree_tracer.h"

#include <cstring>

namespace gloam {
namespace {

/// Embree may stop the program at what is no ray, as hostile scenes can make: it hits nothing.
template <class F>
MaskOf<F> is_ray(const RayOf<F>& ray) {
  const F far = magnitude(ray.o.x) + magnitude(ray.o.y) + magnitude(ray.o.z);
  const F d2 = dot(ray.d, ray.d);
  return (far < 1e18f) & (d2 > 0.25f) & (d2 < 4.0f) & (ray.tmax >= 0.0f);
}

/// Row + 1 of the nearest infinite plane before *tmax, which moves there; 0 = none.
template <class F>
UintOf<F> hit_planes(const EmbreeTracer& tracer, const RayOf<F>& ray, F* tmax) {
  UintOf<F> plane = 0u;
  for (uint32_t i = 0; i < tracer.planes.size; ++i) {
    const uint32_t row = tracer.planes[i];
    const InstanceView& instance = tracer.instances[row];
    Vec3Of<F> X[4];
    const Affine3f &a = instance.X_WG, &b = instance.X_WG_close;
    const Vec3f open[4] = {a.x, a.y, a.z, a.p}, close[4] = {b.x, b.y, b.z, b.p};
    for (int k = 0; k < 4; ++k) {
      X[k] = in_all_lanes<F>(open[k]);
      if (instance.moving) X[k] = lerp(X[k], in_all_lanes<F>(close[k]), ray.time);
    }
    const Vec3Of<F> o = ray.o - X[3];
    const F slope = dot(ray.d, X[2]), t = -dot(o, X[2]) / slope;
    MaskOf<F> hit = (slope < 0.0f) & (t > 0.0f) & (t < *tmax);
    for (int k = 0; k < 2; ++k) {
      if (!(instance.size[k] > 0)) continue;
      hit = hit & (magnitude(dot(o, X[k]) + t * dot(ray.d, X[k])) <= instance.size[k]);
    }
    *tmax = select(hit, t, *tmax);
    plane = select(hit, UintOf<F>(row + 1), plane);
  }
  return plane;
}

template <class Native>
void store(const Native& lanes, void* to) {
  std::memcpy(to, &lanes, sizeof(Native));
}
template <class T>
T load(const void* from) {
  T lanes;
  std::memcpy(&lanes.v, from, sizeof lanes.v);
  return lanes;
}

void fill(const RayOf<FloatLanes>& ray, const FloatLanes& tmax, RTCRay8* q) {
  store(ray.o.x.v, q->org_x);
  store(ray.o.y.v, q->org_y);
  store(ray.o.z.v, q->org_z);
  store(FloatLanes(0.0f).v, q->tnear);
  store(ray.d.x.v, q->dir_x);
  store(ray.d.y.v, q->dir_y);
  store(ray.d.z.v, q->dir_z);
  store(ray.time.v, q->time);
  store(tmax.v, q->tfar);
  store(UintLanes(~0u).v, q->mask);
  store(UintLanes(0u).v, q->id);
  store(UintLanes(0u).v, q->flags);
}

}  // namespace

void EmbreeTracer::resolve(uint32_t instance_id, uint32_t geometry_id, float time,
                           RayHit* hit) const {
  if (instance_id == RTC_INVALID_GEOMETRY_ID) {
    hit->instance = rows[geometry_id];
  } else {
    hit->instance = rows[instance_id];
    Affine3f between;
    hit->normal = transform_vector(pose_at(instances[hit->instance], time, &between),
                                   hit->normal);  // Embree's is in the instance's frame
  }
}

bool EmbreeTracer::trace(const Ray& ray, bool any, RayHit* hit) const {
  if (!is_ray(ray)) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  float tmax = ray.tmax;
  const uint32_t plane = hit_planes(*this, ray, &tmax);
  if (any && plane != 0) return true;
  RTCRayHit query;
  query.ray = {ray.o.x, ray.o.y,  ray.o.z, 0.0f, ray.d.x, ray.d.y,
               ray.d.z, ray.time, tmax,    ~0u,  0,       0};
  if (any) {
    if (fixed != nullptr) rtcOccluded1(fixed, &context, &query.ray);
    if (moving != nullptr && query.ray.tfar >= 0) rtcOccluded1(moving, &context, &query.ray);
    return query.ray.tfar < 0;
  }
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (fixed != nullptr) rtcIntersect1(fixed, &context, &query);
  if (moving != nullptr) rtcIntersect1(moving, &context, &query);
  const RTCHit& h = query.hit;
  const bool found = h.geomID != RTC_INVALID_GEOMETRY_ID;
  if (found) {
    *hit = {query.ray.tfar, 0, h.primID, h.u, h.v, {h.Ng_x, h.Ng_y, h.Ng_z}};
    resolve(h.instID[0], h.geomID, ray.time, hit);
  } else if (plane != 0) {
    *hit = {.t = tmax, .instance = plane - 1};
  }
  return found || plane != 0;
}

bool EmbreeTracer::closest(const Ray& ray, bool active, bool, RayHit* hit) const {
  return active && trace(ray, false, hit);
}
bool EmbreeTracer::occluded(const Ray& ray, bool active) const {
  RayHit hit;
  return active && trace(ray, true, &hit);
}

MaskLanes EmbreeTracer::closest(const RayOf<FloatLanes>& ray, MaskLanes active, bool coherent,
                                RayHitOf<FloatLanes>* hit) const {
  active = active & is_ray(ray);
  FloatLanes tmax = ray.tmax;
  const UintLanes plane = hit_planes(*this, ray, &tmax);
  alignas(32) RTCRayHit8 q;
  fill(ray, tmax, &q.ray);
  store(UintLanes(RTC_INVALID_GEOMETRY_ID).v, q.hit.geomID);
  store(UintLanes(RTC_INVALID_GEOMETRY_ID).v, q.hit.instID[0]);
  alignas(32) int32_t valid[kLaneCount];
  store(active.v, valid);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  if (fixed != nullptr) rtcIntersect8(valid, fixed, &context, &q);
  if (moving != nullptr) rtcIntersect8(valid, moving, &context, &q);
  const MaskLanes found = active & (load<UintLanes>(q.hit.geomID) != RTC_INVALID_GEOMETRY_ID);
  hit->t = load<FloatLanes>(q.ray.tfar);
  hit->primitive = load<UintLanes>(q.hit.primID);
  hit->u = load<FloatLanes>(q.hit.u);
  hit->v = load<FloatLanes>(q.hit.v);
  hit->normal = {load<FloatLanes>(q.hit.Ng_x), load<FloatLanes>(q.hit.Ng_y),
                 load<FloatLanes>(q.hit.Ng_z)};
  hit->instance = plane + UintLanes(~0u);  // row, where a plane is the nearest
  for (uint32_t left = bits_of(found); left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    RayHit one;
    one.normal = lane(hit->normal, i);
    resolve(q.hit.instID[0][i], q.hit.geomID[i], lane(ray.time, i), &one);
    set_lane(&hit->instance, i, one.instance);
    set_lane(&hit->normal, i, one.normal);
  }
  return found | (active & (plane != 0u));
}

MaskLanes EmbreeTracer::occluded(const RayOf<FloatLanes>& ray, MaskLanes active) const {
  active = active & is_ray(ray);
  FloatLanes tmax = ray.tmax;
  MaskLanes blocked = active & (hit_planes(*this, ray, &tmax) != 0u);
  alignas(32) RTCRay8 q;
  fill(ray, tmax, &q);
  alignas(32) int32_t valid[kLaneCount];
  store((active & !blocked).v, valid);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (fixed != nullptr) rtcOccluded8(valid, fixed, &context, &q);
  blocked = blocked | (active & (load<FloatLanes>(q.tfar) < 0.0f));
  const MaskLanes open = active & !blocked;
  if (moving == nullptr || !any(open)) return blocked;
  store(open.v, valid);
  rtcOccluded8(valid, moving, &context, &q);
  return blocked | (open & (load<FloatLanes>(q.tfar) < 0.0f));
}

void EmbreeTracer::trace_packet(const Ray* const* rays, int count, bool any, bool coherent,
                                RayHit* hits, bool* found) const {
  alignas(64) int valid[kPacket];
  alignas(64) RTCRayHit16 q;
  uint32_t plane[kPacket];  // row + 1
  for (int i = 0; i < kPacket; ++i) {
    const Ray& ray = *rays[i < count ? i : 0];
    float tmax = ray.tmax;
    plane[i] = i < count ? hit_planes(*this, ray, &tmax) : 0;
    valid[i] = i < count && is_ray(ray) && !(any && plane[i] != 0) ? -1 : 0;
    q.ray.org_x[i] = ray.o.x;
    q.ray.org_y[i] = ray.o.y;
    q.ray.org_z[i] = ray.o.z;
    q.ray.tnear[i] = 0;
    q.ray.dir_x[i] = ray.d.x;
    q.ray.dir_y[i] = ray.d.y;
    q.ray.dir_z[i] = ray.d.z;
    q.ray.time[i] = ray.time;
    q.ray.tfar[i] = tmax;
    q.ray.mask[i] = ~0u;
    q.ray.id[i] = q.ray.flags[i] = 0;
    q.hit.geomID[i] = q.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  if (any) {
    if (fixed != nullptr) rtcOccluded16(valid, fixed, &context, &q.ray);
    for (int i = 0; i < count; ++i) {
      found[i] = plane[i] != 0 || q.ray.tfar[i] < 0;
      if (found[i]) valid[i] = 0;
    }
    if (moving == nullptr) return;
    rtcOccluded16(valid, moving, &context, &q.ray);
    for (int i = 0; i < count; ++i) found[i] = found[i] || q.ray.tfar[i] < 0;
    return;
  }
  if (fixed != nullptr) rtcIntersect16(valid, fixed, &context, &q);
  if (moving != nullptr) rtcIntersect16(valid, moving, &context, &q);
  for (int i = 0; i < count; ++i) {
    if (q.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
      hits[i] = {q.ray.tfar[i], 0,          q.hit.primID[i],
                 q.hit.u[i],    q.hit.v[i], {q.hit.Ng_x[i], q.hit.Ng_y[i], q.hit.Ng_z[i]}};
      resolve(q.hit.instID[0][i], q.hit.geomID[i], rays[i]->time, &hits[i]);
      found[i] = true;
    } else {
      if (plane[i] != 0) hits[i] = {.t = q.ray.tfar[i], .instance = plane[i] - 1};
      found[i] = plane[i] != 0;
    }
  }
}

}  // namespace gloam

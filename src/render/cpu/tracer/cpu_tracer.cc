#include "render/cpu/tracer/cpu_tracer.h"

#include <cstring>
#include <type_traits>

#include "render/cpu/tracer/embree_api.h"

namespace gloam {
namespace {

/// Embree may stop the program at what is no ray, as hostile scenes can make:
/// it hits nothing.
template <class F>
MaskOf<F> is_ray(const RayOf<F>& ray) {
  const F far = magnitude(ray.o.x) + magnitude(ray.o.y) + magnitude(ray.o.z);
  const F d2 = dot(ray.d, ray.d);
  return (far < 1e18f) & (d2 > 0.25f) & (d2 < 4.0f) & (ray.tmax >= 0.0f);
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

// Embree's packets of as many rays as there are lanes.
using RayHitPacket = std::conditional_t<kLaneCount == 16, RTCRayHit16, RTCRayHit8>;
using RayPacket = std::conditional_t<kLaneCount == 16, RTCRay16, RTCRay8>;

template <class Packet>
void fill(const RayOf<FloatLanes>& ray, const FloatLanes& tmax, Packet* q) {
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

/// Mask of the rays of a packet that Embree is to trace.
struct Valid {
  alignas(64) int32_t lanes[kLaneCount];
  explicit Valid(MaskLanes m) { store(select(m, UintLanes(~0u), UintLanes(0u)).v, lanes); }
};

}  // namespace

void CpuTracer::resolve(uint32_t instance_id, uint32_t geometry_id, float time, RayHit* hit) const {
  if (instance_id == RTC_INVALID_GEOMETRY_ID) {
    hit->instance = rows[geometry_id];
  } else {
    hit->instance = rows[instance_id];
    Affine3f between;
    hit->normal = transform_vector(pose_at(scanned.instances[hit->instance], time, &between),
                                   hit->normal);  // Embree's is in the instance's frame
  }
}

bool CpuTracer::by_embree(const Ray& ray, bool any, RayHit* hit) const {
  if (!is_ray(ray)) return false;
  float tmax = ray.tmax;
  const uint32_t row = scan(scanned, ray, true, any, &tmax);
  if (any && row != 0) return true;
  EmbreeQuery embree;
  RTCRayHit query;
  query.ray = {ray.o.x, ray.o.y,  ray.o.z, 0.0f, ray.d.x, ray.d.y,
               ray.d.z, ray.time, tmax,    ~0u,  0,       0};
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  for (const EmbreePart* part : {&fixed, &moving}) {
    if (part->scene == nullptr || !may_meet(part->bounds, ray, query.ray.tfar)) continue;
    if (any) {
      embree.occluded(part->scene, &query.ray);
      if (query.ray.tfar < 0) return true;
    } else {
      embree.intersect(part->scene, &query);
    }
  }
  if (any) return false;
  const RTCHit& h = query.hit;
  if (h.geomID != RTC_INVALID_GEOMETRY_ID) {
    *hit = {query.ray.tfar, 0, h.primID, h.u, h.v, {h.Ng_x, h.Ng_y, h.Ng_z}};
    resolve(h.instID[0], h.geomID, ray.time, hit);
    return true;
  }
  if (row != 0) *hit = {.t = tmax, .instance = row - 1};
  return row != 0;
}

MaskLanes CpuTracer::closest_by_embree(const RayOf<FloatLanes>& ray, MaskLanes active,
                                       bool coherent, RayHitOf<FloatLanes>* hit) const {
  active = active & is_ray(ray);
  FloatLanes tmax = ray.tmax;
  const UintLanes row = scan(scanned, ray, active, false, &tmax);
  *hit = {};
  hit->t = tmax;
  hit->instance = row + UintLanes(~0u);
  const MaskLanes met = active & (row != 0u);
  const MaskLanes near_fixed =
      fixed.scene != nullptr ? active & may_meet(fixed.bounds, ray, tmax) : MaskLanes(false);
  const MaskLanes near_moving =
      moving.scene != nullptr ? active & may_meet(moving.bounds, ray, tmax) : MaskLanes(false);
  if (!any(near_fixed | near_moving)) return met;

  alignas(64) RayHitPacket q;
  fill(ray, tmax, &q.ray);
  store(UintLanes(RTC_INVALID_GEOMETRY_ID).v, q.hit.geomID);
  store(UintLanes(RTC_INVALID_GEOMETRY_ID).v, q.hit.instID[0]);
  EmbreeQuery embree(coherent);
  if (any(near_fixed)) embree.intersect(Valid(near_fixed).lanes, fixed.scene, &q);
  if (any(near_moving)) embree.intersect(Valid(near_moving).lanes, moving.scene, &q);
  const MaskLanes found = active & (load<UintLanes>(q.hit.geomID) != RTC_INVALID_GEOMETRY_ID);
  hit->t = load<FloatLanes>(q.ray.tfar);
  hit->primitive = load<UintLanes>(q.hit.primID);
  hit->u = load<FloatLanes>(q.hit.u);
  hit->v = load<FloatLanes>(q.hit.v);
  hit->normal = {load<FloatLanes>(q.hit.Ng_x), load<FloatLanes>(q.hit.Ng_y),
                 load<FloatLanes>(q.hit.Ng_z)};
  each_lane(found, [&](int i) {
    RayHit one;
    one.normal = lane(hit->normal, i);
    resolve(q.hit.instID[0][i], q.hit.geomID[i], lane(ray.time, i), &one);
    set_lane(&hit->instance, i, one.instance);
    set_lane(&hit->normal, i, one.normal);
  });
  return found | met;
}

MaskLanes CpuTracer::occluded_by_embree(const RayOf<FloatLanes>& ray, MaskLanes active) const {
  active = active & is_ray(ray);
  FloatLanes tmax = ray.tmax;
  MaskLanes blocked = active & (scan(scanned, ray, active, true, &tmax) != 0u);
  if (!any(active & !blocked)) return blocked;
  alignas(64) RayPacket q;
  fill(ray, ray.tmax, &q);
  EmbreeQuery embree;
  for (const EmbreePart* part : {&fixed, &moving}) {
    if (part->scene == nullptr) continue;
    const MaskLanes open = active & may_meet(part->bounds, ray, ray.tmax) & !blocked;
    if (!any(open)) continue;
    embree.occluded(Valid(open).lanes, part->scene, &q);
    blocked = blocked | (open & (load<FloatLanes>(q.tfar) < 0.0f));
  }
  return blocked;
}

}  // namespace gloam

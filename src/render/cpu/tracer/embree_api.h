#pragma once
// Embree 3 (Debian 12) or Embree 4 (Debian 13, Ubuntu 24.04). The two differ in how a query is
// called: this file is the only one that depends on the major version.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace gloam {

#if RTC_VERSION_MAJOR >= 4

/// Arguments of ray queries; one object serves any number of queries, one after the other.
class EmbreeQuery {
 public:
  /// `coherent`: the rays of a packet have nearly the same origin and direction.
  explicit EmbreeQuery(bool coherent = false) {
    rtcInitRayQueryContext(&context_);
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    intersect_.context = occluded_.context = &context_;
    if (coherent) intersect_.flags = occluded_.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  }
  EmbreeQuery(const EmbreeQuery&) = delete;
  EmbreeQuery& operator=(const EmbreeQuery&) = delete;

  // `valid` holds -1 for each ray of the packet that is traced, 0 for the others.
  void intersect(RTCScene scene, RTCRayHit* q) { rtcIntersect1(scene, q, &intersect_); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit8* q) {
    rtcIntersect8(valid, scene, q, &intersect_);
  }
  void intersect(const int* valid, RTCScene scene, RTCRayHit16* q) {
    rtcIntersect16(valid, scene, q, &intersect_);
  }
  void occluded(RTCScene scene, RTCRay* q) { rtcOccluded1(scene, q, &occluded_); }
  void occluded(const int* valid, RTCScene scene, RTCRay8* q) {
    rtcOccluded8(valid, scene, q, &occluded_);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay16* q) {
    rtcOccluded16(valid, scene, q, &occluded_);
  }

 private:
  RTCRayQueryContext context_;
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
};

#else

/// As above, with the calls of Embree 3.
class EmbreeQuery {
 public:
  explicit EmbreeQuery(bool coherent = false) {
    rtcInitIntersectContext(&context_);
    if (coherent) context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  EmbreeQuery(const EmbreeQuery&) = delete;
  EmbreeQuery& operator=(const EmbreeQuery&) = delete;

  void intersect(RTCScene scene, RTCRayHit* q) { rtcIntersect1(scene, &context_, q); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit8* q) {
    rtcIntersect8(valid, scene, &context_, q);
  }
  void intersect(const int* valid, RTCScene scene, RTCRayHit16* q) {
    rtcIntersect16(valid, scene, &context_, q);
  }
  void occluded(RTCScene scene, RTCRay* q) { rtcOccluded1(scene, &context_, q); }
  void occluded(const int* valid, RTCScene scene, RTCRay8* q) {
    rtcOccluded8(valid, scene, &context_, q);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay16* q) {
    rtcOccluded16(valid, scene, &context_, q);
  }

 private:
  RTCIntersectContext context_;
};

#endif

/// Whether the library that is loaded has the major version of the headers, whose calls differ.
inline bool is_embree_of_headers(RTCDevice device) {
  return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_MAJOR) == RTC_VERSION_MAJOR;
}

}  // namespace gloam

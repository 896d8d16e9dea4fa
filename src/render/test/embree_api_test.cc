// Queries of whichever Embree is built with: single rays and packets, their masks, instances.
#include "render/cpu/tracer/embree_api.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace gloam {
namespace {

constexpr unsigned kEmbreeInstance = 7;

/// A triangle at z = 0, and an instance of it at z = 2.
struct EmbreeTriangle {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene triangle = rtcNewScene(device), top = rtcNewScene(device);

  EmbreeTriangle() {
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3));
    for (int i = 0; i < 9; ++i) positions[i] = corners[i];
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 1));
    for (unsigned i = 0; i < 3; ++i) indices[i] = i;
    add(mesh, triangle, 0);
    RTCGeometry copy = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    const float columns[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2};
    rtcSetGeometryInstancedScene(copy, triangle);
    rtcSetGeometryTransform(copy, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    add(copy, top, kEmbreeInstance);
  }
  ~EmbreeTriangle() {
    rtcReleaseScene(top);
    rtcReleaseScene(triangle);
    rtcReleaseDevice(device);
  }

 private:
  static void add(RTCGeometry geometry, RTCScene scene, unsigned id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
};

constexpr RTCRay kEmbreeRay{0.25f, 0.25f, -1, 0, 0, 0, 1, 0, 100, ~0u, 0, 0};

template <class Packet>
void fill_packet(int count, Packet* q) {
  for (int i = 0; i < count; ++i) {
    q->org_x[i] = q->org_y[i] = 0.25f;
    q->org_z[i] = -1;
    q->tnear[i] = q->dir_x[i] = q->dir_y[i] = q->time[i] = 0;
    q->dir_z[i] = 1;
    q->tfar[i] = 100;
    q->mask[i] = ~0u;
    q->id[i] = q->flags[i] = 0;
  }
}

TEST(EmbreeApi, TheLibraryIsThatOfTheHeaders) {
  const EmbreeTriangle scenes;
  EXPECT_TRUE(is_embree_of_headers(scenes.device));
}

TEST(EmbreeApi, SingleRaysMeetTrianglesAndInstances) {
  const EmbreeTriangle scenes;
  EmbreeQuery embree;
  for (RTCScene scene : {scenes.triangle, scenes.top}) {
    const bool is_top = scene == scenes.top;
    RTCRayHit hit;
    hit.ray = kEmbreeRay;
    hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree.intersect(scene, &hit);
    EXPECT_FLOAT_EQ(hit.ray.tfar, is_top ? 3 : 1);
    EXPECT_EQ(hit.hit.geomID, 0u);
    EXPECT_EQ(hit.hit.instID[0], is_top ? kEmbreeInstance : RTC_INVALID_GEOMETRY_ID);
    RTCRay shadow = kEmbreeRay;
    embree.occluded(scene, &shadow);
    EXPECT_LT(shadow.tfar, 0);
  }
}

TEST(EmbreeApi, PacketsTraceTheRaysOfTheMask) {
  const EmbreeTriangle scenes;
  EmbreeQuery embree(true);
  alignas(64) int odd[16];
  for (int i = 0; i < 16; ++i) odd[i] = i % 2 != 0 ? -1 : 0;
  alignas(64) RTCRayHit8 eight;
  fill_packet(8, &eight.ray);
  for (int i = 0; i < 8; ++i) eight.hit.geomID[i] = eight.hit.instID[0][i] = ~0u;
  embree.intersect(odd, scenes.top, &eight);
  for (int i = 0; i < 8; ++i) {
    EXPECT_FLOAT_EQ(eight.ray.tfar[i], i % 2 != 0 ? 3 : 100) << i;
    EXPECT_EQ(eight.hit.instID[0][i], i % 2 != 0 ? kEmbreeInstance : ~0u) << i;
  }
  alignas(64) RTCRay8 shadows;
  fill_packet(8, &shadows);
  embree.occluded(odd, scenes.triangle, &shadows);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(shadows.tfar[i] < 0, i % 2 != 0) << i;
}

}  // namespace
}  // namespace gloam

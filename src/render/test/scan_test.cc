// Solids that are scanned and solids that Embree holds are the same to a ray.

#include <gtest/gtest.h>

#include <set>

#include "render/test/probe.h"

namespace gloam {
namespace {

constexpr int kSolids = 40;

/// All simple shapes in a heap, boxes along the axes and across. `scanned` = false: larger solids,
/// out of reach, take their places in the list.
SceneBuilder heap_of_solids(bool scanned) {
  SceneBuilder b;
  const int material = b.add_diffuse({0.5f, 0.5f, 0.5f});
  const ShapeType shapes[] = {ShapeType::kBox,      ShapeType::kSphere,  ShapeType::kEllipsoid,
                              ShapeType::kCylinder, ShapeType::kCapsule, ShapeType::kPlane,
                              ShapeType::kBox};
  Sampler sampler = draw(0, 7);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * sampler.next_1d();
  };
  for (int i = 0; i < kSolids; ++i) {
    const Vec3f size{uniform(0.05f, 0.4f), uniform(0.05f, 0.4f), uniform(0.05f, 0.4f)};
    const Vec3f axis = normalize(Vec3f{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1) + 1e-3f});
    const float quarter = 1.57079632679f * static_cast<float>(i % 4);
    const bool across = i % 3 == 0;
    const Vec3f p{uniform(-2, 2), uniform(-2, 2), uniform(-2, 2)};
    b.add(shapes[i % 7], size,
          rigid(across ? axis : Vec3f{0, 0, 1}, across ? uniform(0, 3) : quarter, p), material);
  }
  for (int i = 0; i < 64 && !scanned; ++i) {
    b.add(ShapeType::kBox, {9, 9, 9}, translation({500.0f + 20.0f * static_cast<float>(i), 0, 0}),
          material);
  }
  return b;
}

Ray ray_through_heap(uint32_t i) {
  Sampler sampler = draw(i);
  const Vec2f a = sampler.next_2d(), b = sampler.next_2d(), c = sampler.next_2d();
  const float reach = i % 2 == 0 ? 4.0f : 2.0f;  // from outside and from within
  const Vec3f o{(a.x * 2 - 1) * reach, (a.y * 2 - 1) * reach, (b.x * 2 - 1) * reach};
  Vec3f d = sample_sphere(c);
  if (i % 5 == 0) d = {i % 2 == 0 ? 1.0f : -1.0f, 0, 0};
  if (i % 5 == 1) d = {0, d.y, d.z};
  Ray ray = make_ray(o, d);
  ray.tmax = 20;
  return ray;
}

TEST(Scan, FindsWhatEmbreeFinds) {
  const Probe scan(heap_of_solids(true)), bvh(heap_of_solids(false));
  if (scan.tracer.own) GTEST_SKIP() << "solids are scanned beside Embree, which this build lacks";
  ASSERT_EQ(scan.tracer.scanned.solids.size, static_cast<uint32_t>(kSolids));
  ASSERT_EQ(scan.tracer.fixed.scene, nullptr);
  for (uint32_t i = 0; i < bvh.tracer.scanned.solids.size; ++i) {
    ASSERT_GE(bvh.tracer.scanned.solids[i].row, static_cast<uint32_t>(kSolids));
  }
  constexpr uint32_t kRays = 40000;
  int hits = 0, other = 0;
  for (uint32_t i = 0; i < kRays; ++i) {
    const Ray ray = ray_through_heap(i);
    RayHit a, b, any;
    const bool found = scan.tracer.trace(ray, false, &a);
    EXPECT_EQ(found, scan.tracer.trace(ray, true, &any))
        << "closest and any hit disagree, ray " << i;
    const bool same = found == bvh.tracer.trace(ray, false, &b) &&
                      (!found || (a.instance == b.instance && std::fabs(a.t - b.t) < 2e-4f));
    hits += found ? 1 : 0;
    other += same ? 0 : 1;
  }
  EXPECT_GT(hits, static_cast<int>(kRays / 10));
  EXPECT_LE(other, 4) << "more than rays that graze an edge";
}

TEST(Scan, LanesFindWhatSingleRaysFind) {
  const Probe probe(heap_of_solids(true));
  for (uint32_t first = 0; first < 8000; first += kLaneCount) {
    RayOf<FloatLanes> rays;
    MaskLanes active = false;
    for (int i = 0; i < kLaneCount; ++i) {
      const Ray ray = ray_through_heap(first + static_cast<uint32_t>(i));
      set_lane(&rays.o, i, ray.o);
      set_lane(&rays.d, i, ray.d);
      set_lane(&rays.tmax, i, ray.tmax);
      set_lane(&active, i, i % 7 != 3);
    }
    RayHitOf<FloatLanes> hits;
    const MaskLanes found = probe.tracer.closest(rays, active, false, &hits);
    const MaskLanes blocked = probe.tracer.occluded(rays, active);
    for (int i = 0; i < kLaneCount; ++i) {
      RayHit hit;
      const bool expected = i % 7 != 3 && probe.tracer.trace(lane(rays, i), false, &hit);
      ASSERT_EQ(lane(found, i), expected);
      ASSERT_EQ(lane(blocked, i), expected);
      if (!expected) continue;
      ASSERT_EQ(lane(hits.t, i), hit.t);
      ASSERT_EQ(lane(hits.instance, i), hit.instance);
    }
  }
}

/// A room with twenty books in a corner: those are passed by as one where no ray comes near.
TEST(Scan, WhatIsSmallAndCloseTogetherIsOneGroup) {
  SceneBuilder b;
  const int material = b.add_diffuse({0.5f, 0.5f, 0.5f});
  for (int k = 0; k < 6; ++k) {
    const Vec3f axis{k / 2 == 0 ? 1.0f : 0, k / 2 == 1 ? 1.0f : 0, k / 2 == 2 ? 1.0f : 0};
    b.add(ShapeType::kBox, Vec3f{2, 2, 2} - axis * 1.9f,
          translation(axis * (k % 2 == 0 ? 2.1f : -2.1f)), material);
  }
  for (int i = 0; i < 20; ++i) {
    b.add(ShapeType::kBox, {0.02f, 0.1f, 0.15f},
          translation({1.0f + 0.045f * static_cast<float>(i), 1.8f, -1.8f}), material);
  }
  const Probe probe(b);
  if (probe.tracer.own) GTEST_SKIP() << "solids are scanned beside Embree, which this build lacks";
  const ScanList& list = probe.tracer.scanned;
  uint32_t next = 0;
  for (uint32_t i = 0; i < list.groups.size; ++i) {
    const ScanGroup& group = list.groups[i];
    EXPECT_EQ(group.first, next);
    next += group.count;
    for (uint32_t k = group.first; k < next; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(group.bounds.low[axis], list.solids[k].bounds.low[axis]);
        EXPECT_GE(group.bounds.high[axis], list.solids[k].bounds.high[axis]);
      }
    }
    const bool is_wall = list.solids[group.first].row < 6;
    EXPECT_TRUE(group.count == 1 || !is_wall) << "every ray would meet the group";
  }
  EXPECT_EQ(next, 26u);
  EXPECT_LT(list.groups.size, 11u);
}

TEST(Scan, TakesTheLargestOfManyAndLeavesTheRestToEmbree) {
  SceneBuilder b;
  const int material = b.add_diffuse({0.5f, 0.5f, 0.5f});
  for (int i = 0; i < 200; ++i) {
    const float half = 0.05f + 0.001f * static_cast<float>(i);
    b.add(ShapeType::kBox, {half, half, half}, translation({static_cast<float>(i), 0, 0}),
          material);
  }
  const Probe probe(b);
  if (probe.tracer.own) GTEST_SKIP() << "solids are scanned beside Embree, which this build lacks";
  ASSERT_EQ(probe.tracer.scanned.solids.size, 64u);
  std::set<uint32_t> rows;
  for (uint32_t i = 0; i < 64; ++i) rows.insert(probe.tracer.scanned.solids[i].row);
  EXPECT_EQ(rows.size(), 64u);
  EXPECT_EQ(*rows.begin(), 136u);
  for (int i = 0; i < 200; ++i) {
    RayHit hit;
    ASSERT_TRUE(
        probe.tracer.trace(make_ray({static_cast<float>(i), -3, 0}, {0, 1, 0}), false, &hit));
    EXPECT_EQ(hit.instance, static_cast<uint32_t>(i));
  }
}

}  // namespace
}  // namespace gloam

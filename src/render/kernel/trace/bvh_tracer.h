#pragma once
// A tracer over our own BVH, for the CPU and for CUDA. Device-safe.

#include "geometry/bvh/bvh_traverse.h"
#include "render/kernel/surface/shapes.h"
#include "render/kernel/trace/scan.h"

namespace gloam {

/// The instances without triangles, as traverse() asks for them.
struct BvhSolids {
  DeviceSpan<const InstanceView> instances;

  GLOAM_HD float meet(const BvhInstance& in, Vec3f o_G, Vec3f d_G, float, float tmax) const {
    const InstanceView& instance = instances[in.id];
    if (instance.shape != ShapeType::kBox) {
      return intersect_shape(instance.shape, instance.size, o_G, d_G, 0.0f, tmax);
    }
    float enter, leave;
    scans::cross_box(-instance.size, instance.size, o_G, scans::inverse_of(d_G), &enter, &leave);
    if (!(enter <= leave)) return -1.0f;
    const float t = enter > 0 ? enter : leave;  // from within
    return t <= tmax ? t : -1.0f;
  }
};

/// Cheap to copy; valid until the scene's next update.
struct BvhTracer {
  BvhView bvh;
  ScanList scanned;

  /// One ray: the closest hit, or with `any` just whether there is one.
  GLOAM_HD bool trace(const Ray& ray, bool any, RayHit* hit) const {
    float tmax = ray.tmax;
    const uint32_t row = scan(scanned, ray, true, any, &tmax);
    if (any && row != 0) return true;
    return trace_tree(ray, any, row, tmax, hit, nullptr);
  }
  /// The same, but with `any` whether something hides what is behind it. Surfaces that may let
  /// light through do not count; *clear tells whether some may be in the way.
  GLOAM_HD bool trace(const SceneView& scene, const Ray& ray, bool any, RayHit* hit,
                      bool* clear) const {
    float tmax = ray.tmax;
    uint32_t row = scan(scanned, ray, true, any, &tmax);
    *clear = false;
    if (any && row != 0) {
      *clear = scene.materials[scanned.instances[row - 1].material].transparent;
      if (!*clear) return true;
      tmax = ray.tmax;
      row = 0;
    }
    return trace_tree(ray, any, row, tmax, hit, clear);
  }
  /// The closest hit of the ray, and whether the shadow ray before it hits anything; a ray with
  /// tmax 0 is none.
  GLOAM_HD bool trace_both(const Ray& shadow, const Ray& ray, bool* shadowed, RayHit* hit) const {
    float lit = shadow.tmax, tmax = ray.tmax;
    *shadowed = lit > 0 && scan(scanned, shadow, true, true, &lit) != 0;
    const uint32_t row = tmax > 0 ? scan(scanned, ray, true, false, &tmax) : 0;
    const BvhShadow before{shadow.o, shadow.d, *shadowed ? 0.0f : shadow.tmax};
    BvhHit found;
    const bool in_tree =
        traverse<!kPlainScenes, false>(bvh, BvhSolids{scanned.instances}, ray.o, ray.d, ray.time,
                                       tmax, false, &found, &before, shadowed);
    return nearest(ray, in_tree, found, row, tmax, hit);
  }
  GLOAM_HD bool closest(const Ray& ray, bool active, bool, RayHit* hit) const {
    return active && trace(ray, false, hit);
  }
  GLOAM_HD bool occluded(const Ray& ray, bool active) const {
    RayHit hit;
    return active && trace(ray, true, &hit);
  }

 private:
  /// Continues trace() after the scan, which has found `row` at tmax.
  GLOAM_HD bool trace_tree(const Ray& ray, bool any, uint32_t row, float tmax, RayHit* hit,
                           bool* clear) const {
    BvhHit found;
    const bool in_tree =
        traverse<!kPlainScenes, kPlainScenes>(bvh, BvhSolids{scanned.instances}, ray.o, ray.d,
                                              ray.time, tmax, any, &found, nullptr, nullptr, clear);
    return any ? in_tree : nearest(ray, in_tree, found, row, tmax, hit);
  }
  /// Hit that the tree has found, or else the row of the scan.
  GLOAM_HD bool nearest(const Ray& ray, bool in_tree, const BvhHit& found, uint32_t row, float tmax,
                        RayHit* hit) const {
    if (in_tree) {
      *hit = {found.t, found.id, found.primitive, found.u, found.v, normal_of(found, ray.time)};
    } else if (row != 0) {
      *hit = {.t = tmax, .instance = row - 1};
    }
    return in_tree || row != 0;
  }
  GLOAM_HD Vec3f normal_of(const BvhHit& hit, float time) const {
    const BvhInstance& in = bvh.instances[hit.instance];
    if (in.root == bvh::kNothing) return {};
    const bvh::Corners at =
        bvh::corners_at<!kPlainScenes>(bvh, in, bvh.triangles + hit.triangle, time);
    const Vec3f n = cross(at.b - at.a, at.c - at.a);
    const InstanceView& instance = scanned.instances[in.id];
    if (instance.shape == ShapeType::kDeformable) return n;
    Affine3f between;
    return transform_vector(pose_at(instance, time, &between), n);
  }
};

}  // namespace gloam

#pragma once
// Surface at a hit: position, normals, textures, layers, BSDF. Device-safe.

#include "render/kernel/bsdf/layered_bsdf.h"
#include "render/kernel/surface/surface_layers.h"

namespace gloam {

namespace surfaces {

/// Results of the first part of make_surface() that the rest needs.
template <class F>
struct PlacedOf {
  AffineOf<F> X_WG;
  Vec3Of<F> p_G;
  MaskOf<F> solid = false;                                        ///< no mesh
  MaskOf<F> textured = false, layered = false, outwards = false;  ///< as in MaterialView
};

/// Shading normals of a triangle's corners.
template <class F>
GLOAM_HD Vec3Of<F> corner_normal(const Vec3f* normals, UintOf<F> first) {
  const float* data = &normals->x;
  return {gather(data, first), gather(data + 1, first), gather(data + 2, first)};
}

/// Place, normals without textures, and the material's own numbers.
template <class F>
GLOAM_HD PlacedOf<F> place_surface(const SceneView& scene, const RayOf<F>& ray,
                                   const RayHitOf<F>& hit, MaskOf<F> found, SurfaceOf<F>* surface) {
  SurfaceOf<F>& s = *surface;
  s.instance = hit.instance;
  s.t = hit.t;
  s.p = ray.o + ray.d * hit.t;

  PlacedOf<F> out;
  AffineOf<F>& X_WG = out.X_WG;
  Vec3Of<F> size, corner[3];  // of the shape; of a triangle
  MaskOf<F> mesh = false, smooth = false, box = false, moving = false;
  // Rays side by side meet few different things.
  each_value(found, hit.instance, [&](MaskOf<F> same, uint32_t row) {
    const InstanceView& instance = scene.instances[row];
    const MaterialView& m = scene.materials[instance.material];
    const auto put = [&](F* to, float value) { *to = select(same, F(value), *to); };
    const auto put3 = [&](Vec3Of<F>* to, Vec3f value) {
      *to = select<F>(same, in_all_lanes<F>(value), *to);
    };
    if (instance.moving) {
      each_lane(same, [&](int i) {
        Affine3f between;
        set_lane(&X_WG, i, pose_at(instance, lane(ray.time, i), &between));
      });
    } else {
      put3(&X_WG.x, instance.X_WG.x);
      put3(&X_WG.y, instance.X_WG.y);
      put3(&X_WG.z, instance.X_WG.z);
      put3(&X_WG.p, instance.X_WG.p);
    }
    put3(&s.base_color, m.base_color);
    if (scene.has_flicker() && m.levels >= 0) {
      each_lane(same, [&](int i) {
        set_lane(&s.emission, i, m.emission * level_at(scene, m.levels, lane(ray.time, i)));
      });
    } else {
      put3(&s.emission, m.emission);
    }
    put(&s.metallic, m.metallic);
    put(&s.roughness, m.roughness);
    put(&s.f0, m.f0);
    put(&s.f90, m.f90);
    put(&s.opacity, m.opacity);
    if (m.textured) out.textured = out.textured | same;
    if (m.layers >= 0) out.layered = out.layered | same;
    if (m.emits_outwards) out.outwards = out.outwards | same;
    if (is_mesh(instance.shape)) {
      mesh = mesh | same;
      const DeviceSpan<const Vec3f>& normals = scene.meshes[instance.mesh].corner_normals;
      if (normals.empty()) return;
      smooth = smooth | same;
      // Lanes take indices below 2^31: meshes of more triangles would not fit into memory.
      const UintOf<F> first = select(same, hit.primitive * UintOf<F>(9u), UintOf<F>(0u));
      for (int k = 0; k < 3; ++k) {
        corner[k] = select<F>(same, corner_normal<F>(normals.data + k, first), corner[k]);
      }
    } else {
      if (instance.moving) moving = moving | same;
      if (instance.shape == ShapeType::kBox) box = box | same;
      put3(&size, instance.size);
    }
  });

  if (any(mesh)) {
    // Normals of tiny triangles would vanish when squared.
    const Vec3Of<F>& n = hit.normal;
    const F scale = max(magnitude(n.x), max(magnitude(n.y), magnitude(n.z)));
    s.geometric = select<F>(scale > 0.0f, normalize(n * (1.0f / max(scale, 1e-37f))), -ray.d);
    s.normal = s.geometric;
    if (any(smooth)) {
      const Vec3Of<F> mean =
          corner[0] * (1.0f - hit.u - hit.v) + corner[1] * hit.u + corner[2] * hit.v;
      smooth = smooth & (length_squared(mean) > 1e-8f);
      s.normal = select<F>(smooth, normalize(transform_vector(X_WG, mean)), s.normal);
    }
  }
  const MaskOf<F> solid = out.solid = found & !mesh;
  Vec3Of<F>& p_G = out.p_G = to_frame(X_WG, s.p - X_WG.p);
  if (any(solid)) {
    Vec3Of<F> on_G = p_G, n_G;
    if (any(box)) n_G = snap_to_box(size, &on_G);
    each_lane(solid & !box, [&](int i) {
      Vec3f p = lane(p_G, i);
      const ShapeType shape = scene.instances[lane(hit.instance, i)].shape;
      set_lane(&n_G, i, snap_to_shape(shape, lane(size, i), &p));
      set_lane(&on_G, i, p);
    });
    Vec3Of<F> n = transform_vector(X_WG, n_G);
    if (any(moving)) n = select<F>(moving, normalize(n), n);  // X_WG is a mean of two poses
    p_G = select<F>(solid, on_G, p_G);
    s.p = select<F>(solid, transform_point(X_WG, on_G), s.p);
    s.geometric = select<F>(solid, n, s.geometric);
    s.normal = select<F>(solid, n, s.normal);
  }
  return out;
}

}  // namespace surfaces

/// The surfaces that the lanes of `found` have hit. `cone` is that of the ray at its origin.
template <class F>
GLOAM_HD_LARGE SurfaceOf<F> make_surface(const SceneView& scene, const RayOf<F>& ray,
                                         const RayHitOf<F>& hit, RayConeOf<F> cone,
                                         MaskOf<F> found = true) {
  SurfaceOf<F> s;
  const surfaces::PlacedOf<F> at = surfaces::place_surface(scene, ray, hit, found, &s);
  const F cosine = dot(s.geometric, ray.d);
  // The footprint is an ellipse; its mean axis keeps near texels sharp without aliasing far ones.
  const auto width_at = [&](int i) {
    return (lane(cone.width, i) + lane(cone.spread, i) * lane(hit.t, i)) /
           sqrtf(max(fabsf(lane(cosine, i)), 0.05f));
  };
  each_lane(at.textured & scene.has_textures(), [&](int i) {
    Surface one = lane(s, i);
    surfaces::apply_textures(scene, scene.instances[one.instance], lane(hit, i), lane(at.X_WG, i),
                             lane(at.p_G, i), width_at(i), lane(ray.time, i), &one);
    lane_copies::set(&s, i, one, typename SurfaceOf<F>::Textured{}, Surface::Textured{});
  });
  const MaskOf<F> inside = cosine > 0.0f;
  s.outside = !inside;
  s.emission = select<F>((at.solid | at.outwards) & inside, Vec3Of<F>{}, s.emission);
  s.geometric = select<F>(inside, -s.geometric, s.geometric);
  s.normal = select<F>(inside, -s.normal, s.normal);
  s.normal = face_viewer(s.normal, ray.d);
  each_lane(found & at.layered & scene.has_layers(), [&](int i) {
    Surface one = lane(s, i);
    surfaces::apply_layers(scene, lane(hit, i), lane(at.X_WG, i), lane(at.p_G, i), lane(ray.d, i),
                           width_at(i), lane(ray.time, i), &one);
    set_lane(&s, i, one);
  });
  return s;
}

/// BSDF of the surface for the direction `wo` towards the viewer; `frame` is its shading frame.
template <class F>
GLOAM_HD LayeredBsdfOf<F> surface_bsdf(const SceneView& scene, const SurfaceOf<F>& s, Vec3Of<F> wo,
                                       FrameOf<F>* frame, MaskOf<F> active = true) {
  *frame = FrameOf<F>::from_z(s.normal);
  const MaskOf<F> drawn_out = length_squared(s.tangent) > 0.0f;
  if (any(drawn_out)) {
    frame->x = select<F>(drawn_out, s.tangent, frame->x);
    frame->y = select<F>(drawn_out, cross(s.normal, s.tangent), frame->y);
  }
  Vec3Of<F> wo_local = frame->to_local(wo);
  wo_local.z = max(wo_local.z, 1e-4f);
  LayeredBsdfOf<F> bsdf;
  bsdf.base = make_bsdf(*scene.albedo, s.base_color, s.base_color, s.metallic, F(1.0f), s.roughness,
                        s.f0, s.f90, F(0.0f), wo_local);
  if (scene.has_layers()) {
    each_lane(active, [&](int i) {
      const int row = scene.materials[scene.instances[lane(s.instance, i)].material].layers;
      if (row < 0) return;
      const SurfaceParameters base{
          .base_color = lane(s.base_color, i),
          .metallic = lane(s.metallic, i),
          .roughness = lane(s.roughness, i),
          .f0 = lane(s.f0, i),
          .f90 = lane(s.f90, i),
          .outside = lane(s.outside, i),
          .coat_weight = lane(s.coat_weight, i),
          .coat_roughness = lane(s.coat_roughness, i),
          .coat_f0 = lane(s.coat_f0, i),
          .coat_darkening = lane(s.coat_darkening, i),
          .fuzz_weight = lane(s.fuzz_weight, i),
          .transmission = lane(s.transmission, i),
      };
      set_lane(
          &bsdf, i,
          make_layered(scene, scene.layers[static_cast<uint32_t>(row)], base, lane(wo_local, i)));
    });
  }
  return bsdf;
}

#if !defined(__CUDACC__) && \
    !defined(GLOAM_LARGE_IN_PLACE)  // instantiated in render/cpu/kernels/surfaces.cc
extern template Surface make_surface<float>(const SceneView&, const Ray&, const RayHit&, RayCone,
                                            bool);
extern template SurfaceOf<FloatLanes> make_surface<FloatLanes>(const SceneView&,
                                                               const RayOf<FloatLanes>&,
                                                               const RayHitOf<FloatLanes>&,
                                                               RayConeOf<FloatLanes>, MaskLanes);
#endif

}  // namespace gloam

#pragma once
// One light: a direction towards it, its density, and what arrives. Device-safe.

#include "render/kernel/surface/shapes.h"
#include "render/kernel/surface/surface.h"

namespace gloam {

template <class F>
struct LightSampleOf {
  Vec3Of<F> wi;        ///< unit, from the surface to the light
  F distance{};        ///< [m]
  Vec3Of<F> lift;      ///< moves the point on the light off its surface [m]
  Vec3Of<F> radiance;  ///< [cd/m²]; delta lights: illuminance on a facing surface [lx]
  F pdf{};             ///< per solid angle, selection included; delta: of the selection; 0 = none
  MaskOf<F> is_delta = MaskOf<F>(false);
  MaskOf<F> casts_shadow = MaskOf<F>(true);
  using Members = MemberList<&LightSampleOf::wi, &LightSampleOf::distance, &LightSampleOf::lift,
                             &LightSampleOf::radiance, &LightSampleOf::pdf,
                             &LightSampleOf::is_delta, &LightSampleOf::casts_shadow>;
};
using LightSample = LightSampleOf<float>;

/// Share of a lamp's full intensity in the unit direction from its centre.
template <class F>
GLOAM_HD F relative_intensity(const SceneView& scene, const LightView& light, Vec3Of<F> d) {
  F relative = 1.0f;
  if (light.kind == LightKind::kSpot) {
    const F cosine = dot(in_all_lanes<F>(light.direction), d);
    relative = select(cosine >= light.cos_inner, F(1.0f), F(0.0f));
    each_lane((cosine > light.cos_cutoff) & (cosine < light.cos_inner), [&](int i) {
      const float angle = acosf(clamp(lane(cosine, i), -1.0f, 1.0f));
      const float x = (light.cutoff - angle) / max(light.cutoff - light.inner, 1e-6f);
      set_lane(&relative, i, x * x * (3.0f - 2.0f * x));
    });
  }
  if (!kPlainScenes && light.profile >= 0) {
    const ProfileView& profile = scene.profiles[static_cast<uint32_t>(light.profile)];
    const Frame R_WL{light.x, cross(light.x, light.direction), -light.direction};
    each_lane(relative > 0.0f, [&](int i) {
      const float of_profile =
          ies_intensity(scene.profile_values.data + profile.first, profile.rows, profile.columns,
                        R_WL.to_local(lane(d, i)));
      set_lane(&relative, i, lane(relative, i) * of_profile);
    });
  }
  return relative;
}

/// A lamp or sun as it is at a time in the shutter: evenly between its keys.
GLOAM_HD LightView light_at(const SceneView& scene, const LightView& light, float time) {
  LightView now = light;
  if (light.first_key < 0) return now;
  float fraction;
  const uint32_t row =
      static_cast<uint32_t>(light.first_key) + key_before(scene.light_key_count, time, &fraction);
  const LightKey &a = scene.light_keys[row], &b = scene.light_keys[row + 1];
  now.p = lerp(a.p, b.p, fraction);
  now.direction = normalize(lerp(a.direction, b.direction, fraction));
  now.x = normalize(lerp(a.x, b.x, fraction));
  now.first_key = -1;
  return now;
}

namespace lights {

template <class F>
GLOAM_HD LightSampleOf<F> sample_lamp(const SceneView& scene, const LightView& light, Vec3Of<F> p,
                                      Vec2Of<F> u) {
  LightSampleOf<F> s;
  const Vec3Of<F> to = in_all_lanes<F>(light.p) - p;
  const F d2 = max(dot(to, to), 1e-12f), d = square_root(d2);
  const Vec3Of<F> axis = to / d;
  const Vec3Of<F> intensity =
      in_all_lanes<F>(light.intensity) * relative_intensity(scene, light, -axis);
  const float r2 = light.radius * light.radius;
  // Within the sphere it acts as a point.
  const MaskOf<F> point = MaskOf<F>(light.is_delta) | (d2 <= r2 * 1.0001f);
  s.wi = axis;
  s.distance = d;
  s.radiance = intensity / max(d2, r2);
  s.pdf = 1.0f;
  s.is_delta = point;
  if (any(!point)) {
    const F one_minus_cos = one_minus_cos_of(min(r2 / d2, 1.0f));
    const Vec3Of<F> wi = FrameOf<F>::from_z(axis).to_world(sample_cone(one_minus_cos, u));
    const F along = dot(to, wi);
    s.wi = select<F>(point, s.wi, wi);
    s.distance = select(point, s.distance, along - safe_sqrt(r2 - max(d2 - along * along, 0.0f)));
    s.radiance = select<F>(point, s.radiance, intensity * (1.0f / (kPi * r2)));
    s.pdf = select(point, s.pdf, cone_pdf(one_minus_cos));
  }
  s.pdf = select(max_component(intensity) > 0.0f, s.pdf, F(0.0f));
  return s;
}

template <class F>
GLOAM_HD LightSampleOf<F> sample_sun(const LightView& light, Vec2Of<F> u) {
  LightSampleOf<F> s;
  s.distance = 1e7f;
  const Vec3f axis = -light.direction;
  if (light.is_delta) {
    s.wi = in_all_lanes<F>(axis);
    s.radiance = in_all_lanes<F>(light.intensity);
    s.pdf = 1.0f;
    s.is_delta = true;
    return s;
  }
  const float sin2 = light.radius * light.radius;
  s.wi =
      FrameOf<F>::from_z(in_all_lanes<F>(axis)).to_world(sample_cone(F(one_minus_cos_of(sin2)), u));
  s.radiance = in_all_lanes<F>(light.intensity / (kPi * sin2));
  s.pdf = cone_pdf(one_minus_cos_of(sin2));
  return s;
}

/// A point on an emitter and its outward normal.
template <class F>
struct EmitterPointOf {
  Vec3Of<F> p_G, p_W, n_W;
};
using EmitterPoint = EmitterPointOf<float>;

/// Samples towards points of emitters that were sampled with a density per area.
template <class F>
GLOAM_HD LightSampleOf<F> aim_at(const EmitterPointOf<F>& at, F pdf_area, bool one_sided,
                                 Vec3Of<F> p) {
  LightSampleOf<F> s;
  const Vec3Of<F> to = at.p_W - p;
  const F d2 = dot(to, to);
  s.distance = square_root(d2);
  s.wi = to / s.distance;
  F cosine = -dot(s.wi, at.n_W), step = surface_step(at.p_W, F(0.0f));
  if (!one_sided) {
    step = select(cosine < 0.0f, -step, step);
    cosine = magnitude(cosine);
  }
  s.pdf = select((pdf_area > 0.0f) & (cosine > 1e-6f) & (s.distance > 1e-6f),
                 pdf_area * d2 / cosine, F(0.0f));
  s.lift = at.n_W * step;
  return s;
}

/// A point on a face of a box that p sees, from outside: every lane takes its own face. Returns its
/// density per area.
template <class F>
GLOAM_HD F sample_box(Vec3f size, const Affine3f& X_WG, Vec3Of<F> p, Vec2Of<F> u,
                      EmitterPointOf<F>* at) {
  const AffineOf<F> X = pose_in_all_lanes<F>(X_WG);
  Vec3Of<F> n_G;
  const F pdf_area = sample_box_from(size, to_frame(X, p - X.p), u, &at->p_G, &n_G);
  at->p_W = transform_point(X, at->p_G);
  at->n_W = transform_vector(X, n_G);
  return pdf_area;
}

/// Samples towards spheres, from outside; every lane may have its own. `normal`: at the sampled
/// point.
template <class F>
GLOAM_HD LightSampleOf<F> sample_ball(F radius, Vec3Of<F> center, Vec3Of<F> p, Vec2Of<F> u,
                                      Vec3Of<F>* normal) {
  LightSampleOf<F> s;
  const Vec3Of<F> to = center - p;
  const F r2 = sqr(radius);
  const F d2 = dot(to, to), one_minus_cos = one_minus_cos_of(min(r2 / d2, 1.0f));
  s.wi = FrameOf<F>::from_z(to / square_root(d2)).to_world(sample_cone(one_minus_cos, u));
  const F along = dot(to, s.wi);
  s.distance = along - safe_sqrt(r2 - max(d2 - along * along, 0.0f));
  const Vec3Of<F> there = p + s.wi * s.distance;
  *normal = normalize(there - center);
  s.pdf = select(s.distance > 1e-6f, cone_pdf(one_minus_cos), F(0.0f));
  s.lift = *normal * surface_step(there, F(0.0f));
  return s;
}
template <class F>
GLOAM_HD MaskOf<F> is_outside_ball(F radius, Vec3Of<F> center, Vec3Of<F> p) {
  return length_squared(center - p) > sqr(radius) * 1.0001f;
}

/// Samples towards points of a sheet: with no triangle to look up, and no seam in the points' even
/// spread.
template <class F>
GLOAM_HD LightSampleOf<F> sample_sheet(const LightView& light, Vec3Of<F> p, Vec2Of<F> u) {
  const Vec3f normal = cross(light.edges[0], light.edges[1]);
  const float area = length(normal);
  EmitterPointOf<F> at;
  at.p_W = in_all_lanes<F>(light.p) + in_all_lanes<F>(light.edges[0]) * (u.x - 0.5f) +
           in_all_lanes<F>(light.edges[1]) * (u.y - 0.5f);
  at.n_W = in_all_lanes<F>(normal / area);
  LightSampleOf<F> s = aim_at(at, F(1.0f / area), true, p);
  s.radiance = in_all_lanes<F>(light.intensity);
  return s;
}

/// Density per solid angle at p of the direction to a point of an emitting instance.
GLOAM_HD float instance_pdf(const SceneView& scene, const InstanceView& instance, Vec3f p,
                            Vec3f hit_p, Vec3f hit_normal, float time) {
  if (instance.shape == ShapeType::kSphere) {
    const Vec3f center = pose_at(instance, time).p;
    if (is_outside_ball(instance.size.x, center, p)) {
      return cone_pdf(one_minus_cos_of(sqr(instance.size.x) / length_squared(center - p)));
    }
  }
  float pdf_area = is_mesh(instance.shape) ? 1.0f / scene.meshes[instance.mesh].area : 0.0f;
  if (!is_mesh(instance.shape)) {
    const Affine3f X_WG = pose_at(instance, time);
    pdf_area =
        instance.shape == ShapeType::kBox
            ? box_pdf_from(instance.size, to_frame(X_WG, p - X_WG.p), to_frame(X_WG, hit_normal))
            : shape_pdf(instance.shape, instance.size, to_frame(X_WG, hit_p - X_WG.p));
  }
  const Vec3f to = hit_p - p;
  const float d2 = dot(to, to), cosine = fabsf(dot(to, hit_normal)) / sqrtf(d2);
  return cosine > 1e-6f ? pdf_area * d2 / cosine : 0.0f;
}

/// A point of a mesh, by area: the triangle by u.x, the point on it by what is left of u.x and by
/// u.y; `hit` tells where. Returns its density per area.
template <class F>
GLOAM_HD F sample_mesh(const MeshView& mesh, const Affine3f& X_WG, Vec2Of<F> u, F time,
                       RayHitOf<F>* hit, EmitterPointOf<F>* at) {
  const float* sums = mesh.area_cdf.data;
  const uint32_t count = mesh.area_cdf.size - 1;
  UintOf<F> low = 0u;  // the last triangle that begins no later than u.x
  uint32_t step = 1;
  while (step < count) step *= 2;
  for (; step > 0; step /= 2) {
    const UintOf<F> middle = low + step;
    const MaskOf<F> inside = UintOf<F>(count) > middle;
    const F begin = gather(sums, select(inside, middle, UintOf<F>(0u)));
    low = select(inside & (begin <= u.x), middle, low);
  }
  const F begin = gather(sums, low), end = gather(sums, low + 1u);
  u.x = rest_of(u.x, begin, max(end - begin, 1e-30f));
  hit->primitive = low;
  // Heitz 2019, "A low-distortion map between triangle and square".
  const MaskOf<F> upper = u.y > u.x;
  const F half = 0.5f * select(upper, u.x, u.y);
  hit->u = select(upper, half, u.x - half);
  hit->v = select(upper, u.y - half, half);
  Vec3Of<F> corner[3];
  for (uint32_t k = 0; k < 3; ++k) {
    corner[k] = mesh_vertices(mesh, gather(mesh.indices.data, low * 3u + k), time);
  }
  const Vec3Of<F> e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
  const AffineOf<F> X = pose_in_all_lanes<F>(X_WG);
  at->p_G = corner[0] + e1 * hit->u + e2 * hit->v;
  at->p_W = transform_point(X, at->p_G);
  at->n_W = normalize(transform_vector(X, cross(e1, e2)));
  return 1.0f / mesh.area;
}

/// Samples any emitting instance: moving, textured, of whatever shape.
GLOAM_HD LightSample sample_instance(const SceneView& scene, const LightView& light, Vec3f p,
                                     Vec2f u, float time) {
  LightSample s;
  const InstanceView& instance = scene.instances[light.instance];
  const MaterialView& material = scene.materials[instance.material];
  const Affine3f X_WG = pose_at(instance, time);
  RayHit hit;
  EmitterPoint at;
  if (instance.shape == ShapeType::kSphere && is_outside_ball(instance.size.x, X_WG.p, p)) {
    s = sample_ball(instance.size.x, X_WG.p, p, u, &at.n_W);
    at.p_G = to_frame(X_WG, at.n_W) * instance.size.x;
  } else {
    float pdf_area;
    if (instance.shape == ShapeType::kBox) {
      pdf_area = sample_box(instance.size, X_WG, p, u, &at);
    } else if (is_mesh(instance.shape)) {
      pdf_area = sample_mesh(scene.meshes[instance.mesh], X_WG, u, time, &hit, &at);
    } else {
      Vec3f n_G;
      at.p_G = sample_shape(instance.shape, instance.size, u, &n_G);
      at.p_W = transform_point(X_WG, at.p_G);
      at.n_W = transform_vector(X_WG, n_G);
      pdf_area = shape_pdf(instance.shape, instance.size, at.p_G);
    }
    s = aim_at(at, pdf_area, !is_mesh(instance.shape) || material.emits_outwards, p);
  }
  Surface surface;
  surface.emission = material.emission;
  surface.opacity = material.opacity;
  if (material.textured) {
    surface.geometric = surface.normal = at.n_W;
    surfaces::apply_textures(scene, instance, hit, X_WG, at.p_G, 0.0f, time, &surface);
  }
  s.radiance = surface.emission * surface.opacity;
  if (max_component(s.radiance) <= 0) s.pdf = 0;
  return s;
}

}  // namespace lights

/// A direction from p towards light `index` for the `active` lanes; the density does not include
/// its selection.
template <class F>
GLOAM_HD_LARGE LightSampleOf<F> sample_one_light(const SceneView& scene, uint32_t index,
                                                 Vec3Of<F> p, Vec2Of<F> u, F time,
                                                 MaskOf<F> active = true) {
  const LightView& light = scene.lights[index];
  LightSampleOf<F> s;
  if (!kPlainScenes && light.first_key >= 0) {
    each_lane(active, [&](int i) {
      const LightView now = light_at(scene, light, lane(time, i));
      set_lane(&s, i,
               now.kind == LightKind::kDirectional
                   ? lights::sample_sun(now, lane(u, i))
                   : lights::sample_lamp(scene, now, lane(p, i), lane(u, i)));
    });
  } else if (light.kind == LightKind::kDirectional) {
    s = lights::sample_sun(light, u);
  } else if (kPlainScenes || light.kind != LightKind::kInstance) {
    s = lights::sample_lamp(scene, light, p, u);
  } else if (light.is_sheet) {
    s = lights::sample_sheet(light, p, u);
  } else {
    const InstanceView& instance = scene.instances[light.instance];
    const MaterialView& material = scene.materials[instance.material];
    const bool is_box = instance.shape == ShapeType::kBox;
    if ((is_box || is_mesh(instance.shape)) && !instance.moving && !material.textured) {
      RayHitOf<F> hit;
      lights::EmitterPointOf<F> at;
      const F pdf_area = is_box ? lights::sample_box(instance.size, instance.X_WG, p, u, &at)
                                : lights::sample_mesh(scene.meshes[instance.mesh], instance.X_WG, u,
                                                      time, &hit, &at);
      s = lights::aim_at(at, pdf_area, is_box || material.emits_outwards, p);
      s.radiance = in_all_lanes<F>(material.emission * material.opacity);
    } else {
      each_lane(active, [&](int i) {
        set_lane(&s, i,
                 lights::sample_instance(scene, light, lane(p, i), lane(u, i), lane(time, i)));
      });
    }
  }
  if (scene.has_flicker() && light.levels >= 0) {
    each_lane(active, [&](int i) {
      const float level = level_at(scene, light.levels, lane(time, i));
      set_lane(&s.radiance, i, lane(s.radiance, i) * level);
      if (!(level > 0)) set_lane(&s.pdf, i, 0.0f);
    });
  }
  s.casts_shadow = light.casts_shadow;
  // Lights that no ray can hit are found by light sampling alone.
  if (!light.casts_shadow && light.kind != LightKind::kInstance) s.is_delta = true;
  return s;
}

/// Turns `ray` into the shadow ray from the surface point p, found at distance t, to the light. It
/// aims from its own, moved origin at a point just off the light: along the old direction it would
/// meet the light's surface too soon where that is close and slanted.
template <class F>
GLOAM_HD void aim_shadow_ray(Vec3Of<F> p, Vec3Of<F> geometric, F t, const LightSampleOf<F>& light,
                             RayOf<F>* ray) {
  ray->o = leave_surface(p, geometric, light.wi, t);
  const Vec3Of<F> to = p - ray->o + light.wi * light.distance + light.lift;
  const F distance = length(to);
  ray->d = select<F>(distance > 0.0f, to / distance, light.wi);
  ray->tmax = distance * 0.9999f;
}

#if !defined(__CUDACC__) && \
    !defined(GLOAM_LARGE_IN_PLACE)  // instantiated in render/cpu/kernels/lights.cc
extern template LightSample sample_one_light<float>(const SceneView&, uint32_t, Vec3f, Vec2f, float,
                                                    bool);
extern template LightSampleOf<FloatLanes> sample_one_light<FloatLanes>(const SceneView&, uint32_t,
                                                                       Vec3Of<FloatLanes>,
                                                                       Vec2Of<FloatLanes>,
                                                                       FloatLanes, MaskLanes);
#endif

}  // namespace gloam

#pragma once
// Lights: sample a direction towards one, its density, and the radiance of what a ray meets. The
// luminous spheres of lamps and the disc of a sun are seen in reflections, do not block rays, and
// are not shown to the camera. Device-safe.

#include "render/kernel/shapes.h"
#include "render/kernel/surface.h"

namespace gloam {

struct LightSample {
  Vec3f wi;            ///< unit, from the surface to the light
  float distance = 0;  ///< [m]
  Vec3f lift;          ///< moves the point on the light off its surface [m]
  Vec3f radiance;      ///< [cd/m²]; delta lights: illuminance on a facing surface [lx]
  float pdf = 0;       ///< per solid angle, selection included; delta: of the selection; 0 = none
  bool is_delta = false;
  bool casts_shadow = true;
};

/// Share of a lamp's full intensity in the direction from its centre to p.
GLOAM_HD float spot_falloff(const LightView& light, Vec3f to_p) {
  if (light.kind != LightKind::kSpot) return 1.0f;
  const float cosine = dot(light.direction, to_p);
  if (cosine <= light.cos_cutoff) return 0.0f;
  if (cosine >= light.cos_inner) return 1.0f;
  const float angle = acosf(clamp(cosine, -1.0f, 1.0f));
  const float x = (light.cutoff - angle) / max(light.cutoff - light.inner, 1e-6f);
  return x * x * (3.0f - 2.0f * x);
}

namespace lights {

GLOAM_HD LightSample sample_lamp(const LightView& light, Vec3f p, Vec2f u) {
  LightSample s;
  const Vec3f to = light.p - p;
  const float d2 = max(dot(to, to), 1e-12f), d = sqrtf(d2);
  const Vec3f axis = to / d;
  const Vec3f intensity = light.intensity * spot_falloff(light, -axis);
  if (max_component(intensity) <= 0) return s;
  const float r2 = light.radius * light.radius;
  if (light.is_delta || d2 <= r2 * 1.0001f) {  // within the sphere it acts as a point
    s.wi = axis;
    s.distance = d;
    s.radiance = intensity / max(d2, r2);
    s.pdf = 1;
    s.is_delta = true;
    return s;
  }
  const float one_minus_cos = one_minus_cos_of(r2 / d2);
  s.wi = Frame::from_z(axis).to_world(sample_cone(one_minus_cos, u));
  const float along = dot(to, s.wi);
  s.distance = along - safe_sqrt(r2 - max(d2 - along * along, 0.0f));
  s.radiance = intensity / (kPi * r2);
  s.pdf = cone_pdf(one_minus_cos);
  return s;
}

GLOAM_HD LightSample sample_sun(const LightView& light, Vec2f u) {
  LightSample s;
  s.distance = 1e7f;
  const Vec3f axis = -light.direction;
  if (light.is_delta) {
    s.wi = axis;
    s.radiance = light.intensity;
    s.pdf = 1;
    s.is_delta = true;
    return s;
  }
  const float sin2 = light.radius * light.radius;
  s.wi = Frame::from_z(axis).to_world(sample_cone(one_minus_cos_of(sin2), u));
  s.radiance = light.intensity / (kPi * sin2);
  s.pdf = cone_pdf(one_minus_cos_of(sin2));
  return s;
}

GLOAM_HD Vec3f to_instance(const Affine3f& X_WG, Vec3f v) {
  return {dot(v, X_WG.x), dot(v, X_WG.y), dot(v, X_WG.z)};
}

/// Density per solid angle at p of the direction to a point of an emitting instance.
GLOAM_HD float instance_pdf(const SceneView& scene, const InstanceView& instance, Vec3f p,
                            Vec3f hit_p, Vec3f hit_normal, float time) {
  if (instance.shape == ShapeType::kSphere) {
    const Vec3f to = pose_at(instance, time).p - p;
    const float d2 = dot(to, to), r2 = sqr(instance.size.x);
    if (d2 > r2 * 1.0001f) return cone_pdf(one_minus_cos_of(r2 / d2));
  }
  const bool is_mesh =
      instance.shape == ShapeType::kMesh || instance.shape == ShapeType::kDeformable;
  float pdf_area = is_mesh ? 1.0f / scene.meshes[instance.mesh].area : 0.0f;
  if (!is_mesh) {
    const Affine3f X_WG = pose_at(instance, time);
    pdf_area = instance.shape == ShapeType::kBox
                   ? box_pdf_from(instance.size, to_instance(X_WG, p - X_WG.p),
                                  to_instance(X_WG, hit_normal))
                   : shape_pdf(instance.shape, instance.size, to_instance(X_WG, hit_p - X_WG.p));
  }
  const Vec3f to = hit_p - p;
  const float d2 = dot(to, to), cosine = fabsf(dot(to, hit_normal)) / sqrtf(d2);
  return cosine > 1e-6f ? pdf_area * d2 / cosine : 0.0f;
}

GLOAM_HD LightSample sample_instance(const SceneView& scene, const LightView& light, Vec3f p,
                                     float pick, Vec2f u, float time) {
  LightSample s;
  const InstanceView& instance = scene.instances[light.instance];
  const MaterialView& material = scene.materials[instance.material];
  const Affine3f X_WG = pose_at(instance, time);
  RayHit hit;
  Vec3f p_W, n_W, p_G;
  if (instance.shape == ShapeType::kMesh || instance.shape == ShapeType::kDeformable) {
    const MeshView& mesh = scene.meshes[instance.mesh];
    uint32_t low = 0, high = mesh.area_cdf.size - 1;
    while (low < high) {
      const uint32_t middle = (low + high) / 2;
      if (pick < mesh.area_cdf[middle]) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    hit.primitive = low;
    const float root = sqrtf(u.x);
    hit.u = root * (1.0f - u.y);
    hit.v = root * u.y;
    const uint32_t* index = mesh.indices.data + 3 * static_cast<size_t>(low);
    const Vec3f a = mesh_vertex(mesh, index[0], time);
    const Vec3f e1 = mesh_vertex(mesh, index[1], time) - a;
    const Vec3f e2 = mesh_vertex(mesh, index[2], time) - a;
    p_G = a + e1 * hit.u + e2 * hit.v;
    p_W = transform_point(X_WG, p_G);
    n_W = normalize(transform_vector(X_WG, cross(e1, e2)));
  } else if (const float d2 = length_squared(X_WG.p - p), r2 = sqr(instance.size.x);
             instance.shape == ShapeType::kSphere && d2 > r2 * 1.0001f) {
    const Frame frame = Frame::from_z((X_WG.p - p) / sqrtf(d2));
    const Vec3f wi = frame.to_world(sample_cone(one_minus_cos_of(r2 / d2), u));
    const float along = dot(X_WG.p - p, wi);
    p_W = p + wi * (along - safe_sqrt(r2 - max(d2 - along * along, 0.0f)));
    n_W = normalize(p_W - X_WG.p);
    p_G = to_instance(X_WG, n_W) * instance.size.x;
  } else {
    Vec3f n_G;
    if (instance.shape != ShapeType::kBox) {
      p_G = sample_shape(instance.shape, instance.size, pick, u, &n_G);
    } else if (!sample_box_from(instance.size, to_instance(X_WG, p - X_WG.p), pick, u, &p_G,
                                &n_G)) {
      return s;
    }
    p_W = transform_point(X_WG, p_G);
    n_W = transform_vector(X_WG, n_G);
  }
  const Vec3f to = p_W - p;
  s.distance = length(to);
  if (!(s.distance > 1e-6f)) return s;
  s.wi = to / s.distance;
  Surface surface;
  surface.instance = &instance;
  surface.material = &material;
  surface.outside = dot(s.wi, n_W) < 0;
  surface.emission = material.emission;
  if (material.textured) {
    surface.normal = n_W;
    surfaces::apply_textures(scene, hit, X_WG, p_G, 0.0f, time, &surface);
  }
  s.radiance = surface_emission(surface) * surface.opacity;
  if (max_component(s.radiance) <= 0) return s;
  s.pdf = instance_pdf(scene, instance, p, p_W, n_W, time);
  s.lift = leave_surface(p_W, n_W, -s.wi, 0.0f) - p_W;
  return s;
}

}  // namespace lights

/// A direction from p to light `index`; the density does not include its selection.
GLOAM_HD LightSample sample_one_light(const SceneView& scene, uint32_t index, Vec3f p, float pick,
                                      Vec2f u, float time) {
  const LightView& light = scene.lights[index];
  LightSample s = light.kind == LightKind::kInstance
                      ? lights::sample_instance(scene, light, p, pick, u, time)
                  : light.kind == LightKind::kDirectional ? lights::sample_sun(light, u)
                                                          : lights::sample_lamp(light, p, u);
  s.casts_shadow = light.casts_shadow;
  // What cannot be hit must be found here alone.
  if (!light.casts_shadow) s.is_delta = s.is_delta || light.kind != LightKind::kInstance;
  return s;
}

/// Turns `ray` into the shadow ray from the surface to the light. It aims from its own, moved
/// origin at a point just off the light: along the old direction it would meet the light's surface
/// too soon where that is close and slanted.
GLOAM_HD void aim_shadow_ray(const Surface& s, const LightSample& light, Ray* ray) {
  ray->o = leave_surface(s.p, s.geometric, light.wi, s.t);
  const Vec3f to = s.p - ray->o + light.wi * light.distance + light.lift;
  const float distance = length(to);
  ray->d = distance > 0 ? to / distance : light.wi;
  ray->tmax = distance * 0.9999f;
}

/// Scenes with more lights select by power alone.
inline constexpr uint32_t kMaxWeighedLights = 16;

/// A bound, up to a factor, of what light i brings to the surface at p with the geometric normal n
/// if nothing is in between; zero only if it brings nothing.
GLOAM_HD float light_weight(const LightView& light, Vec3f p, Vec3f n) {
  if (light.kind == LightKind::kDirectional) {
    const float cosine = -dot(light.direction, n);
    return cosine > -light.radius ? light.strength * (max(cosine, 0.0f) + 0.05f) : 0.0f;
  }
  const Vec3f to = light.p - p;
  const float height = dot(to, n) + light.reach;
  if (height <= 0) return 0.0f;
  const float d2 = max(dot(to, to), light.reach * light.reach);
  const float inv_d2 = 1.0f / max(d2, 1e-8f);
  const float cosine = min(height * sqrtf(inv_d2), 1.0f);
  // Outside the cone of a spot nothing arrives.
  const float cone = light.kind == LightKind::kSpot
                         ? spot_falloff(light, -to / sqrtf(max(dot(to, to), 1e-12f)))
                         : 1.0f;
  return light.strength * inv_d2 * (cosine + 0.05f) * cone;
}

/// How lights are taken at one surface: in proportion to light_weight where there are few, by power
/// alone where there are many.
class LightPicker {
 public:
  /// For the surface at p with the geometric normal n.
  GLOAM_HD void prepare(const SceneView& scene, Vec3f p, Vec3f n) {
    count_ = scene.lights.size;
    sky_ = {};
    sky_share_ = 0;
    if (count_ > kMaxWeighedLights) return;
    const LightGuide& guide = scene.guide;
    const int row = guide.row_at(p, n);
    const float* visible =
        row >= 0 ? guide.visible.data + static_cast<size_t>(row) * guide.lights : nullptr;
    float total = 0;
    for (uint32_t i = 0; i < count_; ++i) {
      const LightView& light = scene.lights[i];
      share_[i] = light_weight(light, p, n);
      if (visible != nullptr && light.guide >= 0) share_[i] *= visible[light.guide];
      total += share_[i];
    }
    if (row >= 0 && guide.sky[row].strength > 0) {
      sky_ = guide.sky[row];
      const float reach = sqrtf(min(2.0f * sky_.one_minus_cos, 1.0f));
      const float cosine = dot(sky_.axis, n) + reach;
      if (cosine > 0) total += sky_share_ = sky_.strength * (min(cosine, 1.0f) + 0.05f);
    }
    if (!(total > 0)) {
      count_ = 0;  // nothing can arrive
      return;
    }
    const float inverse = 1.0f / total;
    for (uint32_t i = 0; i < count_; ++i) share_[i] *= inverse;
    sky_share_ *= inverse;
  }

  /// Density with which sample() makes the direction d for its sky.
  GLOAM_HD float sky_pdf(Vec3f d) const {
    const bool inside = sky_share_ > 0 && dot(d, sky_.axis) >= 1.0f - sky_.one_minus_cos;
    return inside ? sky_share_ * cone_pdf(sky_.one_minus_cos) : 0.0f;
  }

  /// Probability of taking light i.
  GLOAM_HD float probability(const SceneView& scene, uint32_t i) const {
    if (count_ > kMaxWeighedLights) return scene.lights[i].probability;
    return i < count_ ? share_[i] : 0.0f;
  }

  /// Takes a light, or the sky, and a direction from p towards it. `spread`: of the sky's cone.
  GLOAM_HD LightSample sample(const SceneView& scene, Vec3f p, float pick, Vec2f u, float time,
                              float spread) const {
    if (sky_share_ > 0) {
      if (pick < sky_share_) return sample_sky(scene, u, spread);
      pick -= sky_share_;
    }
    if (count_ == 0) return {};
    float before = 0, taken = 0;
    uint32_t index = 0;
    if (count_ > kMaxWeighedLights) {
      uint32_t high = count_ - 1;
      while (index < high) {
        const uint32_t middle = (index + high) / 2;
        if (pick < scene.lights[middle].cdf) {
          high = middle;
        } else {
          index = middle + 1;
        }
      }
      taken = scene.lights[index].probability;
      before = scene.lights[index].cdf - taken;
    } else {
      for (uint32_t i = 0; i < count_; ++i) {
        if (!(share_[i] > 0)) continue;
        before += taken;
        taken = share_[i];
        index = i;
        if (pick < before + taken) break;
      }
      if (!(taken > 0)) return {};
    }
    pick = clamp((pick - before) / taken, 0.0f, 0.9999999f);
    LightSample s = sample_one_light(scene, index, p, pick, u, time);
    s.pdf *= taken;
    return s;
  }

 private:
  GLOAM_HD LightSample sample_sky(const SceneView& scene, Vec2f u, float spread) const {
    LightSample s;
    s.wi = Frame::from_z(sky_.axis).to_world(sample_cone(sky_.one_minus_cos, u));
    s.distance = 1e7f;
    s.radiance = sky_radiance(scene, s.wi, spread) + scene.sky_ambient;
    s.pdf = sky_pdf(s.wi);
    return s;
  }

  uint32_t count_ = 0;
  float share_[kMaxWeighedLights];
  SkyCone sky_;
  float sky_share_ = 0;
};

/// Light of lamps and suns that a scattered ray meets before `tmax`, each weighted against
/// `picker` at `from`, the surface that scattered it, by the density `pdf_bsdf` of its direction.
GLOAM_HD Vec3f visible_lights(const SceneView& scene, const Ray& ray, float tmax, Vec3f from,
                              const LightPicker& picker, float pdf_bsdf) {
  Vec3f sum;
  for (uint32_t i = 0; i < scene.lights.size; ++i) {
    const LightView& light = scene.lights[i];
    if (light.is_delta || !light.casts_shadow || light.kind == LightKind::kInstance) continue;
    Vec3f radiance;
    float sin2 = light.radius * light.radius;
    if (light.kind == LightKind::kDirectional) {
      if (tmax < 1e29f || -dot(ray.d, light.direction) < 1.0f - one_minus_cos_of(sin2)) continue;
      radiance = light.intensity / (kPi * sin2);
    } else {
      const float t = enter_sphere(ray, light.p, light.radius);
      if (t <= 0 || t >= tmax) continue;
      const Vec3f to = light.p - from;
      const float d2 = dot(to, to);
      if (d2 <= sin2 * 1.0001f) continue;
      radiance = light.intensity * (spot_falloff(light, -to / sqrtf(d2)) / (kPi * sin2));
      sin2 /= d2;
    }
    const float pdf = picker.probability(scene, i) * cone_pdf(one_minus_cos_of(sin2));
    sum += radiance * mis_weight(pdf_bsdf, pdf);
  }
  return sum;
}

}  // namespace gloam

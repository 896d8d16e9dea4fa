#pragma once
// The exact channels: what stands at the ray through a pixel's centre. Device-safe.

#include "render/kernel/camera.h"

namespace gloam {

struct ExactChannels {
  float depth = INFINITY;     ///< along the optical axis [m]
  float distance = INFINITY;  ///< along the ray [m]
  uint32_t part = 0;          ///< instance + 1; 0 = nothing
  Vec3f normal, albedo;
  Vec2f motion;  ///< [px]
};

/// Whether the exact channels stop at a surface: what is evenly transparent is a thing, as MuJoCo
/// draws it; holes in an opacity texture are not.
GLOAM_HD bool shows(const SceneView& scene, const Surface& s) {
  return s.opacity >= 0.5f || scene.materials[scene.instances[s.instance].material].opacity < 1.0f;
}

/// The first surface along the ray that shows, and the distance to it.
template <class Tracer>
GLOAM_HD bool find_first(const SceneView& scene, const Tracer& tracer, Ray ray, RayCone cone,
                         Surface* s, RayHit* hit, uint32_t* rays) {
  float passed_distance = 0;
  for (int passed = 0; passed < 64; ++passed) {
    ++*rays;
    if (!tracer.trace(ray, false, hit)) return false;
    *s = make_surface(scene, ray, *hit, cone);
    if (shows(scene, *s)) {
      s->t = hit->t += passed_distance;
      return true;
    }
    passed_distance += hit->t;
    ray.o = leave_surface(s->p, s->geometric, ray.d, hit->t);
  }
  return false;
}

/// Where the point of the surface was at the previous frame.
GLOAM_HD Vec3f previous_point(const SceneView& scene, const Surface& s, const RayHit& hit) {
  const InstanceView& instance = scene.instances[s.instance];
  if (instance.shape == ShapeType::kDeformable) {
    const MeshView& mesh = scene.meshes[instance.mesh];
    const uint32_t* index = mesh.indices.data + 3 * static_cast<size_t>(hit.primitive);
    return mesh.positions_previous[index[0]] * (1.0f - hit.u - hit.v) +
           mesh.positions_previous[index[1]] * hit.u + mesh.positions_previous[index[2]] * hit.v;
  }
  if (!instance.has_moved) return s.p;
  return transform_point(instance.X_WG_previous, transform_point(inverse(instance.X_WG), s.p));
}

/// Channels of the surface seen (at shutter open) through the pixel (x, y).
GLOAM_HD ExactChannels describe_surface(const SceneView& scene, const CameraView32& camera,
                                        const Ray& ray, const Surface& s, const RayHit& hit) {
  ExactChannels c;
  c.distance = dot(s.p - ray.o, ray.d);
  const Vec3f axis = camera.pose.X_WC_open.z;
  c.depth = -dot(s.p - camera.pose.X_WC_open.p, axis);
  c.part = s.instance + 1;
  c.normal = s.normal;
  c.albedo = s.base_color;
  Vec2f now, before;
  if (project(camera, camera.pose.X_WC_open, s.p, &now) &&
      project(camera, camera.pose.X_WC_previous, previous_point(scene, s, hit), &before)) {
    c.motion = now - before;
  }
  return c;
}

/// Channels where nothing stands: the sky moves only as the camera turns.
GLOAM_HD ExactChannels describe_sky(const CameraView32& camera, const Ray& ray) {
  ExactChannels c;
  Vec2f now, before;
  if (!camera.orthographic &&
      project(camera, camera.pose.X_WC_open, camera.pose.X_WC_open.p + ray.d, &now) &&
      project(camera, camera.pose.X_WC_previous, camera.pose.X_WC_previous.p + ray.d, &before)) {
    c.motion = now - before;
  }
  return c;
}

}  // namespace gloam

#pragma once
// The exact channels: what stands at the ray through a pixel's centre. Device-safe.

#include "render/kernel/camera.h"

namespace gloam {

struct ExactChannels {
  float depth = INFINITY;     ///< along the optical axis, of wide lenses along the ray [m]
  float distance = INFINITY;  ///< along the ray [m]
  uint32_t part = 0;          ///< instance + 1; 0 = nothing
  Vec3f normal, albedo;
  Vec2f motion;      ///< [px]
  Vec3f scene_flow;  ///< of the surface's point since the previous frame, world [m]
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

/// Where the point of the surface that is seen at `time` was at the previous frame.
GLOAM_HD Vec3f previous_point(const SceneView& scene, const Surface& s, const RayHit& hit,
                              float time) {
  const InstanceView& instance = scene.instances[s.instance];
  if (instance.shape == ShapeType::kDeformable) {
    const MeshView& mesh = scene.meshes[instance.mesh];
    const uint32_t* index = mesh.indices.data + 3 * static_cast<size_t>(hit.primitive);
    return mesh.positions_previous[index[0]] * (1.0f - hit.u - hit.v) +
           mesh.positions_previous[index[1]] * hit.u + mesh.positions_previous[index[2]] * hit.v;
  }
  if (!instance.has_moved && !instance.moving) return s.p;
  Affine3f between;
  const Affine3f& X_WG = pose_at(instance, time, &between);
  return transform_point(instance.X_WG_previous, transform_point(inverse(X_WG), s.p));
}

/// The way from one point of the picture to another; a full panorama has no edge to its sides.
GLOAM_HD Vec2f flow(const CameraView32& camera, Vec2f before, Vec2f now) {
  Vec2f way = now - before;
  if (camera.lens.model == LensModel::kEquirectangular) {
    const float turn = 2.0f * kPi * camera.fx;
    way.x -= turn * floorf(way.x / turn + 0.5f);
  }
  return way;
}

/// Channels of the surface that the ray through a pixel's centre meets, at the ray's time.
GLOAM_HD ExactChannels describe_surface(const SceneView& scene, const CameraView32& camera,
                                        const Ray& ray, const Surface& s, const RayHit& hit) {
  ExactChannels c;
  const Affine3f X_WC = camera_pose_at(camera.pose, ray.time);
  c.distance = dot(s.p - ray.o, ray.d);
  c.depth = is_wide(camera.lens.model) ? c.distance : -dot(s.p - X_WC.p, X_WC.z);
  c.part = s.instance + 1;
  c.normal = s.normal;
  c.albedo = s.base_color;
  const Vec3f p_before = previous_point(scene, s, hit, ray.time);
  c.scene_flow = s.p - p_before;
  Vec2f now, before;
  if (project(camera, X_WC, s.p, &now) &&
      project(camera, camera.pose.X_WC_previous, p_before, &before)) {
    c.motion = flow(camera, before, now);
  }
  return c;
}

/// Channels where nothing stands: the sky moves only as the camera turns.
GLOAM_HD ExactChannels describe_sky(const CameraView32& camera, const Ray& ray) {
  ExactChannels c;
  const Affine3f X_WC = camera_pose_at(camera.pose, ray.time);
  Vec2f now, before;
  if (!camera.orthographic && sees(ray) && project(camera, X_WC, X_WC.p + ray.d, &now) &&
      project(camera, camera.pose.X_WC_previous, camera.pose.X_WC_previous.p + ray.d, &before)) {
    c.motion = flow(camera, before, now);
  }
  return c;
}

}  // namespace gloam

#pragma once
// The exact channels: what stands at the ray through a pixel's centre. Device-safe.

#include "render/kernel/camera/camera.h"

namespace gloam {

template <class F>
struct ExactChannelsOf {
  F depth = INFINITY;     ///< along the optical axis, of wide lenses along the ray [m]
  F distance = INFINITY;  ///< along the ray [m]
  UintOf<F> part = 0u;    ///< instance + 1; 0 = nothing
  Vec3Of<F> center_normal, center_albedo;
  Vec2Of<F> motion;      ///< [px]
  Vec3Of<F> scene_flow;  ///< of the surface's point since the previous frame, world [m]
};
using ExactChannels = ExactChannelsOf<float>;

/// Calls visit(plane of each) for the channels of one or more ExactChannels, Films or DeviceFilms:
/// where a surface is and which, and the details.
template <class Visit, class... Planes>
GLOAM_HD void visit_places(const Visit& visit, Planes&... planes) {
  visit(planes.depth...);
  visit(planes.distance...);
  visit(planes.part...);
}
template <class Visit, class... Planes>
GLOAM_HD void visit_details(const Visit& visit, Planes&... planes) {
  visit(planes.center_normal...);
  visit(planes.center_albedo...);
  visit(planes.motion...);
  visit(planes.scene_flow...);
}

template <class F>
GLOAM_HD ExactChannels lane(const ExactChannelsOf<F>& c, int i) {
  ExactChannels out;
  const auto get = [i](auto& to, const auto& from) { to = lane(from, i); };
  visit_places(get, out, c);
  visit_details(get, out, c);
  return out;
}

/// Whether the exact channels stop at a surface: evenly transparent surfaces count as things, as
/// MuJoCo renders them; holes in an opacity texture do not, nor surfaces that colour pictures alone
/// show.
GLOAM_HD bool shows(const SceneView& scene, const Surface& s) {
  if (scene.instances[s.instance].color_only) return false;
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

/// Position at the previous frame of the point p of a surface that is seen at `time`.
GLOAM_HD Vec3f previous_point(const SceneView& scene, Vec3f p, const RayHit& hit, float time) {
  const InstanceView& instance = scene.instances[hit.instance];
  if (instance.shape == ShapeType::kDeformable) {
    const MeshView& mesh = scene.meshes[instance.mesh];
    const uint32_t* index = mesh.indices.data + 3 * static_cast<size_t>(hit.primitive);
    return mesh.positions_previous[index[0]] * (1.0f - hit.u - hit.v) +
           mesh.positions_previous[index[1]] * hit.u + mesh.positions_previous[index[2]] * hit.v;
  }
  if (!instance.has_moved && !instance.moving) return p;
  Affine3f between;
  const Affine3f& X_WG = pose_at(instance, time, &between);
  return transform_point(instance.X_WG_previous, transform_point(inverse(X_WG), p));
}
/// The same of the surfaces in the `found` lanes.
template <class F>
GLOAM_HD Vec3Of<F> previous_points(const SceneView& scene, Vec3Of<F> p, const RayHitOf<F>& hit,
                                   F time, MaskOf<F> found) {
  Vec3Of<F> before = p;
  each_value(found, hit.instance, [&](MaskOf<F> same, uint32_t row) {
    const InstanceView& instance = scene.instances[row];
    const bool deforms = instance.shape == ShapeType::kDeformable;
    if (deforms || instance.moving) {
      each_lane(same, [&](int i) {
        set_lane(&before, i, previous_point(scene, lane(p, i), lane(hit, i), lane(time, i)));
      });
    } else if (instance.has_moved) {
      const AffineOf<F> X_GW = pose_in_all_lanes<F>(inverse(instance.X_WG));
      const AffineOf<F> X_WG_previous = pose_in_all_lanes<F>(instance.X_WG_previous);
      before = select<F>(same, transform_point(X_WG_previous, transform_point(X_GW, p)), before);
    }
  });
  return before;
}

/// The way from one point of the picture to another; a full panorama has no edge to its sides.
template <class F>
GLOAM_HD Vec2Of<F> flow(const CameraView32& camera, Vec2Of<F> before, Vec2Of<F> now) {
  Vec2Of<F> way = now - before;
  if (camera.lens.model == LensModel::kEquirectangular) {
    const float turn = 2.0f * kPi * camera.fx;
    way.x -= turn * floor_of(way.x / turn + 0.5f);
  }
  return way;
}

/// Way in the picture [px] of what the rays of the `active` lanes see: in those of `found` surfaces
/// at p, which were at p_before; in the others the sky, which moves only as the camera turns.
template <class F>
GLOAM_HD Vec2Of<F> find_motion(const CameraView32& camera, const RayOf<F>& ray, Vec3Of<F> p,
                               Vec3Of<F> p_before, MaskOf<F> found, MaskOf<F> active) {
  const CameraPose& pose = camera.pose;
  if (camera.orthographic) active = active & found;
  if (stands_still(pose)) active = active & found & !(p == p_before);
  if (!any(active)) return {};
  p = select<F>(found, p, ray.o + ray.d);
  p_before = select<F>(found, p_before, in_all_lanes<F>(pose.X_WC_previous.p) + ray.d);
  Vec2Of<F> now, before;
  MaskOf<F> seen = false;
  if (pose.keys.empty()) {
    seen = project_points(camera, pose.X_WC_open, p, active, &now);
  } else {
    each_lane(active, [&](int i) {
      Vec2f uv;
      if (!project(camera, camera_pose_at(pose, lane(ray.time, i)), lane(p, i), &uv)) return;
      set_lane(&seen, i, true);
      set_lane(&now, i, uv);
    });
  }
  seen = project_points(camera, pose.X_WC_previous, p_before, seen, &before);
  return select<F>(seen, flow<F>(camera, before, now), Vec2Of<F>{});
}

/// Channels of what the rays through pixels' centres meet, at their times; lanes that are not
/// `found` see the sky. `details`: more than where it is and what it is.
template <class F>
GLOAM_HD ExactChannelsOf<F> describe_surface(const SceneView& scene, const CameraView32& camera,
                                             const RayOf<F>& ray, const SurfaceOf<F>& s,
                                             const RayHitOf<F>& hit, MaskOf<F> found = true,
                                             bool details = true) {
  ExactChannelsOf<F> c;
  const F distance = dot(s.p - ray.o, ray.d);
  F depth = distance;
  if (!is_wide(camera.lens.model)) {
    const Affine3f& open = camera.pose.X_WC_open;
    depth = -dot(s.p - in_all_lanes<F>(open.p), in_all_lanes<F>(open.z));
    each_lane(found & !camera.pose.keys.empty(), [&](int i) {
      const Affine3f X_WC = camera_pose_at(camera.pose, lane(ray.time, i));
      set_lane(&depth, i, -dot(lane(s.p, i) - X_WC.p, X_WC.z));
    });
  }
  c.distance = select(found, distance, c.distance);
  c.depth = select(found, depth, c.depth);
  c.part = select(found, hit.instance + 1u, c.part);
  if (!details) return c;
  c.center_normal = select<F>(found, s.normal, c.center_normal);
  c.center_albedo = select<F>(found, s.base_color, c.center_albedo);
  const Vec3Of<F> before = previous_points(scene, s.p, hit, ray.time, found);
  c.scene_flow = select<F>(found, s.p - before, c.scene_flow);
  c.motion = find_motion(camera, ray, s.p, before, found, ray.tmax > 0.0f);
  return c;
}

/// Channels where nothing stands.
GLOAM_HD ExactChannels describe_sky(const CameraView32& camera, const Ray& ray) {
  ExactChannels c;
  c.motion = find_motion<float>(camera, ray, {}, {}, false, sees(ray));
  return c;
}

}  // namespace gloam

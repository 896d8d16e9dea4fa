#pragma once
// From a hit to the surface there: position, normals, textures, BSDF. Device-safe.

#include "render/kernel/layered_bsdf.h"
#include "render/kernel/shapes.h"
#include "render/kernel/texture.h"
#include "world/texture_coordinates.h"

namespace gloam {

/// How wide a ray is: a cone of `width` [m] at its origin that grows by `spread` [m/m].
template <class F>
struct RayConeOf {
  F width{}, spread{};
};
using RayCone = RayConeOf<float>;

template <class F>
struct SurfaceOf {
  Vec3Of<F> p;               ///< world [m]
  Vec3Of<F> geometric;       ///< unit normal of the geometry, towards the viewer
  Vec3Of<F> normal;          ///< unit shading normal, towards the viewer
  F t{};                     ///< distance at which it was found [m]
  MaskOf<F> outside = true;  ///< seen from the side that normals point to
  UintOf<F> instance{};      ///< row of SceneView::instances
  Vec3Of<F> base_color;
  Vec3Of<F> emission;  ///< towards the viewer: meshes shine to both sides, others outwards
  F metallic{}, roughness{};
  F f0{}, f90{};  ///< as in MaterialView
  F opacity = F(1.0f);
  Vec3Of<F> straight;  ///< of light on what is opaque, the share that goes straight through: sheets
  Vec3Of<F> tangent;   ///< along which highlights are drawn out; zero = they are round
};
using Surface = SurfaceOf<float>;

/// The vector v_A in a frame B whose axes are orthonormal.
template <class F>
GLOAM_HD Vec3Of<F> to_frame(const AffineOf<F>& X_AB, Vec3Of<F> v_A) {
  return {dot(v_A, X_AB.x), dot(v_A, X_AB.y), dot(v_A, X_AB.z)};
}

template <class F>
GLOAM_HD Surface lane(const SurfaceOf<F>& s, int i) {
  return {lane(s.p, i),        lane(s.geometric, i), lane(s.normal, i),     lane(s.t, i),
          lane(s.outside, i),  lane(s.instance, i),  lane(s.base_color, i), lane(s.emission, i),
          lane(s.metallic, i), lane(s.roughness, i), lane(s.f0, i),         lane(s.f90, i),
          lane(s.opacity, i),  lane(s.straight, i),  lane(s.tangent, i)};
}

namespace surfaces {

struct TextureCoordinates {
  Vec2f uv;
  Vec3f direction_G;    ///< for cube textures
  float footprint = 0;  ///< in texture lengths
};

/// Texture lengths per metre along the surface, the mean of both directions, repeats included.
GLOAM_HD float texture_density(const InstanceView& instance, const MaterialView& material) {
  const Vec3f size = instance.size, h = instance.half_size;
  const bool uniform = material.texture_uniform;
  Vec2f scale{0.5f, 0.5f};
  switch (instance.shape) {
    case ShapeType::kSphere:
    case ShapeType::kEllipsoid:
    case ShapeType::kCylinder:
    case ShapeType::kCapsule: {
      const bool round =
          instance.shape == ShapeType::kSphere || instance.shape == ShapeType::kEllipsoid;
      scale = {0.5f * kInvPi / h.x, round ? kInvPi / h.z : 0.5f / size.y};
      if (uniform) scale = {scale.x * size.x, scale.y * size.x};
      break;
    }
    case ShapeType::kPlane:
    case ShapeType::kBox:
    case ShapeType::kMesh:
    case ShapeType::kDeformable:
      if (!uniform && h.x > 0) scale.x /= h.x;
      if (!uniform && h.y > 0) scale.y /= h.y;
      break;
  }
  return sqrtf(scale.x * scale.y * material.texture_repeat.x * material.texture_repeat.y);
}

/// Where the hit lies on the material's textures, by the rules of world/texture_coordinates.h.
/// `n_G` = unit geometric normal in the shape's frame.
GLOAM_HD TextureCoordinates texture_coordinates(const SceneView& scene,
                                                const InstanceView& instance,
                                                const MaterialView& material, const RayHit& hit,
                                                Vec3f p_G, Vec3f n_G, float width) {
  TextureCoordinates out;
  if (material.mapping == TextureMapping::kCube) {
    out.direction_G =
        texture_cube_direction(instance.shape, p_G, instance.size, material.texture_uniform);
    const Vec3f h = instance.half_size;
    const float reach = max(max_component(h), 1e-9f);
    out.footprint = 0.5f * width * length(out.direction_G) / max(length(p_G), 1e-3f * reach) /
                    max(length(out.direction_G), 1e-9f);
    return out;
  }
  const bool has_uv = is_mesh(instance.shape) && !scene.meshes[instance.mesh].uvs.empty();
  Vec2f uv;
  float density = 0;
  if (has_uv) {
    const TriangleUv& t = scene.meshes[instance.mesh].uvs[hit.primitive];
    uv = t.corner[0] * (1.0f - hit.u - hit.v) + t.corner[1] * hit.u + t.corner[2] * hit.v;
    density = t.density * sqrtf(material.texture_repeat.x * material.texture_repeat.y);
    if (material.texture_uniform) density *= sqrtf(instance.size.x * instance.size.y);
  } else {
    density = texture_density(instance, material);
  }
  out.uv = texture_uv(instance.shape, p_G, n_G, instance.size, uv, has_uv, material.texture_repeat,
                      material.texture_uniform);
  out.footprint = width * density;
  return out;
}

GLOAM_HD Rgba lookup(const SceneView& scene, const MaterialView& material, int texture,
                     const TextureCoordinates& at) {
  return material.mapping == TextureMapping::kCube && scene.textures[texture].face_count == 6
             ? lookup_cube(scene, texture, at.direction_G, at.footprint)
             : lookup_2d(scene, texture, at.uv, at.footprint);
}

/// Tangents of increasing u and v in the frame G, not normalised; false where the map is singular.
GLOAM_HD bool tangents(const SceneView& scene, const InstanceView& instance, const RayHit& hit,
                       float time, Vec3f* tangent_u, Vec3f* tangent_v) {
  if (!is_mesh(instance.shape)) {
    *tangent_u = {1, 0, 0};
    *tangent_v = {0, 1, 0};
    return true;
  }
  const MeshView& mesh = scene.meshes[instance.mesh];
  if (mesh.uvs.empty()) return false;
  const uint32_t* index = mesh.indices.data + 3 * static_cast<size_t>(hit.primitive);
  const Vec3f a = mesh_vertex(mesh, index[0], time);
  const Vec3f e1 = mesh_vertex(mesh, index[1], time) - a;
  const Vec3f e2 = mesh_vertex(mesh, index[2], time) - a;
  const TriangleUv& t = mesh.uvs[hit.primitive];
  const Vec2f d1 = t.corner[1] - t.corner[0], d2 = t.corner[2] - t.corner[0];
  const float det = d1.x * d2.y - d2.x * d1.y;
  if (fabsf(det) < 1e-12f) return false;
  *tangent_u = (e1 * d2.y - e2 * d1.y) / det;
  *tangent_v = (e2 * d1.x - e1 * d2.x) / det;
  return true;
}

/// Of the surface `s` of an instance, at p_G in its frame.
GLOAM_HD void apply_textures(const SceneView& scene, const InstanceView& instance,
                             const RayHit& hit, const Affine3f& X_WG, Vec3f p_G, float width,
                             float time, Surface* s) {
  const Vec3f n_G = to_frame(X_WG, s->geometric);
  const MaterialView& m = scene.materials[instance.material];
  const MaterialTextures& map = m.textures;
  const TextureCoordinates at = texture_coordinates(scene, instance, m, hit, p_G, n_G, width);
  if (map.base_color >= 0) {
    const Rgba texel = lookup(scene, m, map.base_color, at);
    s->base_color *= texel.rgb;
    s->emission *= texel.rgb;  // MuJoCo: emission is a share of the surface's own colour
    s->opacity *= texel.a;
  }
  if (map.orm >= 0) {
    const Vec3f orm = lookup(scene, m, map.orm, at).rgb;
    s->roughness *= orm.y;
    s->metallic *= orm.z;
  }
  if (map.roughness >= 0) s->roughness *= lookup(scene, m, map.roughness, at).rgb.x;
  if (map.metallic >= 0) s->metallic *= lookup(scene, m, map.metallic, at).rgb.x;
  if (map.opacity >= 0) s->opacity *= lookup(scene, m, map.opacity, at).rgb.x;
  if (map.emission >= 0) s->emission *= lookup(scene, m, map.emission, at).rgb;
  Vec3f u, v;
  if (map.normal >= 0 && m.mapping == TextureMapping::kUv &&
      tangents(scene, instance, hit, time, &u, &v)) {
    const Vec3f n = lookup(scene, m, map.normal, at).rgb * 2.0f - Vec3f{1, 1, 1};
    const Vec3f x = transform_vector(X_WG, u), y = transform_vector(X_WG, v), z = s->normal;
    const Vec3f tx = x - z * dot(z, x), ty = y - z * dot(z, y);
    if (length_squared(tx) > 0 && length_squared(ty) > 0) {
      s->normal = normalize(normalize(tx) * n.x + normalize(ty) * n.y + z * max(n.z, 0.05f));
    }
  }
}

}  // namespace surfaces

namespace surfaces {

/// What the layers of a material need to know of the place: highlights' direction, clear sheets.
GLOAM_HD void find_layers(const SceneView& scene, const InstanceView& instance, const RayHit& hit,
                          const Affine3f& X_WG, Vec3f d, float time, Surface* s) {
  const int row = scene.materials[instance.material].layers;
  if (row < 0) return;
  const MaterialLayers& m = scene.layers[static_cast<uint32_t>(row)];
  Vec3f u, v;
  if (m.anisotropy > 0 && tangents(scene, instance, hit, time, &u, &v)) {
    const Vec3f across = transform_vector(X_WG, u);
    const Vec3f x = across - s->normal * dot(across, s->normal);
    if (length_squared(x) > 0) {
      const Vec3f t = normalize(x);
      s->tangent = t * m.cos_rotation + cross(s->normal, t) * m.sin_rotation;
    }
  }
  if (m.straight) {
    float cos_t;
    const float f = fresnel_dielectric(fabsf(dot(s->normal, d)), m.ior, &cos_t);
    s->straight = m.tint * (m.transmission * (1.0f - s->metallic) * (1.0f - f) / (1.0f + f));
  }
}

}  // namespace surfaces

/// The surfaces that the lanes of `found` have hit. `cone` is that of the ray at its origin.
template <class F>
GLOAM_HD SurfaceOf<F> make_surface(const SceneView& scene, const RayOf<F>& ray,
                                   const RayHitOf<F>& hit, RayConeOf<F> cone,
                                   MaskOf<F> found = true) {
  SurfaceOf<F> s;
  s.instance = hit.instance;
  s.t = hit.t;
  s.p = ray.o + ray.d * hit.t;

  AffineOf<F> X_WG;
  Vec3Of<F> size, corner[3];  // of the shape; shading normals of a triangle's corners
  MaskOf<F> mesh = false, smooth = false, box = false, moving = false, textured = false;
  MaskOf<F> layered = false;
  each_lane(found, [&](int i) {
    const InstanceView& instance = scene.instances[lane(hit.instance, i)];
    const MaterialView& m = scene.materials[instance.material];
    Affine3f between;
    set_lane(&X_WG, i, pose_at(instance, lane(ray.time, i), &between));
    set_lane(&s.base_color, i, m.base_color);
    set_lane(&s.emission, i, m.emission);
    set_lane(&s.metallic, i, m.metallic);
    set_lane(&s.roughness, i, m.roughness);
    set_lane(&s.f0, i, m.f0);
    set_lane(&s.f90, i, m.f90);
    set_lane(&s.opacity, i, m.opacity);
    if (m.textured) set_lane(&textured, i, true);
    if (m.layers >= 0) set_lane(&layered, i, true);
    if (is_mesh(instance.shape)) {
      set_lane(&mesh, i, true);
      const DeviceSpan<const Vec3f>& normals = scene.meshes[instance.mesh].corner_normals;
      if (normals.empty()) return;
      set_lane(&smooth, i, true);
      const size_t first = 3 * static_cast<size_t>(lane(hit.primitive, i));
      for (int k = 0; k < 3; ++k) set_lane(&corner[k], i, normals.data[first + k]);
    } else {
      if (instance.moving) set_lane(&moving, i, true);
      if (instance.shape == ShapeType::kBox) set_lane(&box, i, true);
      set_lane(&size, i, instance.size);
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
  const MaskOf<F> solid = found & !mesh;
  Vec3Of<F> p_G = to_frame(X_WG, s.p - X_WG.p);
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
  const F cosine = dot(s.geometric, ray.d);
  each_lane(textured, [&](int i) {
    // The footprint is an ellipse; its mean axis keeps near texels sharp without aliasing far ones.
    const float width = (lane(cone.width, i) + lane(cone.spread, i) * lane(hit.t, i)) /
                        sqrtf(max(fabsf(lane(cosine, i)), 0.05f));
    Surface one = lane(s, i);
    surfaces::apply_textures(scene, scene.instances[one.instance], lane(hit, i), lane(X_WG, i),
                             lane(p_G, i), width, lane(ray.time, i), &one);
    set_lane(&s.normal, i, one.normal);
    set_lane(&s.base_color, i, one.base_color);
    set_lane(&s.emission, i, one.emission);
    set_lane(&s.metallic, i, one.metallic);
    set_lane(&s.roughness, i, one.roughness);
    set_lane(&s.opacity, i, one.opacity);
  });
  const MaskOf<F> inside = cosine > 0.0f;
  s.outside = !inside;
  s.emission = select<F>(solid & inside, Vec3Of<F>{}, s.emission);
  s.geometric = select<F>(inside, -s.geometric, s.geometric);
  s.normal = select<F>(inside, -s.normal, s.normal);
  // A shading normal that looks away from the viewer is bent back to just face it: black rims and
  // lost energy otherwise.
  const F facing = -dot(s.normal, ray.d);
  const MaskOf<F> away = facing < 1e-3f;
  if (any(away)) {
    s.normal = select<F>(away, normalize(s.normal - ray.d * (1e-2f - facing)), s.normal);
  }
  each_lane(found & layered, [&](int i) {
    Surface one = lane(s, i);
    surfaces::find_layers(scene, scene.instances[one.instance], lane(hit, i), lane(X_WG, i),
                          lane(ray.d, i), lane(ray.time, i), &one);
    set_lane(&s.straight, i, one.straight);
    set_lane(&s.tangent, i, one.tangent);
  });
  return s;
}

/// Of the light on a surface the share that is met: the rest passes as if nothing were there.
template <class F>
GLOAM_HD F met_share(const SurfaceOf<F>& s) {
  return s.opacity * (1.0f - max_component(s.straight));
}
/// Light that passes straight through the surface.
template <class F>
GLOAM_HD Vec3Of<F> passing_light(const SurfaceOf<F>& s) {
  const F gap = 1.0f - s.opacity;
  return Vec3Of<F>{gap, gap, gap} + s.straight * s.opacity;
}

/// BSDF of the surface for the direction `wo` towards the viewer; `frame` is its shading frame.
template <class F>
GLOAM_HD LayeredBsdfOf<F> surface_bsdf(const SceneView& scene, const SurfaceOf<F>& s, Vec3Of<F> wo,
                                       FrameOf<F>* frame, MaskOf<F> active = true) {
  *frame = FrameOf<F>::from_z(s.normal);
  const MaskOf<F> drawn_out = length_squared(s.tangent) > 0.0f;
  if (any(drawn_out)) {
    const Vec3Of<F> x = normalize(s.tangent - s.normal * dot(s.tangent, s.normal));
    frame->x = select<F>(drawn_out, x, frame->x);
    frame->y = select<F>(drawn_out, cross(s.normal, x), frame->y);
  }
  Vec3Of<F> wo_local = frame->to_local(wo);
  wo_local.z = max(wo_local.z, 1e-4f);
  LayeredBsdfOf<F> bsdf;
  bsdf.base = make_bsdf(*scene.albedo, s.base_color, s.base_color, s.metallic, F(1.0f), s.roughness,
                        s.f0, s.f90, F(0.0f), wo_local);
  if (scene.layers.size > 0) {
    each_lane(active, [&](int i) {
      const int row = scene.materials[scene.instances[lane(s.instance, i)].material].layers;
      if (row < 0) return;
      const SurfaceParameters base{lane(s.base_color, i), lane(s.metallic, i), lane(s.roughness, i),
                                   lane(s.f0, i),         lane(s.f90, i),      lane(s.outside, i)};
      set_lane(
          &bsdf, i,
          make_layered(scene, scene.layers[static_cast<uint32_t>(row)], base, lane(wo_local, i)));
    });
  }
  return bsdf;
}

}  // namespace gloam

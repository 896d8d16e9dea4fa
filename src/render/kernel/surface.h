#pragma once
// From a hit to the surface there: position, normals, textures, BSDF. Device-safe.

#include "render/kernel/bsdf.h"
#include "render/kernel/shapes.h"
#include "render/kernel/texture.h"
#include "world/texture_coordinates.h"

namespace gloam {

/// How wide a ray is: a cone of `width` [m] at its origin that grows by `spread` [m/m].
struct RayCone {
  float width = 0, spread = 0;
};

struct Surface {
  Vec3f p;              ///< world [m]
  Vec3f geometric;      ///< unit normal of the geometry, towards the viewer
  Vec3f normal;         ///< unit shading normal, towards the viewer
  float t = 0;          ///< distance at which it was found [m]
  bool outside = true;  ///< seen from the side that normals point to
  const InstanceView* instance = nullptr;
  const MaterialView* material = nullptr;
  Vec3f base_color, emission;
  float metallic = 0, roughness = 0, opacity = 1;
};

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
  const bool is_mesh =
      instance.shape == ShapeType::kMesh || instance.shape == ShapeType::kDeformable;
  const bool has_uv = is_mesh && !scene.meshes[instance.mesh].uvs.empty();
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
  if (instance.shape != ShapeType::kMesh && instance.shape != ShapeType::kDeformable) {
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

GLOAM_HD void apply_textures(const SceneView& scene, const RayHit& hit, const Affine3f& X_WG,
                             Vec3f p_G, float width, float time, Surface* s) {
  const Vec3f g = s->geometric;
  const Vec3f n_G{dot(g, X_WG.x), dot(g, X_WG.y), dot(g, X_WG.z)};
  const MaterialView& m = *s->material;
  const MaterialTextures& map = m.textures;
  const TextureCoordinates at = texture_coordinates(scene, *s->instance, m, hit, p_G, n_G, width);
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
      tangents(scene, *s->instance, hit, time, &u, &v)) {
    const Vec3f n = lookup(scene, m, map.normal, at).rgb * 2.0f - Vec3f{1, 1, 1};
    const Vec3f x = transform_vector(X_WG, u), y = transform_vector(X_WG, v), z = s->normal;
    const Vec3f tx = x - z * dot(z, x), ty = y - z * dot(z, y);
    if (length_squared(tx) > 0 && length_squared(ty) > 0) {
      s->normal = normalize(normalize(tx) * n.x + normalize(ty) * n.y + z * max(n.z, 0.05f));
    }
  }
}

}  // namespace surfaces

/// `cone` is that of the ray at its origin.
GLOAM_HD Surface make_surface(const SceneView& scene, const Ray& ray, const RayHit& hit,
                              RayCone cone) {
  Surface s;
  s.instance = &scene.instances[hit.instance];
  s.material = &scene.materials[s.instance->material];
  s.t = hit.t;
  s.p = ray.o + ray.d * hit.t;
  Affine3f between;
  const Affine3f& X_WG = pose_at(*s.instance, ray.time, &between);
  Vec3f p_G;
  if (s.instance->shape == ShapeType::kMesh || s.instance->shape == ShapeType::kDeformable) {
    const MeshView& mesh = scene.meshes[s.instance->mesh];
    // Normals of tiny triangles would vanish when squared.
    const float scale = max(fabsf(hit.normal.x), max(fabsf(hit.normal.y), fabsf(hit.normal.z)));
    s.geometric = scale > 0 ? normalize(hit.normal * (1.0f / max(scale, 1e-37f))) : -ray.d;
    s.normal = s.geometric;
    if (!mesh.corner_normals.empty()) {
      const Vec3f* n = mesh.corner_normals.data + 3 * static_cast<size_t>(hit.primitive);
      const Vec3f smooth = n[0] * (1.0f - hit.u - hit.v) + n[1] * hit.u + n[2] * hit.v;
      if (length_squared(smooth) > 1e-8f) s.normal = normalize(transform_vector(X_WG, smooth));
    }
    if (s.material->textured) {
      const Vec3f d = s.p - X_WG.p;
      p_G = {dot(d, X_WG.x), dot(d, X_WG.y), dot(d, X_WG.z)};
    }
  } else {
    const Vec3f d = s.p - X_WG.p;
    p_G = {dot(d, X_WG.x), dot(d, X_WG.y), dot(d, X_WG.z)};
    const Vec3f n_G = snap_to_shape(s.instance->shape, s.instance->size, &p_G);
    s.p = transform_point(X_WG, p_G);
    s.geometric = s.normal = transform_vector(X_WG, n_G);
    if (s.instance->moving) s.geometric = s.normal = normalize(s.normal);  // a mean of two poses
  }
  const MaterialView& m = *s.material;
  s.base_color = m.base_color;
  s.emission = m.emission;
  s.metallic = m.metallic;
  s.roughness = m.roughness;
  s.opacity = m.opacity;
  const float cosine = dot(s.geometric, ray.d);
  if (m.textured) {
    // The footprint is an ellipse; its mean axis keeps near texels sharp without aliasing far ones.
    const float width = (cone.width + cone.spread * hit.t) / sqrtf(max(fabsf(cosine), 0.05f));
    surfaces::apply_textures(scene, hit, X_WG, p_G, width, ray.time, &s);
  }
  if (cosine > 0) {
    s.outside = false;
    s.geometric = -s.geometric;
    s.normal = -s.normal;
  }
  // A shading normal that looks away from the viewer is bent back to just face it: black rims and
  // lost energy otherwise.
  const float facing = -dot(s.normal, ray.d);
  if (facing < 1e-3f) s.normal = normalize(s.normal - ray.d * (1e-2f - facing));
  return s;
}

/// BSDF of the surface for the direction `wo` towards the viewer; `frame` is its shading frame.
GLOAM_HD Bsdf surface_bsdf(const SceneView& scene, const Surface& s, Vec3f wo, Frame* frame) {
  *frame = Frame::from_z(s.normal);
  return make_bsdf(*scene.albedo, s.base_color, s.metallic, s.roughness, s.material->f0,
                   s.material->f90, max(dot(wo, s.normal), 1e-4f));
}

/// Light that the surface gives off by itself towards the viewer. Planes and solids shine outwards,
/// meshes to both sides.
GLOAM_HD Vec3f surface_emission(const Surface& s) {
  const bool is_mesh =
      s.instance->shape == ShapeType::kMesh || s.instance->shape == ShapeType::kDeformable;
  return s.outside || is_mesh ? s.emission : Vec3f{0, 0, 0};
}

}  // namespace gloam

#pragma once
// Textures of a material, applied to a surface. Device-safe.

#include "render/kernel/surface/procedural.h"
#include "render/kernel/surface/shapes.h"
#include "render/kernel/surface/surface_point.h"
#include "render/kernel/surface/texture.h"
#include "world/materials/texture_coordinates.h"

namespace gloam {

namespace surfaces {

struct TextureCoordinates {
  Vec2f uv;
  Vec3f direction_G;    ///< for cube textures
  float density = 0;    ///< texture lengths per metre, of 2-D textures
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

/// Texture coordinates of the hit, by the rules of world/materials/texture_coordinates.h. `n_G` =
/// unit geometric normal in the shape's frame.
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
  out.density = density;
  out.footprint = width * density;
  return out;
}

GLOAM_HD Rgba lookup(const SceneView& scene, const MaterialView& material, int texture,
                     const TextureCoordinates& at) {
  return material.mapping == TextureMapping::kCube && scene.textures[texture].face_count == 6
             ? lookup_cube(scene, texture, at.direction_G, at.footprint)
             : lookup_2d(scene, texture, at.uv, at.footprint);
}

/// The same of analytic shapes at p_G, where the unit geometric normal is n_G: as
/// world/materials/texture_coordinates.h lays textures on them. Only right along the surface.
GLOAM_HD void shape_tangents(ShapeType shape, Vec3f p_G, Vec3f n_G, Vec3f* tangent_u,
                             Vec3f* tangent_v) {
  const float ax = fabsf(n_G.x), ay = fabsf(n_G.y), az = fabsf(n_G.z);
  *tangent_u = {1, 0, 0};
  *tangent_v = {0, 1, 0};
  switch (shape) {
    case ShapeType::kBox:
      if (az >= ax && az >= ay) return;
      if (ax > ay) *tangent_u = {0, 1, 0};
      *tangent_v = {0, 0, 1};
      return;
    case ShapeType::kCylinder:
      if (az > 0.5f) {
        *tangent_v = {0, -1, 0};
        return;
      }
      [[fallthrough]];
    case ShapeType::kSphere:
    case ShapeType::kEllipsoid:
    case ShapeType::kCapsule:
      *tangent_u = {-p_G.y, p_G.x, 0};
      *tangent_v = {0, 0, 1};
      return;
    default:
      return;
  }
}

/// Tangents of increasing u and v in the frame G, not normalised; false where the map is singular.
GLOAM_HD bool tangents(const SceneView& scene, const InstanceView& instance, const RayHit& hit,
                       Vec3f p_G, Vec3f n_G, float time, Vec3f* tangent_u, Vec3f* tangent_v) {
  if (!is_mesh(instance.shape)) {
    shape_tangents(instance.shape, p_G, n_G, tangent_u, tangent_v);
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

/// Slope of the material's bump map along the surface, in the frame G [m/m], by differences over a
/// texel or what the ray sees, whichever is wider. `n_G` = unit geometric normal.
GLOAM_HD Vec3f bump_gradient(const SceneView& scene, const InstanceView& instance,
                             const MaterialView& m, const RayHit& hit, const TextureCoordinates& at,
                             Vec3f p_G, Vec3f n_G, float width, float time) {
  const TextureView& texture = scene.textures[m.textures.bump];
  const TextureLevel& finest = scene.texture_levels[texture.first_level];
  const float texels =
      sqrtf(static_cast<float>(finest.width) * static_cast<float>(finest.height)) * at.density;
  if (!(texels > 0)) return {};
  const float step = 0.5f * max(1.0f / texels, width);  // [m] to either side
  const bool has_uv = is_mesh(instance.shape) && !scene.meshes[instance.mesh].uvs.empty();
  Vec3f u_slope, v_slope;  // change of u and v per metre
  if (has_uv) {
    Vec3f along_u, along_v;
    if (!tangents(scene, instance, hit, p_G, n_G, time, &along_u, &along_v)) return {};
    const Vec3f n = cross(along_u, along_v);
    const float inv = 1.0f / length_squared(n);
    const Vec2f c = m.texture_uniform ? Vec2f{instance.size.x, instance.size.y} : Vec2f{1, 1};
    u_slope = cross(along_v, n) * (inv * c.x * m.texture_repeat.x);
    v_slope = cross(n, along_u) * (inv * c.y * m.texture_repeat.y);
  }
  const auto height = [&](Vec3f shift) {
    const Vec2f uv = has_uv ? at.uv + Vec2f{dot(u_slope, shift), dot(v_slope, shift)}
                            : texture_uv(instance.shape, p_G + shift, n_G, instance.size, {}, false,
                                         m.texture_repeat, m.texture_uniform);
    return lookup_2d(scene, m.textures.bump, uv, at.footprint).rgb.x;
  };
  const Frame frame = Frame::from_z(n_G);
  const Vec3f x = frame.x * step, y = frame.y * step;
  const float scale = m.bump_scale / (2.0f * step);
  return frame.x * ((height(x) - height(-x)) * scale) +
         frame.y * ((height(y) - height(-y)) * scale);
}

/// Textures applied to the surface `s` of an instance, at p_G in its frame.
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
    if (m.glows_in_color) s->emission *= texel.rgb;
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
      tangents(scene, instance, hit, p_G, n_G, time, &u, &v)) {
    const Vec3f n = lookup(scene, m, map.normal, at).rgb * 2.0f - Vec3f{1, 1, 1};
    const Vec3f x = transform_vector(X_WG, u), y = transform_vector(X_WG, v), z = s->normal;
    const Vec3f tx = x - z * dot(z, x), ty = y - z * dot(z, y);
    if (length_squared(tx) > 0 && length_squared(ty) > 0) {
      s->normal = normalize(normalize(tx) * n.x + normalize(ty) * n.y + z * max(n.z, 0.05f));
    }
  }
  if (map.bump >= 0 && m.mapping == TextureMapping::kUv) {
    const Vec3f slope = bump_gradient(scene, instance, m, hit, at, p_G, n_G, width, time);
    if (length_squared(slope) > 0) {
      s->normal = bumped_normal(s->normal, {0, transform_vector(X_WG, slope)});
    }
  }
}

}  // namespace surfaces

}  // namespace gloam

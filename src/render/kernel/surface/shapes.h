#pragma once
// The closed list of analytic shapes, centred in their own frame G: intersection, surface, area
// sampling. Sizes as in ShapeType. Device-safe.

#include "render/kernel/math/ray.h"
#include "world/render_description.h"

namespace gloam {

GLOAM_HD bool is_mesh(ShapeType shape) {
  return shape == ShapeType::kMesh || shape == ShapeType::kDeformable;
}

/// Half extents of the object that MuJoCo scales to unit size before it maps textures.
GLOAM_HD Vec3f shape_half_size(ShapeType shape, Vec3f size) {
  switch (shape) {
    case ShapeType::kSphere:
      return {size.x, size.x, size.x};
    case ShapeType::kCapsule:
    case ShapeType::kCylinder:
      return {size.x, size.x, size.y};
    default:
      return size;
  }
}

namespace shapes {

/// Nearest root in (tmin, tmax) of a t² - 2 b t + c = 0 with a > 0 that `accept` takes.
template <class Accept>
GLOAM_HD float nearest_root(float a, float b, float disc, float tmin, float tmax, Accept accept) {
  if (disc < 0) return -1.0f;
  const float root = sqrtf(disc);
  const float t0 = (b - root) / a, t1 = (b + root) / a;
  if (t0 > tmin && t0 < tmax && accept(t0)) return t0;
  if (t1 > tmin && t1 < tmax && accept(t1)) return t1;
  return -1.0f;
}

/// One-sided, as MuJoCo's rays see it.
template <class F>
GLOAM_HD F hit_plane(Vec3f size, Vec3Of<F> o, Vec3Of<F> d, F tmin, F tmax) {
  const F t = -o.z / d.z;
  MaskOf<F> hit = (d.z < 0.0f) & (t > tmin) & (t < tmax);
  if (size.x > 0) hit = hit & (magnitude(o.x + t * d.x) <= size.x);
  if (size.y > 0) hit = hit & (magnitude(o.y + t * d.y) <= size.y);
  return select(hit, t, F(-1.0f));
}

/// Sphere of radius 1 scaled by `axes`.
GLOAM_HD float hit_ellipsoid(Vec3f axes, Vec3f o, Vec3f d, float tmin, float tmax) {
  const Vec3f f{o.x / axes.x, o.y / axes.y, o.z / axes.z};
  const Vec3f g{d.x / axes.x, d.y / axes.y, d.z / axes.z};
  const float a = dot(g, g), b = -dot(f, g);
  const Vec3f closest = f + g * (b / a);
  return nearest_root(a, b, a * (1.0f - dot(closest, closest)), tmin, tmax,
                      [](float) { return true; });
}

/// Wall of an infinite cylinder about z, cut at |z| <= half.
GLOAM_HD float hit_tube(float radius, float half, Vec3f o, Vec3f d, float tmin, float tmax) {
  const float a = d.x * d.x + d.y * d.y;
  if (a < 1e-14f) return -1.0f;
  const float b = -(o.x * d.x + o.y * d.y);
  const float cx = o.x + d.x * (b / a), cy = o.y + d.y * (b / a);
  return nearest_root(a, b, a * (radius * radius - cx * cx - cy * cy), tmin, tmax,
                      [&](float t) { return fabsf(o.z + t * d.z) <= half; });
}

GLOAM_HD float hit_cylinder(float radius, float half, Vec3f o, Vec3f d, float tmin, float tmax) {
  float best = hit_tube(radius, half, o, d, tmin, tmax);
  if (best > 0) tmax = best;
  for (int i = 0; i < 2 && d.z != 0; ++i) {
    const float t = ((i == 0 ? half : -half) - o.z) / d.z;
    if (t > tmin && t < tmax && sqr(o.x + t * d.x) + sqr(o.y + t * d.y) <= radius * radius) {
      best = tmax = t;
    }
  }
  return best;
}

GLOAM_HD float hit_capsule(float radius, float half, Vec3f o, Vec3f d, float tmin, float tmax) {
  float best = hit_tube(radius, half, o, d, tmin, tmax);
  if (best > 0) tmax = best;
  for (int i = 0; i < 2; ++i) {
    const float side = i == 0 ? 1.0f : -1.0f;
    const Vec3f f{o.x, o.y, o.z - side * half};
    const float a = dot(d, d), b = -dot(f, d);
    const Vec3f closest = f + d * (b / a);
    const float t = nearest_root(a, b, a * (radius * radius - dot(closest, closest)), tmin, tmax,
                                 [&](float s) { return (f.z + s * d.z) * side >= 0; });
    if (t > 0) best = tmax = t;
  }
  return best;
}

}  // namespace shapes

/// Nearest hit of the ray (in G) with tmin < t < tmax, or a value <= 0, for all shapes but boxes,
/// which are crossed in lanes or are triangles. `d` need not be unit.
GLOAM_HD float intersect_shape(ShapeType shape, Vec3f size, Vec3f o, Vec3f d, float tmin,
                               float tmax) {
  switch (shape) {
    case ShapeType::kPlane:
      return shapes::hit_plane(size, o, d, tmin, tmax);
    case ShapeType::kSphere:
      return shapes::hit_ellipsoid({size.x, size.x, size.x}, o, d, tmin, tmax);
    case ShapeType::kEllipsoid:
      return shapes::hit_ellipsoid(size, o, d, tmin, tmax);
    case ShapeType::kCapsule:
      return shapes::hit_capsule(size.x, size.y, o, d, tmin, tmax);
    case ShapeType::kCylinder:
      return shapes::hit_cylinder(size.x, size.y, o, d, tmin, tmax);
    default:
      return -1.0f;
  }
}

/// Outward unit normal of the face of a box that *p is nearest to; moves *p onto it.
template <class F>
GLOAM_HD Vec3Of<F> snap_to_box(Vec3Of<F> size, Vec3Of<F>* p) {
  const F gap_x = size.x - magnitude(p->x), gap_y = size.y - magnitude(p->y),
          gap_z = size.z - magnitude(p->z);
  const MaskOf<F> x = (gap_x <= gap_y) & (gap_x <= gap_z), y = (gap_y <= gap_z) & !x, z = !(x | y);
  const F zero = 0.0f, one = 1.0f;
  const Vec3Of<F> side{select(p->x < 0.0f, -one, one), select(p->y < 0.0f, -one, one),
                       select(p->z < 0.0f, -one, one)};
  *p = {select(x, side.x * size.x, p->x), select(y, side.y * size.y, p->y),
        select(z, side.z * size.z, p->z)};
  return {select(x, side.x, zero), select(y, side.y, zero), select(z, side.z, zero)};
}

/// Outward unit normal at a point near the surface; moves *p onto the surface.
GLOAM_HD Vec3f snap_to_shape(ShapeType shape, Vec3f size, Vec3f* p) {
  switch (shape) {
    case ShapeType::kBox:
      return snap_to_box(size, p);
    case ShapeType::kSphere: {
      const Vec3f n = normalize(*p);
      *p = n * size.x;
      return n;
    }
    case ShapeType::kEllipsoid: {
      const Vec3f q = normalize(Vec3f{p->x / size.x, p->y / size.y, p->z / size.z});
      *p = q * size;
      return normalize(Vec3f{q.x / size.x, q.y / size.y, q.z / size.z});
    }
    case ShapeType::kCapsule: {
      const Vec3f axis{0, 0, clamp(p->z, -size.y, size.y)};
      const Vec3f n = normalize(*p - axis);
      *p = axis + n * size.x;
      return n;
    }
    case ShapeType::kCylinder: {
      const float r = sqrtf(p->x * p->x + p->y * p->y);
      if (size.y - fabsf(p->z) < size.x - r) {
        p->z = copysignf(size.y, p->z);
        return {0, 0, copysignf(1.0f, p->z)};
      }
      const Vec3f n{p->x / r, p->y / r, 0};
      p->x = n.x * size.x;
      p->y = n.y * size.x;
      return n;
    }
    default:
      p->z = 0;
      return {0, 0, 1};
  }
}

/// Area [m²]; for an ellipsoid the area it is sampled over is not needed (0), for an infinite plane
/// 0.
GLOAM_HD float shape_area(ShapeType shape, Vec3f s) {
  switch (shape) {
    case ShapeType::kPlane:
      return 4 * s.x * s.y;
    case ShapeType::kBox:
      return 8 * (s.x * s.y + s.y * s.z + s.z * s.x);
    case ShapeType::kSphere:
      return 4 * kPi * s.x * s.x;
    case ShapeType::kEllipsoid: {  // Thomsen's approximation, within 1.1 %: weighs lights only
      const float q = 1.6075f;
      const float a = powf(s.x, q), b = powf(s.y, q), c = powf(s.z, q);
      return 4 * kPi * powf((a * b + b * c + c * a) / 3, 1 / q);
    }
    case ShapeType::kCapsule:
      return 4 * kPi * s.x * (s.x + s.y);
    case ShapeType::kCylinder:
      return 2 * kPi * s.x * (2 * s.y + s.x);
    default:
      return 0;
  }
}

/// Density per area [1/m²] with which sample_shape makes p; 0 for an infinite plane.
GLOAM_HD float shape_pdf(ShapeType shape, Vec3f s, Vec3f p) {
  if (shape == ShapeType::kEllipsoid) {
    const Vec3f q{p.x / (s.x * s.x), p.y / (s.y * s.y), p.z / (s.z * s.z)};
    return 1.0f / (4 * kPi * s.x * s.y * s.z * length(q));
  }
  const float area = shape_area(shape, s);
  return area > 0 ? 1.0f / area : 0.0f;
}

/// A point on the surface and its outward normal; density shape_pdf.
GLOAM_HD Vec3f sample_shape(ShapeType shape, Vec3f s, Vec2f u, Vec3f* normal) {
  Vec3f p;
  switch (shape) {
    case ShapeType::kBox: {
      const float yz = s.y * s.z, zx = s.z * s.x, xy = s.x * s.y, total = yz + zx + xy;
      const float side = u.x < 0.5f ? -1.0f : 1.0f;
      const float x = rest_of(u.x, u.x < 0.5f ? 0.0f : 0.5f, 0.5f) * total;
      const float within = x < yz        ? rest_of(x, 0.0f, yz)
                           : x < yz + zx ? rest_of(x, yz, zx)
                                         : rest_of(x, yz + zx, xy);
      const float a = within * 2 - 1, b = u.y * 2 - 1;
      p = x < yz        ? Vec3f{side * s.x, a * s.y, b * s.z}
          : x < yz + zx ? Vec3f{a * s.x, side * s.y, b * s.z}
                        : Vec3f{a * s.x, b * s.y, side * s.z};
      *normal = x < yz ? Vec3f{side, 0, 0} : x < yz + zx ? Vec3f{0, side, 0} : Vec3f{0, 0, side};
      return p;
    }
    case ShapeType::kSphere:
      *normal = sample_sphere(u);
      return *normal * s.x;
    case ShapeType::kEllipsoid:
      p = sample_sphere(u) * s;
      *normal = snap_to_shape(shape, s, &p);
      return p;
    case ShapeType::kCapsule: {
      const float probability = s.y / (s.x + s.y);  // of the wall
      const bool wall = u.x < probability;
      u.x = wall ? rest_of(u.x, 0.0f, probability) : rest_of(u.x, probability, 1 - probability);
      if (!wall) {
        *normal = sample_sphere(u);
        p = *normal * s.x;
        p.z += copysignf(s.y, p.z);
        return p;
      }
      float sine, cosine;
      sincos_turn(u.y, &sine, &cosine);
      *normal = {cosine, sine, 0};
      return {cosine * s.x, sine * s.x, (u.x * 2 - 1) * s.y};
    }
    case ShapeType::kCylinder: {
      float sine, cosine;
      sincos_turn(u.y, &sine, &cosine);
      const float probability = 2 * s.y / (2 * s.y + s.x);  // of the wall
      if (u.x < probability) {
        *normal = {cosine, sine, 0};
        return {cosine * s.x, sine * s.x, (rest_of(u.x, 0.0f, probability) * 2 - 1) * s.y};
      }
      const float x = rest_of(u.x, probability, 1 - probability), side = x < 0.5f ? -1.0f : 1.0f;
      const float r = s.x * sqrtf(rest_of(x, x < 0.5f ? 0.0f : 0.5f, 0.5f));
      *normal = {0, 0, side};
      return {cosine * r, sine * r, side * s.y};
    }
    default:
      *normal = {0, 0, 1};
      return {(u.x * 2 - 1) * s.x, (u.y * 2 - 1) * s.y, 0};
  }
}

/// A point on a face that p sees, its normal, and its density per area; 0 inside the box.
template <class F>
GLOAM_HD F sample_box_from(Vec3f s, Vec3Of<F> p, Vec2Of<F> u, Vec3Of<F>* q, Vec3Of<F>* normal) {
  // At most one of two opposite faces is seen; they are taken by area times the height of p above.
  const float area[3] = {4 * s.y * s.z, 4 * s.z * s.x, 4 * s.x * s.y};
  F height[3], weight[3];
  for (int i = 0; i < 3; ++i) {
    height[i] = max(magnitude(p[i]) - s[i], 0.0f);
    weight[i] = height[i] * area[i];
  }
  const F total = weight[0] + weight[1] + weight[2];
  const F pick = u.x * total;
  const auto x = pick < weight[0], y = pick < weight[0] + weight[1];
  const F from = select(x, F(0.0f), select(y, weight[0], weight[0] + weight[1]));
  u.x = rest_of(pick, from, max(select(x, weight[0], select(y, weight[1], weight[2])), 1e-30f));
  const F side_x = select(p.x < 0.0f, F(-1.0f), F(1.0f)),
          side_y = select(p.y < 0.0f, F(-1.0f), F(1.0f)),
          side_z = select(p.z < 0.0f, F(-1.0f), F(1.0f));
  const F a = u.x * 2.0f - 1.0f, b = u.y * 2.0f - 1.0f, zero = 0.0f;
  *q = {select(x, side_x, a) * s.x, select(x, a, select(y, side_y, b)) * s.y,
        select(x, b, select(y, b, side_z)) * s.z};
  *normal = {select(x, side_x, zero), select(x, zero, select(y, side_y, zero)),
             select(x, zero, select(y, zero, side_z))};
  const F seen = select(x, height[0], select(y, height[1], height[2]));
  return select((total > 0.0f) & (seen > 0.0f), seen / total, zero);
}

/// Density per area with which sample_box_from(s, p) makes points of the face with this normal.
GLOAM_HD float box_pdf_from(Vec3f s, Vec3f p, Vec3f normal) {
  const float area[3] = {4 * s.y * s.z, 4 * s.z * s.x, 4 * s.x * s.y};
  float total = 0;
  for (int i = 0; i < 3; ++i) total += area[i] * max(fabsf(p[i]) - s[i], 0.0f);
  const int axis = fabsf(normal.x) > 0.5f ? 0 : (fabsf(normal.y) > 0.5f ? 1 : 2);
  const float height = (normal[axis] > 0 ? p[axis] : -p[axis]) - s[axis];
  return total > 0 && height > 0 ? height / total : 0.0f;
}

}  // namespace gloam

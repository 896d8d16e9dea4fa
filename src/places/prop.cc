#include "places/prop.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"

namespace gloam {
namespace {

Pose at(Vec3f p, const Quat& q = {}) { return {{p.x, p.y, p.z}, q}; }

// The rotation that takes z to the direction of d.
Quat from_z(Vec3f d) {
  const double length_d = std::sqrt(double(dot(d, d)));
  const double x = d.x / length_d, y = d.y / length_d, z = d.z / length_d;
  if (z < -0.999999) return {0, 1, 0, 0};
  const double w = std::sqrt((1 + z) / 2);
  return {w, -y / (2 * w), x / (2 * w), 0};
}

Vec3f rotate(const Quat& q, Vec3f v) {
  const Vec3f u{float(q.x), float(q.y), float(q.z)};
  const Vec3f t = cross(u, v) * 2.0f;
  return v + t * float(q.w) + cross(u, t);
}

void append(const Solid& solid, PropVisual* visual) {
  Solid whole(std::move(visual->mesh));
  whole += solid;
  visual->mesh = std::move(whole).mesh();
}

void include(Vec3f p, Prop::Box* box) {
  box->low = {min(box->low.x, p.x), min(box->low.y, p.y), min(box->low.z, p.z)};
  box->high = {max(box->high.x, p.x), max(box->high.y, p.y), max(box->high.z, p.z)};
}

// Points whose box is the collider's, along its own axes: corners, or for cylinders two rims.
std::vector<Vec3f> hull_of(const PropCollider& c) {
  std::vector<Vec3f> points;
  if (c.shape == ColliderShape::kCylinder) {
    constexpr int kRim = 32;
    for (int i = 0; i < kRim; ++i) {
      const float angle = 2 * kPi * static_cast<float>(i) / kRim;
      for (const float z : {-c.size.y, c.size.y})
        points.push_back({c.size.x * std::cos(angle), c.size.x * std::sin(angle), z});
    }
    return points;
  }
  if (c.shape == ColliderShape::kHull) return c.hull.positions;
  const float r = c.size.x;
  const Vec3f half = c.shape == ColliderShape::kBox       ? c.size
                     : c.shape == ColliderShape::kCapsule ? Vec3f{r, r, c.size.y + r}
                                                          : Vec3f{r, r, r};
  for (int corner = 0; corner < 8; ++corner)
    points.push_back({corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y,
                      corner & 4 ? half.z : -half.z});
  return points;
}

}  // namespace

Quat turn(Vec3 axis, double angle) {
  const double s =
      std::sin(angle / 2) / std::sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
  return {std::cos(angle / 2), axis.x * s, axis.y * s, axis.z * s};
}

PropPart& PropPart::show(const std::string& name, const std::string& material, const Solid& solid) {
  for (PropVisual& visual : visuals) {
    if (visual.name != name) continue;
    GLOAM_CHECK(visual.material == material, "a visual has two materials");
    append(solid, &visual);
    return *this;
  }
  visuals.push_back({name, material, solid.mesh()});
  return *this;
}

void PropPart::join_visuals() {
  std::vector<PropVisual> joined;
  for (PropVisual& visual : visuals) {
    const auto like = std::find_if(joined.begin(), joined.end(), [&](const PropVisual& other) {
      return other.material == visual.material && other.mesh.uvs.empty() == visual.mesh.uvs.empty();
    });
    if (like == joined.end())
      joined.push_back(std::move(visual));
    else
      append(Solid(std::move(visual.mesh)), &*like);
  }
  visuals = std::move(joined);
}

PropPart& PropPart::collide_box(Vec3f low, Vec3f high) {
  colliders.push_back({ColliderShape::kBox, (high - low) * 0.5f, at((low + high) * 0.5f)});
  return *this;
}

PropPart& PropPart::collide_box(Vec3f center, Vec3f half, const Quat& q) {
  colliders.push_back({ColliderShape::kBox, half, at(center, q)});
  return *this;
}

PropPart& PropPart::collide_cylinder(float radius, float z0, float z1, float x, float y) {
  colliders.push_back(
      {ColliderShape::kCylinder, {radius, (z1 - z0) / 2, 0}, at({x, y, (z0 + z1) / 2})});
  return *this;
}

PropPart& PropPart::collide_cylinder(Vec3f from, Vec3f to, float radius) {
  colliders.push_back({ColliderShape::kCylinder,
                       {radius, length(to - from) / 2, 0},
                       at((from + to) * 0.5f, from_z(to - from))});
  return *this;
}

PropPart& PropPart::collide_capsule(Vec3f from, Vec3f to, float radius) {
  colliders.push_back({ColliderShape::kCapsule,
                       {radius, length(to - from) / 2, 0},
                       at((from + to) * 0.5f, from_z(to - from))});
  return *this;
}

PropPart& PropPart::collide_sphere(Vec3f center, float radius) {
  colliders.push_back({ColliderShape::kSphere, {radius, 0, 0}, at(center)});
  return *this;
}

PropPart& PropPart::collide_hull(const Solid& solid, double friction) {
  const Vec3f half = (solid.high() - solid.low()) * 0.5f;
  colliders.push_back({ColliderShape::kHull, half, {}, friction, solid.mesh()});
  return *this;
}

PropPart& Prop::hang(const std::string& name, Vec3f p, const PropJoint& joint, int parent) {
  PropPart& part = parts.emplace_back();
  part.name = name;
  part.parent = parent;
  part.p_P = {p.x, p.y, p.z};
  part.joint = joint;
  return part;
}

double Prop::mass() const {
  double sum = 0;
  for (const PropPart& part : parts) sum += part.mass;
  return sum;
}

Prop::Box Prop::bounds() const {
  constexpr float kFar = 1e30f;
  Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const PropPart& part : parts) {
    const auto to_prop = [&](Vec3f p) {
      for (const PropPart* at = &part;;) {
        if (at->joint && at->joint->slides) {
          const Vec3& axis = at->joint->axis;
          p += Vec3f{float(axis.x), float(axis.y), float(axis.z)} * float(at->joint->initial);
        } else if (at->joint) {
          p = rotate(turn(at->joint->axis, at->joint->initial), p);
        }
        p += {float(at->p_P.x), float(at->p_P.y), float(at->p_P.z)};
        if (at->parent < 0) return p;
        at = &parts[size_t(at->parent)];
      }
    };
    for (const PropVisual& visual : part.visuals)
      for (const Vec3f p : visual.mesh.positions) include(to_prop(p), &box);
    for (const PropCollider& c : part.colliders) {
      const Vec3f middle{float(c.X_PG.p.x), float(c.X_PG.p.y), float(c.X_PG.p.z)};
      for (const Vec3f p : hull_of(c)) include(to_prop(middle + rotate(c.X_PG.q, p)), &box);
    }
  }
  return box.low.x > box.high.x ? Box{} : box;
}

}  // namespace gloam

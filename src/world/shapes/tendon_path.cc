#include "world/shapes/tendon_path.h"

#include <algorithm>
#include <cmath>

#include "world/shapes/capsule_mesh.h"

namespace gloam {
namespace {

constexpr int kArcSegments = 10;       // around one geom
constexpr int kCatenarySegments = 24;  // segments of a slack tendon

constexpr int kPulley = -2;  // in mjData::wrap_obj; -1 = a site

/// Hands out a tendon's capsules in order.
class Chain {
 public:
  Chain(double radius, int capacity, float* vertices)
      : radius_(radius), left_(capacity), vertices_(vertices) {}
  void add(const double* a, const double* b) {
    if (left_ <= 0) return;
    place_capsule(a, b, radius_, vertices_);
    vertices_ += 3 * kCapsuleVertices;
    --left_;
  }
  /// The rest are points at `p`.
  void close(const double* p) {
    radius_ = 0;
    while (left_ > 0) add(p, p);
  }

 private:
  double radius_;
  int left_;
  float* vertices_;
};

/// From `a` to `b` on the surface of a sphere or cylinder, leaving `a` in the direction of
/// `tangent`: a part of a circle, or of a helix.
void add_arc(const mjModel& m, const mjData& d, int geom, const double* a, const double* b,
             const double* tangent, Chain* chain) {
  const double* R = d.geom_xmat + 9 * geom;
  const double axis[3] = {R[2], R[5], R[8]};
  const bool is_cylinder = m.geom_type[geom] == mjGEOM_CYLINDER;
  // Radii of both points and the tangent, within the circle's plane.
  double r_a[3], r_b[3], t[3];
  mju_sub3(r_a, a, d.geom_xpos + 3 * geom);
  mju_sub3(r_b, b, d.geom_xpos + 3 * geom);
  mju_copy3(t, tangent);
  const double along_a = is_cylinder ? mju_dot3(r_a, axis) : 0;
  const double along_b = is_cylinder ? mju_dot3(r_b, axis) : 0;
  mju_addToScl3(r_a, axis, -along_a);
  mju_addToScl3(r_b, axis, -along_b);
  if (is_cylinder) mju_addToScl3(t, axis, -mju_dot3(t, axis));
  const double radius = mju_norm3(r_a);
  if (radius > mjMINVAL) mju_addToScl3(t, r_a, -mju_dot3(t, r_a) / (radius * radius));
  if (radius <= mjMINVAL || mju_normalize3(t) < mjMINVAL) return chain->add(a, b);

  double angle = std::atan2(mju_dot3(r_b, t), mju_dot3(r_b, r_a) / radius);
  constexpr double kBackwards = 0.1;  // [rad] a rounding error at most: wraps turn forwards
  if (angle < -kBackwards) angle += 2 * mjPI;
  double from[3], to[3];
  mju_copy3(from, a);
  for (int k = 1; k <= kArcSegments; ++k) {
    const double share = static_cast<double>(k) / kArcSegments;
    if (k == kArcSegments) {
      mju_copy3(to, b);
    } else {
      mju_copy3(to, d.geom_xpos + 3 * geom);
      mju_addToScl3(to, r_a, std::cos(share * angle));
      mju_addToScl3(to, t, radius * std::sin(share * angle));
      mju_addToScl3(to, axis, along_a + share * (along_b - along_a));
    }
    chain->add(from, to);
    mju_copy3(from, to);
  }
}

/// Length that a slack tendon hangs with [m], or 0: it is taut or cannot be slack.
double slack_length(const mjModel& m, const mjData& d, const double* gravity, int i) {
  const double* range = m.tendon_range + 2 * i;
  const double* spring = m.tendon_lengthspring + 2 * i;
  const bool by_limit = m.tendon_limited[i] && range[0] == 0 && m.tendon_stiffness[i] == 0;
  const bool by_spring = m.tendon_stiffness[i] > 0 && spring[0] == 0 && spring[1] > 0;
  if (by_limit == by_spring || m.tendon_num[i] != 2 || m.tendon_damping[i] != 0 ||
      m.tendon_frictionloss[i] != 0 || mju_norm3(gravity) < mjMINVAL) {
    return 0;
  }
  const double length = by_limit ? range[1] : spring[1];
  return d.ten_length[i] < length ? length : 0;
}

/// Half the width of a catenary over its parameter: the b > 0 with sinh b / b = ratio > 1.
double catenary_parameter(double ratio) {
  const double target = std::log(ratio);
  const auto error = [target](double b) { return std::log(std::sinh(b) / b) - target; };
  double low = 0, high = 1;
  while (error(high) < 0) high *= 2;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (error(middle) < 0 ? low : high) = middle;
  }
  return high;
}

/// A rope of `length` from `a` to `b`, longer than the way between them.
void add_catenary(const double* a, const double* b, const double* gravity, double length,
                  Chain* chain) {
  double up[3], across[3];
  mju_scl3(up, gravity, -1);
  mju_normalize3(up);
  mju_sub3(across, b, a);
  const double rise = mju_dot3(across, up);
  mju_addToScl3(across, up, -rise);
  const double width = mju_normalize3(across);
  double from[3], to[3];
  if (width < 1e-4 * length) {  // straight down and up again
    mju_copy3(to, a);
    mju_addToScl3(to, up, -0.5 * (length - rise));
    chain->add(a, to);
    chain->add(to, b);
    return;
  }
  // z(s) = sqrt(c² + (s - s0)²) over the way s along the rope; s0 is where it hangs lowest.
  const double half_over_c = catenary_parameter(std::sqrt(length * length - rise * rise) / width);
  const double c = 0.5 * width / half_over_c;
  const double s0 = c * std::sinh(half_over_c - std::atanh(rise / length));
  mju_copy3(from, a);
  for (int k = 1; k <= kCatenarySegments; ++k) {
    const double s = length * k / kCatenarySegments;
    mju_copy3(to, a);
    mju_addToScl3(to, up, std::hypot(c, s - s0) - std::hypot(c, s0));
    mju_addToScl3(to, across, c * (std::asinh((s - s0) / c) + std::asinh(s0 / c)));
    if (k == kCatenarySegments) mju_copy3(to, b);
    chain->add(from, to);
    mju_copy3(from, to);
  }
}

}  // namespace

int tendon_segments(const mjModel& model, int i) {
  int segments = 0;
  for (int k = model.tendon_adr[i]; k < model.tendon_adr[i] + model.tendon_num[i]; ++k) {
    const int type = model.wrap_type[k];
    if (type == mjWRAP_JOINT) return 0;
    segments += type == mjWRAP_SPHERE || type == mjWRAP_CYLINDER ? kArcSegments + 1 : 1;
  }
  return std::max(segments, kCatenarySegments);
}

void place_tendon(const mjModel& model, const mjData& data, const double* gravity, int i,
                  float* vertices) {
  Chain chain(model.tendon_width[i], tendon_segments(model, i), vertices);
  const int first = data.ten_wrapadr[i], last = first + data.ten_wrapnum[i] - 1;
  const auto point = [&](int k) { return data.wrap_xpos + 3 * k; };
  if (const double length = slack_length(model, data, gravity, i);
      length > 0 && last == first + 1) {
    add_catenary(point(first), point(last), gravity, length, &chain);
  } else {
    for (int k = first; k < last; ++k) {
      const int geom = data.wrap_obj[k];
      if (geom == kPulley || data.wrap_obj[k + 1] == kPulley) continue;
      if (geom >= 0 && data.wrap_obj[k + 1] == geom && k > first) {
        double tangent[3];
        mju_sub3(tangent, point(k), point(k - 1));
        add_arc(model, data, geom, point(k), point(k + 1), tangent, &chain);
      } else {
        chain.add(point(k), point(k + 1));
      }
    }
  }
  const double nowhere[3] = {0, 0, 0};
  chain.close(last >= first ? point(last) : nowhere);
}

}  // namespace gloam

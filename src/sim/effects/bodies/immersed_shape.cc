#include "sim/effects/bodies/immersed_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/effects/bodies/collider_mesh.h"

namespace gloam {
namespace {

constexpr double kEllipseFactor = std::numbers::pi;
constexpr int kLines = 6;        // through an element along each edge
constexpr int kMostAlong = 100;  // elements along an edge

/// Drag of solids at Reynolds numbers of 10⁴ to 2·10⁵: Hoerner 1965, "Fluid-Dynamic Drag", chapter
/// 3. Cylinders and capsules are about three times as long as they are wide.
struct DragRow {
  double across, along;
};
constexpr DragRow kBallDrag{0.47, 0.47}, kCylinderDrag{0.75, 0.85}, kCapsuleDrag{0.75, 0.3};

/// Interval of a line along z inside the shape.
struct Inside {
  double low, high;  // high <= low: nowhere
};

class SolidLines {
 public:
  SolidLines(const mjModel& m, int geom) : type_(m.geom_type[geom]), size_(m.geom_size + 3 * geom) {
    if (type_ == mjGEOM_MESH) planes_ = hull_planes(m, m.geom_dataid[geom]);
  }

  Inside at(double x, double y) const {
    const double *s = size_, squares = x * x + y * y;
    switch (type_) {
      case mjGEOM_BOX:
        return {-s[2], s[2]};
      case mjGEOM_SPHERE:
        return both(s[0] * s[0] - squares, 0);
      case mjGEOM_CYLINDER:
        return squares < s[0] * s[0] ? Inside{-s[1], s[1]} : Inside{0, 0};
      case mjGEOM_CAPSULE:
        return both(s[0] * s[0] - squares, s[1]);
      case mjGEOM_ELLIPSOID: {
        const double u = x / s[0], v = y / s[1];
        return both((1 - u * u - v * v) * s[2] * s[2], 0);
      }
      default:
        return between_planes(x, y);
    }
  }

 private:
  static Inside both(double square, double more) {
    if (square <= 0) return {0, 0};
    const double z = std::sqrt(square) + more;
    return {-z, z};
  }
  Inside between_planes(double x, double y) const {
    Inside in{-1e30, 1e30};
    for (const SolidPlane& plane : planes_) {
      const double room = plane.offset - plane.n[0] * x - plane.n[1] * y;
      if (std::abs(plane.n[2]) < 1e-12) {
        if (room < 0) return {0, 0};
      } else if (plane.n[2] > 0) {
        in.high = std::min(in.high, room / plane.n[2]);
      } else {
        in.low = std::max(in.low, room / plane.n[2]);
      }
    }
    return in;
  }

  int type_;
  const mjtNum* size_;
  std::vector<SolidPlane> planes_;
};

double exact_volume(const mjModel& m, int geom, double sampled) {
  const mjtNum* s = m.geom_size + 3 * geom;
  switch (m.geom_type[geom]) {
    case mjGEOM_BOX:
      return 8 * s[0] * s[1] * s[2];
    case mjGEOM_SPHERE:
      return kEllipseFactor * 4 / 3 * s[0] * s[0] * s[0];
    case mjGEOM_ELLIPSOID:
      return kEllipseFactor * 4 / 3 * s[0] * s[1] * s[2];
    case mjGEOM_CYLINDER:
      return kEllipseFactor * s[0] * s[0] * 2 * s[1];
    case mjGEOM_CAPSULE:
      return kEllipseFactor * s[0] * s[0] * (2 * s[1] + s[0] * 4 / 3);
    default:
      return sampled;
  }
}

void set_drag(const mjModel& m, int geom, ImmersedShape* shape) {
  const int type = m.geom_type[geom];
  const DragRow row = type == mjGEOM_SPHERE || type == mjGEOM_ELLIPSOID ? kBallDrag
                      : type == mjGEOM_CYLINDER                         ? kCylinderDrag
                      : type == mjGEOM_CAPSULE                          ? kCapsuleDrag
                                               : DragRow{kBoxDrag, kBoxDrag};
  shape->drag[0] = shape->drag[1] = row.across;
  shape->drag[2] = row.along;
  shape->is_round = type == mjGEOM_CYLINDER || type == mjGEOM_CAPSULE;
}

/// Fills a column of elements from lines through it; `seen`: its fraction of the area along z.
void add_column(const SolidLines& solid, const double* low, const int* n, int i, int j,
                ImmersedShape* shape, double* seen) {
  std::vector<double> sums(static_cast<size_t>(4 * n[2]));  // volume and its first moments
  const double dx = shape->cell[0] / kLines, dy = shape->cell[1] / kLines, dz = shape->cell[2];
  for (int line = 0; line < kLines * kLines; ++line) {
    const int along_x = line % kLines, along_y = line / kLines;
    const double x = low[0] + shape->cell[0] * i + dx * (along_x + 0.5);
    const double y = low[1] + shape->cell[1] * j + dy * (along_y + 0.5);
    const Inside in = solid.at(x, y);
    if (in.high <= in.low) continue;
    *seen += dx * dy;
    for (int k = 0; k < n[2]; ++k) {
      const double from = std::max(in.low, low[2] + dz * k);
      const double to = std::min(in.high, low[2] + dz * (k + 1));
      if (to <= from) continue;
      const double v = dx * dy * (to - from);
      double* sum = sums.data() + 4 * k;
      sum[0] += v, sum[1] += v * x, sum[2] += v * y, sum[3] += v * (from + to) / 2;
    }
  }
  for (int k = 0; k < n[2]; ++k) {
    const double* sum = sums.data() + 4 * k;
    if (sum[0] <= 0) continue;
    shape->elements.push_back({{sum[1] / sum[0], sum[2] / sum[0], sum[3] / sum[0]}, sum[0]});
  }
}

/// Added mass and inertia of the ellipsoid of the same second moments: Lamb 1932, "Hydrodynamics",
/// articles 114 and 115; the integrals by the midpoint rule.
void set_added_mass(ImmersedShape* shape) {
  double middle[3] = {}, square[3] = {};
  for (const VolumeElement& e : shape->elements) {
    for (int a = 0; a < 3; ++a) {
      middle[a] += e.volume * e.p[a] / shape->volume;
      square[a] += e.volume * e.p[a] * e.p[a] / shape->volume;
    }
  }
  double s[3];  // squares of the half axes
  for (int a = 0; a < 3; ++a)
    s[a] = 5 * (square[a] - middle[a] * middle[a] + shape->cell[a] * shape->cell[a] / 12);
  constexpr int kPoints = 1024;
  const double unit = std::cbrt(s[0] * s[1] * s[2]);
  double alpha[3] = {};
  for (int n = 0; n < kPoints; ++n) {
    const double v = (n + 0.5) / kPoints, lambda = unit * (1 / (v * v) - 1);
    const double root = std::sqrt((s[0] + lambda) * (s[1] + lambda) * (s[2] + lambda));
    const double weight = 2 * unit / (v * v * v) / kPoints * std::sqrt(s[0] * s[1] * s[2]) / root;
    for (int a = 0; a < 3; ++a) alpha[a] += weight / (s[a] + lambda);
  }
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    shape->added[a] = alpha[a] / (alpha[b] + alpha[c]);  // their sum is 2
    const double d = s[b] - s[c], sum = s[b] + s[c];
    const double below = 2 * d + sum * (alpha[b] - alpha[c]);
    if (std::abs(d) > 1e-3 * sum && below != 0)
      shape->added_inertia[a] = shape->volume / 5 * d * d * (alpha[c] - alpha[b]) / below;
  }
}

}  // namespace

std::optional<ImmersedShape> immersed_shape(const mjModel& m, int geom, int elements) {
  switch (m.geom_type[geom]) {
    case mjGEOM_BOX:
    case mjGEOM_SPHERE:
    case mjGEOM_CYLINDER:
    case mjGEOM_CAPSULE:
    case mjGEOM_ELLIPSOID:
    case mjGEOM_MESH:
      break;
    default:
      return {};
  }
  ImmersedShape shape;
  shape.geom = geom;
  shape.body = m.geom_bodyid[geom];
  std::copy_n(m.geom_aabb + 6 * geom, 3, shape.centre);
  std::copy_n(m.geom_aabb + 6 * geom + 3, 3, shape.half);
  const double* half = shape.half;
  const double edge = std::cbrt(8 * half[0] * half[1] * half[2] / elements);
  if (!(edge > 0)) return {};
  int n[3];
  double low[3];
  for (int a = 0; a < 3; ++a) {
    n[a] = std::clamp(static_cast<int>(std::lround(2 * half[a] / edge)), 1, kMostAlong);
    shape.cell[a] = 2 * half[a] / n[a];
    low[a] = shape.centre[a] - half[a];
  }
  const SolidLines solid(m, geom);
  double sampled = 0, seen = 0;
  for (int i = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j) add_column(solid, low, n, i, j, &shape, &seen);
  for (const VolumeElement& e : shape.elements) sampled += e.volume;
  if (!(sampled > 0)) return {};
  shape.volume = exact_volume(m, geom, sampled);
  for (VolumeElement& e : shape.elements) e.volume *= shape.volume / sampled;
  shape.radius = std::cbrt(shape.volume * 3 / 4 / kEllipseFactor);
  // Along x and y as much of the bounding box as along z.
  const double full = seen / (4 * half[0] * half[1]);
  for (int a = 0; a < 3; ++a) shape.area[a] = full * 4 * half[(a + 1) % 3] * half[(a + 2) % 3];
  if (m.geom_type[geom] == mjGEOM_CYLINDER) {
    shape.area[0] = shape.area[1] = 4 * half[0] * half[2];
  } else if (m.geom_type[geom] == mjGEOM_CAPSULE) {
    const double r = half[0], length = 2 * (half[2] - r);
    shape.area[0] = shape.area[1] = 2 * r * length + kEllipseFactor * r * r;
  }
  make_clusters(low, &shape);
  set_drag(m, geom, &shape);
  set_added_mass(&shape);
  return shape;
}

std::vector<ImmersedShape> immersed_shapes(const mjModel& m) {
  std::vector<ImmersedShape> shapes;
  const std::vector<bool> collide = colliders(m);
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const bool moves = m.body_weldid[m.geom_bodyid[geom]] != 0;
    if (!moves || !collide[static_cast<size_t>(geom)]) continue;
    if (std::optional<ImmersedShape> shape = immersed_shape(m, geom))
      shapes.push_back(std::move(*shape));
  }
  return shapes;
}

}  // namespace gloam

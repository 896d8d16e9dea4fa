#pragma once
// Directions in proportion to the light that arrives at a row of the guide. Device-safe.
//
// The sphere is laid out on the square [-1, 1]² by the octahedral map (Cigolle et al. 2014, "A
// survey of efficient representations for independent unit vectors"): neither way needs more than
// a square root, cells have areas that are known, and the planes between the axes fall on edges of
// cells, so that a wall takes no light of the cells behind it.

#include "render/kernel/scene_view.h"

namespace gloam::directions {

inline constexpr uint32_t kAcross = LightGuide::kAcross;

template <class F>
GLOAM_HD F with_sign_of(F value, F sign) {
  return select(sign < 0.0f, -value, value);
}

/// Point of the square for the direction d, of any length.
template <class F>
GLOAM_HD Vec2Of<F> to_square(Vec3Of<F> d) {
  const F inverse = 1.0f / (magnitude(d.x) + magnitude(d.y) + magnitude(d.z));
  const F x = d.x * inverse, y = d.y * inverse;
  const MaskOf<F> low = d.z < 0.0f;
  return {select(low, with_sign_of<F>(1.0f - magnitude(y), x), x),
          select(low, with_sign_of<F>(1.0f - magnitude(x), y), y)};
}

/// The unit direction at q.
template <class F>
GLOAM_HD Vec3Of<F> from_square(Vec2Of<F> q) {
  const F z = 1.0f - magnitude(q.x) - magnitude(q.y);
  const MaskOf<F> low = z < 0.0f;
  return normalize(Vec3Of<F>{select(low, with_sign_of<F>(1.0f - magnitude(q.y), q.x), q.x),
                             select(low, with_sign_of<F>(1.0f - magnitude(q.x), q.y), q.y), z});
}

/// Area on the square per solid angle about the unit direction d.
template <class F>
GLOAM_HD F area_per_solid_angle(Vec3Of<F> d) {
  const F norm = magnitude(d.x) + magnitude(d.y) + magnitude(d.z);
  return 1.0f / (norm * norm * norm);
}

/// Cell of the map that holds the point q.
template <class F>
GLOAM_HD UintOf<F> cell_of(Vec2Of<F> q) {
  const auto along = [](F x) {
    return to_uint(clamp((x + 1.0f) * (0.5f * kAcross), 0.0f, kAcross - 0.5f));
  };
  return along(q.y) * kAcross + along(q.x);
}

/// Density per solid angle with which `sample` makes the unit direction d at the row.
template <class F>
GLOAM_HD F pdf(const LightGuide& guide, UintOf<F> row, Vec3Of<F> d) {
  const UintOf<F> cell = row * LightGuide::kSums + cell_of(to_square(d));
  const F probability = gather(guide.arriving.data, cell + 1u) - gather(guide.arriving.data, cell);
  return probability * (0.25f * kAcross * kAcross) * area_per_solid_angle(d);
}

/// A direction by u in [0, 1)²: a line of the map by u.y, a cell of it by u.x, a point in the cell
/// by what is left of both.
template <class F>
GLOAM_HD Vec3Of<F> sample(const LightGuide& guide, UintOf<F> row, Vec2Of<F> u) {
  const float* sums = guide.arriving.data;
  const auto find = [sums](UintOf<F> first, uint32_t stride, F target) {
    UintOf<F> low = 0u;
    for (uint32_t step = kAcross / 2; step > 0; step /= 2) {
      const UintOf<F> middle = low + step;
      low = select(gather(sums, first + middle * stride) <= target, middle, low);
    }
    return low;
  };
  const auto place = [](F x, F from, F to) {
    return clamp((x - from) / max(to - from, 1e-30f), 0.0f, 0.99999994f);
  };
  const UintOf<F> first = row * LightGuide::kSums;
  const UintOf<F> line = find(first, kAcross, u.y), cells = first + line * kAcross;
  const F begin = gather(sums, cells), end = gather(sums, cells + kAcross);
  const F target = lerp(begin, end, u.x);
  const UintOf<F> column = find(cells, 1, target);
  const F low = gather(sums, cells + column), high = gather(sums, cells + column + 1u);
  const Vec2Of<F> q{to_float(column) + place(target, low, high),
                    to_float(line) + place(u.y, begin, end)};
  return from_square(Vec2Of<F>{q.x * (2.0f / kAcross) - 1.0f, q.y * (2.0f / kAcross) - 1.0f});
}

}  // namespace gloam::directions

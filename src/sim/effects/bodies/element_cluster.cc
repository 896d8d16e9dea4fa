#include <algorithm>
#include <tuple>

#include "sim/effects/bodies/immersed_shape.h"

namespace gloam {

// Two elements along each axis make a cluster; those that are not full share.
void make_clusters(const double* low, ImmersedShape* shape) {
  const auto place = [low, shape](const VolumeElement& e) {
    uint64_t out = 0;
    for (int a = 2; a >= 0; --a)
      out = out << 16 | static_cast<uint64_t>((e.p[a] - low[a]) / (2 * shape->cell[a]));
    return out;
  };
  const auto key = [&](const VolumeElement& e) {
    return std::tuple(place(e), e.p[0], e.p[1], e.p[2]);
  };
  std::sort(shape->elements.begin(), shape->elements.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  for (size_t from = 0; from < shape->elements.size(); from += ElementCluster::kSide) {
    ElementCluster& cluster = shape->clusters.emplace_back();
    const size_t count = std::min(ElementCluster::kSide, shape->elements.size() - from);
    double most[3], least[3];
    std::copy_n(shape->elements[from].p, 3, most), std::copy_n(most, 3, least);
    for (size_t n = 0; n < count; ++n) {
      const VolumeElement& e = shape->elements[from + n];
      cluster.x[n] = e.p[0], cluster.y[n] = e.p[1], cluster.z[n] = e.p[2];
      cluster.volume[n] = e.volume;
      for (int a = 0; a < 3; ++a)
        most[a] = std::max(most[a], e.p[a]), least[a] = std::min(least[a], e.p[a]);
    }
    for (int a = 0; a < 3; ++a) {
      cluster.centre[a] = (most[a] + least[a]) / 2;
      cluster.half[a] = (most[a] - least[a]) / 2;
    }
  }
}

}  // namespace gloam

#include "sensors/imager/mosaic.h"

#include <algorithm>

#include "base/check.h"
#include "base/parallel.h"

namespace gloam {
namespace {

// The other colours change as the pixel's own does: gradient correction.
struct Estimates {
  float cross;       // estimate from the colour on the four sides, at red and blue: green
  float horizontal;  // estimate from the colour left and right, at green
  float vertical;    // estimate from the colour above and below, at green
  float diagonal;    // estimate from the colour at the corners: blue at red, red at blue
};

int mirror(int i, int n) {
  if (n == 1) return 0;
  while (i < 0 || i >= n) i = i < 0 ? -i : 2 * (n - 1) - i;  // keeps the place in the 2 x 2
  return i;
}

Estimates estimate(const std::vector<float>& values, int width, int height, int x, int y) {
  const auto at = [&](int dx, int dy) {
    return values[static_cast<size_t>(mirror(y + dy, height)) * static_cast<size_t>(width) +
                  static_cast<size_t>(mirror(x + dx, width))];
  };
  const float center = at(0, 0);
  const float sides_x = at(-1, 0) + at(1, 0), sides_y = at(0, -1) + at(0, 1);
  const float far_x = at(-2, 0) + at(2, 0), far_y = at(0, -2) + at(0, 2);
  const float corners = at(-1, -1) + at(1, -1) + at(-1, 1) + at(1, 1);
  Estimates out;
  out.cross = (4 * center + 2 * (sides_x + sides_y) - far_x - far_y) / 8;
  out.horizontal = (5 * center + 4 * sides_x - corners - far_x + 0.5f * far_y) / 8;
  out.vertical = (5 * center + 4 * sides_y - corners - far_y + 0.5f * far_x) / 8;
  out.diagonal = (6 * center + 2 * corners - 1.5f * (far_x + far_y)) / 8;
  return out;
}

}  // namespace

Mosaic::Mosaic(const std::string& name) {
  GLOAM_CHECK(name.size() == 4, "a mosaic must have four letters");
  for (size_t i = 0; i < 4; ++i) colors_[i] = name[i] == 'r' ? 0 : name[i] == 'g' ? 1 : 2;
}

void demosaic(const Mosaic& mosaic, const std::vector<float>& values, int width, int height,
              std::vector<Vec3f>* out) {
  out->resize(values.size());
  parallel_for_range("demosaic", height, 16, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < width; ++x) {
        const size_t i =
            static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
        const Estimates e = estimate(values, width, height, x, y);
        float rgb[3];
        const int own = mosaic.color(x, y);
        rgb[own] = values[i];
        if (own == 1) {
          rgb[mosaic.color(x + 1, y)] = e.horizontal;
          rgb[mosaic.color(x, y + 1)] = e.vertical;
        } else {
          rgb[1] = e.cross;
          rgb[2 - own] = e.diagonal;
        }
        (*out)[i] = {rgb[0], rgb[1], rgb[2]};
      }
    }
  });
}

}  // namespace gloam

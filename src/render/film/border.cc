#include "render/film/border.h"

#include <algorithm>

#include "render/kernel/film/border.h"

namespace gloam {
namespace {

void add_mirrored(const std::vector<Vec3f>& plane, const Film& film, int border,
                  std::vector<Vec3f>* wide) {
  wide->clear();
  if (plane.size() != film.pixel_count()) return;
  wide->reserve(static_cast<size_t>(film.width + 2 * border) *
                static_cast<size_t>(film.height + 2 * border));
  for (int y = -border; y < film.height + border; ++y) {
    const Vec3f* row = plane.data() + static_cast<ptrdiff_t>(mirrored(y, film.height)) * film.width;
    for (int x = -border; x < 0; ++x) wide->push_back(row[mirrored(x, film.width)]);
    wide->insert(wide->end(), row, row + film.width);
    for (int x = film.width; x < film.width + border; ++x)
      wide->push_back(row[mirrored(x, film.width)]);
  }
}

}  // namespace

void add_border(const Film& film, const std::vector<Vec3f>& radiance, int border, Film* wide) {
  wide->width = film.width + 2 * border;
  wide->height = film.height + 2 * border;
  add_mirrored(radiance, film, border, &wide->radiance);
  add_mirrored(film.albedo, film, border, &wide->albedo);
  add_mirrored(film.normal, film, border, &wide->normal);
}

void remove_border(const std::vector<Vec3f>& wide, const Film& film, int border,
                   std::vector<Vec3f>* out) {
  out->resize(film.pixel_count());
  const ptrdiff_t stride = film.width + 2 * border;
  for (int y = 0; y < film.height; ++y) {
    const Vec3f* row = wide.data() + (y + border) * stride + border;
    std::copy(row, row + film.width, out->begin() + static_cast<ptrdiff_t>(y) * film.width);
  }
}

}  // namespace gloam

#pragma once
// A mirrored border around a film: networks take what is beyond a picture for black, and so leave
// noise in its outermost rows and columns.

#include <vector>

#include "render/film/film.h"

namespace gloam {

/// Film of `radiance`, albedo and normal with `border` more pixels on each side. Planes that do not
/// have the film's size are left out.
void add_border(const Film& film, const std::vector<Vec3f>& radiance, int border, Film* wide);

/// Part of a plane with a border that belongs to the film.
void remove_border(const std::vector<Vec3f>& wide, const Film& film, int border,
                   std::vector<Vec3f>* out);

}  // namespace gloam

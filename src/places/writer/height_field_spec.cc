#include "places/writer/height_field_spec.h"

#include "places/writer/spec_edit.h"

#include <algorithm>

namespace gloam {
namespace {

constexpr double kFlat = 1e-6;  // [m] MuJoCo wants a height above 0, of flat fields too

}  // namespace

mjsGeom* add_height_field(const std::string& name, const HeightField& field, mjSpec* spec) {
  const auto [low, high] = std::minmax_element(field.z.begin(), field.z.end());
  const double base = *low, range = double{*high} - base;
  std::vector<float> share;  // MuJoCo's elevations: 0 the lowest … 1 the highest
  share.reserve(field.z.size());
  for (const float z : field.z)
    share.push_back(range > 0 ? static_cast<float>((z - base) / range) : 0);
  const HeightGrid& grid = field.grid;
  const double half_x = grid.step[0] * (grid.columns - 1) / 2;
  const double half_y = grid.step[1] * (grid.rows - 1) / 2;

  mjsHField* hfield = edit(mjs_addHField, spec);
  edit(mjs_setName, hfield->element, name.c_str());
  hfield->nrow = grid.rows;
  hfield->ncol = grid.columns;
  const double size[4] = {half_x, half_y, std::max(range, kFlat), field.base};
  std::copy(size, size + 4, hfield->size);
  edit(mjs_setFloat, hfield->userdata, share.data(), static_cast<int>(share.size()));

  mjsGeom* geom = edit(mjs_addGeom, mjs_findBody(spec, "world"), nullptr);
  edit(mjs_setName, geom->element, name.c_str());
  geom->type = mjGEOM_HFIELD;
  edit(mjs_setString, geom->hfieldname, name.c_str());
  const double middle[3] = {grid.low[0] + half_x, grid.low[1] + half_y, base};
  std::copy(middle, middle + 3, geom->pos);
  return geom;
}

}  // namespace gloam

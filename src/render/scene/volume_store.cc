#include "render/scene/volume_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cfloat>

#include "base/check.h"
#include "base/parallel.h"
#include "render/scene/black_body_table.h"
#include "render/scene/span_of.h"

namespace gloam {
namespace {

int cells_along(int voxels) { return (voxels + kBoundsVoxels - 1) / kBoundsVoxels; }

bool is_amount(float x) { return x >= 0 && x <= FLT_MAX; }

/// Calls store(cell, low, high) with the bounds of what trilinear lookups in the cells of one row
/// read. False if some value is no amount. Works along x in chunks, so that its scratch is on
/// the stack.
template <class Store>
bool bound_row(const VolumeView& v, const float* grid, int cell_y, int cell_z, const Store& store) {
  constexpr int kCells = 32, kRoom = kCells * kBoundsVoxels + 2;
  const int y0 = std::max(cell_y * kBoundsVoxels - 1, 0);
  const int y1 = std::min((cell_y + 1) * kBoundsVoxels, v.ny - 1);
  const int z0 = std::max(cell_z * kBoundsVoxels - 1, 0);
  const int z1 = std::min((cell_z + 1) * kBoundsVoxels, v.nz - 1);
  int bad = 0;
  for (int first = 0; first < v.cells_x; first += kCells) {
    const int last = std::min(first + kCells, v.cells_x);
    const int x0 = std::max(first * kBoundsVoxels - 1, 0);
    const int x1 = std::min(last * kBoundsVoxels, v.nx - 1);
    float low[kRoom], high[kRoom];
    std::fill(low, low + kRoom, FLT_MAX);
    std::fill(high, high + kRoom, 0.0f);
    for (int z = z0; z <= z1; ++z) {
      for (int y = y0; y <= y1; ++y) {
        const float* row = grid + (static_cast<size_t>(z) * v.ny + y) * v.nx + x0;
        for (int x = 0; x <= x1 - x0; ++x) {
          low[x] = min(low[x], row[x]);
          high[x] = max(high[x], row[x]);
          bad |= !is_amount(row[x]);
        }
      }
    }
    for (int cell = first; cell < last; ++cell) {
      const int from = std::max(cell * kBoundsVoxels - 1, 0) - x0;
      const int to = std::min((cell + 1) * kBoundsVoxels, v.nx - 1) - x0;
      store(cell, *std::min_element(low + from, low + to + 1),
            *std::max_element(high + from, high + to + 1));
    }
  }
  return bad == 0;
}

struct FieldsAreGood {
  std::atomic<bool> density = true, temperature = true;
};

void bound_cells(const VolumeView& v, const VolumeGrid& density, const VolumeGrid& temperature,
                 std::vector<CellBounds>* cells, FieldsAreGood* good) {
  const CellBounds even{v.fade > 0 ? 0.0f : v.even_density, v.even_density, v.even_temperature};
  cells->assign(static_cast<size_t>(v.cells_x) * v.cells_y * v.cells_z, even);
  const bool fades = v.fade > 0;
  parallel_for("volumes", static_cast<int64_t>(v.cells_y) * v.cells_z, [&](int64_t i) {
    const int y = static_cast<int>(i % v.cells_y), z = static_cast<int>(i / v.cells_y);
    CellBounds* row = cells->data() + i * v.cells_x;
    if (density && !bound_row(v, density->data(), y, z, [&](int cell, float low, float high) {
          row[cell].low = fades ? 0.0f : low;
          row[cell].high = high;
        })) {
      good->density = false;
    }
    if (temperature && !bound_row(v, temperature->data(), y, z,
                                  [&](int cell, float, float high) { row[cell].hottest = high; })) {
      good->temperature = false;
    }
  });
}

Error refuse_value(const VolumeDescription& volume, const std::vector<float>& grid,
                   const char* what) {
  const size_t i = std::find_if_not(grid.begin(), grid.end(), is_amount) - grid.begin();
  const size_t nx = static_cast<size_t>(volume.nx), ny = static_cast<size_t>(volume.ny);
  return {ErrorKind::kInput,
          fmt::format("volume '{}' has a {} of {} in voxel ({}, {}, {}); it must be 0 or more",
                      volume.name, what, grid[i], i % nx, i / nx % ny, i / nx / ny)};
}

Status check_extinction(const std::string& name, const VolumeView& v,
                        const std::vector<CellBounds>& cells) {
  float high = 0;
  for (const CellBounds& cell : cells) high = max(high, cell.high);
  const float k = *std::max_element(v.mass_extinction, v.mass_extinction + kMediumBands);
  if (k * high <= kMaxExtinction) return {};
  return Error{
      ErrorKind::kInput,
      fmt::format("volume '{}' has an extinction of up to {:.3g} 1/m ({:.3g} m²/kg at {:.3g} "
                  "kg/m³); the limit is {:.3g}",
                  name, k * high, k, high, kMaxExtinction),
      {},
      "use a surface for such dense matter"};
}

VolumeView place(const VolumeDescription& in, VolumeView out) {
  out.nx = in.nx;
  out.ny = in.ny;
  out.nz = in.nz;
  // Even fields need no voxels, whatever their number.
  if (!in.density && !in.temperature) out.nx = out.ny = out.nz = 1;
  const Vec3f n{static_cast<float>(out.nx), static_cast<float>(out.ny), static_cast<float>(out.nz)};
  out.voxel = {in.size.x / n.x, in.size.y / n.y, in.size.z / n.z};
  const Affine3f X_VG{
      {out.voxel.x, 0, 0}, {0, out.voxel.y, 0}, {0, 0, out.voxel.z}, in.size * -0.5f};
  out.X_GW = inverse(in.X_WV * X_VG);
  out.cells_x = cells_along(out.nx);
  out.cells_y = cells_along(out.ny);
  out.cells_z = cells_along(out.nz);
  out.even_density = in.even_density;
  out.even_temperature = in.even_temperature;
  out.fade = in.fade;
  out.changes = in.field >= 0;
  return out;
}

}  // namespace

Result<VolumeStore> VolumeStore::make(const std::vector<MediumDescription>& media,
                                      const std::vector<VolumeDescription>& volumes) {
  for (const MediumDescription& medium : media) GLOAM_TRY_STATUS(check_medium(medium));
  if (volumes.size() > kMaxVolumes) {
    return Error{ErrorKind::kInput,
                 fmt::format("the scene has {} volumes of participating media; the limit is {}",
                             volumes.size(), kMaxVolumes),
                 {},
                 "join volumes of the same medium into one grid"};
  }
  VolumeStore store;
  store.views_.resize(volumes.size());
  store.fields_.resize(volumes.size());
  store.glow_tables_.resize(volumes.size());
  store.glows_.reserve(volumes.size());
  if (!volumes.empty()) store.black_body_ = make_black_body_table();
  for (size_t i = 0; i < volumes.size(); ++i) {
    GLOAM_TRY_STATUS(check_volume(volumes[i], media.size()));
    const MediumDescription& medium = media[static_cast<size_t>(volumes[i].medium)];
    VolumeView& view = store.views_[i];
    std::copy(medium.mass_extinction.begin(), medium.mass_extinction.end(), view.mass_extinction);
    std::copy(medium.albedo.begin(), medium.albedo.end(), view.albedo);
    std::copy(medium.g.begin(), medium.g.end(), view.g);
    view.emission = medium.emission;
    GLOAM_TRY_STATUS(store.replace(i, volumes[i]));
  }
  return store;
}

Status VolumeStore::replace(size_t volume, const VolumeDescription& with) {
  GLOAM_CHECK(volume < views_.size(), "the volume does not exist");
  GLOAM_TRY_STATUS(check_volume(with, static_cast<size_t>(with.medium) + 1));
  VolumeView& old = views_[volume];
  Fields& fields = fields_[volume];
  VolumeView view = place(with, old);
  const bool same_bounds = !fields.cells.empty() && with.density == fields.density &&
                           with.temperature == fields.temperature && view.nx == old.nx &&
                           view.ny == old.ny && view.nz == old.nz && view.fade == old.fade &&
                           view.even_density == old.even_density &&
                           view.even_temperature == old.even_temperature;
  if (!same_bounds) {
    FieldsAreGood good;
    bound_cells(view, with.density, with.temperature, &fields.spare, &good);
    if (!good.density) return refuse_value(with, *with.density, "density");
    if (!good.temperature) return refuse_value(with, *with.temperature, "temperature");
    GLOAM_TRY_STATUS(check_extinction(with.name, view, fields.spare));
    fields.cells.swap(fields.spare);
  }
  fields.density = with.density;
  fields.temperature = with.temperature;
  view.cells = span_of(fields.cells);
  view.density = with.density ? span_of(*with.density) : DeviceSpan<const float>{};
  view.temperature = with.temperature ? span_of(*with.temperature) : DeviceSpan<const float>{};
  old = view;
  if (old.emission > 0) find_glow(volume);
  return {};
}

void VolumeStore::follow(const std::vector<VolumeDescription>& volumes, const PoseFrame& frame) {
  for (size_t i = 0; i < volumes.size(); ++i) {
    const int field = volumes[i].field;
    if (field < 0 || static_cast<size_t>(field) >= frame.fields.size()) continue;
    const PoseFrame::Field& grids = frame.fields[static_cast<size_t>(field)];
    VolumeDescription now = volumes[i];
    now.density = now.flame ? grids.flame : grids.density;
    now.temperature = now.flame ? nullptr : grids.temperature;
    if (fields_[i].density == now.density && fields_[i].temperature == now.temperature) continue;
    GLOAM_CHECK(replace(i, now).ok(), "an effect produced a field that cannot be rendered");
  }
}

void VolumeStore::find_glow(size_t changed) {
  glow_tables_[changed].build(view(), static_cast<uint32_t>(changed));
  glows_.clear();
  for (size_t i = 0; i < views_.size(); ++i) {
    views_[i].glow = glow_tables_[i].is_dark() ? -1 : static_cast<int>(glows_.size());
    if (!glow_tables_[i].is_dark()) glows_.push_back(glow_tables_[i].view());
  }
}

MediaView VolumeStore::view() const {
  return {span_of(views_), span_of(glows_), {span_of(black_body_)}};
}

}  // namespace gloam

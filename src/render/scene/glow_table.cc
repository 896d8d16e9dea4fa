#include "render/scene/glow_table.h"

#include <algorithm>

#include "base/parallel.h"

namespace gloam {
namespace {

constexpr int kVoxels = kBoundsVoxels * kBoundsVoxels * kBoundsVoxels;

/// The i-th cell, or voxel, of rows of nx and layers of nx x ny.
Vec3f place_of(int i, int nx, int ny) {
  const int x = i % nx, y = i / nx % ny, z = i / (nx * ny);
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

/// Corner of a cell [voxels].
Vec3f corner_of(const VolumeView& v, uint32_t cell) {
  return place_of(static_cast<int>(cell), v.cells_x, v.cells_y) * static_cast<float>(kBoundsVoxels);
}

/// Mean luminance that a voxel gives off per metre [cd/m³], from the eight middles of its octants:
/// at the rim of a flame its own middle may be dark.
double power_at(const MediaView& media, const VolumeView& v, Vec3f low) {
  const Vec3f absorption = Bands{}.of(v.mass_extinction) * (Vec3f{1, 1, 1} - Bands{}.of(v.albedo));
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3f p_G = low + Vec3f{(i & 1) != 0 ? 0.75f : 0.25f, (i & 2) != 0 ? 0.75f : 0.25f,
                                  (i & 4) != 0 ? 0.75f : 0.25f};
    const float density = media::density_at(v, p_G);
    if (density > 0) {
      sum +=
          static_cast<double>(luminance(absorption * media::glow_at(media, v, p_G, {}) * density));
    }
  }
  return sum / 8;
}

/// Running sums of a cell's voxels; returns their mean power times their number.
double sum_voxels(const MediaView& media, const VolumeView& v, uint32_t cell, float* sums) {
  const Vec3f corner = corner_of(v, cell);
  double power[kVoxels], total = 0, before = 0;
  for (int i = 0; i < kVoxels; ++i) {
    const Vec3f low = corner + place_of(i, kBoundsVoxels, kBoundsVoxels);
    const bool exists = low.x < static_cast<float>(v.nx) && low.y < static_cast<float>(v.ny) &&
                        low.z < static_cast<float>(v.nz);
    power[i] = exists ? power_at(media, v, low) : 0;
    total += power[i];
  }
  for (int i = 0; i < kVoxels; ++i) {
    sums[i] = total > 0 ? static_cast<float>(before / total) : 0.0f;
    before += power[i];
  }
  sums[kVoxels] = 1;
  return total;
}

}  // namespace

void GlowTable::build(const MediaView& media, uint32_t row) {
  const VolumeView& v = media.volumes[row];
  cells_.clear();
  cell_sums_.clear();
  float hottest = 0;
  for (uint32_t i = 0; i < v.cells.size; ++i) {
    if (!(v.cells[i].high > 0) || !media::glows(v, v.cells[i].hottest, {})) continue;
    cells_.push_back(i);
    hottest = max(hottest, v.cells[i].hottest);
  }
  if (cells_.empty()) return;
  power_.resize(cells_.size());
  voxel_sums_.resize(cells_.size() * GlowView::kSums);
  parallel_for("glow", static_cast<int64_t>(cells_.size()), [&](int64_t i) {
    const auto at = static_cast<size_t>(i);
    power_[at] = sum_voxels(media, v, cells_[at], &voxel_sums_[at * GlowView::kSums]);
  });
  double total = 0, before = 0;
  for (const double power : power_) total += power;
  if (!(total > 0)) return;

  cell_sums_.resize(v.cells.size + 1);
  rows_.assign(v.cells.size, -1);
  Vec3f low{1e30f, 1e30f, 1e30f}, high = -low;
  size_t next = 0;
  for (uint32_t cell = 0; cell < v.cells.size; ++cell) {
    cell_sums_[cell] = static_cast<float>(before / total);
    if (next == cells_.size() || cells_[next] != cell) continue;
    before += power_[next];
    if (power_[next] > 0) {
      rows_[cell] = static_cast<int>(next);
      const Vec3f from = corner_of(v, cell);
      low = {min(low.x, from.x), min(low.y, from.y), min(low.z, from.z)};
      high = {max(high.x, from.x), max(high.y, from.y), max(high.z, from.z)};
    }
    ++next;
  }
  cell_sums_[v.cells.size] = 1;

  const float edge = kBoundsVoxels;
  high = {min(high.x + edge, static_cast<float>(v.nx)),
          min(high.y + edge, static_cast<float>(v.ny)),
          min(high.z + edge, static_cast<float>(v.nz))};
  const float voxel = v.voxel.x * v.voxel.y * v.voxel.z;
  const Vec3f size = (high - low) * v.voxel;
  view_.volume = row;
  view_.low_G = low, view_.high_G = high;
  view_.X_WG = inverse(v.X_GW);
  view_.center = transform_point(view_.X_WG, (low + high) * 0.5f);
  view_.reach = 0.5f * length(size);
  view_.voxels_per_volume = 1 / voxel;
  // Thick media shine by their surface alone; of a convex body a quarter of it is seen on average.
  const Vec3f absorbed = Vec3f{1, 1, 1} - Bands{}.of(v.albedo);
  const float brightest = luminance(absorbed * media.black_body.at(hottest)) * v.emission;
  const float face = 0.5f * (size.x * size.y + size.y * size.z + size.z * size.x);
  view_.strength = min(static_cast<float>(total) * voxel, brightest * face);
}

GlowView GlowTable::view() const {
  GlowView view = view_;
  view.cell_sums = {cell_sums_.data(), static_cast<uint32_t>(cell_sums_.size())};
  view.rows = {rows_.data(), static_cast<uint32_t>(rows_.size())};
  view.voxel_sums = {voxel_sums_.data(), static_cast<uint32_t>(voxel_sums_.size())};
  return view;
}

}  // namespace gloam

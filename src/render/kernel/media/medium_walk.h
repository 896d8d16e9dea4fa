#pragma once
// A ray's way through the cells that bound a volume's density. Device-safe.

#include "render/kernel/media/medium_view.h"

namespace gloam {

/// Narrows [*begin, *end] of a line to what is in a box; false: the line runs beside it.
GLOAM_HD bool clip_to_box(Vec3f o, Vec3f d, Vec3f low, Vec3f high, float* begin, float* end) {
  bool is_beside = false;
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0) {
      is_beside = is_beside || !(o[a] >= low[a] && o[a] <= high[a]);
      continue;
    }
    const float at_low = (low[a] - o[a]) / d[a], at_high = (high[a] - o[a]) / d[a];
    *begin = max(*begin, min(at_low, at_high));
    *end = min(*end, max(at_low, at_high));
  }
  return !is_beside;
}

/// The cells of one volume along a ray, front to back (Amanatides and Woo 1987, "A fast voxel
/// traversal algorithm for ray tracing"). First comes the way to the box, with bounds of zero.
class CellWalk {
 public:
  /// False when no part of the segment [0, tmax] lies in the box.
  GLOAM_HD bool start(const VolumeView& volume, const Ray& ray, float tmax) {
    const Vec3f o = transform_point(volume.X_GW, ray.o), d = transform_vector(volume.X_GW, ray.d);
    const Vec3f high{static_cast<float>(volume.nx), static_cast<float>(volume.ny),
                     static_cast<float>(volume.nz)};
    const int cells[3] = {volume.cells_x, volume.cells_y, volume.cells_z};
    const int stride[3] = {1, volume.cells_x, volume.cells_x * volume.cells_y};
    float begin = 0;
    end_ = tmax;
    if (!clip_to_box(o, d, {}, high, &begin, &end_) || !(begin < end_)) return false;
    index_ = 0;
    for (int a = 0; a < 3; ++a) {
      const float at = (o[a] + d[a] * begin) / kBoundsVoxels;
      const int cell = static_cast<int>(clamp(at, 0.0f, static_cast<float>(cells[a] - 1)));
      index_ += cell * stride[a];
      const int wall = (d[a] > 0 ? cell + 1 : cell) * kBoundsVoxels;
      left_[a] = d[a] > 0 ? cells[a] - 1 - cell : cell;
      stride_[a] = d[a] > 0 ? stride[a] : -stride[a];
      delta_[a] = kBoundsVoxels / fabsf(d[a]);
      next_[a] =
          left_[a] > 0 && d[a] != 0 ? (static_cast<float>(wall) - o[a]) / d[a] : kNoCollision;
    }
    volume_ = &volume;
    is_inside_ = false;
    low_ = high_ = hottest_ = 0;
    to_ = begin;
    return true;
  }

  /// Moves to the next cell; false behind the last.
  GLOAM_HD bool advance() {
    if (to_ >= end_) return false;
    if (is_inside_) {
      const int a = axis_;
      index_ += stride_[a];
      next_[a] = --left_[a] > 0 ? next_[a] + delta_[a] : kNoCollision;
    }
    is_inside_ = true;
    axis_ = next_[0] <= next_[1] ? (next_[0] <= next_[2] ? 0 : 2) : (next_[1] <= next_[2] ? 1 : 2);
    const CellBounds bounds = volume_->cells[static_cast<uint32_t>(index_)];
    low_ = bounds.low;
    high_ = bounds.high;
    hottest_ = bounds.hottest;
    to_ = min(end_, max(to_, next_[axis_]));
    return true;
  }

  GLOAM_HD const VolumeView& volume() const { return *volume_; }
  GLOAM_HD float low() const { return low_; }  ///< bounds of the density here [kg/m³]
  GLOAM_HD float high() const { return high_; }
  GLOAM_HD float hottest() const { return hottest_; }  ///< [K]
  GLOAM_HD float to() const { return to_; }            ///< distance at which the cell ends [m]
  GLOAM_HD float end() const { return end_; }  ///< distance at which the ray leaves the box [m]

 private:
  static constexpr float kNoCollision = 3e38f;

  // Nothing is initialised before start(): most of MediumWalk's are never used.
  const VolumeView* volume_;
  float low_, high_, hottest_, to_, end_;
  float next_[3], delta_[3];  ///< distances: to the next wall across each axis, between walls [m]
  int stride_[3], left_[3];   ///< along each axis: in cells_, cells that follow
  int index_, axis_;
  bool is_inside_;
};

/// Whether some part of the segment [0, tmax] lies in a volume. If not, the random walks of
/// medium.h use no random numbers.
GLOAM_HD bool meets_media(const MediaView& media, const Ray& ray, float tmax) {
  CellWalk walk;
  for (uint32_t i = 0; i < media.volumes.size; ++i) {
    if (walk.start(media.volumes[i], ray, tmax)) return true;
  }
  return false;
}

/// Several volumes at once: segments on which no bound changes.
class MediumWalk {
 public:
  GLOAM_HD MediumWalk(const MediaView& media, const Ray& ray, float tmax) {
    for (uint32_t i = 0; i < media.volumes.size && count_ < kMaxVolumes; ++i) {
      if (walks_[count_].start(media.volumes[i], ray, tmax)) ++count_;
    }
    find_end();
  }

  GLOAM_HD bool is_over() const { return count_ == 0; }
  GLOAM_HD int count() const { return count_; }
  GLOAM_HD const CellWalk& operator[](int i) const { return walks_[i]; }
  GLOAM_HD float to() const { return to_; }  ///< distance at which the segment ends [m]

  /// Moves to the next segment.
  GLOAM_HD void advance() {
    for (int i = 0; i < count_;) {
      if (walks_[i].to() <= to_ && !walks_[i].advance()) {
        walks_[i] = walks_[--count_];
      } else {
        ++i;
      }
    }
    find_end();
  }

 private:
  GLOAM_HD void find_end() {
    to_ = 3e38f;
    for (int i = 0; i < count_; ++i) to_ = min(to_, walks_[i].to());
  }

  CellWalk walks_[kMaxVolumes];
  int count_ = 0;
  float to_;
};

}  // namespace gloam

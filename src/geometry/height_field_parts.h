#pragma once
// Floors as height fields: fields are solid from their surface down to a base, without holes.

#include "geometry/height_field.h"

namespace gloam {

/// Solid from `z` down to `base` below its lowest sample.
struct HeightField {
  HeightGrid grid;
  int column = 0, row = 0;  ///< place of its first sample in the floors' grid
  double base = 1;          ///< [m]
  std::vector<float> z;     ///< [m], by row and column
  int64_t filled = 0;       ///< samples without a hit

  float at(int c, int r) const {
    return z[static_cast<size_t>(r) * static_cast<size_t>(grid.columns) + static_cast<size_t>(c)];
  }
  /// At a point of a cell, `u` and `v` 0 … 1 of it along x and y. MuJoCo cuts cells from their low
  /// corner to their high one.
  double height(int c, int r, double u, double v) const;
};

/// The lowest floor at each sample. Where there is none it takes the lowest of the eight around
/// that are known, ring by ring. Error: there is none anywhere.
Result<HeightField> ground_of(const Floors& floors);

/// Slabs: thickness of the base, and the height by which they may shorten the air over the floor
/// beneath [m].
inline constexpr double kSlabBase = 0.05, kMostLostAir = 0.2;
inline constexpr size_t kMostSlabs = 255;

/// The floors above the ground, in rectangles without holes that share their borders. A field is
/// solid, so that a slope over another floor is cut into pieces no higher than kMostLostAir. Edges,
/// where a floor ends or climbs by more than kFloorClearance and 2:1 from one sample to the next,
/// are gaps of less than a cell. Error: more than kMostSlabs.
Result<std::vector<HeightField>> slabs_of(const Floors& floors);

/// Vertical distance from the source to the fields that stand for it [m].
struct HeightError {
  double mean = 0, p95 = 0, most = 0;
  int64_t points = 0;
};
/// At a random point of every cell whose corners all met something, floor by floor, to the nearest
/// of the fields there.
Result<HeightError> height_error(std::span<const PlacedMesh> meshes, const Floors& floors,
                                 std::span<const HeightField> fields);

}  // namespace gloam

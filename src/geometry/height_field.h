#pragma once
// Ground as heights over a regular grid, sampled from triangles. W: any frame with z up [m].

#include <array>
#include <span>
#include <vector>

#include "geometry/mesh/mesh.h"
#include "gloam/result.h"

namespace gloam {

/// A mesh in its place. X_WI may scale, shear and mirror; what is outside stays outside.
struct PlacedMesh {
  const TriangleMesh* mesh = nullptr;
  AffineOf<double> X_WI;
};

/// Samples lie at low + (column, row) * step [m].
struct HeightGrid {
  std::array<double, 2> low{}, step{};
  int columns = 0, rows = 0;
  size_t size() const { return static_cast<size_t>(columns) * static_cast<size_t>(rows); }
};

/// Limit on all layers of a grid together: 4096 x 4096.
inline constexpr int64_t kMostHeightSamples = int64_t{1} << 24;
/// Least height of air over a floor that lies under something [m].
inline constexpr double kFloorClearance = 0.3;

/// From low to high, both included, in equal steps of at most `resolution` [m]. Errors: low is not
/// below high, too many samples.
Result<HeightGrid> make_height_grid(const std::array<double, 2>& low,
                                    const std::array<double, 2>& high, double resolution,
                                    int layers);

/// Bounds of all vertices; false when there are none.
bool bounds_of(std::span<const PlacedMesh> meshes, Vec3Of<double>* low, Vec3Of<double>* high);

/// Floors over the samples of a grid, from above. The first is the highest surface, whichever way
/// it faces (scans have holes and turned triangles); the others face up and have kFloorClearance of
/// air over them.
struct Floors {
  HeightGrid grid;
  int layers = 1;
  std::vector<float> z;  ///< [m], by layer, row, column; NaN where there are no more floors
  float at(int layer, size_t sample) const {
    return z[static_cast<size_t>(layer) * grid.size() + sample];
  }
};

/// Triangles that share an edge leave no gap, nor do those that a sample touches exactly; steps
/// that are exactly vertical count where a sample meets them. The same for any number of threads.
/// With `seed` != 0 each sample is at a random place of the cell that begins at its corner, instead
/// (one y for a row). Error: far too many surfaces over
/// one another.
Result<Floors> sample_floors(std::span<const PlacedMesh> meshes, const HeightGrid& grid, int layers,
                             uint64_t seed = 0);
/// Place of a sample with a seed, in its cell, 0 … 1.
std::array<double, 2> place_in_cell(uint64_t seed, int column, int row);

}  // namespace gloam

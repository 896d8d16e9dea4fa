#pragma once
// Walls in the solver's own layout, and what follows from them: how far a cell is from any wall,
// and which cells have no way to open air.

#include <cstdint>

#include "sim/effects/gas/gas_walls.h"
#include "sim/effects/gas/kernel/trace.h"
#include "sim/effects/gas/rows.h"

namespace gloam::gas {

struct Openings {
  Shape shape;
  bool side_open[6] = {};          ///< -x +x -y +y -z +z
  std::vector<uint8_t> solid;      ///< ghosts: 0
  std::vector<uint8_t> moving[3];  ///< faces closed by something that moves along their axis
  /// Cells in every direction, diagonals too, to which all faces are open; at most kReach.
  std::vector<uint8_t> clearance;
  /// 0 = joined with open air, or solid; else 1 + the number of an enclosed space.
  std::vector<int> space;
  int enclosed = 0;  ///< number of enclosed spaces of two cells or more

  Openings(const Shape& s, const bool (&open)[6]);
  /// Sets `open`, 1 or 0 per face, with the sides of the box; what is solid and what moves.
  void set(const GasWalls& walls, const Faces<float>& open);
  /// Sets the rest by what is open.
  void measure(const Faces<const float>& open);
  /// Faces of the cell at c that move.
  int moving_faces(int c) const {
    return moving[0][size_t(c)] + moving[0][size_t(c) + 1] + moving[1][size_t(c)] +
           moving[1][size_t(c + shape.sy)] + moving[2][size_t(c)] + moving[2][size_t(c + shape.sz)];
  }

 private:
  void find_clearance(const Faces<const float>& open);
  void find_spaces(const Faces<const float>& open);
  int root(int run);
  void join(int a, int b);

  std::vector<uint8_t> near_, spread_;        ///< scratch of find_clearance()
  std::vector<int> parent_, number_, count_;  ///< arrays of runs, of find_spaces()
};

}  // namespace gloam::gas

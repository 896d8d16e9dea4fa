#pragma once
// How strongly a luminaire shines into each direction: photometric files after ANSI/IESNA LM-63
// (1986, 1991, 1995, 2002, 2019), goniometer types A, B and C.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "gloam/result.h"

namespace gloam {

/// Luminous intensity on a regular grid about the luminaire's frame L: it hangs from +Z and shines
/// along -Z. Row i is at the angle pi i / (rows - 1) from -Z; column j at 2 pi j / columns from +X
/// towards +Y; one column when it is the same all around.
///
/// Type C: vertical angles count from -Z, horizontal ones from +X. Types A and B: the beam's axis
/// (0, 0) is -Z, horizontal angles count towards +X and vertical ones towards +Y; the polar axis is
/// Y for type A and X for type B.
struct IesProfile {
  int rows = 0, columns = 0;
  std::vector<float> candela;  ///< (rows x columns) [cd], finite, >= 0
  double flux = 0;             ///< of the grid, interpolated, over the sphere [lm]
  float most = 0;              ///< [cd]

  /// Towards the unit direction d_L, bilinear in the angles [cd].
  float intensity(Vec3f d_L) const;
};

/// `name` is for messages. Intensities are the file's times its multiplier and ballast factors.
/// Outside of the measured angles there is no light. TILT=INCLUDE is read past: the luminaire hangs
/// as it was measured. Errors, with the line: no photometric file, a number missing or wrong,
/// angles that do not rise or do not fit their type, TILT in a file of its own, a grid over 2^20
/// values.
Result<IesProfile> parse_ies(std::string_view text, const std::string& name);

/// The same from a file of at most 16 MiB.
Result<IesProfile> read_ies(const std::filesystem::path& path);

}  // namespace gloam

#pragma once
// Intensity of a luminaire by direction: photometric files after ANSI/IESNA LM-63 (1986, 1991,
// 1995, 2002, 2019), goniometer types A, B and C.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "gloam/result.h"

namespace gloam {

/// Bilinear look-up in a grid as IesProfile has it, towards the unit direction d_L.
GLOAM_HD float ies_intensity(const float* grid, int rows, int columns, Vec3f d_L) {
  const float y = atan2f(square_root(d_L.x * d_L.x + d_L.y * d_L.y), -d_L.z) * kInvPi *
                  static_cast<float>(rows - 1);
  const int row = static_cast<int>(clamp(y, 0.0f, static_cast<float>(rows - 2)));
  float x = 0;
  if (columns > 1) {
    x = atan2f(d_L.y, d_L.x) * 0.5f * kInvPi * static_cast<float>(columns);
    if (x < 0) x += static_cast<float>(columns);
  }
  const int column = static_cast<int>(x) % columns, beside = (column + 1) % columns;
  const float* row0 = grid + static_cast<size_t>(row) * static_cast<size_t>(columns);
  const float* row1 = row0 + columns;
  const float share = x - floorf(x);
  return lerp(lerp(row0[column], row0[beside], share), lerp(row1[column], row1[beside], share),
              clamp(y - static_cast<float>(row), 0.0f, 1.0f));
}

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
  double flux = 0;             ///< flux of the grid, interpolated, over the sphere [lm]
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

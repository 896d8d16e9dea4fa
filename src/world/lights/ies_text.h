#pragma once
// The text of a photometric file as numbers. Behind world/lights/ies_profile.h.

#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

enum class Goniometer { kC = 1, kB = 2, kA = 3 };

/// Angles rise strictly [degrees]; intensities are [cd], all factors applied, finite, >= 0.
struct IesMeasurement {
  Goniometer type = Goniometer::kC;
  std::vector<double> vertical, horizontal;
  std::vector<double> candela;                 ///< (horizontal x vertical)
  int vertical_line = 0, horizontal_line = 0;  ///< lines where the angles begin
};

Result<IesMeasurement> read_ies_text(std::string_view text, const std::string& name);

}  // namespace gloam

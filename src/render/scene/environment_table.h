#pragma once
// The buffers behind an EnvironmentView: mip levels, and the running sums that directions are
// sampled by.

#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "render/kernel/light/environment_map.h"

namespace gloam {

class EnvironmentTable {
 public:
  /// An equirectangular map, laid out as render/kernel/light/environment_map.h says. `texels`:
  /// linear Rec. 709, (height x width), finite and not negative. `name` is for messages. Errors: an
  /// empty or too large map (kMaxImagePixels), a number of texels that is not width x height, a
  /// texel that is no light.
  static Result<EnvironmentTable> make(int width, int height, std::span<const Vec3f> texels,
                                       const std::string& name);

  /// Valid while the table lives and is not moved. `R_WE`: the map's axes in the world; `scale`:
  /// luminance of a texel of one [cd/m²], finite, >= 0.
  EnvironmentView view(const Frame& R_WE, float scale) const;

 private:
  std::vector<Vec3f> texels_;
  std::vector<EnvironmentLevel> levels_;
  std::vector<float> row_cdf_, column_cdf_;  ///< empty: black
  float illuminance_ = 0;                    ///< of texels with a scale of one
};

/// E turned by `angle` [rad] about the world's Z, counter-clockwise from above.
Frame turned_about_z(float angle);

}  // namespace gloam

#pragma once
// Light levels of lamps and glowing materials with schedules while the shutter is open.

#include <vector>

#include "world/render_description.h"

namespace gloam {

/// Light level of one lamp or material.
struct LightLevel {
  float mean = 1;  ///< factor on its light
  int row = -1;    ///< of LevelTable::bins(), in bins; -1 = it stays at the mean
};

class LevelTable {
 public:
  /// Updates for a shutter that is open from `open` to `close` [s].
  void update(const RenderDescription& description, double open, double close);

  const std::vector<LightLevel>& lights() const { return lights_; }
  const std::vector<LightLevel>& materials() const { return materials_; }
  /// SceneView::light_levels: bin_count() even spans of time of each row, as fractions of the mean.
  const std::vector<float>& bins() const { return bins_; }
  uint32_t bin_count() const { return bin_count_; }

 private:
  LightLevel level(const RenderDescription& description, int schedule, uint32_t lamp, double open,
                   double close);

  std::vector<LightLevel> lights_, materials_;
  std::vector<float> bins_;
  uint32_t bin_count_ = 0;
};

}  // namespace gloam

#include "sensors/lidar/lidar_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/angle.h"
#include "scene/options/lidar_names.h"
#include "scene/options/pattern_names.h"
#include "sensors/lidar/lidar_presets.h"

namespace gloam {
namespace {

template <class To, class From>
void set(To* to, const std::optional<From>& from) {
  if (from) *to = static_cast<To>(*from);
}

float radians(double degrees) { return static_cast<float>(degrees * kDegree); }

void set_rings(const LidarOptions& options, LidarModel* model) {
  if (!options.elevations) return;
  model->elevations.clear();
  for (const double degrees : *options.elevations) model->elevations.push_back(radians(degrees));
  std::sort(model->elevations.begin(), model->elevations.end());
  model->delays.clear();
}

void set_optics(const LidarOptions& options, LidarOptics* optics) {
  if (options.wavelength) {
    optics->band = *options.wavelength == 1550 ? MediumBand::k1550nm : MediumBand::k905nm;
  }
  set(&optics->min_range, options.min_range);
  set(&optics->max_range, options.max_range);
  if (options.range_at_10_percent)
    optics->threshold = lidar_threshold(*options.range_at_10_percent);
  if (options.divergence) {
    const auto& [across, up] = *options.divergence;
    optics->divergence = {radians(across), radians(up)};
  }
  if (options.beam_size) {
    optics->beam_size = {static_cast<float>((*options.beam_size)[0]),
                         static_cast<float>((*options.beam_size)[1])};
  }
  set(&optics->receiver_diameter, options.receiver_diameter);
  if (options.receiver_diameter || options.beam_size)
    optics->receiver_offset = offset_of_lenses(*optics);
  set(&optics->receiver_offset, options.receiver_offset);
  if (options.receiver_view) optics->receiver_view = radians(*options.receiver_view);
  set(&optics->resolution, options.pulse_length);
  set(&optics->range_sigma, options.range_noise);
  optics->footprint_rays = options.footprint_rays;
  if (options.returns)
    optics->returns = static_cast<LidarReturns>(place_of(*options.returns, kLidarReturns));
  optics->most_returns = 1;
  if (optics->returns == LidarReturns::kDual) optics->most_returns = 2;
  if (optics->returns == LidarReturns::kAll) optics->most_returns = options.most_returns;
  optics->noisy = options.noise;
}

}  // namespace

Result<LidarModel> make_lidar_model(const LidarOptions& options) {
  const auto bad = [&](const std::string& what, std::string hint) {
    return Error{ErrorKind::kInput, fmt::format("lidar '{}' {}", options.name, what), options.loc,
                 std::move(hint)};
  };
  const LidarPreset* preset = find_lidar_preset(options.preset);
  if (preset == nullptr) return bad(fmt::format("has an unknown preset '{}'", options.preset), "");
  LidarModel model = preset->make();
  if (options.pattern) {
    model.pattern = static_cast<LidarPatternKind>(place_of(*options.pattern, kLidarPatterns));
  }
  set(&model.rate, options.rate);
  set_rings(options, &model);
  set(&model.columns, options.columns);
  set(&model.rows, options.rows);
  set(&model.points, options.points);
  if (options.azimuth) {
    model.azimuth_from = radians((*options.azimuth)[0]);
    model.azimuth_to = radians((*options.azimuth)[1]);
  }
  if (options.field_of_view) {
    model.width = radians((*options.field_of_view)[0]);
    model.height = radians((*options.field_of_view)[1]);
  }
  set(&model.clockwise, options.clockwise);
  set_optics(options, &model.optics);

  if (!(model.optics.min_range < model.optics.max_range)) {
    return bad(fmt::format("has a range from {} m to {} m", model.optics.min_range,
                           model.optics.max_range),
               "'max_range' must be greater than 'min_range'");
  }
  // Limit on the beams of a scan; the densest sensors that are sold have less than a million.
  constexpr int64_t kMostBeams = int64_t{1} << 22;
  const bool spins = model.pattern == LidarPatternKind::kSpinning;
  const bool is_rosette = model.pattern == LidarPatternKind::kRosette;
  const int64_t rings = spins ? static_cast<int64_t>(model.elevations.size()) : model.rows;
  const int64_t beams = is_rosette ? model.points : rings * model.columns;
  if (beams > kMostBeams) {
    return bad(fmt::format("has {} beams; the limit is {}", beams, kMostBeams),
               "reduce 'columns', 'rows' or 'points'");
  }
  switch (model.pattern) {
    case LidarPatternKind::kSpinning:
      if (model.elevations.empty()) {
        return bad("has no rings", "set 'elevations' or use a preset with rings");
      }
      break;
    case LidarPatternKind::kRaster:
    case LidarPatternKind::kFlash:
      if (model.rows < 1 || !(model.width > 0)) {
        return bad("has an incomplete grid",
                   "set 'rows', 'columns' and 'field_of_view' for this pattern");
      }
      break;
    case LidarPatternKind::kRosette:
      if (model.points < 1 || model.prism_hz[0] == 0) {
        return bad("has no rotating prisms", "use the preset \"Mid-40\" for a rosette");
      }
  }
  return model;
}

}  // namespace gloam

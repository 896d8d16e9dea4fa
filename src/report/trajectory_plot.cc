// Plot of `gloam evaluate`.

#include "gloam/report.h"
#include "report/svg_chart.h"

namespace gloam {

std::string trajectory_plot(const TrajectoryPair& pair, const PoseErrors& absolute) {
  const auto from_above = [](const Trajectory& of, int color) {
    ChartCurve curve;
    curve.label = of.name;
    curve.color = color;
    for (const Vec3& p : of.positions) {
      curve.x.push_back(p.x);
      curve.y.push_back(p.y);
    }
    return curve;
  };
  Chart ground{.title = "From above: reference dotted, estimate solid",
               .x_label = "x [m]",
               .y_label = "y [m]",
               .equal_scale = true,
               .width = 760,
               .height = 480};
  ground.curves = {from_above(pair.reference, 6), from_above(pair.estimate, 0)};
  ground.curves[0].is_target = true;
  const std::vector<int64_t>& stamps =
      pair.reference.stamps.empty() ? pair.estimate.stamps : pair.reference.stamps;
  Chart errors{.title = "Absolute translation error",
               .x_label = stamps.empty() ? "pose" : "time from the first pose [s]",
               .y_label = "[m]",
               .width = 760,
               .height = 240};
  ChartCurve curve;
  curve.label = "ATE";
  for (size_t k = 0; k < absolute.values.size(); ++k) {
    const size_t i = absolute.poses[k];
    curve.x.push_back(stamps.empty() ? static_cast<double>(i)
                                     : 1e-9 * static_cast<double>(stamps[i] - stamps[0]));
    curve.y.push_back(absolute.values[k]);
  }
  errors.curves = {curve};
  return chart_file({ground, errors});
}

}  // namespace gloam

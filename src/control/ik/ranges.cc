#include "control/ik/ranges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam::ik {

Error refuse_value(const char* what) { return Error{ErrorKind::kInput, what}; }

Status check_gains(double gain, double lm_damping) {
  if (!(gain >= 0 && gain <= 1)) return refuse_value("the gain of a task must lie within 0..1");
  if (!(lm_damping >= 0 && std::isfinite(lm_damping)))
    return refuse_value("'lm_damping' of a task must be finite and not negative");
  return {};
}

Status check_costs(std::span<const double> costs) {
  if (!std::ranges::all_of(costs, [](double c) { return c >= 0 && std::isfinite(c); }))
    return refuse_value("costs of a task must be finite and not negative");
  return {};
}

Status check_finite(std::span<const double> values, const char* what) {
  if (std::ranges::all_of(values, [](double v) { return std::isfinite(v); })) return {};
  return Error{ErrorKind::kInput, fmt::format("{} is not finite", what)};
}

Status check_pose(const Pose& X) {
  const double values[] = {X.p.x, X.p.y, X.p.z, X.q.w, X.q.x, X.q.y, X.q.z};
  GLOAM_TRY_STATUS(check_finite(values, "the target of a frame"));
  const double norm = std::hypot(std::hypot(X.q.w, X.q.x), std::hypot(X.q.y, X.q.z));
  if (!(norm > 1e-6)) return refuse_value("the target of a frame has a quaternion of length zero");
  return {};
}

}  // namespace gloam::ik

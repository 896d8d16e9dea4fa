#include "metrics/declared_metric.h"

#include <fmt/format.h>

#include <cmath>

#include "base/log.h"

namespace gloam {

Result<DeclaredMetric> DeclaredMetric::make(const MetricOptions& options,
                                            const CompiledWorld& world,
                                            const std::vector<BuiltinColumn>& builtin, int robot) {
  DeclaredMetric metric;
  metric.options_ = options;
  metric.robot_ = robot;
  const std::string prefix = robot < 0 ? "" : world.robots[static_cast<size_t>(robot)].name;
  metric.name_ = prefix.empty() ? options.name : prefix + "." + options.name;
  Quantities quantities(world, builtin, robot);
  auto expression = Expression::parse(options.value, quantities);
  if (!expression.ok()) {
    Error error = std::move(expression).error();
    error.message = fmt::format("metric '{}', {}: {}", options.name,
                                place_in_expression(error.loc, options.value), error.message);
    error.loc = options.loc;
    return error;
  }
  metric.expression_ = std::move(*expression);
  metric.readers_ = quantities.take_readers();
  metric.inputs_.resize(quantities.size());
  return metric;
}

std::string DeclaredMetric::column() const { return with_unit(name_, options_.unit); }

void DeclaredMetric::begin_episode() {
  reduction_ = {};
  next_ = 0;
}

double DeclaredMetric::sample(const MetricInstant& instant) {
  const SnapshotData& at = instant.snapshot->data();
  if (options_.rate) {
    if (!has_schedule_)
      schedule_ = StepSchedule::at_most(*options_.rate, exact_rational(at.timestep));
    has_schedule_ = true;
    if (at.step < schedule_.step_of(next_)) return NAN;
    next_ = schedule_.first_at_or_after(at.step + 1);
  }
  for (const QuantityReader& reader : readers_)
    reader.read(instant, reader, inputs_.data() + reader.first);
  double value = expression_.evaluate(inputs_);
  if (!std::isfinite(value)) {
    if (missing_++ == 0)
      log_warning("metric '{}' is {} at t = {} s: its cell stays empty, and reductions skip it",
                  name_, std::isnan(value) ? "not a number" : "infinite", instant.time());
    value = NAN;
  }
  reduction_.add(instant.time(), value);
  return value;
}

void DeclaredMetric::summarize(std::vector<MetricNumber>* numbers) const {
  for (const std::string& kind : options_.reduce) {
    const std::optional<double> value = reduction_.get(kind);
    const std::string unit = reduced_unit(kind, options_.unit);
    if (value) numbers->emplace_back(with_unit(name_ + "_" + kind, unit), *value);
  }
}

}  // namespace gloam

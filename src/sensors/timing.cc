#include "sensors/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "sensors/signal/draw.h"

namespace gloam {
namespace {

constexpr double kTruncationSigma = 4;  // standard deviations

double cut_normal(uint64_t seed, uint32_t stream, int64_t k) {
  const double x = draw_normal({seed, stream}, static_cast<uint64_t>(k), 0);
  return std::clamp(x, -kTruncationSigma, kTruncationSigma);
}

}  // namespace

uint64_t sensor_seed(uint64_t simulation_seed, const std::string& name) {
  return hash_bytes(name.data(), name.size(), simulation_seed);
}

Result<SensorTiming> SensorTiming::make(Rational rate, const TimingOptions& options,
                                        Rational timestep, uint64_t seed) {
  SensorTiming timing;
  GLOAM_TRY(timing.schedule_, StepSchedule::make(rate, options.phase, timestep));
  timing.options_ = options;
  timing.timestep_ = timestep.value();
  timing.seed_ = seed;
  const double period = 1 / rate.value();
  const auto check = [&](const char* what, double jitter, double room) -> Status {
    if (jitter <= room / (2 * kTruncationSigma) * (1 + 1e-9)) return {};
    return Error{ErrorKind::kInput,
                 fmt::format("a {} of {} s at {:g} Hz would change the order of samples", what,
                             jitter, rate.value()),
                 options.loc,
                 fmt::format("use at most {:.3g} s", std::max(0.0, room / (2 * kTruncationSigma)))};
  };
  if (options.jitter > 0)
    GLOAM_TRY_STATUS(check("jitter", options.jitter, period - timing.timestep_));
  GLOAM_TRY_STATUS(check("latency_jitter", options.latency_jitter, period));
  return timing;
}

int64_t SensorTiming::step_of(int64_t k) const {
  const int64_t step = schedule_.step_of(k);
  if (options_.jitter == 0) return step;
  const double jitter =
      options_.jitter / timestep_ * cut_normal(seed_, stream_id("timing.jitter"), k);
  return std::max<int64_t>(
      0, step + static_cast<int64_t>(std::ceil(jitter - schedule_.lateness_of(k))));
}

int64_t SensorTiming::first_at_or_after(int64_t step) const {
  // Jitter moves a sample by less than half a period, so the neighbours are all to look at.
  int64_t k = std::max<int64_t>(0, schedule_.first_at_or_after(step) - 1);
  while (step_of(k) < step) ++k;
  return k;
}

std::function<int64_t(int64_t step)> due_steps(const SensorTiming& timing) {
  return [timing](int64_t step) { return timing.step_of(timing.first_at_or_after(step)); };
}

bool SensorTiming::dropped(int64_t k) const {
  if (options_.drop <= 0) return false;
  const RandomStream stream{seed_, stream_id("timing.drop")};
  return stream.uniform(static_cast<uint64_t>(k), 0) < options_.drop;
}

double delivery_time(const TimingOptions& options, uint64_t seed, int64_t k, double time) {
  double latency = options.latency;
  if (options.latency_jitter > 0)
    latency += options.latency_jitter * cut_normal(seed, stream_id("timing.latency"), k);
  return time + std::max(0.0, latency);
}

}  // namespace gloam

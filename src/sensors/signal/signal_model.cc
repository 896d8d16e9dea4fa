#include "sensors/signal/signal_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sensors/signal/draw.h"

namespace gloam {
namespace {

constexpr double kSpacing = 4;     // between relaxation times
constexpr double kLongest = 3600;  // [s]
// Flat part of the Allan deviation over B, where the spectrum is B² / (2 pi f).
const double kFlat = std::sqrt(2 * std::numbers::ln2 / std::numbers::pi);

double normal(uint64_t seed, const char* stream, int64_t k, size_t index) {
  return draw_normal({seed, stream_id(stream)}, static_cast<uint64_t>(k),
                     static_cast<uint32_t>(index));
}

// q * (1, e / 2), normalised: a small rotation in the frame that q turns.
void turn(std::span<double> q, const double e[3]) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double a = 0.5 * e[0], b = 0.5 * e[1], c = 0.5 * e[2];
  q[0] = w - x * a - y * b - z * c;
  q[1] = x + w * a + y * c - z * b;
  q[2] = y + w * b + z * a - x * c;
  q[3] = z + w * c + x * b - y * a;
}

void normalise(std::span<double> v) {
  double square = 0;
  for (const double x : v) square += x * x;
  if (square <= 0) return;
  for (double& x : v) x /= std::sqrt(square);
}

}  // namespace

SignalModel::SignalModel(const SignalErrors& errors, SensorKind kind, int count, double rate,
                         uint64_t seed)
    : errors_(errors),
      kind_(kind),
      components_(kind == SensorKind::kRotation ? 3 : static_cast<size_t>(count)),
      period_(1 / rate),
      seed_(seed) {
  if (errors.bias_instability > 0) {
    for (double t = 4 * period_; t < kSpacing * kLongest; t *= kSpacing) times_.push_back(t);
    const double b = errors.bias_instability / kFlat;
    relaxation_variance_ = b * b * std::log(kSpacing) / std::numbers::pi;
  }
  for (size_t i = 0; i < components_; ++i) {
    constant_.push_back(errors.offset + errors.bias * normal(seed, "signal.bias", 0, i));
    scale_.push_back(1 + errors.scale_error * normal(seed, "signal.scale", 0, i));
  }
  restart();
}

void SignalModel::restart() {
  k_ = 0;
  walked_.assign(components_, 0);
  relaxed_.resize(components_ * times_.size());
  for (size_t i = 0; i < relaxed_.size(); ++i)
    relaxed_[i] = std::sqrt(relaxation_variance_) * normal(seed_, "signal.relaxation", 0, i);
}

void SignalModel::advance() {
  ++k_;
  for (size_t i = 0; i < relaxed_.size(); ++i) {
    const double keep = std::exp(-period_ / times_[i % times_.size()]);
    relaxed_[i] = keep * relaxed_[i] + std::sqrt(relaxation_variance_ * (1 - keep * keep)) *
                                           normal(seed_, "signal.relaxation", k_, i);
  }
  if (errors_.random_walk <= 0) return;
  for (size_t i = 0; i < components_; ++i)
    walked_[i] += errors_.random_walk * std::sqrt(period_) * normal(seed_, "signal.walk", k_, i);
}

double SignalModel::drift(size_t component, int64_t k) const {
  double sum = constant_[component] + walked_[component];
  for (size_t i = 0; i < times_.size(); ++i) sum += relaxed_[component * times_.size() + i];
  const double white = std::hypot(errors_.noise, errors_.noise_density * std::sqrt(0.5 / period_));
  if (white > 0) sum += white * normal(seed_, "signal.white", k, component);
  return sum;
}

void SignalModel::apply(int64_t k, std::span<double> values) {
  if (k < k_) restart();
  const bool drifts = !times_.empty() || errors_.random_walk > 0;
  if (!drifts) k_ = k;
  while (k_ < k) advance();
  if (kind_ == SensorKind::kRotation) {
    const double e[3] = {drift(0, k), drift(1, k), drift(2, k)};
    turn(values, e);
    return normalise(values);
  }
  for (size_t i = 0; i < values.size(); ++i) {
    if (kind_ == SensorKind::kDistance && values[i] < 0) continue;
    double x = scale_[i] * values[i] + drift(i, k);
    if (errors_.range > 0) x = std::clamp(x, -errors_.range, errors_.range);
    if (errors_.resolution > 0) x = errors_.resolution * std::round(x / errors_.resolution);
    values[i] = kind_ == SensorKind::kDistance ? std::max(0.0, x) : x;
  }
  if (kind_ == SensorKind::kDirection) normalise(values);
}

double SignalModel::allan_variance(double tau) const {
  double sum = (errors_.noise * errors_.noise * period_ +
                errors_.noise_density * errors_.noise_density / 2) /
                   tau +
               errors_.random_walk * errors_.random_walk * tau / 3;
  for (const double t : times_) {  // times of a Gauss-Markov process
    const double e = std::exp(-tau / t), x = t / tau;
    sum += 2 * relaxation_variance_ * x * (1 - x / 2 * (3 - 4 * e + e * e));
  }
  return sum;
}

}  // namespace gloam

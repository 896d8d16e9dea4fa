#include "policy/observer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

size_t values_of(const ObservationPart& part, const PartWiring& wiring) {
  return part.term->size() != 0 ? part.term->size() : wiring.count;
}

}  // namespace

void ValueHistory::push(std::span<const double> now, bool starts_with_zeros) {
  const size_t size = values_.size();
  if (is_empty_) {
    for (size_t i = 0; i < size; ++i) values_[i] = starts_with_zeros ? 0 : now[i % size_];
    is_empty_ = false;
  }
  if (newest_first_) {
    std::copy_backward(values_.begin(), values_.end() - static_cast<ptrdiff_t>(size_),
                       values_.end());
    std::ranges::copy(now, values_.begin());
  } else {
    std::copy(values_.begin() + static_cast<ptrdiff_t>(size_), values_.end(), values_.begin());
    std::ranges::copy(now, values_.end() - static_cast<ptrdiff_t>(size_));
  }
}

Observer::Observer(const NetworkSpec& spec, const NetworkWiring& wiring)
    : spec_(spec),
      wiring_(wiring),
      frames_(wiring.frame, spec.history, spec.newest_first),
      frame_(wiring.frame) {
  size_t most = 0;
  for (size_t i = 0; i < spec.parts.size(); ++i) {
    const ObservationPart& part = spec.parts[i];
    const size_t size = values_of(part, wiring.parts[i]);
    terms_.push_back(part.term->clone());
    histories_.emplace_back(size, part.history, spec.newest_first);
    most = std::max(most, size);
  }
  value_.resize(most);
}

Observer::Observer(const Observer& other)
    : spec_(other.spec_),
      wiring_(other.wiring_),
      histories_(other.histories_),
      frames_(other.frames_),
      value_(other.value_),
      frame_(other.frame_) {
  for (const auto& term : other.terms_) terms_.push_back(term->clone());
}

Status Observer::bind(const TermBinding& binding) {
  for (size_t i = 0; i < terms_.size(); ++i) {
    if (!spec_.parts[i].sensor.empty()) continue;
    if (Status status = terms_[i]->bind(binding); !status.ok()) {
      Error error = std::move(status).error();
      error.loc = spec_.parts[i].loc;
      return error;
    }
  }
  return {};
}

void Observer::reset() {
  for (const auto& term : terms_) term->reset();
  for (ValueHistory& history : histories_) history.reset();
  frames_.reset();
}

void Observer::take_over(const Observer& other) {
  for (size_t i = 0; i < terms_.size(); ++i) terms_[i]->take_over(*other.terms_[i]);
  histories_ = other.histories_;
  frames_ = other.frames_;
}

void Observer::observe(size_t i, const TermInputs& in, std::span<const double> reading) {
  const ObservationPart& part = spec_.parts[i];
  const std::span<double> now(value_.data(), values_of(part, wiring_.parts[i]));
  if (reading.empty())
    terms_[i]->write(in, now);
  else
    std::ranges::copy(reading, now.begin());
  const bool is_clipped = part.clip[0] != -kUnlimited || part.clip[1] != kUnlimited;
  for (size_t k = 0; k < now.size(); ++k) {
    // NaN stays NaN in both comparisons.
    if (is_clipped)
      now[k] = now[k] < part.clip[0] ? part.clip[0] : now[k] > part.clip[1] ? part.clip[1] : now[k];
    now[k] *= part.scale[part.scale.size() == 1 ? 0 : k];
  }
  histories_[i].push(now, in.spec->starts_with_zeros);
}

int Observer::write(bool starts_with_zeros, Network* network) {
  int bad = -1;
  for (size_t i = 0; i < spec_.parts.size(); ++i) {
    const PartWiring& wiring = wiring_.parts[i];
    const std::span<const double> values = histories_[i].values();
    const std::span<float> input = network->input(wiring.input);
    for (size_t k = 0; k < values.size(); ++k) {
      const auto value = static_cast<float>(values[k]);
      if (!std::isfinite(value) && bad < 0) bad = static_cast<int>(i);
      if (wiring.is_framed)
        frame_[wiring.offset + k] = values[k];
      else
        input[wiring.offset + k] = value;
    }
  }
  if (wiring_.frame == 0) return bad;
  frames_.push(frame_, starts_with_zeros);
  const std::span<const double> values = frames_.values();
  std::ranges::transform(values, network->input(0).begin(),
                         [](double value) { return static_cast<float>(value); });
  return bad;
}

}  // namespace gloam

// Terms of the gait: clocks and parameters.

#include <algorithm>
#include <cmath>

#include "policy/policy_spec.h"
#include "policy/terms/terms.h"

namespace gloam {
namespace {

void phase(const TermInputs& in, std::span<double> out) {
  out[0] = std::sin(in.clock->legs()[0]);
  out[1] = std::cos(in.clock->legs()[0]);
}
void sin_phase(const TermInputs& in, std::span<double> out) {
  for (size_t i = 0; i < 2; ++i) out[i] = std::sin(in.clock->legs()[i]);
}
void cos_phase(const TermInputs& in, std::span<double> out) {
  for (size_t i = 0; i < 2; ++i) out[i] = std::cos(in.clock->legs()[i]);
}
void gait_clock(const TermInputs& in, std::span<double> out) {
  std::ranges::copy(in.clock->feet(*in.gait), out.begin());
}

class GaitParameters final : public Term {
 public:
  explicit GaitParameters(size_t size) : size_(size) {}
  size_t size() const override { return size_; }
  void write(const TermInputs& in, std::span<double> out) override {
    for (size_t i = 0; i < size_; ++i) out[i] = in.gait->values[in.gait->parameters[i]];
  }
  std::unique_ptr<Term> clone() const override { return std::make_unique<GaitParameters>(*this); }

 private:
  size_t size_;
};

std::unique_ptr<Term> make_parameters(const TermRequest& request) {
  return std::make_unique<GaitParameters>(request.spec->gait.parameters.size());
}

constexpr TermKind kGaitTerms[] = {
    {.name = "phase",
     .aliases = "gait_phase",
     .fixed = 2,
     .unit = "1",
     .doc = "sine and cosine of the first leg's gait phase",
     .write = phase},
    {.name = "sin_phase",
     .fixed = 2,
     .unit = "1",
     .doc = "sines of the two legs' gait phases, half a period apart",
     .write = sin_phase},
    {.name = "cos_phase",
     .fixed = 2,
     .unit = "1",
     .doc = "cosines of the two legs' gait phases",
     .write = cos_phase},
    {.name = "gait_clock",
     .aliases = "clock_inputs",
     .fixed = 4,
     .unit = "1",
     .doc = "sines of the feet's phases by frequency, offsets and duration: FL, FR, RL, RR",
     .write = gait_clock},
    {.name = "gait_parameters",
     .aliases = "gait_commands",
     .unit = "their own",
     .doc = "values of [policy.gait] in the order of its parameters",
     .make = make_parameters},
};

}  // namespace

std::span<const TermKind> gait_terms() { return kGaitTerms; }

}  // namespace gloam

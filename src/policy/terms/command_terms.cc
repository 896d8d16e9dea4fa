// Terms of the commanded velocity.

#include <algorithm>

#include "policy/terms/terms.h"

namespace gloam {
namespace {

void velocity(const TermInputs& in, std::span<double> out) {
  std::ranges::copy(in.command, out.begin());
}
void linear(const TermInputs& in, std::span<double> out) {
  std::ranges::copy(in.command.first(2), out.begin());
}
void angular(const TermInputs& in, std::span<double> out) { out[0] = in.command[2]; }

constexpr TermKind kCommandTerms[] = {
    {.name = "velocity_commands",
     .aliases = "command commands velocity_command generated_commands twist",
     .fixed = 3,
     .unit = "m/s, m/s, rad/s",
     .doc = "commanded vx, vy, yaw rate, heading frame",
     .write = velocity},
    {.name = "command_lin_vel",
     .fixed = 2,
     .unit = "m/s",
     .doc = "commanded vx, vy",
     .write = linear},
    {.name = "command_ang_vel",
     .fixed = 1,
     .unit = "rad/s",
     .doc = "commanded yaw rate",
     .write = angular},
};

}  // namespace

std::span<const TermKind> command_terms() { return kCommandTerms; }

}  // namespace gloam

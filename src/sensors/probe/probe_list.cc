#include <algorithm>

#include "base/check.h"
#include "scene/options/probe_quantities.h"
#include "sensors/probe/probe_families.h"

namespace gloam {
namespace {

struct ProbeRow {
  std::string_view word;
  ProbeMaker make;
};
// A new quantity is a line here.
constexpr ProbeRow kProbes[] = {
    {"wind", wind_probe},
    {"gas_velocity", gas_velocity_probe},
    {"gas_density", gas_density_probe},
    {"gas_temperature", gas_temperature_probe},
    {"visibility", visibility_probe},
    {"water_height", water_height_probe},
    {"illuminance", illuminance_probe},
    {"contact_force", contact_force_probe},
    {"sinkage", sinkage_probe},
    {"soil_work", soil_work_probe},
    {"exposure", exposure_probe},
    {"sun_disc", sun_disc_probe},
};

constexpr bool all_words_are_made() {
  return std::ranges::equal(kProbes, kProbeQuantities, {}, &ProbeRow::word, &ProbeQuantity::word);
}
static_assert(all_words_are_made(),
              "there must be one row per quantity, in the order of the quantity table");

}  // namespace

Result<ProbeReader> make_probe_reader(const ProbeDescription& probe, const ProbeSetup& setup) {
  const auto row = std::ranges::find(kProbes, probe.quantity->word, &ProbeRow::word);
  GLOAM_CHECK(row != std::end(kProbes), "the quantity must exist in a validated scene");
  return row->make(probe, setup);
}

}  // namespace gloam

#pragma once
// Makers of the readers of all quantities, by family: a file each.

#include "sensors/probe/probe.h"

namespace gloam {

using ProbeMaker = Result<ProbeReader> (*)(const ProbeDescription& probe, const ProbeSetup& setup);

// air_probes.cc: wind and what hangs in the air.
Result<ProbeReader> wind_probe(const ProbeDescription& probe, const ProbeSetup& setup);
Result<ProbeReader> visibility_probe(const ProbeDescription& probe, const ProbeSetup& setup);
// gas_probes.cc: the fields of a [[gas]].
Result<ProbeReader> gas_velocity_probe(const ProbeDescription& probe, const ProbeSetup& setup);
Result<ProbeReader> gas_density_probe(const ProbeDescription& probe, const ProbeSetup& setup);
Result<ProbeReader> gas_temperature_probe(const ProbeDescription& probe, const ProbeSetup& setup);
// ground_probes.cc: waters, soft ground and contacts.
Result<ProbeReader> water_height_probe(const ProbeDescription& probe, const ProbeSetup& setup);
Result<ProbeReader> sinkage_probe(const ProbeDescription& probe, const ProbeSetup& setup);
Result<ProbeReader> soil_work_probe(const ProbeDescription& probe, const ProbeSetup& setup);
Result<ProbeReader> contact_force_probe(const ProbeDescription& probe, const ProbeSetup& setup);
// light_probes.cc: light without a camera, and of one.
Result<ProbeReader> illuminance_probe(const ProbeDescription& probe, const ProbeSetup& setup);
Result<ProbeReader> exposure_probe(const ProbeDescription& probe, const ProbeSetup& setup);
Result<ProbeReader> sun_disc_probe(const ProbeDescription& probe, const ProbeSetup& setup);

}  // namespace gloam

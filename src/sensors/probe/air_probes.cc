// Probes of the weather's wind and of what hangs in the air.

#include <algorithm>

#include "geometry/mesh/single.h"
#include "gloam/command.h"
#include "sensors/probe/probe_families.h"
#include "sensors/probe/visibility_probe.h"
#include "sim/effects/wind/wind.h"
#include "world/world.h"

namespace gloam {

// A Command that sets the wind takes the weather's place, everywhere alike.
Result<ProbeReader> wind_probe(const ProbeDescription& probe, const ProbeSetup& setup) {
  return ProbeReader([&probe, wind = Wind(setup.world->wind)](ProbeInstant& at,
                                                              std::span<double> numbers) -> Status {
    GLOAM_TRY(const Vec3 p, at.place(probe));
    const LiveFields* live = at.data().live.get();
    constexpr auto kWind = static_cast<size_t>(LiveFieldId::kWind);
    if (live != nullptr && !live->values[kWind].empty()) {
      std::ranges::copy(live->values[kWind], numbers.begin());
      return {};
    }
    const Vec3 v = wind.at(at.data().time, p.z);
    numbers[0] = v.x, numbers[1] = v.y, numbers[2] = v.z;
    return {};
  });
}

Result<ProbeReader> visibility_probe(const ProbeDescription& probe, const ProbeSetup& setup) {
  GLOAM_TRY(VisibilityProbe made, VisibilityProbe::make(*setup.world));
  return ProbeReader([&probe, air = std::make_shared<const VisibilityProbe>(std::move(made))](
                         ProbeInstant& at, std::span<double> numbers) -> Status {
    GLOAM_TRY(const Vec3 p, at.place(probe));
    numbers[0] = air->visibility(at.data(), to_vec3f(from_origin(p, at.world().render_origin)));
    return {};
  });
}

}  // namespace gloam

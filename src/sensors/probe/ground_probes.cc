// Probes of waters, of soft ground and of contacts.

#include <algorithm>
#include <cmath>
#include <limits>

#include "sensors/probe/probe_families.h"
#include "sim/effects/water/water_surface.h"
#include "world/effects/surface_layout.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool is_measured_on(const ProbeDescription& probe, int body) {
  return std::ranges::binary_search(probe.bodies, body);
}

// Depth of the print below the undisturbed surface at a place [m]; heaps count as none.
double print_depth(const CompiledWorld& world, const SnapshotData& data, const Vec3& p) {
  for (size_t row = 0; row < world.soils.size(); ++row) {
    const SoilDescription& soil = world.soils[row];
    const double x = (p.x - soil.low_x()) / soil.dx, y = (p.y - soil.low_y()) / soil.dy;
    if (!(x >= 0 && y >= 0 && x < soil.nx && y < soil.ny)) continue;
    const auto& tracks = data.effects.surfaces[soil_surface(world, row)].field;
    if (tracks == nullptr) return 0;
    const size_t cell =
        static_cast<size_t>(y) * static_cast<size_t>(soil.nx) + static_cast<size_t>(x);
    const double fallen = soil.share_of(cell) * soil.growth * data.time;
    return std::max(0.0, -double{track_height(tracks->height[cell], static_cast<float>(fallen))});
  }
  return kNone;
}

void add_force(const Vec3& force, double sign, std::span<double> to) {
  to[0] += sign * force.x, to[1] += sign * force.y, to[2] += sign * force.z;
}

}  // namespace

Result<ProbeReader> water_height_probe(const ProbeDescription& probe, const ProbeSetup&) {
  return ProbeReader([&probe](ProbeInstant& at, std::span<double> numbers) -> Status {
    GLOAM_TRY(const Vec3 p, at.place(probe));
    numbers[0] = kNone;
    const std::vector<WaterDescription>& waters = at.world().waters;
    for (size_t row = 0; row < waters.size(); ++row) {
      const WaterDescription& water = waters[row];
      if (std::abs(p.x - water.x) > water.size_x / 2 || std::abs(p.y - water.y) > water.size_y / 2)
        continue;
      const HeightChange& ripples = at.data().effects.surfaces[water_surface(at.world(), row)];
      numbers[0] = water.level + wave_height(water, p.x, p.y, at.data().time);
      if (ripples.field != nullptr) numbers[0] += ripple_height(water, ripples, p.x, p.y);
    }
    return {};
  });
}

Result<ProbeReader> sinkage_probe(const ProbeDescription& probe, const ProbeSetup&) {
  return ProbeReader([&probe](ProbeInstant& at, std::span<double> numbers) -> Status {
    if (probe.bodies.empty()) {
      GLOAM_TRY(const Vec3 p, at.place(probe));
      numbers[0] = print_depth(at.world(), at.data(), p);
      return {};
    }
    numbers[0] = 0;
    for (const ContactLoad& load : at.data().effects.loads)
      if (is_measured_on(probe, load.body)) numbers[0] = std::max(numbers[0], load.depth);
    return {};
  });
}

Result<ProbeReader> soil_work_probe(const ProbeDescription& probe, const ProbeSetup&) {
  return ProbeReader([&probe](ProbeInstant& at, std::span<double> numbers) -> Status {
    numbers[0] = 0;
    for (const int body : probe.bodies)
      numbers[0] += at.data().effects.ground_work[static_cast<size_t>(body)];
    return {};
  });
}

// Contacts within the bodies of the probe cancel out.
Result<ProbeReader> contact_force_probe(const ProbeDescription& probe, const ProbeSetup&) {
  return ProbeReader([&probe](ProbeInstant& at, std::span<double> numbers) -> Status {
    GLOAM_TRY(const std::vector<ContactState>* const contacts, at.contacts());
    std::ranges::fill(numbers, 0.0);
    for (const ContactState& contact : *contacts) {
      const bool first = std::ranges::binary_search(probe.geoms, contact.geoms[0].id);
      const bool second = std::ranges::binary_search(probe.geoms, contact.geoms[1].id);
      if (first != second) add_force(contact.force, second ? 1 : -1, numbers);
    }
    for (const ContactLoad& load : at.data().effects.loads) {
      if (!is_measured_on(probe, load.body)) continue;
      add_force({load.force[0], load.force[1], load.force[2]}, 1, numbers);
    }
    return {};
  });
}

}  // namespace gloam

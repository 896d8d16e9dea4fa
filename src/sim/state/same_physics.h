#pragma once
// Whether two models move alike.

#include <mujoco/mujoco.h>

#include <string>

namespace gloam {

/// The first field in which they differ that decides motion: "geom_size", "opt.gravity"; "" = none.
/// Looks, lamps, cameras, sites, sensors and names decide nothing.
std::string physical_difference(const mjModel& a, const mjModel& b);

}  // namespace gloam

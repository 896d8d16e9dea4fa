#pragma once
// Lengths of shortest ways, for robots' goals.

#include <memory>

#include "metrics/metric_instant.h"
#include "sim/agents/nav_world.h"

namespace gloam {

/// The navigation mesh of the scene's first agent, or, in scenes without agents and where it has no
/// way, straight lines. Doors and loose things are as at the instant that it is made at.
class ShortestWays {
 public:
  ShortestWays(const CompiledWorld& world, const MetricInstant& instant);
  /// Horizontal length of the shortest way between two places [m].
  double length(const Vec3& from, const Vec3& to) const;

 private:
  double length_on_mesh(const NavMesh& mesh, const NavPoint& from, const NavPoint& to) const;
  std::unique_ptr<NavWorld> nav_;
};

}  // namespace gloam

#pragma once
// Rules of [planner].

#include "gloam/scene.h"

namespace gloam {

/// Errors: no robot of that name, or a choice between several; keys that do not belong to the type.
Status validate_planner(const PlannerOptions& planner, const std::vector<RobotOptions>& robots);

}  // namespace gloam

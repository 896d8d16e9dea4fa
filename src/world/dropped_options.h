#pragma once
// Options of an attached model that the level does not take: MuJoCo has one <option> and one
// <visual> for the whole level.

#include <mujoco/mujoco.h>

#include <set>
#include <string>
#include <vector>

namespace gloam {

/// What a model's file says of <option> and <visual>.
struct ModelSettings {
  mjOption option;
  mjVisual visual;

  static ModelSettings of(const mjSpec& spec) { return {spec.option, spec.visual}; }
};

/// Settings that the file `own` gives and the level does not have, one sentence each, as
/// "integrator implicitfast, the level has Euler". What `own` has by default is not given, unless
/// its name is one of `given`.
std::vector<std::string> dropped_settings(const ModelSettings& own, const ModelSettings& level,
                                          const std::set<std::string>& given);

}  // namespace gloam

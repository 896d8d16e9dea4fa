#pragma once
// Options of an attached model that the level does not take: MuJoCo has one <option> and one
// <visual> for the whole level.

#include <mujoco/mujoco.h>

#include <set>
#include <string>
#include <vector>

namespace gloam {

/// Options and visual settings of a model's file: <option> and <visual>.
struct ModelSettings {
  mjOption option;
  mjVisual visual;

  static ModelSettings of(const mjSpec& spec) { return {spec.option, spec.visual}; }
};

/// One setting that is lost.
struct DroppedSetting {
  std::string text;       ///< "integrator implicitfast, but the scene has Euler"
  std::string element;    ///< element of MJCF: "option", "flag", "headlight" …
  std::string attribute;  ///< "" = any of the element's
};

/// Settings that the file `own` gives and the level does not have. Defaults of `own` do not count
/// as given, unless their name is in `given`.
std::vector<DroppedSetting> dropped_settings(const ModelSettings& own, const ModelSettings& level,
                                             const std::set<std::string>& given);

}  // namespace gloam

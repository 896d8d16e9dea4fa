#pragma once
// Places that cameras and LiDARs are fixed to by name: a body's frame, or a site's.

#include <mujoco/mujoco.h>

#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// In a spec, before it is compiled. A site's pose may be relative to a <frame> of its body.
struct SpecMount {
  mjsBody* body = nullptr;
  mjsFrame* frame = nullptr;  ///< F; null = the body's own frame
  Pose X_FM;
};
/// The body of this name or else the site; "" = the world. Nothing if there is neither. Error: a
/// site whose orientation MuJoCo cannot resolve.
Result<std::optional<SpecMount>> find_mount(mjSpec* spec, const std::string& name);

/// In a compiled model.
struct ModelMount {
  int body = 0;
  Pose X_BM;
};
std::optional<ModelMount> find_mount(const mjModel& model, const std::string& name);

/// X_AC = X_AB X_BC.
Pose compose(const Pose& X_AB, const Pose& X_BC);

}  // namespace gloam

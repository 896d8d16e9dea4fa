#pragma once
// Numbers that are none: MuJoCo takes "nan" and "inf" where it reads numbers, and what is placed,
// sized or coloured by them goes missing without a word.

#include <mujoco/mujoco.h>

#include <optional>
#include <string>

namespace gloam {

struct NotFinite {
  mjtObj type = mjOBJ_UNKNOWN;
  int id = -1;
  std::string name;   ///< name of the element, full; without one that of its body
  std::string fault;  ///< "camera 'go1/front': fovy is not a number", with `name` in the quotes
};

/// The first number of a body, joint, geom, site, camera, light or material that is not one, or is
/// infinite where only a finite one makes sense: not in ranges, margins and what users keep there.
std::optional<NotFinite> find_not_finite(const mjModel& model);

}  // namespace gloam

#pragma once

namespace gloam {

/// Loads MuJoCo's own engine plugins: the libraries in the folder "plugin" beside libmujoco, and no
/// others. Once for the process; thread-safe.
void load_mujoco_plugins();

}  // namespace gloam

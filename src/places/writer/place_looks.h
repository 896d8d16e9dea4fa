#pragma once
// Names of a place's looks among the materials of an environment that has names of its own.

#include <mujoco/mujoco.h>

#include <string>

namespace gloam {

/// Name under which a look joins the materials of the spec: its own where that is free, else
/// "props/LOOK", "props/LOOK_2" …
std::string free_look_name(const std::string& look, mjSpec* spec);

}  // namespace gloam

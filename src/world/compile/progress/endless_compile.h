#pragma once
// Refusal of models that MuJoCo's compiler never finishes: to find the length range of a muscle it
// simulates until some time has passed, and a joint that moves the wrong way sets its clock back
// again and again.

#include <mujoco/mujoco.h>

#include <optional>
#include <string>

namespace gloam {

struct EndlessCompile {
  std::string name;   ///< name of the element, full
  std::string fault;  ///< "joint 'arm/elbow': armature is nan, line 3", as MuJoCo's errors are
};

/// The first such element of a model whose length ranges MuJoCo has to find.
std::optional<EndlessCompile> find_endless_compile(const mjSpec& spec);

}  // namespace gloam

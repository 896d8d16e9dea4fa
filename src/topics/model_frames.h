#pragma once
// Frames of a model as /tf has them: every body by its full name, "world" at the root.

#include <mujoco/mujoco.h>

#include <string>

#include "gloam/types.h"

namespace gloam {

/// Full name of a body; "body_ID" where the model gives none, "world" for 0.
std::string body_frame(const mjModel& model, int body);

/// True if a body has degrees of freedom of its own or is a mocap body: others keep their place in
/// their parent.
bool moves_in_parent(const mjModel& model, int body);

/// Name of a joint without a robot's prefix; "joint_ID" where the model gives none.
std::string joint_label(const mjModel& model, int joint, const std::string& prefix);

/// The name without a robot's prefix "go1/".
std::string local_name(const std::string& name, const std::string& prefix);

/// Pose of C in A out of those of B in A and of C in B.
Pose product(const Pose& X_AB, const Pose& X_BC);
/// Pose of A in B out of that of B in A.
Pose inverse(const Pose& X_AB);
/// R(q)^-1 v.
Vec3 rotate_back(const Quat& q, const Vec3& v);

}  // namespace gloam

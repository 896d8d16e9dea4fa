#pragma once
// MuJoCo's compiler reads meshes and pictures on threads of its own, which no guard covers
// (mujoco_guard.h).

namespace gloam {

/// While it lives MuJoCo compiles, on threads of its own, too: an abort() of any of them is want of
/// memory.
class MujocoCompiles {
 public:
  MujocoCompiles();
  ~MujocoCompiles();
  MujocoCompiles(const MujocoCompiles&) = delete;
  MujocoCompiles& operator=(const MujocoCompiles&) = delete;
};

}  // namespace gloam

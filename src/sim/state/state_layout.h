#pragma once
// Where the parts of a Snapshot's state vector (mjSTATE_INTEGRATION) begin.

#include <mujoco/mujoco.h>

#include <span>
#include <vector>

namespace gloam {

/// How many numbers a joint of a mjtJoint has.
struct JointWidth {
  int qpos, qvel;
};
constexpr JointWidth joint_width(int type) {
  switch (type) {
    case mjJNT_FREE:
      return {7, 6};
    case mjJNT_BALL:
      return {4, 3};
    default:
      return {1, 1};
  }
}

/// Length of the state vector.
inline int state_size(const mjModel& model) { return mj_stateSize(&model, mjSTATE_INTEGRATION); }

/// Offset of one component (one bit of mjtState) in the state vector.
inline int state_offset(const mjModel& model, mjtState component) {
  return mj_stateSize(&model, mjSTATE_INTEGRATION & (static_cast<int>(component) - 1));
}

/// One component of a state vector.
inline std::span<const double> state_part(const mjModel& model, std::span<const double> state,
                                          mjtState component) {
  return state.subspan(static_cast<size_t>(state_offset(model, component)),
                       static_cast<size_t>(mj_stateSize(&model, component)));
}

/// Reads mjSTATE_INTEGRATION out of one mjData exactly as mj_getState does, in half the time: every
/// step does it, so the arrays are looked up once.
class StateReader {
 public:
  StateReader() = default;
  StateReader(const mjModel& model, const mjData& data);
  void read(double* state) const;

 private:
  struct Part {
    const mjtNum* from;
    int offset, count;
  };
  std::vector<Part> parts_;  // those that are not empty, but the one below
  const mjtBool* eq_active_ = nullptr;
  int eq_offset_ = 0, eq_count_ = 0;
};

}  // namespace gloam

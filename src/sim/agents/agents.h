#pragma once
// People and vehicles of a World, as the simulation goes on. Decisions are made at navigation.rate
// on the sim thread, bodies move at 50 Hz of simulation time, and mocap poses are interpolated
// between these for every step: a Snapshot holds those of its own instant.

#include <memory>
#include <vector>

#include "sim/agents/agent.h"
#include "sim/agents/doors.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

class Agents {
 public:
  /// Null where the World has none. `data`: poses of the initial state. Errors: nowhere to go, a
  /// place without room, a behaviour tree that is none, a rate above the step rate; no Recast.
  static Result<std::unique_ptr<Agents>> create(std::shared_ptr<const CompiledWorld> world,
                                                uint64_t seed, Rational timestep,
                                                const mjModel& model, const mjData& data);

  /// Back to the beginning; `data` has the poses of the initial state, but the agents'.
  void reset(const mjModel& model, const mjData& data);
  /// At a step in the middle of a run: goes on with those that were in `before` by the same name,
  /// kind and seed, null = none; the others begin.
  void take_over(int64_t step, const Agents* before, const mjModel& model, const mjData& data);

  /// After a step: the simulation stands at `step`, and mjData still has poses and contacts of the
  /// step before. Decides and moves when it is time, and writes the mocap poses of this instant.
  /// The hash of the simulation's state goes in and comes out with the agents'.
  uint64_t advance(int64_t step, const mjModel& model, mjData* data, uint64_t hash);
  /// The mocap poses of a step since the last advance() or reset(); what doors are pushed by.
  void write(int64_t step, mjData* data) const;

  const std::vector<AgentBody>& bodies() const { return agents_; }
  const NavWorld& navigation() const { return *nav_; }

 private:
  Agents(std::shared_ptr<const CompiledWorld> world, uint64_t seed);
  Status read_trees();
  Status place(bool tell);
  bool draw_place(size_t row, NavPoint* at) const;
  void stand(size_t row, const NavPoint& at, double heading);
  void read_contacts(const mjModel& model, const mjData& data);
  void decide(int64_t step, const mjModel& model, const mjData& data);
  void move(int64_t step);
  Vec3d steer(size_t row, const mjData& data);
  void avoid(size_t row, Vec3d* wanted);
  bool has_room(size_t row, Vec3d wanted) const;
  double free_speed(size_t row) const;
  double time_of(int64_t step) const { return static_cast<double>(step) * timestep_; }

  const std::shared_ptr<const CompiledWorld> world_;
  const uint64_t seed_;
  double timestep_ = 0;  // [s]
  StepSchedule decisions_, motions_;
  int64_t decision_ = 0, motion_ = 0;  // the next ones
  int64_t last_motion_step_ = 0, next_motion_step_ = 0;
  double decision_time_ = 0;  // of a period [s]
  std::unique_ptr<NavWorld> nav_;
  std::unique_ptr<AgentDoors> doors_;
  NavAvoidance avoidance_;
  std::vector<AgentBody> agents_;
  std::vector<AgentSpline> splines_;  // by agent; empty ones too
  std::vector<int> agent_of_geom_;    // -1 = none's
  std::vector<bool> is_robot_geom_;
};

}  // namespace gloam

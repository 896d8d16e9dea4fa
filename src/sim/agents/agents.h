#pragma once
// People and vehicles of a World, as the simulation goes on. Decisions are made at navigation.rate
// on the sim thread, bodies move at 50 Hz of simulation time, and mocap poses are interpolated
// between these for every step: a Snapshot holds those of its own instant.

#include <array>
#include <memory>
#include <vector>

#include "sim/agents/agent.h"
#include "sim/agents/body_contact.h"
#include "sim/agents/doors.h"
#include "sim/effects/effect.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

class Agents final : public Effect {
 public:
  /// Errors: nowhere to go, a place without room, a behaviour tree that is none, a rate above the
  /// step rate; no Recast.
  static Result<std::unique_ptr<Effect>> make(const EffectParts& parts);

  std::string_view kind() const override { return "agents"; }
  bool moves_bodies() const override { return true; }
  /// People are softer than what MuJoCo knows of its contacts.
  bool acts_on_bodies() const override { return softens_; }
  void apply_loads(const EffectContext& at) override;
  void reset(const EffectContext& at) override;
  /// Goes on with those of the same name, kind and seed; the others begin.
  void take_over(const EffectContext& at, Effect* before) override;
  /// The mocap poses of a step since the last advance() or reset(); what doors are pushed by.
  void write_state(int64_t step, mjData* data) const override;
  /// Decides and moves when it is time, and writes the mocap poses of this instant. The hash comes
  /// out with the agents'; feet that have come down are among the events.
  void advance(const EffectContext& at) override;

  const std::vector<AgentBody>& bodies() const { return agents_; }
  const NavWorld& navigation() const { return *nav_; }

 private:
  Agents(std::shared_ptr<const CompiledWorld> world, uint64_t seed);
  Status prepare(Rational timestep, const mjModel& model, const mjData& data);
  void map_geoms(const mjModel& model);
  Status read_trees();
  void begin(const mjModel& model, const mjData& data);
  Status place(bool tell);
  bool draw_place(size_t row, NavPoint* at) const;
  void stand(size_t row, const NavPoint& at, double heading);
  void read_contacts(const mjModel& model, const mjData& data);
  void decide(int64_t step, const mjModel& model, const mjData& data);
  void move(int64_t step);
  void find_footfalls(const mjData& data, std::vector<Footfall>* footfalls);
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
  double decision_time_ = 0;  // length of a period [s]
  std::unique_ptr<NavWorld> nav_;
  std::unique_ptr<AgentDoors> doors_;
  NavAvoidance avoidance_;
  std::vector<AgentBody> agents_;
  std::vector<AgentSpline> splines_;  // by agent; empty ones too
  std::vector<int> agent_of_geom_;    // -1 = none's
  std::unique_ptr<BodyContacts> contacts_;
  bool softens_ = false;  // there are people, and steps have halves
  std::vector<bool> is_robot_geom_;
  std::vector<std::array<bool, 2>> planted_;  // feet of agents, at the step before
};

}  // namespace gloam

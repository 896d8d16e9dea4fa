#pragma once
// The air of one [[gas]]: a solver, what it meets, what feeds it, and the thread that it runs on.

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "sim/effects/dust/ground_dust.h"
#include "sim/effects/gas/gas_obstacles.h"
#include "sim/effects/gas/gas_solver.h"
#include "sim/effects/wind/rotor_thrust.h"
#include "sim/effects/wind/wind.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

class GasEffect {
 public:
  /// `row`: of CompiledWorld::gases. Errors: of memory, MuJoCo's, a rate above the step rate.
  static Result<std::unique_ptr<GasEffect>> create(std::shared_ptr<const CompiledWorld> world,
                                                   size_t row, Rational timestep);
  ~GasEffect();

  /// Back to clear air at rest, before the tick at step 0.
  void reset();
  /// Begins with clear air at rest at a step in the middle of a run.
  void begin_at(int64_t step);
  /// Goes on where `before`, of the same name, grid and rate, stands; its own air stays as it is.
  void take_over(GasEffect& before);
  bool continues(const GasEffect& before) const;

  int64_t next_tick() const { return schedule_.step_of(tick_ + 1); }
  /// At next_tick(): waits for its field and returns the digest of what the solver stands at.
  uint64_t tick();
  /// Solves for the next field on its own thread.
  void start(const Snapshot& now);
  FieldWindow window(int64_t step) const;

  /// After each mj_step, while `data` has its contacts: gathers dust that is raised.
  void observe(const mjModel& model, const mjData& data, const StepEvents& events);
  /// The air since the last tick, as it was at it.
  const MediumField& air() const { return *now_; }

 private:
  GasEffect(std::shared_ptr<const CompiledWorld> world, size_t row, StepSchedule schedule,
            double timestep);
  const GasDescription& gas() const { return world_->gases.gases[row_]; }
  Status make_solver();
  void make_clear();
  void run_thread();
  void solve(const Snapshot& now, std::span<const DustDeposit> deposits);
  void read_field(MediumField* to) const;
  void find_sources(double from, double to);
  Vec3f wind(double time) const;
  void warn_of_blocked(const GasStep& step);

  const std::shared_ptr<const CompiledWorld> world_;
  const size_t row_;
  const StepSchedule schedule_;
  const double timestep_;  // [s]
  std::unique_ptr<GasSolver> solver_;
  std::unique_ptr<GasObstacles> obstacles_;
  GasWalls walls_;
  std::vector<GasSource> sources_;
  std::unique_ptr<RotorThrust> rotor_thrust_;  // null = there are none
  std::vector<GasRotor> rotors_;
  std::unique_ptr<GroundDust> ground_dust_;  // null = this gas carries none
  const Wind wind_;
  bool warned_ = false;

  int64_t tick_ = -1;                                // the last one
  std::shared_ptr<const MediumField> now_, coming_;  // fields of it and of the next
  std::unique_ptr<ContactDust> contact_dust_;        // null as ground_dust_

  std::mutex mutex_;  // guards what follows
  std::condition_variable wanted_;
  Snapshot work_;                      // to be solved from
  std::vector<DustDeposit> deposits_;  // since the tick before it
  std::shared_ptr<MediumField> result_;
  bool quit_ = false;
  std::thread thread_;
};

}  // namespace gloam

#pragma once
// Snow that bodies shed as they move. It is only seen: on what is walked on it is a bed of soil.
//
// Dry snow holds by friction. On a body the apparent weight, gravity less the acceleration, turns:
// with the body's tilt, with pushes, and outwards with spin. A cover lies while that stays within
// 15 degrees of where it was when the snow came to lie, the slope up to which smooth cold roofs
// keep theirs (ASCE 7-16, figure 7.4-1). Once loose it slides on, with a time constant of 0.3 s,
// until there are less than half of these degrees for so long: snow that moves has less friction
// (Bowden 1953, "Friction on snow and ice"). What falls or stays then lies as the body is. Each
// body is looked at 50 times a second, as a whole.

#include <memory>
#include <vector>

#include "sim/effects/effect.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

class SnowShedding final : public Effect {
 public:
  /// Null where no snow lies or falls, or nothing moves.
  static Result<std::unique_ptr<Effect>> make(const EffectParts& parts);

  std::string_view kind() const override { return "snow"; }
  void reset(const EffectContext& at) override;
  /// Bodies of another World begin as they are there: covered.
  void take_over(const EffectContext& at, Effect* before) override;
  void advance(const EffectContext& at) override;
  void publish(int64_t step, EffectOutputs* out) override;

 private:
  struct Cover {
    int body = 0;
    double reach = 0;     // of its shapes from its frame [m]
    double depth = 0;     // [m]
    double rest[3] = {};  // up, by apparent weight, when the snow came to lie; body's frame
    double p[2][3] = {};  // places at the last ticks, the newest first [m]
    double R[9] = {};     // attitude at the last tick
    int ticks = 0;        // that p and R hold
    double slides = 0;    // for how long yet [s]
  };
  SnowShedding(const EffectParts& parts, double depth, double growth);
  static void slide(double tilt, const double* up, double dt, Cover* cover);
  void look(const mjModel& model, const mjData& data, double dt, Cover* cover) const;
  void show();

  const StepSchedule schedule_;
  const double timestep_;        // [s]
  const double start_, growth_;  // depth on level ground [m], [m/s]
  int64_t tick_ = -1;            // step of the last
  double level_ = 0;             // depth on level ground now [m]
  std::vector<Cover> covers_;
  std::vector<std::shared_ptr<std::vector<float>>> pool_;
  std::shared_ptr<const std::vector<float>> shown_;  // fraction that is left, by body; null = all
};

}  // namespace gloam

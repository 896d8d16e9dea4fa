#pragma once
// Gaits that policies are conditioned on: parameters, and clocks that are observation terms.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace gloam {

/// Parameters of a gait as in Walk-These-Ways (Margolis and Agrawal, CoRL 2022), table 1.
enum class GaitValue {
  kBodyHeight,    ///< offset to the nominal height [m]
  kFrequency,     ///< cycles per second [Hz]
  kPhase,         ///< shift between front right and front left [cycles]
  kOffset,        ///< shift of the pacing pair [cycles]
  kBound,         ///< shift of the bounding pair [cycles]
  kDuration,      ///< share of a cycle in which a foot stands, in (0, 1)
  kSwingHeight,   ///< [m]
  kPitch,         ///< [rad]
  kRoll,          ///< [rad]
  kStanceWidth,   ///< [m]
  kStanceLength,  ///< [m]
  kAux,           ///< weight of auxiliary rewards; 0 in use
};
inline constexpr size_t kGaitValues = 12;

/// By GaitValue, as settings name them.
inline constexpr std::array<std::string_view, kGaitValues> kGaitValueNames = {
    "body_height",  "frequency", "phase", "offset",       "bound",         "duration",
    "swing_height", "pitch",     "roll",  "stance_width", "stance_length", "aux"};

struct GaitOptions {
  std::array<double, kGaitValues> values = {0, 3, 0.5, 0, 0, 0.5, 0.08, 0, 0, 0.25, 0.4, 0};
  bool pacing_offset = true;  ///< which pairs of feet `offset` and `bound` shift: see feet_of()
  double still_speed = 0;     ///< [m/s], [rad/s]: commands below it stop the clock; 0 = none does
  std::vector<size_t> parameters;  ///< GaitValues that the term gait_parameters hands in
  double period = 1;  ///< [s] of the two legs' phases (terms phase, sin_phase, cos_phase)

  double value(GaitValue which) const { return values[static_cast<size_t>(which)]; }
};

/// State of both clocks. It moves on before each observation.
class GaitClock {
 public:
  /// `command`: vx, vy [m/s], yaw rate [rad/s]; `rate`: observations per second [Hz].
  void tick(const GaitOptions& options, std::span<const double> command, double rate);

  /// Clock inputs sin(2 pi w) of the feet FL, FR, RL, RR: w is 0 to 0.5 while a foot stands and 0.5
  /// to 1 while it swings, whatever their durations are.
  std::array<double, 4> feet(const GaitOptions& options) const;
  /// Phases of two legs half a period apart [rad], as holosoma's policies were trained with them:
  /// while no velocity is commanded both stay at pi; they restart at 0 and pi.
  std::span<const double, 2> legs() const { return legs_; }

 private:
  double index_ = 0;  // in [0, 1)
  std::array<double, 2> legs_ = {0, 3.14159265358979323846};
  bool stands_ = false;
};

}  // namespace gloam

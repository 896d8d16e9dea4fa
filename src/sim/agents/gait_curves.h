#pragma once
// Curves of a walk over its cycle, at 1.3 m/s and for a person of 1.7 m. They were fitted, with the
// bones of PersonShape and feet that stay where they stand, to the joint angles in the sagittal
// plane of Pinzone et al. 2014, "The comparison of normative reference data from different gait
// analysis services", Gait and Posture 40 (electronic appendix): all are within one standard
// deviation.

namespace gloam::gait {

/// Fraction of the cycle that a foot stands, at 1.3 m/s.
inline constexpr double kStanceFraction = 0.615;
/// Fraction of the way in stance by which a foot comes down ahead of the hips.
inline constexpr double kTouchdownFraction = 0.341;

/// Pitch of a foot [rad], heel up positive. `phase`: 0 = it comes down, kStanceFraction = it
/// lifts, 1.
double foot_pitch(double phase);
/// Least descent of the hips from straight legs, by knees that are never quite straight [m].
inline constexpr double kKneeDescent = 0.0048;
/// Further descent [m]; it grows with the square of the step's length, of which `kStep` is given
/// [m].
double hip_descent(double phase);
inline constexpr double kStep = 0.701;
/// Pivots of a foot that stands, ahead of the ankle, in lengths of the foot.
inline constexpr double kToe = 0.7, kHeel = -0.22;
/// Pivot of a swinging foot, from the toes to the heel. `u`: fraction of the swing.
double swing_pivot(double u);
/// Its progress, 0 … 1, and the height of its pivot [m].
double swing_progress(double u);
double swing_lift(double u);

}  // namespace gloam::gait

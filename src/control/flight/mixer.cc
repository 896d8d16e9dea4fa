#include "control/flight/mixer.h"

#include <algorithm>
#include <limits>

namespace gloam {

RotorMixer::RotorMixer(const Multirotor& vehicle) : rotors_(vehicle.rotors) {
  inverse_ = vehicle.effectiveness.completeOrthogonalDecomposition().pseudoInverse();
  const auto count = static_cast<Eigen::Index>(rotors_.size());
  lowest_.resize(count);
  highest_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    lowest_[i] = rotors_[static_cast<size_t>(i)].lowest;
    highest_[i] = rotors_[static_cast<size_t>(i)].highest;
  }
  thrusts_ = part_ = Eigen::VectorXd::Zero(count);
}

// The largest scale in [0, 1] with which `part` fits into the limits when added to the thrusts.
double RotorMixer::largest_scale(const Eigen::VectorXd& part) const {
  double scale = 1;
  for (Eigen::Index i = 0; i < part.size(); ++i) {
    const double room = part[i] > 0   ? highest_[i] - thrusts_[i]
                        : part[i] < 0 ? lowest_[i] - thrusts_[i]
                                      : 0;
    if (part[i] != 0) scale = std::clamp(room / part[i], 0.0, scale);
  }
  return scale;
}

void RotorMixer::mix(const FlightWrench& wrench, double* ctrl) {
  saturated_ = false;
  const auto count = static_cast<Eigen::Index>(rotors_.size());
  // Roll and pitch. Their spread must fit between the limits, wherever the thrust then puts it.
  part_.noalias() = inverse_.col(1) * wrench.torque.x();
  part_.noalias() += inverse_.col(2) * wrench.torque.y();
  double scale = 1;
  const double spread = part_.maxCoeff() - part_.minCoeff();
  const double width = (highest_ - lowest_).minCoeff();
  if (spread > width) scale = width / spread;
  thrusts_ = scale * part_;
  saturated_ |= scale < 1;

  // Thrust, in the range in which no rotor leaves its limits.
  double least = -std::numeric_limits<double>::infinity(), most = -least;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double per_newton = inverse_(i, 0);
    if (per_newton <= 0) continue;
    least = std::max(least, (lowest_[i] - thrusts_[i]) / per_newton);
    most = std::min(most, (highest_[i] - thrusts_[i]) / per_newton);
  }
  const double thrust = least <= most ? std::clamp(wrench.thrust, least, most) : (least + most) / 2;
  saturated_ |= thrust != wrench.thrust;
  thrusts_.noalias() += inverse_.col(0) * thrust;

  // Yaw takes the rest.
  part_.noalias() = inverse_.col(3) * wrench.torque.z();
  scale = largest_scale(part_);
  saturated_ |= scale < 1;
  thrusts_.noalias() += scale * part_;

  for (Eigen::Index i = 0; i < count; ++i) {
    const Rotor& rotor = rotors_[static_cast<size_t>(i)];
    thrusts_[i] = std::clamp(thrusts_[i], lowest_[i], highest_[i]);
    ctrl[rotor.ctrl] = thrusts_[i] / rotor.gain;
  }
}

}  // namespace gloam

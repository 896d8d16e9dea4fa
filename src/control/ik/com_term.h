#pragma once
// ComTask as a term of the objective.

#include <optional>

#include "control/ik/objective.h"

namespace gloam::ik {

class ComTerm {
 public:
  static Result<ComTerm> create(const Kinematics& at, const ComTask& options);
  Status set_target(std::span<const double> com_W);
  bool has_target() const { return target_W_.has_value(); }
  void add_to(Objective& objective, Kinematics& at);
  std::span<const double> error() const { return {error_.data(), 3}; }

 private:
  int body_ = 1;
  Vector3d weight_ = Vector3d::Ones(), error_ = Vector3d::Zero();
  double gain_ = 1, lm_damping_ = 0;
  std::optional<Vector3d> target_W_;
  MatrixXd J_;  // (3 x n)
};

}  // namespace gloam::ik

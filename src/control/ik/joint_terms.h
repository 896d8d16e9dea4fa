#pragma once
// Tasks of joint coordinates: PostureTask and DampingTask as terms of the objective. Free joints
// take no part.

#include "control/ik/objective.h"

namespace gloam::ik {

class PostureTerm {
 public:
  static Result<PostureTerm> create(const Kinematics& at, const PostureTask& options);
  Status set_target(std::span<const double> qpos);
  bool has_target() const { return !target_.empty(); }
  void add_to(Objective& objective, Kinematics& at);
  std::span<const double> error() const { return error_; }

 private:
  VectorXd weight_;  // (n), 0 for free joints
  double gain_ = 1, lm_damping_ = 0;
  int nq_ = 0;
  std::vector<double> target_;  // (nq)
  std::vector<double> error_;   // (nv)
  std::vector<char> free_;      // by degree of freedom, (nv)
};

class DampingTerm {
 public:
  static Result<DampingTerm> create(const Kinematics& at, const DampingTask& options);
  bool has_target() const { return true; }
  void add_to(Objective& objective, Kinematics& at);
  std::span<const double> error() const { return error_; }

 private:
  VectorXd weight_;            // (n), 0 for free joints
  std::vector<double> error_;  // zeros, (nv)
};

}  // namespace gloam::ik

#pragma once
// Tasks of frames: FrameTask and RelativeFrameTask as terms of the objective.

#include <optional>

#include "control/ik/objective.h"

namespace gloam::ik {

/// Weights of a twist's error, and how it is removed.
struct TwistGains {
  Vector6d weight;
  double gain, lm_damping;
};

class FrameTerm {
 public:
  static Result<FrameTerm> create(const Kinematics& at, const FrameTask& options);
  Status set_target(const Pose& X_WT);
  bool has_target() const { return X_WT_.has_value(); }
  void add_to(Objective& objective, Kinematics& at);
  std::span<const double> error() const { return {error_.data(), 6}; }

 private:
  FrameId frame_;
  TwistGains gains_;
  std::optional<Transform> X_WT_;
  Vector6d error_ = Vector6d::Zero();
  MatrixXd J_;  // (6 x n)
};

class RelativeFrameTerm {
 public:
  static Result<RelativeFrameTerm> create(const Kinematics& at, const RelativeFrameTask& options);
  Status set_target(const Pose& X_RT);
  bool has_target() const { return X_RT_.has_value(); }
  void add_to(Objective& objective, Kinematics& at);
  std::span<const double> error() const { return {error_.data(), 6}; }

 private:
  FrameId frame_, root_;
  TwistGains gains_;
  std::optional<Transform> X_RT_;
  Vector6d error_ = Vector6d::Zero();
  MatrixXd J_, J_root_;  // (6 x n)
};

}  // namespace gloam::ik

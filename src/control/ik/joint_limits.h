#pragma once
// ConfigurationLimit and VelocityLimit.

#include "control/ik/constraints.h"

namespace gloam::ik {

class ConfigurationRows {
 public:
  static Result<ConfigurationRows> create(const Kinematics& at, const ConfigurationLimit& options);
  int count() const { return static_cast<int>(balls_.size()); }  ///< inequalities beside bounds
  void add_to(ConstraintRows rows, Kinematics& at, double dt) const;

 private:
  struct Slot {
    int column, qpos;
    double low, high;
  };
  struct Ball {
    int column, qpos;  ///< of its first coordinate
    double max_angle;
  };
  double gain_ = 1;
  std::vector<Slot> slots_;
  std::vector<Ball> balls_;
};

class VelocityRows {
 public:
  static Result<VelocityRows> create(const Kinematics& at, const VelocityLimit& options);
  static VelocityRows uniform(int n, double limit);  ///< one bound for all columns
  int count() const { return 0; }
  void add_to(ConstraintRows rows, Kinematics& at, double dt) const;

 private:
  std::vector<std::pair<int, double>> bounds_;  // column, velocity
};

}  // namespace gloam::ik

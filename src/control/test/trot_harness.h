#pragma once
// Walks a robot on a floor under the trot controller and measures how well it follows.

#include <mujoco/mujoco.h>

#include <array>
#include <string>
#include <vector>

#include "control/trot.h"
#include "control/trot_options.h"
#include "trot_robots.h"

namespace gloam {

struct TrialGoal {
  double time = 0;  ///< [s]
  VelocityTarget target;
};

struct Trial {
  std::vector<TrialGoal> goals;
  double duration = 10;  ///< [s]
  double settle = 1;     ///< stands this long before the schedule starts [s]; not measured
  double push = 0;       ///< [m/s], in a random direction
  int pushes = 0;        ///< at random times
  uint64_t seed = 1;
  double control_period = 0.002;  ///< [s]
  TrotOptions options;
  double surprise_mass = 0;  ///< put on the base after the controller has read the model [kg]
};

/// Velocities are those of the base's origin in the heading frame: forward, left, yaw.
struct TrialResult {
  bool fell = false;
  bool stepping = false;           ///< at the end
  std::array<double, 3> raw{};     ///< RMS of goal - measured over the whole run, every transient
                                   ///< included, over the RMS of the goal where it is not zero
  std::array<double, 3> stride{};  ///< the same after a moving mean over one stride
  std::array<double, 3> mean{};    ///< mean measured velocity [m/s, m/s, rad/s]
  std::array<double, 4> extent{};  ///< of the base's path: x from, to; y from, to [m]
  double tilt_deg = 0;             ///< RMS of roll and pitch together
  double height_sd = 0;            ///< of the base [m]
  double slip = 0;                 ///< mean speed of feet on the ground [m/s]
  double clearance = 0;            ///< mean height of a swing's top over the ground [m]
  double torque_share = 0;         ///< largest |torque| / limit
  double speed = 0;                ///< largest joint speed [rad/s]
  int64_t saturated = 0;
  int64_t calls = 0;
  double control_us = 0;  ///< mean CPU time of control() [us]
};

TrialResult run_trial(const mjModel& model, const Trial& trial);
std::string table_header();
std::string table_row(const std::string& name, const TrialResult& result);

}  // namespace gloam

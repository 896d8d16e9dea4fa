#pragma once
// Observation terms of policies: a closed list, the same for C++ and Python. Frames and signs
// follow legged_gym, Isaac Lab and mjlab: the base frame B is that of the robot's floating root
// body, x forward, y left, z up.

#include <mujoco/mujoco.h>
#include <toml++/toml.h>

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/contact.h"
#include "gloam/result.h"
#include "policy/settings.h"
#include "policy/terms/gait.h"
#include "world/world.h"

namespace gloam {

struct PolicySpec;

/// State of a robot at one instant. Joints are in the order of the policy, (n).
struct RobotState {
  std::array<double, 3> p_WB = {};                           ///< [m]
  std::array<double, 9> R_WB = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row by row
  std::array<double, 3> v_B = {}, omega_B = {};              ///< of B's origin [m/s], [rad/s]
  std::array<double, 3> gravity_B = {0, 0, -1};              ///< direction of gravity
  std::vector<double> q, qd;                                 ///< [rad], [rad/s]; m of slides
};

/// Inputs of a term at one observation.
struct TermInputs {
  const mjModel* model = nullptr;
  const mjData* data = nullptr;  ///< poses of bodies and contacts are those of the last step
  std::span<const ContactLoad> loads = {};
  const PolicySpec* spec = nullptr;
  const GaitOptions* gait = nullptr;
  const RobotState* robot = nullptr;
  std::span<const double> command;                  ///< vx, vy [m/s], yaw rate [rad/s], (3)
  std::span<const double> action, previous_action;  ///< last outputs after their clip, (n)
  const GaitClock* clock = nullptr;
  int64_t period = 0;             ///< number of the control period since the start
  std::span<const float> source;  ///< output of a network that the term reads
};

/// The robot whose elements a term finds in the model.
struct TermBinding {
  const mjModel* model;
  const RobotInstance* robot;
  const PolicySpec* spec;
};

/// One term of one policy. It may remember values between observations; copies remember the same.
class Term {
 public:
  virtual ~Term() = default;
  /// Numbers per observation, without history; 0 = as many as the output that it reads.
  virtual size_t size() const = 0;
  /// Finds its elements in a robot's model.
  virtual Status bind(const TermBinding&) { return {}; }
  /// Writes size() numbers before clip and scale. No allocation.
  virtual void write(const TermInputs& in, std::span<double> out) = 0;
  virtual void reset() {}
  /// Takes over what `before`, the same term in the World before a recompile, remembers.
  virtual void take_over(const Term& before) { static_cast<void>(before); }
  virtual std::unique_ptr<Term> clone() const = 0;
  /// Whether it reads the pose or velocity of a floating base.
  virtual bool needs_base() const { return false; }
};

/// A term's own keys in its [[observation]] table.
struct TermRequest {
  const toml::table* table;
  Settings* settings;
  const PolicySpec* spec;  ///< [policy] is complete
};

/// A row of the list of terms. Terms without keys of their own have a `write`, others a `make`.
struct TermKind {
  std::string_view name;
  std::string_view aliases;         ///< separated by spaces
  size_t fixed = 0, per_joint = 0;  ///< size = fixed + per_joint * joints; 0, 0 = by its keys
  std::string_view unit, doc;
  void (*write)(const TermInputs&, std::span<double>) = nullptr;
  std::unique_ptr<Term> (*make)(const TermRequest&) = nullptr;
  std::string_view keys = {};  ///< of its own, separated by spaces
  bool needs_base = false;
  bool reads_output = false;  ///< from = … is required
};

/// All terms, in the order of the documentation.
std::span<const TermKind> term_kinds();
/// The term of a name or alias; null: there is none, and `settings` has the error with the nearest.
const TermKind* find_term(const toml::node& name, Settings* settings);
/// Reads a term's own keys. Null: `settings` has the error.
std::unique_ptr<Term> make_term(const TermKind& kind, const TermRequest& request);

/// Groups of the list, one file each.
std::span<const TermKind> robot_terms();
std::span<const TermKind> command_terms();
std::span<const TermKind> gait_terms();
std::span<const TermKind> contact_terms();
std::span<const TermKind> ray_terms();
std::span<const TermKind> network_terms();

}  // namespace gloam

#pragma once
// Specification of a policy: what its networks were trained with. Read from a TOML file, from the
// metadata of ONNX files of mjlab and holosoma, or both.

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "policy/terms/gait.h"
#include "policy/terms/terms.h"

namespace gloam {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// An output of a network: "NETWORK" (its first) or "NETWORK.OUTPUT".
struct OutputName {
  std::string network, output;
  bool is_set() const { return !network.empty(); }
};

/// One part of an observation. Order of work: value, clip, scale, history.
struct ObservationPart {
  const TermKind* kind = nullptr;  ///< its row in the list
  std::shared_ptr<const Term> term;
  std::vector<double> scale = {1};                         ///< one number, or one of each value
  std::array<double, 2> clip = {-kUnlimited, kUnlimited};  ///< in the term's unit
  int history = 1;                                         ///< observations that are handed in
  std::string sensor;        ///< gives the values instead of the true state; "" = none
  std::string input;         ///< input of the network; "" = its first
  OutputName from;           ///< the output that a term of networks reads
  int first = 0, count = 0;  ///< elements of that output; count 0 = all from `first`
  SourceLoc loc;
};

struct NetworkSpec {
  std::string name = "policy";
  std::filesystem::path file;  ///< relative to the settings; "" = the policy's own file
  int every = 1;               ///< it runs in each k-th control period
  int history = 1;             ///< whole observations of its first input that are handed in
  bool newest_first = false;   ///< order of all its histories
  bool prime = false;          ///< run once at the start, so that its terms can read its outputs
  std::vector<ObservationPart> parts;
  SourceLoc loc;
};

/// Lists are (n), in the order of `joints`.
struct PolicySpec {
  std::string file;  ///< names it in errors
  double rate = 50;  ///< [Hz]
  std::vector<std::string> joints;
  std::vector<double> kp, kd;             ///< [N m/rad], [N m s/rad]
  std::vector<double> default_positions;  ///< [rad]
  std::vector<double> action_scale;       ///< target = default + scale * action [rad]
  std::vector<double> torque_limit;       ///< [N m], infinite if not given
  std::array<double, 2> action_clip = {-kUnlimited, kUnlimited};
  bool starts_with_zeros = false;  ///< before the first observation: zeros, else repetitions of it
  /// vx, vy [m/s], yaw rate [rad/s]
  std::array<std::array<double, 2>, 3> command_ranges = {
      {{-kUnlimited, kUnlimited}, {-kUnlimited, kUnlimited}, {-kUnlimited, kUnlimited}}};
  /// Gain of the integral of the velocity's error that is added to commands [1/s]; 0 = none
  double velocity_feedback = 0;
  std::map<std::string, std::string> model_joints;  ///< names in the model where they differ
  GaitOptions gait;
  std::vector<std::string> feet;  ///< geoms or bodies of the model
  std::vector<NetworkSpec> networks;
};

inline constexpr std::array<std::string_view, 3> kCommandAxes = {"vx", "vy", "yaw_rate"};

/// Settings from the metadata of an ONNX file by mjlab or holosoma: {policy = {…}, observation =
/// […]}; empty without known metadata.
Result<toml::table> settings_of_metadata(
    const std::vector<std::pair<std::string, std::string>>& metadata, const std::string& file);

/// Settings of the metadata, overridden by a TOML: keys of [policy] one by one, [[observation]] as
/// a whole.
Result<toml::table> merge_settings(const toml::table& base, toml::table over,
                                   const std::string& file);

/// The checked spec. Errors name `file` and the place.
Result<PolicySpec> build_policy_spec(const toml::table& settings, const std::string& file);

/// Reads [policy.gait].
void read_gait(const toml::table& table, Settings* settings, GaitOptions* gait);
/// Reads the tables of observations of a network.
void read_observations(const toml::node& list, Settings* settings, const PolicySpec& spec,
                       NetworkSpec* network);

}  // namespace gloam

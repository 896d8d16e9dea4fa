#pragma once
// The inputs of one network at one control period: terms in order, each clipped, scaled and with
// its history; then the history of whole observations.

#include <span>
#include <vector>

#include "policy/network.h"
#include "policy/policy_spec.h"

namespace gloam {

/// The last values of one part of an observation, as they are handed in.
class ValueHistory {
 public:
  ValueHistory(size_t size, int length, bool newest_first)
      : size_(size), newest_first_(newest_first), values_(size * static_cast<size_t>(length)) {}

  /// Adds values and drops the oldest. The first ones after a reset fill the whole history, or
  /// stand after zeros.
  void push(std::span<const double> now, bool starts_with_zeros);
  void reset() { is_empty_ = true; }
  std::span<const double> values() const { return values_; }

 private:
  size_t size_;
  bool newest_first_, is_empty_ = true;
  std::vector<double> values_;
};

/// Where a part of an observation goes, and the output that it reads.
struct PartWiring {
  size_t input = 0;        ///< of the network
  size_t offset = 0;       ///< in the whole observation of that input
  size_t size = 0;         ///< with its history
  bool is_framed = false;  ///< whether the network's own history contains it
  size_t source_network = 0, source_output = 0;
  size_t first = 0, count = 0;  ///< elements of the output; count 0 = it reads none
};

/// A network's parts, resolved against the sizes of the networks.
struct NetworkWiring {
  std::vector<PartWiring> parts;
  size_t frame = 0;  ///< numbers of one observation in the network's own history
};

/// Resolves the parts of all networks. Errors: terms that do not fill an input (with the size of
/// each), unknown inputs, networks, outputs.
Result<std::vector<NetworkWiring>> wire_networks(
    const PolicySpec& spec, std::span<const std::unique_ptr<Network>> networks);

/// Computes the inputs of one network. Copies remember the same past.
class Observer {
 public:
  Observer(const NetworkSpec& spec, const NetworkWiring& wiring);
  Observer(const Observer& other);
  Observer& operator=(const Observer&) = delete;

  Status bind(const TermBinding& binding);
  void reset();
  /// Takes over what `other`, of the same spec, remembers of histories.
  void take_over(const Observer& other);

  /// Computes part `i` from a sensor's reading, or from `in` if that is empty.
  void observe(size_t i, const TermInputs& in, std::span<const double> reading);
  /// Writes what was observed into the inputs. Returns the first part that is not finite; -1 =
  /// none.
  int write(bool starts_with_zeros, Network* network);

 private:
  const NetworkSpec& spec_;
  const NetworkWiring& wiring_;
  std::vector<std::unique_ptr<Term>> terms_;
  std::vector<ValueHistory> histories_;  // by part
  ValueHistory frames_;
  std::vector<double> value_, frame_;  // scratch
};

}  // namespace gloam

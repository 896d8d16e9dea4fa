#pragma once
// A state as a keyframe of MJCF: text that models, other simulators and this page exchange.

#include <string>
#include <string_view>
#include <vector>

#include "gloam/command.h"
#include "gloam/snapshot.h"

namespace gloam::studio {

/// Empty lists leave that part of the state as it is.
struct StateKey {
  std::vector<double> qpos, qvel, ctrl;
  std::vector<double> mpos, mquat;  ///< of mocap bodies
};

/// The state of an instant.
StateKey key_of(const Instant& instant);
/// A keyframe of the model. Error: there is none with this index.
Result<StateKey> keyframe_of(const Instant& instant, int keyframe);

std::string to_mjcf(const StateKey& key);
/// Reads a <key> element. Activations are ignored. Errors: not XML, no <key>, not numbers.
Result<StateKey> parse_key(std::string_view text);

/// Commands that set the state. Error: a list of another size than the model's.
Result<std::vector<Command>> set_key(const StateKey& key, const Instant& instant);

}  // namespace gloam::studio

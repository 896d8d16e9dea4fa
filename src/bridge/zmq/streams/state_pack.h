#pragma once
// State of an instant as msgpack: {step, time, hash, qpos, qvel, ctrl}.

#include <memory>
#include <mutex>

#include "bridge/zmq/pack.h"
#include "gloam/snapshot.h"
#include "gloam/world.h"

namespace gloam::bridge::zeromq {

/// Lengths of arrays in Snapshot::state() of one World.
struct StateLayout {
  size_t nq = 0, nv = 0, nu = 0;
  size_t ctrl_begin = 0;
};

/// Layouts by World; the last one is kept. Any thread.
class StateLayouts {
 public:
  /// Takes one forward pass where the World is another. Error: MuJoCo's.
  Result<StateLayout> of(const Snapshot& snapshot);

 private:
  std::mutex mutex_;
  std::shared_ptr<const CompiledWorld> world_;
  StateLayout layout_;
};

/// Number of pairs that pack_state() adds to a map.
inline constexpr uint32_t kStatePairs = 6;
/// Packs the pairs; the map around them is the caller's.
void pack_state(Packer& packer, const Snapshot& snapshot, const StateLayout& layout);

}  // namespace gloam::bridge::zeromq

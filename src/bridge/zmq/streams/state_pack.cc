#include "bridge/zmq/streams/state_pack.h"

namespace gloam::bridge::zeromq {
namespace {

// Length of an array of mjData; a model without such elements has none.
size_t length_of(const Instant& instant, const char* field) {
  const auto values = instant.value(field);
  return values.ok() ? values->size() : 0;
}

}  // namespace

Result<StateLayout> StateLayouts::of(const Snapshot& snapshot) {
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<const CompiledWorld> world = snapshot.world().compiled();
  if (world == world_) return layout_;
  Instant instant;
  GLOAM_TRY_STATUS(instant.solve(snapshot));
  StateLayout layout{.nq = length_of(instant, "qpos"),
                     .nv = length_of(instant, "qvel"),
                     .nu = length_of(instant, "ctrl")};
  // Time, qpos, qvel, act, history, qacc_warmstart come before: mj_getState's order.
  layout.ctrl_begin =
      1 + layout.nq + 2 * layout.nv + length_of(instant, "act") + length_of(instant, "history");
  if (layout.ctrl_begin + layout.nu > snapshot.state().size())
    return Error{ErrorKind::kUnsupported, "the state has an unexpected layout"};
  world_ = world;
  layout_ = layout;
  return layout;
}

void pack_state(Packer& packer, const Snapshot& snapshot, const StateLayout& layout) {
  const std::span<const double> state = snapshot.state();
  pack_pair(packer, "step", snapshot.step());
  pack_pair(packer, "time", snapshot.time());
  pack_pair(packer, "hash", snapshot.hash());
  packer.pack(std::string_view("qpos"));
  pack_numbers(packer, state.subspan(1, layout.nq));
  packer.pack(std::string_view("qvel"));
  pack_numbers(packer, state.subspan(1 + layout.nq, layout.nv));
  packer.pack(std::string_view("ctrl"));
  pack_numbers(packer, state.subspan(layout.ctrl_begin, layout.nu));
}

}  // namespace gloam::bridge::zeromq

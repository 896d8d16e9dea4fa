// The state of a gas as bytes, and its hash.

#include <cstring>
#include <utility>

#include "base/hash.h"
#include "sim/effects/gas/gas_state.h"

namespace gloam {
namespace {

constexpr uint64_t kFormat = 0x31534147'4d4f4c47;  // "GLOMGAS1"

/// Calls f with each block of bytes of the state, always in the same order.
template <class State, class F>
void for_blocks(State& state, F&& f) {
  const auto values = [&f](auto& v) { f(v.data(), v.size() * sizeof(v[0])); };
  const auto value = [&f](auto& v) { f(&v, sizeof(v)); };
  for (auto& field : state.velocity) values(field);
  for (auto& field : state.scalars) values(field);
  values(state.burning);
  values(state.pressure.solution());
  value(state.parity);
  value(state.last_dt);
  value(state.budget);
  for (int a = 0; a < 3; ++a) {
    values(state.walls.closed[a]);
    values(state.walls.velocity[a]);
  }
  values(state.walls.solid);
}

template <class State>
size_t saved_size(const State& state) {
  size_t size = sizeof(kFormat) + sizeof(GasGrid);
  for_blocks(state, [&size](const void*, size_t n) { size += n; });
  return size;
}

}  // namespace

void GasSolver::save(std::vector<std::byte>* out) const {
  state_->fetch(gas::kAllFields);
  const GasGrid grid = state_->grid;
  out->resize(saved_size(*state_));
  std::byte* to = out->data();
  const auto put = [&to](const void* data, size_t size) {
    std::memcpy(to, data, size);
    to += size;
  };
  put(&kFormat, sizeof(kFormat));
  put(&grid, sizeof(grid));
  for_blocks(std::as_const(*state_), put);
}

Status GasSolver::restore(std::span<const std::byte> bytes) {
  uint64_t format = 0;
  GasGrid grid;
  if (bytes.size() >= sizeof(format) + sizeof(grid)) {
    std::memcpy(&format, bytes.data(), sizeof(format));
    std::memcpy(&grid, bytes.data() + sizeof(format), sizeof(grid));
  }
  if (bytes.size() != saved_size(*state_) || format != kFormat || !(grid == state_->grid)) {
    return Error{ErrorKind::kInput, "these bytes are not the state of a gas on this grid"};
  }
  const std::byte* from = bytes.data() + sizeof(format) + sizeof(grid);
  for_blocks(*state_, [&from](void* to, size_t n) {
    std::memcpy(to, from, n);
    from += n;
  });
  state_->stale = 0;
  if (state_->card) state_->card->upload(gas::kAllFields);
  state_->use_walls();
  return {};
}

uint64_t GasSolver::hash() const {
  state_->fetch(gas::kAllFields);
  uint64_t hash = 0;
  for_blocks(std::as_const(*state_),
             [&hash](const void* data, size_t n) { hash = hash_bytes(data, n, hash); });
  return hash;
}

}  // namespace gloam

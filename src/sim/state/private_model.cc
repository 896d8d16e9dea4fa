#include "sim/state/private_model.h"

#include <mujoco/mjxmacro.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

namespace gloam {
namespace {

constexpr size_t kAlignment = 64;  // that of MuJoCo's own arrays [bytes]

bool is_shared(std::string_view field) {
  constexpr std::array<std::string_view, 5> kShared = {"mesh_", "tex_", "skin_", "bvh_", "oct_"};
  return std::ranges::any_of(kShared, [&](auto prefix) { return field.starts_with(prefix); });
}

size_t aligned(size_t bytes) { return (bytes + kAlignment - 1) / kAlignment * kAlignment; }

std::byte* first_aligned(std::vector<std::byte>& storage) {
  void* at = storage.data();
  size_t room = storage.size();
  return static_cast<std::byte*>(std::align(kAlignment, 1, at, room));
}

// Calls use(array of `m`, the World's, bytes) for every array that is not shared.
template <class Use>
void for_each_own_array(mjModel& m, const mjModel& world, Use&& use) {
#undef MJ_M
#define MJ_M(n) m.n
#define X(type, name, rows, columns) \
  if (!is_shared(#name))             \
    use(m.name, world.name,          \
        sizeof(type) * static_cast<size_t>(m.rows) * static_cast<size_t>(columns));
#define XNV X
  MJMODEL_POINTERS
#undef XNV
#undef X
}

}  // namespace

PrivateModel::PrivateModel(std::shared_ptr<const CompiledWorld> world)
    : world_(std::move(world)), model_(*world_->model) {
  const mjModel& from = *world_->model;
  size_t bytes = kAlignment;
  for_each_own_array(model_, from, [&](auto&, const auto*, size_t n) { bytes += aligned(n); });
  arrays_.resize(bytes);
  std::byte* at = first_aligned(arrays_);
  for_each_own_array(model_, from, [&]<class T>(T*& own, const T*, size_t n) {
    own = reinterpret_cast<T*>(std::exchange(at, at + aligned(n)));
  });
  renew();
}

void PrivateModel::renew() {
  const mjModel& from = *world_->model;
  model_.opt = from.opt;
  for_each_own_array(model_, from, [](auto* own, const auto* array, size_t bytes) {
    if (bytes > 0) std::memcpy(own, array, bytes);
  });
  if (!bounds_.empty()) std::memcpy(model_.bvh_aabb, from.bvh_aabb, bounds_bytes());
}

void PrivateModel::own_bounds() {
  if (!bounds_.empty() || model_.nbvhstatic == 0) return;
  bounds_.resize(bounds_bytes() + kAlignment);
  const mjtNum* const from = model_.bvh_aabb;
  model_.bvh_aabb = reinterpret_cast<mjtNum*>(first_aligned(bounds_));
  std::memcpy(model_.bvh_aabb, from, bounds_bytes());
}

size_t PrivateModel::bounds_bytes() const {
  return sizeof(mjtNum) * 6 * static_cast<size_t>(model_.nbvhstatic);
}

}  // namespace gloam

#include "model_mirror.h"

#include <mujoco/mjxmacro.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <string_view>

namespace gloam::python {
namespace {

constexpr size_t kAlignment = 64;  // that of MuJoCo's own arrays [bytes]
constexpr size_t kLarge = size_t{1}
                          << 16;  // arrays beyond it are not compared at every step [bytes]

// As in the simulation's own copy of the model.
bool is_shared(std::string_view field) {
  constexpr std::array<std::string_view, 5> kShared = {"mesh_", "tex_", "skin_", "bvh_", "oct_"};
  return std::ranges::any_of(kShared, [&](auto prefix) { return field.starts_with(prefix); });
}

size_t aligned(size_t bytes) { return (bytes + kAlignment - 1) / kAlignment * kAlignment; }

// Calls use(name, array of `m`, the same of `physics`, numbers) for every array that is not shared.
template <class Use>
void for_each_array(mjModel& m, const mjModel& physics, Use&& use) {
#undef MJ_M
#define MJ_M(n) physics.n
#define X(type, name, rows, columns)                           \
  if (!is_shared(#name))                                       \
    use(#name, m.name, static_cast<const type*>(physics.name), \
        static_cast<size_t>(physics.rows) * static_cast<size_t>(columns));
#define XNV X
  MJMODEL_POINTERS
#undef XNV
#undef X
}

template <class T>
double number_at(const std::byte* array, size_t i) {
  T value;
  std::memcpy(&value, array + i * sizeof(T), sizeof(T));
  return static_cast<double>(value);
}

// True where a double has the same bits: a NaN that was written is refused later.
bool differs(const void* a, const void* b, size_t bytes) { return std::memcmp(a, b, bytes) != 0; }

Error cannot_change(const std::string& name) {
  return {ErrorKind::kUsage,
          "sim.model." + name + " cannot be changed while the simulation runs",
          {},
          "arrays of live fields can be changed: sim.model.body_mass, geom_friction, "
          "actuator_gainprm, dof_damping …; for other arrays, change the scene and recompile()"};
}

}  // namespace

struct ModelMirror::LiveArray {
  LiveFieldId field;
  std::byte* mine;
  const std::byte* physics;
  bool is_option;
  size_t width;  // of a number [bytes]
  double (*number)(const std::byte*, size_t);
  std::vector<std::byte> seen;  // as of the last follow()

  size_t bytes() const { return seen.size(); }
  bool is_written() const { return differs(mine, seen.data(), bytes()); }
  bool has_changed() const { return differs(physics, seen.data(), bytes()); }

  Command command() const {
    const auto differs_at = [&](size_t i) {
      return differs(mine + i * width, seen.data() + i * width, width);
    };
    size_t first = 0, end = bytes() / width;
    while (!differs_at(first)) ++first;
    while (!differs_at(end - 1)) --end;
    SetLiveField change{field, static_cast<int>(first), {}};
    for (size_t i = first; i < end; ++i) change.values.push_back(number(mine, i));
    return {.what = std::move(change)};
  }
};

ModelMirror::ModelMirror(std::shared_ptr<const mjModel_> physics)
    : physics_(std::move(physics)),
      arrays_(std::make_unique<mjModel>(*physics_)),
      seen_option_(std::make_unique<mjOption>(physics_->opt)) {
  size_t bytes = kAlignment;
  for_each_array(*arrays_, *physics_, [&]<class T>(const char*, T*&, const T*, size_t n) {
    bytes += aligned(n * sizeof(T));
  });
  storage_.resize(bytes);
  void* begin = storage_.data();
  size_t room = storage_.size();
  auto* at = static_cast<std::byte*>(std::align(kAlignment, 1, begin, room));
  for_each_array(*arrays_, *physics_, [&]<class T>(const char*, T*& own, const T*, size_t n) {
    own = reinterpret_cast<T*>(at);
    at += aligned(n * sizeof(T));
  });
  copy_all();
}

ModelMirror::~ModelMirror() = default;

mjModel* ModelMirror::lend() {
  lent_ = static_cast<mjModel*>(mju_malloc(sizeof(mjModel)));
  if (lent_ == nullptr) throw std::bad_alloc();
  *lent_ = *arrays_;
  lent_->buffer = nullptr;
  add_live_arrays();
  return lent_;
}

void ModelMirror::add_live_arrays() {
  const auto add = [this]<class T>(const std::string& name, T* mine, const T* physics, size_t n) {
    const bool is_option = name.starts_with("opt.");
    for (int i = 0; i < kLiveFieldCount; ++i) {
      const auto field = static_cast<LiveFieldId>(i);
      if (name != live_field_array(field) || n == 0) continue;
      const auto* from = reinterpret_cast<const std::byte*>(physics);
      live_.push_back({field,
                       reinterpret_cast<std::byte*>(mine),
                       from,
                       is_option,
                       sizeof(T),
                       number_at<T>,
                       {from, from + n * sizeof(T)}});
    }
  };
  for_each_array(*lent_, *physics_, add);
  add("opt.gravity", lent_->opt.gravity, static_cast<const mjtNum*>(physics_->opt.gravity), 3);
  add("opt.wind", lent_->opt.wind, static_cast<const mjtNum*>(physics_->opt.wind), 3);
}

std::vector<std::string> ModelMirror::writable() {
  std::vector<std::string> names;
  for (int i = 0; i < kLiveFieldCount; ++i)
    names.emplace_back(live_field_array(static_cast<LiveFieldId>(i)));
  return names;
}

// Name of an option that was written and is no live field; "" = none.
std::string ModelMirror::written_option() const {
  const mjOption &mine = lent_->opt, &seen = *seen_option_;
  std::string name;
  const auto compare = [&](const char* field, const auto& a, const auto& b) {
    const std::string_view text = field;
    if (text != "gravity" && text != "wind" && differs(&a, &b, sizeof(a)))
      name = std::string("opt.") + field;
  };
#define X(type, field, size) compare(#field, mine.field, seen.field);
#define XVEC(type, field, size) compare(#field, mine.field, seen.field);
  MJOPTION_FIELDS
#undef X
#undef XVEC
  return name;
}

// The same of arrays.
std::string ModelMirror::written_array() const {
  std::string found;
  for_each_array(
      *lent_, *physics_, [&]<class T>(const char* name, T*& mine, const T* physics, size_t n) {
        const auto* own = reinterpret_cast<const std::byte*>(mine);
        const bool is_live =
            std::ranges::any_of(live_, [own](const LiveArray& array) { return array.mine == own; });
        if (!is_live && n > 0 && differs(mine, physics, n * sizeof(T))) found = name;
      });
  return found;
}

Result<std::vector<Command>> ModelMirror::take_written(bool all) {
  std::vector<Command> commands;
  for (LiveArray& array : live_) {
    if ((!all && array.bytes() > kLarge) || !array.is_written()) continue;
    commands.push_back(array.command());
    std::memcpy(array.seen.data(), array.mine, array.bytes());
    is_taken_ = true;
  }
  std::string refused = written_option();
  // Who writes masses may let MuJoCo derive its constants; physics does so itself.
  if (refused.empty() && all && commands.empty()) refused = written_array();
  if (refused.empty()) return commands;
  is_taken_ = true;
  follow();
  return cannot_change(refused);
}

void ModelMirror::copy_all() {
  for_each_array(*arrays_, *physics_, []<class T>(const char*, T*& own, const T* from, size_t n) {
    if (n > 0) std::memcpy(own, from, n * sizeof(T));
  });
}

void ModelMirror::follow(bool all) {
  const bool has_changed = is_taken_ || std::ranges::any_of(live_, [all](const LiveArray& array) {
                             const bool is_compared =
                                 !array.is_option && (all || array.bytes() <= kLarge);
                             return is_compared && (array.has_changed() || array.is_written());
                           });
  is_taken_ = false;
  *seen_option_ = physics_->opt;
  if (lent_ != nullptr) lent_->opt = physics_->opt;
  if (has_changed) copy_all();
  for (LiveArray& array : live_)
    if (has_changed || array.is_option)
      std::memcpy(array.seen.data(), array.physics, array.bytes());
}

std::shared_ptr<ModelMirror> ModelMirrors::make(const std::shared_ptr<mjModel_>& physics) {
  auto mirror = std::make_shared<ModelMirror>(physics);
  const std::lock_guard lock(mutex_);
  std::erase_if(mirrors_, [](const auto& one) { return one.second.expired(); });
  mirrors_[physics.get()] = mirror;
  return mirror;
}

std::shared_ptr<ModelMirror> ModelMirrors::of(const mjModel_* physics) const {
  const std::lock_guard lock(mutex_);
  const auto found = mirrors_.find(physics);
  return found == mirrors_.end() ? nullptr : found->second.lock();
}

}  // namespace gloam::python

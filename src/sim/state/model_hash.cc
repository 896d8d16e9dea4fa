#include "sim/state/model_hash.h"

#include <mujoco/mjxmacro.h>

#include <string_view>

#include "base/hash.h"

namespace gloam {

uint64_t hash_model(const mjModel& model) {
  // Paths are absolute in a compiled model; where they lie among each other says nothing either.
  const auto is_path = [](std::string_view name) {
    return name == "paths" || name == "npaths" || name == "nbuffer" || name.ends_with("pathadr") ||
           name.ends_with("contenttypeadr");
  };
  uint64_t hash = 0;
  const auto add = [&](std::string_view name, const void* data, size_t bytes) {
    if (!is_path(name)) hash = hash_bytes(data, bytes, hash);
  };
  const mjModel* m = &model;
#define X(name) add(#name, &m->name, sizeof(m->name));
  MJMODEL_SIZES
#undef X
#undef MJ_M
#define MJ_M(n) m->n
#define X(type, name, nr, nc) \
  add(#name, m->name, sizeof(type) * static_cast<size_t>(m->nr) * static_cast<size_t>(nc));
  MJMODEL_POINTERS
#undef X
#undef MJ_M
#define MJ_M(n) n
  add("opt", &m->opt, sizeof(m->opt));
  add("vis", &m->vis, sizeof(m->vis));
  add("stat", &m->stat, sizeof(m->stat));
  return hash;
}

}  // namespace gloam

#include "sim/state/same_physics.h"

#include <mujoco/mjxmacro.h>

#include <array>
#include <cstring>
#include <string_view>

namespace gloam {
namespace {

// Members of the groups below that are looks, groups of viewers, or of users.
bool is_look(std::string_view name) {
  constexpr std::array<std::string_view, 5> kEnds = {"_matid", "_group", "_rgba", "_user",
                                                     "_castshadow"};
  for (const std::string_view end : kEnds)
    if (name.ends_with(end)) return true;
  return name == "tendon_width";
}

// Options that the weather sets, too: in a replay they move smoke, not bodies.
bool is_of_the_air(std::string_view option) {
  return option == "wind" || option == "density" || option == "viscosity";
}

}  // namespace

std::string physical_difference(const mjModel& a, const mjModel& b) {
  std::string first;
  const auto compare = [&first](const char* name, const void* x, const void* y, size_t bytes) {
    if (first.empty() && !is_look(name) && bytes > 0 && std::memcmp(x, y, bytes) != 0) first = name;
  };
#define X(type, name, nr, nc)                     \
  if (first.empty() && a.nr != b.nr) first = #nr; \
  if (first.empty())                              \
    compare(#name, a.name, b.name,                \
            sizeof(type) * static_cast<size_t>(a.nr) * static_cast<size_t>(nc));
#undef MJ_M
#define MJ_M(n) a.n
#undef XNV
#define XNV X
  X(mjtNum, qpos0, nq, 1)
  X(mjtNum, qpos_spring, nq, 1)
  MJMODEL_POINTERS_BODY
  MJMODEL_POINTERS_JOINT
  MJMODEL_POINTERS_DOF
  MJMODEL_POINTERS_GEOM
  MJMODEL_POINTERS_EQUALITY
  MJMODEL_POINTERS_TENDON
  MJMODEL_POINTERS_ACTUATOR
#undef X
#define X(type, name, n) \
  if (!is_of_the_air(#name)) compare("opt." #name, &a.opt.name, &b.opt.name, sizeof(a.opt.name));
#define XVEC X
  MJOPTION_FIELDS
#undef XVEC
#undef X
  return first;
}

}  // namespace gloam

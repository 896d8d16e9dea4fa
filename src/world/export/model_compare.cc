#include "world/export/model_compare.h"

#include <mujoco/mjxmacro.h>

#include <cstring>
#include <string_view>

namespace gloam {
namespace {

bool says_where_it_came_from(std::string_view field) {
  return field == "paths" || field == "npaths" || field == "nbuffer" || field.ends_with("_pathadr");
}

}  // namespace

std::vector<std::string> compare_models(const mjModel* a, const mjModel* b, int* compared) {
  std::vector<std::string> differing;
  int ignored = 0;
  int& count = compared != nullptr ? *compared : ignored;
  count = 0;
  const auto check = [&](const char* name, bool equal) {
    if (says_where_it_came_from(name)) return;
    ++count;
    if (!equal) differing.emplace_back(name);
  };
#define X(name) check(#name, a->name == b->name);
  MJMODEL_SIZES
#undef X
  if (!differing.empty()) return differing;  // arrays of different sizes cannot be compared

#define X(type, name, n) \
  check("opt." #name, std::memcmp(&a->opt.name, &b->opt.name, sizeof(a->opt.name)) == 0);
#define XVEC(type, name, n) X(type, name, n)
  MJOPTION_FIELDS
#undef XVEC
#undef X
  check("vis", std::memcmp(&a->vis, &b->vis, sizeof(a->vis)) == 0);
  check("stat", std::memcmp(&a->stat, &b->stat, sizeof(a->stat)) == 0);
  check("flg_gravcomp", a->flg_gravcomp == b->flg_gravcomp);
  check("flg_surfacevel", a->flg_surfacevel == b->flg_surfacevel);
  check("flg_adhesion", a->flg_adhesion == b->flg_adhesion);

  MJMODEL_POINTERS_PREAMBLE(a)
  (void)nuser_body, (void)nuser_jnt, (void)nuser_geom, (void)nuser_site, (void)nuser_cam;
  (void)nuser_tendon, (void)nuser_actuator, (void)nuser_sensor;
  (void)nq, (void)nv, (void)na, (void)nu, (void)nmocap, (void)nplastic;
  // The paths of files may differ in length, so they are not even read.
#define X(type, name, n, columns)                                                                 \
  if (!says_where_it_came_from(#name)) {                                                          \
    const size_t bytes = sizeof(type) * static_cast<size_t>(a->n) * static_cast<size_t>(columns); \
    check(#name, bytes == 0 || std::memcmp(a->name, b->name, bytes) == 0);                        \
  }
#define XNV X
  MJMODEL_POINTERS
#undef XNV
#undef X
  return differing;
}

}  // namespace gloam

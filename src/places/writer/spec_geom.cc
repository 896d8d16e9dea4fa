#include "places/writer/spec_geom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "places/writer/spec_edit.h"

namespace gloam {

std::string set_free_name(mjsElement* element, const std::string& text) {
  std::string name = text;
  for (int n = 2; edit(mjs_setName, element, name.c_str()) != 0; ++n)
    name = fmt::format("{}_{}", text, n);
  return name;
}

const mjsDefault* own_defaults() {
  struct Deleter {
    void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
  };
  static const std::unique_ptr<mjSpec, Deleter> spec(edit(mj_makeSpec));
  return mjs_getSpecDefault(spec.get());
}

void write_pose(const Pose& X, double* pos, double* quat) {
  pos[0] = X.p.x, pos[1] = X.p.y, pos[2] = X.p.z;
  quat[0] = X.q.w, quat[1] = X.q.x, quat[2] = X.q.y, quat[3] = X.q.z;
  // MuJoCo normalises what it reads: what no longer changes by that survives export bit for bit.
  for (int i = 0; i < 8; ++i) {
    const double norm =
        std::sqrt(quat[0] * quat[0] + quat[1] * quat[1] + quat[2] * quat[2] + quat[3] * quat[3]);
    for (int k = 0; k < 4; ++k) quat[k] = quat[k] / norm + 0.0;  // no -0: MJCF leaves defaults out
  }
}

void write_friction(const std::optional<Vec3>& friction, mjsGeom* geom) {
  if (!friction) return;
  const double numbers[3] = {friction->x, friction->y, friction->z};
  std::copy(numbers, numbers + 3, geom->friction);
}

mjsGeom* add_collider_geom(mjsBody* body, const std::string& name, const mjsDefault* defaults) {
  mjsGeom* geom = edit(mjs_addGeom, body, defaults);
  set_free_name(geom->element, name);
  geom->group = kColliderGroup;
  constexpr float kBlue[4] = {0.3f, 0.6f, 0.9f, 0.3f};
  std::copy(kBlue, kBlue + 4, geom->rgba);
  return geom;
}

}  // namespace gloam

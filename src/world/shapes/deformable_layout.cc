#include "world/shapes/deformable_layout.h"

#include "world/shapes/capsule_mesh.h"
#include "world/shapes/tendon_path.h"

namespace gloam {

DeformableLayout deformable_layout(const mjModel& model) {
  DeformableLayout layout;
  const int skin_vertices = static_cast<int>(model.nskinvert);
  for (int skin = 0; skin < model.nskin; ++skin) {
    layout.skin_first.push_back(model.skin_vertadr[skin]);
  }
  for (int flex = 0; flex < model.nflex; ++flex) {
    layout.flex_first.push_back(skin_vertices + model.flex_vertadr[flex]);
  }
  layout.nvertex = skin_vertices + static_cast<int>(model.nflexvert);
  const auto add_capsules = [&layout](int count, std::vector<int>* first) {
    first->push_back(count > 0 ? layout.nvertex : -1);
    layout.nvertex += count * kCapsuleVertices;
  };
  for (int flex = 0; flex < model.nflex; ++flex) {
    add_capsules(model.flex_dim[flex] == 1 ? model.flex_elemnum[flex] : 0, &layout.cable_first);
  }
  for (int tendon = 0; tendon < model.ntendon; ++tendon) {
    add_capsules(tendon_segments(model, tendon), &layout.tendon_first);
    layout.has_tendons |= layout.tendon_first.back() >= 0;
  }
  return layout;
}

void place_capsules(const mjModel& model, const mjData& data, const double* gravity,
                    const DeformableLayout& layout, float* vertices) {
  for (int flex = 0; flex < model.nflex; ++flex) {
    const int first = layout.cable_first[static_cast<size_t>(flex)];
    if (first < 0) continue;
    const int* ends = model.flex_elem + model.flex_elemdataadr[flex];
    const double* points = data.flexvert_xpos + 3 * model.flex_vertadr[flex];
    float* out = vertices + 3 * first;
    for (int e = 0; e < model.flex_elemnum[flex]; ++e, out += 3 * kCapsuleVertices) {
      place_capsule(points + 3 * ends[2 * e], points + 3 * ends[2 * e + 1], model.flex_radius[flex],
                    out);
    }
  }
  for (int tendon = 0; tendon < model.ntendon; ++tendon) {
    const int first = layout.tendon_first[static_cast<size_t>(tendon)];
    if (first >= 0) place_tendon(model, data, gravity, tendon, vertices + 3 * first);
  }
}

}  // namespace gloam
